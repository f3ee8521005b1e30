//! Radial gas load without the end faces of the gap.

use gudgeon_core::geometry::RingSection;
use gudgeon_core::kinds::{RadialGas, RadialGasSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pressure behind the ring on its inner cylinder and the lands on the parts of the face beside the running face, all above `p_cav`:
///
/// ```text
/// r_o W = p_back b r_i - r_o ∫ p dx (beside the running face)
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BackAndFace {}

#[register_model(
    name = "back_and_face",
    summary = "back of the ring and face beside the running face, without the ends of the gap",
    equations = "r_o W = p_back b r_i - r_o int p dx (beside the running face)",
    validity = "A ring without a gap. For a split ring p b w/r_o is missing, some 8 % of p b.",
    references = [],
    example = "",
)]
impl RadialGasSpec for BackAndFace {
    fn build(&self) -> Result<Box<dyn RadialGas>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl RadialGas for BackAndFace {
    fn circumference(&self, ring: &RingSection<'_>) -> f64 {
        ring.outer_circumference()
    }

    fn load(&self, ring: &RingSection<'_>) -> f64 {
        ring.gas_on_back() - ring.gas_beside_face()
    }
}
