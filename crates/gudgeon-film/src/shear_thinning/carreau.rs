use gudgeon_core::kinds::{ShearThinning, ShearThinningSpec};
use gudgeon_core::quantity::{Fraction, PosShearRate, Ratio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::slices::check;

/// The law of Carreau: `μ/μ0 = m + (1 - m) [1 + (γ̇/γ̇_c)²]^((n-1)/2)`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Carreau {
    /// Shear rate γ̇_c at which thinning sets in.
    pub critical_shear_rate: PosShearRate,
    /// Exponent n of the power law far above it: 1 does not thin.
    pub exponent: Ratio<Fraction>,
    /// Ratio m of the viscosity at high shear rate, of the base oil, to that at rest.
    #[serde(default = "none")]
    pub high_shear_ratio: Ratio<Fraction>,
}

fn none() -> Ratio<Fraction> {
    quantity(0.0)
}

#[register_model(
    name = "carreau",
    summary = "shear thinning between two plateaus, by Carreau",
    equations = "mu/mu0 = m + (1 - m) [1 + (gamma/gamma_c)^2]^((n-1)/2)",
    validity = "Multigrade oils; gamma_c and n from a flow curve of the oil at its temperature. Generalised Newtonian: no elasticity.",
    references = ["carreau1972"],
    example = "critical_shear_rate = \"1e5 1/s\"\nexponent = 0.7\nhigh_shear_ratio = 0.5\n",
)]
impl ShearThinningSpec for Carreau {
    fn build(&self) -> Result<Box<dyn ShearThinning>, BuildError> {
        let inverse = self.critical_shear_rate.si().recip();
        if !inverse.is_finite() {
            return Err(BuildError::at(
                "critical_shear_rate",
                "the critical shear rate is too small to compute with",
            ));
        }
        Ok(Box::new(Plateaus { inverse, exponent: self.exponent.si(), high: self.high_shear_ratio.si() }))
    }
}

#[derive(Debug)]
struct Plateaus {
    /// `1/γ̇_c`.
    inverse: f64,
    exponent: f64,
    high: f64,
}

impl ShearThinning for Plateaus {
    fn factor(&self, shear_rate: &[f64], factor: &mut [f64], slope: &mut [f64]) -> Result<(), EvalError> {
        check("carreau", "shear rate [1/s]", shear_rate, &[factor.len(), slope.len()])?;
        let power = self.exponent - 1.0;
        for (i, &rate) in shear_rate.iter().enumerate() {
            let x = (rate * self.inverse).clamp(-f64::MAX, f64::MAX);
            // √(1 + x²) without overflow, and its logarithmic derivative x/(1 + x²) as (x/root)/root.
            let root = elementary::hypot(x, 1.0).min(f64::MAX);
            let thin = (1.0 - self.high) * elementary::powf(root, power);
            factor[i] = self.high + thin;
            slope[i] = thin * power * (x / root) / root * self.inverse;
        }
        Ok(())
    }
}
