use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// No solid contact: only the film carries load, however thin it becomes.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no solid contact, the film carries everything",
    equations = "p_contact = 0",
    validity = "Films that stay thicker than the roughness. A film that no load-carrying surface stops may become as thin as the equations make it.",
    references = [],
    example = "",
)]
impl ContactSpec for Off {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        Ok(Box::new(NoContact))
    }
}

#[derive(Debug)]
struct NoContact;

impl Contact for NoContact {
    fn pressure(&self, _: &[f64], pressure: &mut [f64]) {
        pressure.fill(0.0);
    }
    fn range(&self) -> f64 {
        0.0
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        0.0
    }
}
