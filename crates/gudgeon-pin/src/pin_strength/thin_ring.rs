use gudgeon_core::kinds::{PIN_QUANTITIES, PinStrength, PinStrengthCtx, PinStrengthSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::jet::Real;
use serde::{Deserialize, Serialize};

use super::formula::{Evaluated, Formula, Loaded, Surroundings};

/// The set of formulas after Schlaefke and Khovakh with which pins were sized (`reimer1984`).
///
/// The pin is a beam under a force spread over the small end, carried at the pressure centres of the bosses, and a thin ring that
/// the same force, uniform over its projection, flattens. Limits of practice were calibrated on these formulas, approximations
/// included: the deflection takes the coefficient of the moment, the ovalisation the gas force alone, the shear stress the
/// coefficient 0.85 for `8/(3π)`.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ThinRing {}

#[register_model(
    name = "thin_ring",
    summary = "beam and thin ring with the coefficients of practice, on which limits were calibrated",
    equations = "p_boss = F/(d_o (L - D3));  p_rod = F/(d_o B);  a = (L + D3)/2, gamma = 1 - B/(2 a);  f = gamma a^3 F/(48 E J);  s_b = gamma F a/(4 Z);  dO = F_gas ((1 + rho)/(1 - rho))^3/(8 E L), rho = d_i/d_o;  s_o = 0.75 F (d_o + d_i)/(L (d_o - d_i)^2);  tau = 0.85 F (1 + rho + rho^2)/(d_o^2 (1 - rho^4));  s_r = sqrt(s_b^2 + s_o^2)",
    validity = "For comparison with limits of the same formulas. The deflection is 16 % below the beam's and leaves out shear, the hoop stress of a wall of a sixth of the diameter 28 % below plane elasticity.",
    references = ["reimer1984"],
    example = "",
)]
impl PinStrengthSpec for ThinRing {
    fn build(&self, ctx: &PinStrengthCtx) -> Result<Box<dyn PinStrength>, BuildError> {
        Ok(Box::new(Evaluated(Published(Surroundings::new(ctx)?))))
    }
}

/// Coefficient of the shear stress as the published programs round it.
const SHEAR: f64 = 0.85;

#[derive(Debug)]
struct Published(Surroundings);

impl Formula for Published {
    const NAME: &'static str = "thin_ring";
    fn surroundings(&self) -> &Surroundings {
        &self.0
    }
    #[inline(always)]
    fn quantities<T: Real>(&self, pin: &Loaded<'_, T>, gas: f64) -> [T; PIN_QUANTITIES] {
        let (bending, hoop) = (pin.bending_stress(), pin.thin_ring_stress());
        [
            pin.boss_pressure(),
            pin.thin_ring_ovalisation(gas),
            pin.deflection_by_coefficient(),
            pin.rod_pressure(),
            bending,
            hoop,
            pin.shear_stress(SHEAR),
            Loaded::resultant(bending, hoop),
        ]
    }
}
