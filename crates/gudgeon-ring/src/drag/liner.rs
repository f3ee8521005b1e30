//! Friction on the liner.

use gudgeon_core::kinds::{Drag, DragSpec, FaceForces};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Shear on the liner: what a load cell of the liner feels, and what the crank pays for.
///
/// ```text
/// F = ∫ (μ u/h + h p'/2) dx        P = F u
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Liner {}

#[register_model(
    name = "liner",
    summary = "shear on the liner, what the crank pays for",
    equations = "F = int (mu u/h + h p'/2) dx;  P = F u",
    validity = "Any face.",
    references = [],
    example = "",
)]
impl DragSpec for Liner {
    fn build(&self) -> Result<Box<dyn Drag>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl Drag for Liner {
    fn shear(&self, film: &FaceForces) -> f64 {
        film.liner_shear
    }
}
