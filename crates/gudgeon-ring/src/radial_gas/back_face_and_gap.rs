//! Radial gas load of a split ring in equilibrium.

use gudgeon_core::geometry::RingSection;
use gudgeon_core::kinds::{RadialGas, RadialGasSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Equilibrium of half a split ring of inner and outer radius `r_i` and `r_o`: pressure behind it on its inner cylinder, the lands on the parts
/// of the face beside the running face, and gas on the two end faces of the gap, `w` deep, which closes the ring like a hoop:
///
/// ```text
/// r_o W = p_back b r_i + p_gap b w - r_o ∫ p dx (beside the running face),    p_gap w = p_back (r_l - r_i) + ½ (p_above + p_below) (r_o - r_l)
/// ```
///
/// `W` the load of the gas on the running face per circumference \[N/m\], all pressures above `p_cav`, `r_l` the radius of the neighbouring lands: as
/// deep as the gap lies in the groove it sees the pressure behind the ring, outside it leads from land to land. Under one pressure everywhere `W` is that
/// pressure on the running face, as it must be; without the end faces `p b w / r_o` is missing, 8 % of `p b` of a usual ring, and gas pushes a ring
/// off the liner that nothing pushes.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BackFaceAndGap {}

#[register_model(
    name = "back_face_and_gap",
    summary = "equilibrium of half a split ring: back, face beside the running face, ends of the gap",
    equations = "r_o W = p_back b r_i + p_gap b w - r_o int p dx (beside the running face)",
    validity = "Sections much smaller than the radius; a ring that rotates or twists is not meant.",
    references = [],
    example = "",
)]
impl RadialGasSpec for BackFaceAndGap {
    fn build(&self) -> Result<Box<dyn RadialGas>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl RadialGas for BackFaceAndGap {
    fn circumference(&self, ring: &RingSection<'_>) -> f64 {
        ring.outer_circumference()
    }

    fn load(&self, ring: &RingSection<'_>) -> f64 {
        ring.gas_on_back() + on_gap(ring) - ring.gas_beside_face()
    }
}

/// Radial load of the gas on the end faces of the gap above `p_cav`, per circumference \[N/m\]: their force over the outer radius.
fn on_gap(ring: &RingSection<'_>) -> f64 {
    let (g, place) = (ring.geometry, ring.place);
    let land = 0.5 * (g.piston_radius_above + g.piston_radius_below);
    let land = land.clamp(place.r_inner, place.r_outer);
    let between = 0.5 * (ring.p_above + ring.p_below) - ring.p_cav;
    let force = (ring.p_back - ring.p_cav) * (land - place.r_inner) + between * (place.r_outer - land);
    g.height * force / place.r_outer
}
