//! The lower running face counts twice.

use gudgeon_core::kinds::{TwinLandFriction, TwinLandFrictionSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The program listed in zottin1992 takes the lower running face twice: `F = 2 F_lower`.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LowerTwice {}

#[register_model(
    name = "lower_twice",
    summary = "the lower running face twice, as in a published program",
    equations = "F = 2 F_lower",
    validity = "Reproduces the listing of zottin1992. Wrong as soon as the two faces stand under different pressures.",
    references = ["zottin1992"],
    example = "",
)]
impl TwinLandFrictionSpec for LowerTwice {
    fn build(&self) -> Result<Box<dyn TwinLandFriction>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl TwinLandFriction for LowerTwice {
    fn shares(&self) -> [f64; 2] {
        [0.0, 2.0]
    }
}
