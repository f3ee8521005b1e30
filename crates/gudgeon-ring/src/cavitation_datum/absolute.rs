//! Films cavitate at absolute zero.

use gudgeon_core::kinds::{CavitationDatum, CavitationDatumSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Absolute zero: the vapour pressure of an oil without dissolved gas, far below that of the lands.
///
/// ```text
/// p_cav = 0
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Absolute {}

#[register_model(
    name = "absolute",
    summary = "absolute zero",
    equations = "p_cav = 0",
    validity = "Oil without dissolved gas, whose vapour pressure is negligible. Films carry some 1 bar more than at crankcase pressure.",
    references = [],
    example = "",
)]
impl CavitationDatumSpec for Absolute {
    fn build(&self) -> Result<Box<dyn CavitationDatum>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl CavitationDatum for Absolute {
    fn pressure(&self, _p_crankcase: f64, _p_above: f64, _p_below: f64) -> f64 {
        0.0
    }
}
