use gudgeon_core::kinds::{OilTransport, OilTransportCtx, OilTransportSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// No oil is followed: every running face has all the oil it can take, on both sides.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "fully flooded faces, nothing carried",
    equations = "the film reaches from edge to edge",
    validity = "An upper limit of film thickness; friction of a starved face is larger or smaller than this.",
    references = [],
    example = "",
)]
impl OilTransportSpec for Off {
    fn follows_oil(&self) -> bool {
        false
    }

    fn build(&self, _: &OilTransportCtx<'_>) -> Result<Option<Box<dyn OilTransport>>, BuildError> {
        Ok(None)
    }
}
