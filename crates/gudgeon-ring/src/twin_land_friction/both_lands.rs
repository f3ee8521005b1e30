//! Both running faces rub.

use gudgeon_core::kinds::{TwinLandFriction, TwinLandFrictionSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Each running face counts as it is: `F = F_upper + F_lower`.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BothLands {}

#[register_model(
    name = "both_lands",
    summary = "sum over both running faces",
    equations = "F = F_upper + F_lower",
    validity = "Any ring with two running faces.",
    references = [],
    example = "",
)]
impl TwinLandFrictionSpec for BothLands {
    fn build(&self) -> Result<Box<dyn TwinLandFriction>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl TwinLandFriction for BothLands {
    fn shares(&self) -> [f64; 2] {
        [1.0; 2]
    }
}
