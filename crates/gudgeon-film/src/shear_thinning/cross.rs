use gudgeon_core::kinds::{ShearThinning, ShearThinningSpec};
use gudgeon_core::quantity::{Fraction, PosRatio, PosShearRate, Ratio, quantity};
use gudgeon_core::sets::Sets;
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::slices::check;

/// The law of Cross: `μ/μ0 = m + (1 - m)/[1 + (γ̇/γ̇_c)^k]`.
///
/// In ring-pack work it is written `μ = μ0 [1 + m (γ̇/γ̇_c)^k]/[1 + (γ̇/γ̇_c)^k]`, which is the same.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("cross.json")))]
pub struct Cross {
    /// Shear rate γ̇_c half-way between the plateaus.
    pub critical_shear_rate: PosShearRate,
    /// Exponent k: the width of the passage.
    #[serde(default = "one")]
    pub exponent: PosRatio,
    /// Ratio m of the viscosity at high shear rate, of the base oil, to that at rest.
    #[serde(default = "none")]
    pub high_shear_ratio: Ratio<Fraction>,
}

fn one() -> PosRatio {
    quantity(1.0)
}
fn none() -> Ratio<Fraction> {
    quantity(0.0)
}

#[register_model(
    name = "cross",
    summary = "shear thinning between two plateaus, by Cross",
    equations = "mu/mu0 = m + (1 - m)/[1 + (gamma/gamma_c)^k]",
    validity = "Multigrade oils; gamma_c and k from a flow curve of the oil at its temperature. For k <= 1 the slope has a corner at rest. Generalised Newtonian: no elasticity.",
    references = ["cross1965"],
    example = "critical_shear_rate = \"5e5 1/s\"\nexponent = 1.0\nhigh_shear_ratio = 0.5\n",
)]
impl ShearThinningSpec for Cross {
    fn build(&self) -> Result<Box<dyn ShearThinning>, BuildError> {
        let inverse = self.critical_shear_rate.si().recip();
        if !inverse.is_finite() {
            return Err(BuildError::at(
                "critical_shear_rate",
                "the critical shear rate is too small to compute with",
            ));
        }
        Ok(Box::new(Passage { inverse, exponent: self.exponent.si(), high: self.high_shear_ratio.si() }))
    }
}

/// Relative shear rate below which the slope is that at it: for `k < 1` it is infinite at rest.
const REST: f64 = 1e-9;

#[derive(Debug)]
struct Passage {
    /// `1/γ̇_c`.
    inverse: f64,
    exponent: f64,
    high: f64,
}

impl ShearThinning for Passage {
    fn factor(&self, shear_rate: &[f64], factor: &mut [f64], slope: &mut [f64]) -> Result<(), EvalError> {
        check("cross", "shear rate [1/s]", shear_rate, &[factor.len(), slope.len()])?;
        let (k, range) = (self.exponent, 1.0 - self.high);
        for (i, &rate) in shear_rate.iter().enumerate() {
            let x = (rate.abs() * self.inverse).min(f64::MAX);
            // Far up the sum would overflow; 1e300 keeps the inverse a number.
            let power = elementary::powf(x, k).min(1e300);
            let share = 1.0 / (1.0 + power);
            factor[i] = self.high + range * share;
            // d/dx 1/(1 + x^k) = -k x^k/(1 + x^k)² / x.
            let x = x.max(REST);
            let (power, share) = if x == REST {
                let p = elementary::powf(x, k);
                (p, 1.0 / (1.0 + p))
            } else {
                (power, share)
            };
            let steepness = -range * k * (power * share) * share / x * self.inverse;
            slope[i] = if rate == 0.0 { 0.0 } else { steepness * rate.signum() };
        }
        Ok(())
    }
}
