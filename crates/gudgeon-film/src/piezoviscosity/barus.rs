use gudgeon_core::kinds::{Piezoviscosity, PiezoviscositySpec};
use gudgeon_core::quantity::PosPressureCoefficient;
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::tame_exp;
use crate::slices::check;

/// The law of Barus: `μ = μ0 exp(α p)`, `p` above ambient.
///
/// Beyond `α p` = 30 it goes on along its tangent, so that no pressure overflows.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Barus {
    /// Pressure-viscosity coefficient α: 1e-8 to 2.5e-8 1/Pa for engine oils.
    pub pressure_viscosity: PosPressureCoefficient,
}

#[register_model(
    name = "barus",
    summary = "viscosity grows exponentially with pressure",
    equations = "mu = mu0 exp(alpha p)",
    validity = "Pressures up to about 100 MPa; above, it overstates viscosity more and more (see roelands). Follows its tangent beyond alpha p = 30.",
    references = ["barus1893"],
    example = "pressure_viscosity = \"18 1/GPa\"\n",
)]
impl PiezoviscositySpec for Barus {
    fn build(&self) -> Result<Box<dyn Piezoviscosity>, BuildError> {
        Ok(Box::new(Exponential { alpha: self.pressure_viscosity.si() }))
    }
}

#[derive(Debug)]
struct Exponential {
    alpha: f64,
}

impl Piezoviscosity for Exponential {
    fn factor(
        &self,
        _: f64,
        pressure: &[f64],
        factor: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError> {
        check("barus", "pressure [Pa]", pressure, &[factor.len(), slope.len()])?;
        for (i, &p) in pressure.iter().enumerate() {
            let (f, s) = tame_exp(self.alpha * p);
            factor[i] = f;
            slope[i] = self.alpha * s;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use gudgeon_core::quantity::quantity;

    use super::*;

    #[test]
    fn exponential_with_its_slope() {
        let model = Barus { pressure_viscosity: quantity(2e-8) }.build().expect("builds");
        let p = [0.0, 5e7, 1e8, -1e5];
        let (mut f, mut s) = ([0.0; 4], [0.0; 4]);
        model.factor(0.01, &p, &mut f, &mut s).expect("finite");
        // e^1 and e^2: an ulp of the exponent.
        assert_eq!(f[0], 1.0);
        assert!(
            (f[1] / std::f64::consts::E - 1.0).abs() < 4e-16
                && (f[2] / 7.389_056_098_930_65 - 1.0).abs() < 8e-16
        );
        for i in 0..4 {
            assert!((s[i] / (2e-8 * f[i]) - 1.0).abs() < 4e-16);
        }
    }

    #[test]
    fn no_pressure_overflows() {
        let model = Barus { pressure_viscosity: quantity(1e3) }.build().expect("builds");
        let (mut f, mut s) = ([0.0; 3], [0.0; 3]);
        model.factor(0.01, &[1e306, -1e306, 1.0], &mut f, &mut s).expect("finite");
        assert!(
            f.iter().chain(&s).all(|v| v.is_finite() && *v >= 0.0) && f.iter().all(|v| *v > 0.0),
            "{f:?} {s:?}"
        );
        assert!(model.factor(0.01, &[f64::NAN; 3], &mut f, &mut s).is_err_and(|e| e.is_recoverable()));
    }
}
