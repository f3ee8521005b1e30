use gudgeon_core::kinds::{SkirtCompliance, SkirtComplianceCtx, SkirtComplianceSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::QuasiStaticShapes;

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
    fn is_rigid(&self) -> bool {
        true
    }
    fn build(&self, ctx: &SkirtComplianceCtx<'_>) -> Result<Box<dyn SkirtCompliance>, BuildError> {
        Ok(Box::new(QuasiStaticShapes::new(ctx, Vec::new(), Vec::new())))
    }
}
