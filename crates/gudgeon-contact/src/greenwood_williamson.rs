use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, PosPressure, PosRatio, Ratio, quantity};
use gudgeon_core::sets::Sets;
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::asperity_integral::{f_1, f_3_2};
use crate::summits::{SummitHeights, Summits};

/// Elastic contact of a rough surface with a smooth one: spherical summits of equal radius, Gaussian heights, each pressed by Hertz's law.
///
/// ```text
/// p(h) = (4/3) (η β σ) √(σ/β) (σ_s/σ)^(3/2) E' F_(3/2)(d)        d = (h - h_s)/σ_s
/// A_c/A = π (η β σ) (σ_s/σ) F_1(d)
/// F_n(d) = (2π)^(-1/2) ∫_d^∞ (s - d)^n exp(-s²/2) ds
/// ```
///
/// `h` is the separation of the mean planes, `σ` the composite roughness, `η` the number of summits per area, `β` their radius,
/// `1/E' = Σ (1-ν²)/E`, `σ_s` the deviation of the summits and `h_s` their mean height ([`SummitHeights`]). Two rough surfaces are
/// replaced by their sum over a plane, which is what sets this model apart from
/// [`GreenwoodTripp`](crate::GreenwoodTripp), where summits also meet side by side. The film is as thick as the mean gap, `σ F_1(-h/σ)`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("surfaces.json")))]
pub struct GreenwoodWilliamson {
    /// Composite roughness σ of the two surfaces: `√(σ1² + σ2²)` of their rms roughness.
    pub roughness: PosLength,
    /// Composite modulus E' with `1/E' = Σ (1-ν²)/E`: about 75 GPa for steel on grey cast iron, 115 GPa for steel on steel.
    pub composite_modulus: PosPressure,
    /// The product η β σ of the sum of both surfaces, usually 0.03 to 0.07.
    pub eta_beta_sigma: PosRatio,
    /// The ratio σ/β, usually 1e-4 to 1e-2.
    pub sigma_over_beta: PosRatio,
    /// Where the summits stand over the mean plane.
    #[serde(default)]
    pub summit_heights: SummitHeights,
    /// Coefficient of friction of the load that the asperities carry.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}

#[register_model(
    name = "greenwood_williamson",
    summary = "elastic spherical summits of a rough surface on a plane",
    equations = "p = (4/3) (eta beta sigma) sqrt(sigma/beta) (sigma_s/sigma)^(3/2) E' F_3/2(d);  d = (h - h_s)/sigma_s;  A_c/A = pi (eta beta sigma) (sigma_s/sigma) F_1(d)",
    validity = "Elastic, isotropic Gaussian roughness, summits that do not touch each other: real area below a tenth. Deeper overlap follows the formula.",
    references = ["greenwood1966", "mccool1986"],
    example = "roughness = \"0.4 um\"\ncomposite_modulus = \"115 GPa\"\neta_beta_sigma = 0.05\nsigma_over_beta = 1e-3\n",
)]
impl ContactSpec for GreenwoodWilliamson {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        let (product, ratio) = (self.eta_beta_sigma.si(), self.sigma_over_beta.si());
        let summits = Summits::new(self.roughness.si(), product, ratio, self.summit_heights)?;
        let slender = summits.deviation / summits.sigma;
        let scale =
            4.0 / 3.0 * product * ratio.sqrt() * slender * slender.sqrt() * self.composite_modulus.si();
        if !(scale.is_finite() && scale > 0.0) {
            return Err(BuildError::new(format!("the contact pressure has no finite scale: {scale:e} Pa")));
        }
        Ok(Box::new(Elastic {
            range: summits.range(f_3_2),
            summits,
            scale,
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

#[derive(Debug)]
struct Elastic {
    summits: Summits,
    scale: f64,
    range: f64,
    friction_coefficient: f64,
}

impl Contact for Elastic {
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]) {
        for (p, h) in pressure.iter_mut().zip(separation) {
            *p = self.scale * f_3_2(self.summits.distance(*h));
        }
    }
    fn range(&self) -> f64 {
        self.range
    }
    fn mean_gap(&self, separation: f64) -> f64 {
        self.summits.mean_gap(separation)
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
    /// Never above 1: summits that have grown together are no spheres any more.
    fn real_area(&self, separation: &[f64], ratio: &mut [f64]) -> bool {
        let s = &self.summits;
        let scale = std::f64::consts::PI * s.product * s.deviation / s.sigma;
        for (r, h) in ratio.iter_mut().zip(separation) {
            *r = (scale * f_1(s.distance(*h))).min(1.0);
        }
        true
    }
}
