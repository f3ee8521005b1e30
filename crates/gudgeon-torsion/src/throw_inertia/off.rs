use gudgeon_core::kinds::{ThrowCtx, ThrowInertia, ThrowInertiaSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::mean::Same;

/// The crank alone: rod and piston add nothing.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "inertia of the crank alone",
    equations = "I = I_c",
    validity = "Lines whose inertias are given as sums already.",
    references = [],
    example = "",
)]
impl ThrowInertiaSpec for Off {
    fn build(&self, ctx: &ThrowCtx) -> Result<Box<dyn ThrowInertia>, BuildError> {
        Ok(Box::new(Same { inertia: ctx.crank_inertia }))
    }
}
