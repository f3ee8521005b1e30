//! No oil in the groove.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{FlankDamping, FlankDampingCtx, FlankDampingSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The ring moves in a dry groove.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[typetag::serde(name = "off")]
impl FlankDampingSpec for Off {
    fn build(&self, _: &FlankDampingCtx) -> Result<Box<dyn FlankDamping>, BuildError> {
        Ok(Box::new(Runtime))
    }
}

gudgeon_core::register_model! {
    Off,
    kind: "flank_damping",
    name: "off",
    summary: "dry groove: no resistance to axial motion",
    equations: "F = 0",
    validity: "Upper bound of ring mobility.",
    references: [],
    example: "",
}

struct Runtime;

impl FlankDamping for Runtime {
    fn force(&self, _: f64, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }
}
