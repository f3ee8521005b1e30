use gudgeon_core::kinds::{ShearThinning, ShearThinningSpec};
use gudgeon_core::quantity::{Fraction, PosRatio, PosShearRate, Ratio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::slices::check;

/// The law of Cross: `μ/μ0 = m + (1 - m)/[1 + (γ̇/γ̇_c)^k]`.
///
/// In ring-pack work it is written `μ = μ0 [1 + m (γ̇/γ̇_c)^k]/[1 + (γ̇/γ̇_c)^k]`, which is the same.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
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
            let power = x.powf(k).min(1e300);
            let share = 1.0 / (1.0 + power);
            factor[i] = self.high + range * share;
            // d/dx 1/(1 + x^k) = -k x^k/(1 + x^k)² / x.
            let x = x.max(REST);
            let (power, share) = if x == REST {
                let p = x.powf(k);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn at(m: &dyn ShearThinning, rate: f64) -> (f64, f64) {
        let (mut f, mut s) = ([0.0], [0.0]);
        m.factor(&[rate], &mut f, &mut s).expect("finite");
        (f[0], s[0])
    }

    fn cross(k: f64, m: f64) -> Box<dyn ShearThinning> {
        Cross { critical_shear_rate: quantity(5e5), exponent: quantity(k), high_shear_ratio: quantity(m) }
            .build()
            .expect("builds")
    }

    #[test]
    fn known_points() {
        for k in [0.5, 1.0, 2.0] {
            let m = cross(k, 0.4);
            assert_eq!(at(&*m, 0.0), (1.0, 0.0));
            // Half-way at γ̇_c, whatever the exponent.
            assert!((at(&*m, 5e5).0 - 0.7).abs() < 2e-16);
        }
        // k = 1, x = 3: 0.4 + 0.6/4, and the form [1 + m x]/[1 + x].
        assert!((at(&*cross(1.0, 0.4), 1.5e6).0 - (1.0 + 0.4 * 3.0) / 4.0).abs() < 2e-16);
    }

    #[test]
    fn even_and_its_slope_odd() {
        for k in [0.6, 1.0, 2.0] {
            let m = cross(k, 0.2);
            for rate in [1e3, 5e5, 1e7, 1e10] {
                let ((f, s), (g, t)) = (at(&*m, rate), at(&*m, -rate));
                assert_eq!((f, s), (g, -t));
                let d = 1e-4 * rate;
                let central = (at(&*m, rate + d).0 - at(&*m, rate - d).0) / (2.0 * d);
                // Truncation 1e-8 of the slope, rounding 1e-16/d.
                assert!((central - s).abs() < 2e-8 * s.abs() + 2e-16 / d, "{rate}: {central} {s}");
            }
        }
    }

    #[test]
    fn extremes() {
        for k in [0.1, 1.0, 10.0] {
            let m = cross(k, 0.0);
            for rate in [1e300, -f64::MAX, f64::MIN_POSITIVE, -1e-300] {
                let (f, s) = at(&*m, rate);
                assert!(f > 0.0 && f <= 1.0 && s.is_finite(), "{rate}: {f} {s}");
            }
        }
        let m = cross(1.0, 0.5);
        assert!(m.factor(&[f64::NAN], &mut [0.0], &mut [0.0]).is_err_and(|e| e.is_recoverable()));
        assert!(m.factor(&[1.0], &mut [0.0; 2], &mut [0.0]).is_err_and(|e| !e.is_recoverable()));
    }
}
