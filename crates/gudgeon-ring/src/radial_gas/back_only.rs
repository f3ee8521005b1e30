//! Radial gas load on the back of the ring.

use gudgeon_core::geometry::RingSection;
use gudgeon_core::kinds::{RadialGas, RadialGasSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pressure behind the ring, above `p_cav`, on its inner cylinder alone (zottin1992 eq. 3.4): `W = p_back b r_i / r_o`.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BackOnly {}

#[register_model(
    name = "back_only",
    summary = "back of the ring alone",
    equations = "r_o W = p_back b r_i",
    validity = "Running faces as high as the ring. Reproduces zottin1992.",
    references = ["zottin1992"],
    example = "",
)]
impl RadialGasSpec for BackOnly {
    fn build(&self) -> Result<Box<dyn RadialGas>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl RadialGas for BackOnly {
    fn circumference(&self, ring: &RingSection<'_>) -> f64 {
        ring.outer_circumference()
    }

    fn load(&self, ring: &RingSection<'_>) -> f64 {
        ring.gas_on_back()
    }
}
