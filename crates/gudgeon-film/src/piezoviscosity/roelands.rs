use gudgeon_core::kinds::{Piezoviscosity, PiezoviscositySpec};
use gudgeon_core::quantity::{PosPressureCoefficient, PosRatio};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::tame_exp;
use crate::slices::check;

/// The law of Roelands at constant temperature, `p` above ambient.
///
/// ```text
/// ln(μ/μ0) = (ln μ0 + 9.67) [ (1 + p/p_r)^Z - 1 ]         p_r = 0.1962 GPa, μ0 in Pa s
/// Z = α p_r / (ln μ0 + 9.67)
/// ```
///
/// Give `Z`, or the pressure-viscosity coefficient `α` that the law then has at ambient pressure, at every temperature. Where the
/// logarithm exceeds 30 the viscosity goes on along its tangent in it.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Roelands {
    /// Exponent Z: 0.5 to 0.7 for mineral oils.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exponent: Option<PosRatio>,
    /// Pressure-viscosity coefficient α at ambient pressure, instead of `exponent`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure_viscosity: Option<PosPressureCoefficient>,
}

#[register_model(
    name = "roelands",
    summary = "viscosity under pressure by Roelands",
    equations = "ln(mu/mu0) = (ln mu0 + 9.67) [(1 + p/p_r)^Z - 1],  p_r = 0.1962 GPa;  Z = alpha p_r/(ln mu0 + 9.67)",
    validity = "Mineral oils to about 1 GPa. Needs mu0 above 6.4e-5 Pa s and pressures above -p_r/2.",
    references = ["roelands1966"],
    example = "exponent = 0.6\n",
)]
impl PiezoviscositySpec for Roelands {
    fn build(&self) -> Result<Box<dyn Piezoviscosity>, BuildError> {
        let rise = match (self.exponent, self.pressure_viscosity) {
            (Some(z), None) => Rise::Exponent(z.si()),
            (None, Some(a)) => Rise::Initial(a.si()),
            (None, None) => return Err(BuildError::new("the rise of viscosity is not given").help(WAYS)),
            (Some(_), Some(_)) => {
                return Err(
                    BuildError::at("pressure_viscosity", "the rise of viscosity is given twice").help(WAYS)
                );
            }
        };
        Ok(Box::new(PowerOfPressure { rise }))
    }
}

const WAYS: &str = "give `exponent` or `pressure_viscosity`, one of them";
const MODEL: &str = "roelands";
/// Reference pressure \[Pa\].
const P_R: f64 = 1.962e8;
/// `-ln` of the viscosity 6.31e-5 Pa s in which all isotherms meet.
const POLE: f64 = 9.67;

#[derive(Debug)]
enum Rise {
    Exponent(f64),
    Initial(f64),
}

#[derive(Debug)]
struct PowerOfPressure {
    rise: Rise,
}

impl Piezoviscosity for PowerOfPressure {
    fn factor(
        &self,
        mu0: f64,
        pressure: &[f64],
        factor: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError> {
        check(MODEL, "pressure [Pa]", pressure, &[factor.len(), slope.len()])?;
        let height = mu0.ln() + POLE;
        // A hundredth: at the pole itself the exponent for a given α is infinite.
        if !(height > 0.01 && height.is_finite()) {
            return Err(EvalError::recoverable(
                MODEL,
                format!("the viscosity {mu0:e} Pa s is not above 6.4e-5 Pa s"),
            ));
        }
        let z = match self.rise {
            Rise::Exponent(z) => z,
            Rise::Initial(alpha) => alpha * P_R / height,
        };
        for (i, &p) in pressure.iter().enumerate() {
            let x = p / P_R;
            if x < -0.5 {
                return Err(EvalError::recoverable(
                    MODEL,
                    format!("the pressure {p:e} Pa is below {:e} Pa", -0.5 * P_R),
                ));
            }
            // (1 + x)^Z - 1 without cancelling, and no infinity times the tangent's slope.
            let exponent = (z * x.ln_1p()).min(300.0);
            let (f, s) = tame_exp(height * exponent.exp_m1());
            factor[i] = f;
            slope[i] = s * height * z * exponent.exp() / (P_R * (1.0 + x));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use gudgeon_core::quantity::quantity;

    use super::*;

    fn at(m: &dyn Piezoviscosity, mu0: f64, p: f64) -> (f64, f64) {
        let (mut f, mut s) = ([0.0], [0.0]);
        m.factor(mu0, &[p], &mut f, &mut s).expect("in range");
        (f[0], s[0])
    }

    #[test]
    fn worked_values() {
        let m = Roelands { exponent: Some(quantity(0.6)), pressure_viscosity: None }.build().expect("builds");
        // ln μ0 + 9.67 at 0.04 Pa s = 6.451124175; (2^0.6 - 1) at p = p_r: evaluated with 30 digits.
        assert_eq!(at(&*m, 0.04, 0.0).0, 1.0);
        let (f, _) = at(&*m, 0.04, P_R);
        // Rounding of an exponent of 3.3.
        assert!((f / 27.853_304_413_537_067 - 1.0).abs() < 4e-15, "{f}");
        // Isotherms meet: μ0 f -> 6.31e-5 where the exponent tends to -(ln μ0 + 9.67); all rise from there.
        assert!(at(&*m, 0.01, 1e8).0 < at(&*m, 0.1, 1e8).0);
    }

    #[test]
    fn given_coefficient_is_the_slope_at_ambient() {
        let m =
            Roelands { exponent: None, pressure_viscosity: Some(quantity(1.8e-8)) }.build().expect("builds");
        for mu0 in [0.003, 0.02, 0.5] {
            // Three roundings.
            assert!((at(&*m, mu0, 0.0).1 / 1.8e-8 - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn slope_is_the_derivative() {
        let m =
            Roelands { exponent: Some(quantity(0.65)), pressure_viscosity: None }.build().expect("builds");
        // The last two on either side of the tangent, ln f = 30 near 1.5 GPa.
        for p in [-5e7, 0.0, 1e7, 3e8, 1e9, 3e9] {
            let d = 1e4;
            let central = (at(&*m, 0.05, p + d).0 - at(&*m, 0.05, p - d).0) / (2.0 * d);
            // Truncation (d f'/f)² ~ (2e-4)²/6, rounding 1e-16/(1e4 · 1e-8).
            assert!((central / at(&*m, 0.05, p).1 - 1.0).abs() < 1e-8, "{p}");
        }
    }

    #[test]
    fn extremes() {
        let m =
            Roelands { exponent: Some(quantity(0.65)), pressure_viscosity: None }.build().expect("builds");
        for p in [1e12, 1e100, 1e307] {
            let (f, s) = at(&*m, 0.05, p);
            assert!(f.is_finite() && f > 0.0 && s.is_finite() && s >= 0.0, "{p}: {f} {s}");
        }
        let (mut f, mut s) = ([0.0], [0.0]);
        for (mu0, p) in
            [(1e-5, 0.0), (-1.0, 0.0), (f64::NAN, 0.0), (0.05, -2e8), (0.05, f64::NAN), (f64::INFINITY, 0.0)]
        {
            assert!(m.factor(mu0, &[p], &mut f, &mut s).is_err_and(|e| e.is_recoverable()), "{mu0} {p}");
        }
    }

    #[test]
    fn one_description() {
        let neither = Roelands { exponent: None, pressure_viscosity: None };
        assert!(neither.build().is_err());
        let both = Roelands { exponent: Some(quantity(0.6)), pressure_viscosity: Some(quantity(2e-8)) };
        assert_eq!(both.build().err().map(|e| e.field), Some("pressure_viscosity".into()));
    }
}
