use gudgeon_core::kinds::{GrooveFriction, GrooveFrictionCtx, GrooveFrictionSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The rings do not hinder the piston across the bore.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "rings do not hinder the piston across the bore",
    equations = "F = 0",
    validity = "Rings that slide freely in their grooves.",
    references = [],
    example = "",
)]
impl GrooveFrictionSpec for Off {
    fn build(&self, _: &GrooveFrictionCtx) -> Result<Box<dyn GrooveFriction>, BuildError> {
        Ok(Box::new(Free))
    }
}

#[derive(Debug)]
struct Free;

impl GrooveFriction for Free {
    fn is_off(&self) -> bool {
        true
    }
    fn height(&self) -> f64 {
        0.0
    }
    fn force(&self, _: f64, _: f64) -> (f64, f64) {
        (0.0, 0.0)
    }
}
