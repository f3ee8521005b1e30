//! Radial gas load of a published program.

use std::f64::consts::PI;

use gudgeon_core::geometry::RingSection;
use gudgeon_core::kinds::{RadialGas, RadialGasSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pressure behind the ring, above `p_cav`, on `π D b` (tomanik1993 eq. 5): `W = p_back b`, loads per length of the bore's circumference.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BorePerimeter {}

#[register_model(
    name = "bore_perimeter",
    summary = "pressure behind the ring on the bore circumference times the height",
    equations = "W = p_back b on pi D",
    validity = "Reproduces tomanik1993. The back is taken as long as the bore, too large by r_o/r_i.",
    references = ["tomanik1993"],
    example = "",
)]
impl RadialGasSpec for BorePerimeter {
    fn build(&self) -> Result<Box<dyn RadialGas>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl RadialGas for BorePerimeter {
    fn circumference(&self, ring: &RingSection<'_>) -> f64 {
        2.0 * PI * ring.bore_radius
    }

    fn load(&self, ring: &RingSection<'_>) -> f64 {
        ring.geometry.height * (ring.p_back - ring.p_cav)
    }
}
