//! The whole axial force of the film.

use gudgeon_core::kinds::{FaceForces, FilmForce, FilmForceSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Everything that the film does to the ring axially: shear on its face and pressure on the slope of the face, the dry parts included.
///
/// ```text
/// F = ∫ (μ u/h - h p'/2) dx - ∫ p h' dx
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Total {}

#[register_model(
    name = "total",
    summary = "shear on the ring face and pressure on its slope",
    equations = "F = int (mu u/h - h p'/2) dx - int p h' dx",
    validity = "Any face.",
    references = [],
    example = "",
)]
impl FilmForceSpec for Total {
    fn build(&self) -> Result<Box<dyn FilmForce>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl FilmForce for Total {
    fn per_length(&self, film: &FaceForces, beside: f64) -> f64 {
        film.ring_shear + film.slope_force + beside
    }
}
