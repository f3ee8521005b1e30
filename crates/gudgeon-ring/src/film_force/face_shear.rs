//! Axial force of the film as the shear on the ring face.

use gudgeon_core::kinds::{FaceForces, FilmForce, FilmForceSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shear on the ring face, without the pressure on its slope (tomanik1993 eq. 15).
///
/// ```text
/// F = ∫ (μ u/h - h p'/2) dx
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FaceShear {}

#[register_model(
    name = "face_shear",
    summary = "shear on the ring face alone",
    equations = "F = int (mu u/h - h p'/2) dx",
    validity = "Faces with little slope. Reproduces tomanik1993.",
    references = ["tomanik1993"],
    example = "",
)]
impl FilmForceSpec for FaceShear {
    fn build(&self) -> Result<Box<dyn FilmForce>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl FilmForce for FaceShear {
    fn per_length(&self, film: &FaceForces, _beside: f64) -> f64 {
        film.ring_shear
    }
}
