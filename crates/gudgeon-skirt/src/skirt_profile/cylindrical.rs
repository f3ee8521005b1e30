use gudgeon_core::kinds::{SkirtProfile, SkirtProfileCtx, SkirtProfileSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A cylinder.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylindrical {}

#[register_model(
    name = "cylindrical",
    summary = "a cylinder",
    equations = "f = 0",
    validity = "Comparison with programs that have no profile; real skirts have one.",
    references = ["loureiro2009"],
    example = "",
)]
impl SkirtProfileSpec for Cylindrical {
    fn build(&self, _: &SkirtProfileCtx<'_>) -> Result<Box<dyn SkirtProfile>, BuildError> {
        Ok(Box::new(Straight))
    }
}

#[derive(Debug)]
struct Straight;

impl SkirtProfile for Straight {
    fn depth(&self, _: f64, _: f64) -> f64 {
        0.0
    }
    fn is_symmetric(&self) -> bool {
        true
    }
}
