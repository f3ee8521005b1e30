//! Friction on the ring face.

use gudgeon_core::kinds::{Drag, DragSpec, FaceForces};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shear on the ring face alone, and the magnitude of its power (tomanik1993).
///
/// ```text
/// F = ∫ (μ u/h - h p'/2) dx        P = |F u|
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceShear {}

#[register_model(
    name = "face_shear",
    summary = "shear on the ring face, and the magnitude of its power",
    equations = "F = int (mu u/h - h p'/2) dx;  P = |F u|",
    validity = "Reproduces tomanik1993. The part that pressure on the slope of the face takes from the crank is not counted.",
    references = ["tomanik1993"],
    example = "",
)]
impl DragSpec for FaceShear {
    fn build(&self) -> Result<Box<dyn Drag>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl Drag for FaceShear {
    fn shear(&self, film: &FaceForces) -> f64 {
        film.ring_shear
    }

    fn power(&self, friction: f64, u: f64) -> f64 {
        (friction * u).abs()
    }
}
