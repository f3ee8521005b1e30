//! Axial gas force with a linear profile.

use gudgeon_core::geometry::RingSection;
use gudgeon_core::kinds::{AxialGas, AxialGasSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pressure linear along both flanks (zottin1992 eq. 4.2): the pressure behind the ring drops out.
///
/// ```text
/// F = A (p_below - p_above) / 2
/// ```
///
/// `A` the flank annulus of the ring.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearProfile {}

#[register_model(
    name = "linear_profile",
    summary = "flank annulus, pressure linear along both flanks",
    equations = "F = A (p_below - p_above)/2",
    validity = "Small pressure ratios: the profile of an incompressible film in the flank gaps. Reproduces zottin1992.",
    references = ["zottin1992"],
    example = "",
)]
impl AxialGasSpec for LinearProfile {
    fn build(&self) -> Result<Box<dyn AxialGas>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl AxialGas for LinearProfile {
    fn force(&self, ring: &RingSection<'_>) -> f64 {
        0.5 * ring.place.flank_area() * (ring.p_below - ring.p_above)
    }
}
