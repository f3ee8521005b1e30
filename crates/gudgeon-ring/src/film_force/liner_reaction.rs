//! Axial force of the film as the reaction to liner friction.

use gudgeon_core::kinds::{FaceForces, FilmForce, FilmForceSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reaction to the shear on the liner (zottin1992 eq. 4.7): the total force but for the end term `[p h]`.
///
/// ```text
/// F = ∫ (μ u/h + h p'/2) dx
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinerReaction {}

#[register_model(
    name = "liner_reaction",
    summary = "reaction to the shear on the liner",
    equations = "F = int (mu u/h + h p'/2) dx",
    validity = "Ends of the film at which p h is small against the shear. Reproduces zottin1992.",
    references = ["zottin1992"],
    example = "",
)]
impl FilmForceSpec for LinerReaction {
    fn build(&self) -> Result<Box<dyn FilmForce>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl FilmForce for LinerReaction {
    fn per_length(&self, film: &FaceForces, _beside: f64) -> f64 {
        film.liner_shear
    }
}
