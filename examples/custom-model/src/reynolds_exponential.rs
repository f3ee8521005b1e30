//! An oil by two measured viscosities. This file is the whole sub-model.

use gudgeon_core::elementary;
use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::quantity::{PosTemperature, PosViscosity, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The exponential law of Reynolds between two measured viscosities: `μ = μ_cold (μ_hot/μ_cold)^((T - T_cold)/(T_hot - T_cold))`.
///
/// Temperatures further than 50 times `T_hot - T_cold` away get the viscosity of that limit.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReynoldsExponential {
    /// Viscosity at the lower temperature.
    pub mu_cold: PosViscosity,
    /// Viscosity at the higher temperature.
    pub mu_hot: PosViscosity,
    /// Lower temperature.
    #[serde(default = "cold")]
    pub cold: PosTemperature,
    /// Higher temperature.
    #[serde(default = "hot")]
    pub hot: PosTemperature,
}

fn cold() -> PosTemperature {
    quantity(353.15)
}
fn hot() -> PosTemperature {
    quantity(393.15)
}

#[register_model(
    name = "reynolds_exponential",
    summary = "exponential law through two measured viscosities",
    equations = "mu = mu_cold (mu_hot/mu_cold)^((T - T_cold)/(T_hot - T_cold))",
    validity = "Between the two temperatures and some 20 K beyond: an oil thins less and less the hotter it is.",
    references = ["reynolds1886"],
    example = "mu_cold = \"20 mPa s\"\nmu_hot = \"7 mPa s\"\n",
)]
impl OilSpec for ReynoldsExponential {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        let (t1, t2) = (self.cold.si(), self.hot.si());
        if t2 <= t1 {
            return Err(BuildError::at(
                "hot",
                format!("{t2} K is not above the lower temperature of {t1} K"),
            ));
        }
        let ratio = elementary::ln(self.mu_hot.si() / self.mu_cold.si());
        if !(-LARGEST..0.0).contains(&ratio) {
            return Err(BuildError::at(
                "mu_hot",
                "an oil is thinner at the higher temperature, by less than a factor 1000",
            ));
        }
        Ok(Box::new(Exponential { mu: self.mu_cold.si(), ratio, cold: t1, span: t2 - t1 }))
    }
}

/// Largest logarithm of the ratio of both viscosities.
const LARGEST: f64 = 7.0;
/// Parts of `T_hot - T_cold` up to which the law is followed: `7 × 50` is an exponent that no viscosity overflows with.
const FURTHEST: f64 = 50.0;

#[derive(Debug)]
struct Exponential {
    mu: f64,
    /// `ln(μ_hot/μ_cold)`.
    ratio: f64,
    cold: f64,
    span: f64,
}

impl Oil for Exponential {
    fn viscosity(&self, temperature: f64) -> f64 {
        let part = ((temperature - self.cold) / self.span).clamp(-FURTHEST, FURTHEST);
        self.mu * elementary::exp(self.ratio * part)
    }
}
