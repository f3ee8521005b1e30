use gudgeon_core::kinds::{SkirtOil, SkirtOilSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// Every edge of the skirt is flooded at every instant, and the films know no history.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "every edge is flooded; the films have no history",
    equations = "theta = 1 at all edges",
    validity = "More oil than the gap takes, everywhere and always. What the films take in and give away is not balanced over a cycle.",
    references = [],
    example = "",
)]
impl SkirtOilSpec for Off {
    fn keeps_oil(&self) -> bool {
        false
    }

    fn build(&self) -> Result<Option<Box<dyn SkirtOil>>, BuildError> {
        Ok(None)
    }
}
