use gudgeon_core::kinds::{ShearThinning, ShearThinningSpec};
use gudgeon_core::quantity::{Fraction, PosShearRate, Ratio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
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
            let root = x.hypot(1.0).min(f64::MAX);
            let thin = (1.0 - self.high) * root.powf(power);
            factor[i] = self.high + thin;
            slope[i] = thin * power * (x / root) / root * self.inverse;
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

    fn carreau(n: f64, m: f64) -> Box<dyn ShearThinning> {
        Carreau { critical_shear_rate: quantity(1e5), exponent: quantity(n), high_shear_ratio: quantity(m) }
            .build()
            .expect("builds")
    }

    #[test]
    fn known_points() {
        let m = carreau(0.5, 0.4);
        assert_eq!(at(&*m, 0.0), (1.0, 0.0));
        // At γ̇_c: 0.4 + 0.6 · 2^(-1/4).
        assert!((at(&*m, 1e5).0 - (0.4 + 0.6 * 0.5f64.powf(0.25))).abs() < 2e-16);
        // Far above: the plateau, from a power law x^(-1/2) = 1e-5.
        assert!((at(&*m, 1e15).0 - 0.4 - 0.6e-5).abs() < 1e-15);
        // n = 1 does not thin.
        assert_eq!(at(&*carreau(1.0, 0.2), 1e9), (1.0, 0.0));
    }

    #[test]
    fn even_and_its_slope_odd() {
        let m = carreau(0.3, 0.2);
        for rate in [1.0, 3e4, 1e5, 1e7, 1e12] {
            let ((f, s), (g, t)) = (at(&*m, rate), at(&*m, -rate));
            assert_eq!((f, s), (g, -t));
            let d = 1e-4 * rate;
            let central = (at(&*m, rate + d).0 - at(&*m, rate - d).0) / (2.0 * d);
            // Truncation 1e-8 of the slope, rounding 1e-16/d.
            assert!((central - s).abs() < 2e-8 * s.abs() + 2e-16 / d, "{rate}: {central} {s}");
        }
    }

    #[test]
    fn extremes() {
        let m = carreau(0.0, 0.0);
        for rate in [1e300, -f64::MAX, f64::MIN_POSITIVE] {
            let (f, s) = at(&*m, rate);
            assert!(f > 0.0 && f <= 1.0 && s.is_finite(), "{rate}: {f} {s}");
        }
        assert!(m.factor(&[f64::NAN], &mut [0.0], &mut [0.0]).is_err_and(|e| e.is_recoverable()));
        assert!(m.factor(&[1.0], &mut [0.0; 2], &mut [0.0]).is_err_and(|e| !e.is_recoverable()));
    }
}
