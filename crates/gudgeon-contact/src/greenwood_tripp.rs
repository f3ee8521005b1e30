use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{
    NonNegative, PosLength, PosPressure, PosRatio, PosSurfaceDensity, Ratio, quantity,
};
use gudgeon_core::sets::Sets;
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::asperity_formula::{AsperityIntegralFormula, hu1994, polynomial, quintic};
use crate::asperity_integral::{f_1, f_2, f_5_2_field};

/// Elastic contact of two rough surfaces whose summit heights are Gaussian.
///
/// ```text
/// p(h) = (16 √2 π / 15) (η β σ)² √(σ/β) E' F_(5/2)(h/σ)
/// A_c/A = π² (η β σ)² F_2(h/σ)
/// F_n(λ) = (2π)^(-1/2) ∫_λ^∞ (s - λ)^n exp(-s²/2) ds
/// ```
///
/// `h` is the separation of the mean planes, `σ` the composite roughness `√(σ1² + σ2²)`, `η` the number of asperities per
/// area, `β` the radius of their summits, and `E'` the composite modulus in the convention of Greenwood and Tripp,
/// `1/E' = (1-ν1²)/E1 + (1-ν2²)/E2` ([`composite_modulus`]). **A source that writes `2/E' = Σ(1-ν²)/E`, as the ring-liner
/// form of Hu et al. does, prints an `E'` twice as large: halve it.**
///
/// Give either `asperity_density` and `asperity_radius`, or the two products `eta_beta_sigma` (usually 0.03 to 0.07) and
/// `sigma_over_beta` (usually 1e-4 to 1e-2).
///
/// The film between the surfaces is as thick as their mean gap, which stays above zero however deep the mean planes overlap:
///
/// ```text
/// h_film = σ F_1(-h/σ) = ∫ max(h + s, 0) exp(-s²/2σ²)/(√(2π) σ) ds        0.399 σ at h = 0, h beyond 3 σ
/// ```
///
/// Separations below zero (mean planes overlapping) are answered by the formula, `F_(5/2) → |λ|^(5/2)`: the load rises on and on. Summits are
/// pressed flat there, and the model says what a perfectly elastic surface would do.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("surfaces.json")))]
pub struct GreenwoodTripp {
    /// Composite roughness σ of the two surfaces: `√(σ1² + σ2²)` of their rms roughness.
    pub roughness: PosLength,
    /// Composite modulus E' with `1/E' = Σ (1-ν²)/E`: about 75 GPa for steel on grey cast iron, 115 GPa for steel on steel.
    pub composite_modulus: PosPressure,
    /// Asperities per area η; with `asperity_radius`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asperity_density: Option<PosSurfaceDensity>,
    /// Radius of the asperity summits β; with `asperity_density`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub asperity_radius: Option<PosLength>,
    /// The product η β σ; with `sigma_over_beta`, instead of density and radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub eta_beta_sigma: Option<PosRatio>,
    /// The ratio σ/β; with `eta_beta_sigma`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_over_beta: Option<PosRatio>,
    /// How F_5/2 is evaluated: exactly, or by a fit that published results were made with.
    #[serde(default)]
    pub integral: AsperityIntegralFormula,
    /// Coefficient of friction of the load that the asperities carry.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}

/// Composite modulus \[Pa\] of two materials in the convention of Greenwood and Tripp: `1/E' = (1-ν1²)/E1 + (1-ν2²)/E2`.
#[must_use]
pub fn composite_modulus(modulus: [f64; 2], poisson: [f64; 2]) -> f64 {
    1.0 / ((1.0 - poisson[0] * poisson[0]) / modulus[0] + (1.0 - poisson[1] * poisson[1]) / modulus[1])
}

/// Composite roughness `√(σ1² + σ2²)` of two rms roughness heights.
#[must_use]
pub fn composite_roughness(sigma: [f64; 2]) -> f64 {
    elementary::hypot(sigma[0], sigma[1])
}

/// Real over nominal area of contact, `π² (η β σ)² F_2(λ)` with `λ = h/σ`.
#[must_use]
pub fn real_area_ratio(eta_beta_sigma: f64, lambda: f64) -> f64 {
    (std::f64::consts::PI * eta_beta_sigma).powi(2) * f_2(lambda)
}

#[register_model(
    name = "greenwood_tripp",
    summary = "elastic contact pressure of Gaussian rough surfaces",
    equations = "p = (16 sqrt(2) pi/15) (eta beta sigma)^2 sqrt(sigma/beta) E' F_5/2(h/sigma);  F_n(l) = (2 pi)^-1/2 int_l^inf (s-l)^n exp(-s^2/2) ds;  1/E' = sum (1-nu^2)/E",
    validity = "Elastic, isotropic Gaussian roughness; separations between about 0.5 and 4 roughness heights. The fits `hu1994` and `quintic` deviate by more than 11 % there and expect E' in the convention of this model.",
    references = ["greenwood1970", "hu1994"],
    example = "roughness = \"0.4 um\"\ncomposite_modulus = \"115 GPa\"\neta_beta_sigma = 0.05\nsigma_over_beta = 1e-3\n",
)]
impl ContactSpec for GreenwoodTripp {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        let sigma = self.roughness.si();
        let (ebs, ratio) =
            match (self.asperity_density, self.asperity_radius, self.eta_beta_sigma, self.sigma_over_beta) {
                (Some(eta), Some(beta), None, None) => (eta.si() * beta.si() * sigma, sigma / beta.si()),
                (None, None, Some(ebs), Some(ratio)) => (ebs.si(), ratio.si()),
                (Some(_), None, None, None) => return Err(missing("asperity_radius", "asperity_density")),
                (None, Some(_), None, None) => return Err(missing("asperity_density", "asperity_radius")),
                (None, None, Some(_), None) => return Err(missing("sigma_over_beta", "eta_beta_sigma")),
                (None, None, None, Some(_)) => return Err(missing("eta_beta_sigma", "sigma_over_beta")),
                (None, None, None, None) => {
                    return Err(BuildError::new("the asperities are not described").help(WAYS));
                }
                _ => return Err(BuildError::new("the asperities are described twice").help(WAYS)),
            };
        let scale = 16.0 * std::f64::consts::SQRT_2 * std::f64::consts::PI / 15.0
            * (ebs * ebs)
            * ratio.sqrt()
            * self.composite_modulus.si();
        let inverse_roughness = sigma.recip();
        if !(scale.is_finite() && scale > 0.0 && inverse_roughness.is_finite()) {
            let what = format!(
                "the contact pressure has no finite scale: eta_beta_sigma {ebs:e}, sigma_over_beta {ratio:e}, roughness {sigma:e} m"
            );
            return Err(BuildError::new(what));
        }
        Ok(Box::new(Asperities {
            sigma,
            inverse_roughness,
            scale,
            eta_beta_sigma: ebs,
            integral: self.integral,
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

const WAYS: &str = "give `asperity_density` and `asperity_radius`, or `eta_beta_sigma` and `sigma_over_beta`, not both pairs";

fn missing(field: &str, given: &str) -> BuildError {
    BuildError::at(field, format!("`{field}` is missing, it goes with `{given}`")).help(WAYS)
}

#[derive(Debug)]
struct Asperities {
    sigma: f64,
    inverse_roughness: f64,
    scale: f64,
    eta_beta_sigma: f64,
    integral: AsperityIntegralFormula,
    friction_coefficient: f64,
}

impl Contact for Asperities {
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]) {
        let (k, scale) = (self.inverse_roughness, self.scale);
        let pairs = pressure.iter_mut().zip(separation);
        match self.integral {
            AsperityIntegralFormula::Exact => f_5_2_field(separation, k, scale, pressure),
            AsperityIntegralFormula::Polynomial => pairs.for_each(|(p, h)| *p = scale * polynomial(h * k)),
            AsperityIntegralFormula::Hu1994 => pairs.for_each(|(p, h)| *p = scale * hu1994(h * k)),
            AsperityIntegralFormula::Quintic => pairs.for_each(|(p, h)| *p = scale * quintic(h * k)),
        }
    }
    fn range(&self) -> f64 {
        self.sigma * self.integral.range()
    }
    fn mean_gap(&self, separation: f64) -> f64 {
        self.sigma * f_1(-separation * self.inverse_roughness)
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
    /// By the exact integral, whichever formula gives the pressure.
    fn real_area(&self, separation: &[f64], ratio: &mut [f64]) -> bool {
        for (r, h) in ratio.iter_mut().zip(separation) {
            *r = real_area_ratio(self.eta_beta_sigma, h * self.inverse_roughness);
        }
        true
    }
}
