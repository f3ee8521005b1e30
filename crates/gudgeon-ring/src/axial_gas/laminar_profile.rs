//! Axial gas force with laminar flow in the flank gaps.

use gudgeon_core::geometry::RingSection;
use gudgeon_core::kinds::{AxialGas, AxialGasSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Each flank gap has the mean of a laminar pressure profile, `p²` linear, between the pressure behind the ring and that of its land.
///
/// ```text
/// F = A (m(p_back, p_below) - m(p_back, p_above))        m(a, b) = 2/3 (a² + a b + b²)/(a + b)
/// ```
///
/// `A` the flank annulus of the ring. The mean follows from `∫₀¹ √(a² + (b² - a²) x) dx`.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LaminarProfile {}

#[register_model(
    name = "laminar_profile",
    summary = "flank annulus, pressure in the flank gaps as in laminar flow of a gas",
    equations = "F = A (m(p_back, p_below) - m(p_back, p_above)),  m(a, b) = 2/3 (a^2 + a b + b^2)/(a + b)",
    validity = "Flank gaps of even height in laminar flow. A wedge and the dam of a seated flank are not counted.",
    references = [],
    example = "",
)]
impl AxialGasSpec for LaminarProfile {
    fn build(&self) -> Result<Box<dyn AxialGas>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl AxialGas for LaminarProfile {
    fn force(&self, ring: &RingSection<'_>) -> f64 {
        // The difference of two means of the square root of a function that is linear from a² to b², 2/3 (a² + a b + b²)/(a + b), without the loss of digits
        // in it.
        let (back, below, above) = (ring.p_back, ring.p_below, ring.p_above);
        let kept = 1.0 - back * back / ((back + below) * (back + above));
        ring.place.flank_area() * (2.0 / 3.0 * (below - above) * kept)
    }
}
