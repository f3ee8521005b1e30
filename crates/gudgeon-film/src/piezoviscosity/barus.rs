use gudgeon_core::kinds::{Piezoviscosity, PiezoviscositySpec};
use gudgeon_core::quantity::PosPressureCoefficient;
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::tame_exp::tame_exp;
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
