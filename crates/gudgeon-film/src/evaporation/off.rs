use gudgeon_core::kinds::{Evaporation, EvaporationCtx, EvaporationSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// No oil evaporates.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no oil evaporates",
    equations = "flux = 0",
    validity = "Liners below some 120 degC, or results that do not ask how much oil is consumed.",
    references = [],
    example = "",
)]
impl EvaporationSpec for Off {
    fn is_off(&self) -> bool {
        true
    }

    fn build(&self, _: &EvaporationCtx) -> Result<Option<Box<dyn Evaporation>>, BuildError> {
        Ok(None)
    }
}
