use gudgeon_core::kinds::{PinFriction, PinFrictionSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The pin turns freely.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "the gudgeon pin turns freely",
    equations = "M = 0",
    validity = "Pins whose friction does not matter.",
    references = [],
    example = "",
)]
impl PinFrictionSpec for Off {
    fn build(&self) -> Result<Box<dyn PinFriction>, BuildError> {
        Ok(Box::new(Free))
    }
}

#[derive(Debug)]
struct Free;

impl PinFriction for Free {
    fn is_off(&self) -> bool {
        true
    }
    fn moment(&self, _: f64, _: f64) -> f64 {
        0.0
    }
}
