use std::f64::consts::PI;

use gudgeon_core::kinds::{PIN_QUANTITIES, PinStrength, PinStrengthCtx, PinStrengthSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::jet::Real;
use serde::{Deserialize, Serialize};

use super::formula::{Evaluated, Formula, Loaded, Surroundings};

/// Ovalisation of a ring of any thickness by plane elasticity, exact; deflection of the beam with shear.
///
/// A load uniform over the projection of the outer surface has the harmonics 0 and 2 only: a uniform pressure and four terms of
/// Michell's series solve the ring in closed form. A solid pin is left in uniaxial compression. The hoop stress is greatest at the
/// bore, in compression, beside the load.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElasticRing {
    /// Plane strain, for pins long beside their wall; otherwise plane stress, as every ring formula of practice.
    #[serde(default)]
    pub plane_strain: bool,
}

#[register_model(
    name = "elastic_ring",
    summary = "exact plane elasticity of a ring of any thickness; beam with shear",
    equations = "q = d_i/d_o, p = F/(2 d_o L);  dO = p d_o/E (((1+nu)(1 + q^2 + 3 q^4 - q^6) + 4 (1-nu) q^2 + 4 q^4 + 4 q^6)/(1 - q^2)^3 + (1 + q^2)/(1 - q^2) - nu);  s_o = 6 p (1 + q^2)/(1 - q^2)^2;  plane strain: E/(1 - nu^2) for E, nu/(1 - nu) for nu;  f and tau as shear_beam, the rest as thin_ring",
    validity = "Load uniform over the projection of the outer surface, total force. Exact for every wall, the solid pin's ovalisation included; the hoop stress of a solid pin is that at a vanishing bore.",
    references = ["timoshenko1970", "cowper1966", "reimer1984"],
    example = "plane_strain = false\n",
)]
impl PinStrengthSpec for ElasticRing {
    fn build(&self, ctx: &PinStrengthCtx) -> Result<Box<dyn PinStrength>, BuildError> {
        let at = Surroundings::new(ctx)?;
        let (modulus, poisson) = if self.plane_strain {
            (at.modulus / (1.0 - at.poisson * at.poisson), at.poisson / (1.0 - at.poisson))
        } else {
            (at.modulus, at.poisson)
        };
        Ok(Box::new(Evaluated(Michell { at, modulus, poisson })))
    }
}

#[derive(Debug)]
struct Michell {
    at: Surroundings,
    /// Constants of the plane problem.
    modulus: f64,
    poisson: f64,
}

impl Formula for Michell {
    const NAME: &'static str = "elastic_ring";
    fn surroundings(&self) -> &Surroundings {
        &self.at
    }
    #[inline(always)]
    fn quantities<T: Real>(&self, pin: &Loaded<'_, T>, _: f64) -> [T; PIN_QUANTITIES] {
        let nu = self.poisson;
        let q2 = pin.rho.squared();
        let (q4, q6) = (q2.squared(), q2.cubed());
        let wall = -q2 + 1.0;
        let second = ((q2 + q4 * 3.0 - q6 + 1.0) * (1.0 + nu) + q2 * (4.0 * (1.0 - nu)) + (q4 + q6) * 4.0)
            / wall.cubed();
        let uniform = (q2 + 1.0) / wall - nu;
        let per_length = pin.length.recip() * (0.5 * pin.total);
        let ovalisation = per_length * (second + uniform) / self.modulus;
        let hoop = per_length * (q2 + 1.0) * 6.0 / (pin.outer * wall.squared());
        let bending = pin.bending_stress();
        [
            pin.boss_pressure(),
            ovalisation,
            pin.deflection_of_beam() + pin.deflection_by_shear(),
            pin.rod_pressure(),
            bending,
            hoop,
            pin.shear_stress(8.0 / (3.0 * PI)),
            Loaded::resultant(bending, hoop),
        ]
    }
}
