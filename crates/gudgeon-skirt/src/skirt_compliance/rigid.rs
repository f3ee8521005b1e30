use gudgeon_core::kinds::{SkirtComplianceCtx, SkirtComplianceSpec, SkirtModes};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A skirt that does not yield.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {}

#[register_model(
    name = "rigid",
    summary = "a skirt that does not yield",
    equations = "h has no elastic part",
    validity = "Deflections small against the film.",
    references = [],
    example = "",
)]
impl SkirtComplianceSpec for Rigid {
    fn build(&self, _: &SkirtComplianceCtx<'_>) -> Result<SkirtModes, BuildError> {
        Ok(SkirtModes::default())
    }
}
