//! No oil in the groove.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{Flank, FlankCtx, FlankLaw, FlankSpec};
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The ring moves in a dry groove.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dry {}

#[register_model(
    name = "dry",
    summary = "dry groove: no resistance to axial motion, gas passes the whole gap",
    equations = "F = 0",
    validity = "Upper bound of ring mobility.",
    references = [],
    example = "",
)]
impl FlankSpec for Dry {
    fn build(&self, _: &FlankCtx) -> Result<Box<dyn Flank>, BuildError> {
        Ok(Box::new(Runtime))
    }
}

#[derive(Clone, Copy)]
struct Runtime;

impl Stateful for Runtime {}

impl Flank for Runtime {
    fn law(&self) -> Box<dyn FlankLaw> {
        Box::new(*self)
    }
}

impl FlankLaw for Runtime {
    fn force(&self, _: &FlankOil, _: f64, _: f64, _: f64, _: f64) -> f64 {
        0.0
    }
}
