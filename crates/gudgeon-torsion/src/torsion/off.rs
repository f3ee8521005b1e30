use gudgeon_core::kinds::{Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// No torsion: the shaft turns at constant speed and does not twist.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "constant speed, no twist",
    equations = "theta_i = ratio_i Omega t",
    validity = "Where neither speed fluctuation nor torque is asked for.",
    references = [],
    example = "",
)]
impl TorsionSpec for Off {
    fn build(&self, _: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        Ok(Box::new(Nothing))
    }
    fn is_linear(&self) -> bool {
        true
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Nothing
    }
}

#[derive(Debug)]
struct Nothing;

impl Torsion for Nothing {
    fn run(&mut self, _: &mut TorsionOut) -> Result<(), EvalError> {
        Ok(())
    }
}
