use std::f64::consts::PI;

use gudgeon_core::kinds::{PIN_QUANTITIES, PinStrength, PinStrengthCtx, PinStrengthSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::jet::Real;
use serde::{Deserialize, Serialize};

use super::formula::{Evaluated, Formula, Loaded, Surroundings};

/// The thin ring of `thin_ring` on a beam whose deflection is exact for its load, with shear.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShearBeam {
    /// Whether shear deflects the pin too.
    #[serde(default = "yes")]
    pub shear: bool,
}

fn yes() -> bool {
    true
}

#[register_model(
    name = "shear_beam",
    summary = "deflection of the beam under its spread load, with shear; ring as in thin_ring",
    equations = "f = F a^3/(48 E J) (1 - b^2/2 + b^3/8) + F (a/4 - B/8)/(kappa A G), b = B/a;  kappa = 6 (1+nu) (1+rho^2)^2/((7+6 nu) (1+rho^2)^2 + (20+12 nu) rho^2);  tau = 8/(3 pi) F (1 + rho + rho^2)/(d_o^2 (1 - rho^4));  the rest as thin_ring",
    validity = "A pin is a short beam: shear more than doubles the deflection, so limits calibrated on thin_ring do not apply to it.",
    references = ["cowper1966", "reimer1984"],
    example = "shear = true\n",
)]
impl PinStrengthSpec for ShearBeam {
    fn build(&self, ctx: &PinStrengthCtx) -> Result<Box<dyn PinStrength>, BuildError> {
        Ok(Box::new(Evaluated(Beam { at: Surroundings::new(ctx)?, shear: self.shear })))
    }
}

#[derive(Debug)]
struct Beam {
    at: Surroundings,
    shear: bool,
}

impl Formula for Beam {
    const NAME: &'static str = "shear_beam";
    fn surroundings(&self) -> &Surroundings {
        &self.at
    }
    #[inline(always)]
    fn quantities<T: Real>(&self, pin: &Loaded<'_, T>, gas: f64) -> [T; PIN_QUANTITIES] {
        let (bending, hoop) = (pin.bending_stress(), pin.thin_ring_stress());
        let mut deflection = pin.deflection_of_beam();
        if self.shear {
            deflection = deflection + pin.deflection_by_shear();
        }
        [
            pin.boss_pressure(),
            pin.thin_ring_ovalisation(gas),
            deflection,
            pin.rod_pressure(),
            bending,
            hoop,
            pin.shear_stress(8.0 / (3.0 * PI)),
            Loaded::resultant(bending, hoop),
        ]
    }
}
