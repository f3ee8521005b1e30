use gudgeon_core::kinds::{Fatigue, FatigueSpec};
use gudgeon_core::{BuildError, EvalError};
use serde::{Deserialize, Serialize};

/// No judgement of fatigue.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

gudgeon_core::register_model! {
    Off, kind: "fatigue", name: "off",
    summary: "no judgement of fatigue",
    equations: "none",
    validity: "Always.",
    references: [],
    example: "",
}

#[typetag::serde(name = "off")]
impl FatigueSpec for Off {
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
