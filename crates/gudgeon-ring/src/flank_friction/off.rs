//! No friction on the flanks.

use gudgeon_core::kinds::{FlankFriction, FlankFrictionSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The ring slides radially on its flank without resistance.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no friction between ring and groove flank",
    equations = "F = 0",
    validity = "Radial velocities of rings are a few mm/s; the friction left out is at most about a tenth of the axial load.",
    references = [],
    example = "",
)]
impl FlankFrictionSpec for Off {
    fn build(&self) -> Result<Box<dyn FlankFriction>, BuildError> {
        Ok(Box::new(Runtime))
    }
}

struct Runtime;

impl FlankFriction for Runtime {
    fn force(&self, _: f64, _: f64) -> f64 {
        0.0
    }
    fn derivative(&self, _: f64, _: f64) -> f64 {
        0.0
    }
    fn is_off(&self) -> bool {
        true
    }
}
