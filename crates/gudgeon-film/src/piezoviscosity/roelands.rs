use gudgeon_core::kinds::{Piezoviscosity, PiezoviscositySpec};
use gudgeon_core::quantity::{PosPressureCoefficient, PosRatio};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::tame_exp::tame_exp;
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
        let height = elementary::ln(mu0) + POLE;
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
            let exponent = (z * elementary::ln_1p(x)).min(300.0);
            let (f, s) = tame_exp(height * elementary::exp_m1(exponent));
            factor[i] = f;
            slope[i] = s * height * z * elementary::exp(exponent) / (P_R * (1.0 + x));
        }
        Ok(())
    }
}
