//! No oil in the groove.

use gudgeon_core::kinds::{FlankDamping, FlankDampingCtx, FlankDampingSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The ring moves in a dry groove.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "dry groove: no resistance to axial motion",
    equations = "F = 0",
    validity = "Upper bound of ring mobility.",
    references = [],
    example = "",
)]
impl FlankDampingSpec for Off {
    fn build(&self, _: &FlankDampingCtx) -> Result<Box<dyn FlankDamping>, BuildError> {
        Ok(Box::new(Runtime))
    }
}

struct Runtime;

impl FlankDamping for Runtime {
    fn force(&self, _: f64, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }
}
