use gudgeon_core::kinds::{Fatigue, FatigueSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// No judgement of fatigue.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no judgement of fatigue",
    equations = "none",
    validity = "Always.",
    references = [],
    example = "",
)]
impl FatigueSpec for Off {
    fn is_off(&self) -> bool {
        true
    }

    fn build(&self) -> Result<Box<dyn Fatigue>, BuildError> {
        Ok(Box::new(Unjudged))
    }
}

#[derive(Debug)]
struct Unjudged;

impl Fatigue for Unjudged {
    fn is_off(&self) -> bool {
        true
    }
    fn safety(&self, _: f64, _: f64) -> Result<f64, EvalError> {
        Err(EvalError::fatal("off", "fatigue is switched off"))
    }
}
