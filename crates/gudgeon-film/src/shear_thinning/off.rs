use gudgeon_core::kinds::{ShearThinning, ShearThinningSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::slices::check;

/// Viscosity does not depend on shear rate.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "viscosity does not depend on shear rate",
    equations = "mu = mu0",
    validity = "Oils without polymers, or shear rates below about 1e5 1/s.",
    references = [],
    example = "",
)]
impl ShearThinningSpec for Off {
    fn build(&self) -> Result<Box<dyn ShearThinning>, BuildError> {
        Ok(Box::new(Newtonian))
    }
}

#[derive(Debug)]
struct Newtonian;

impl ShearThinning for Newtonian {
    fn is_off(&self) -> bool {
        true
    }
    fn factor(&self, shear_rate: &[f64], factor: &mut [f64], slope: &mut [f64]) -> Result<(), EvalError> {
        check("shear_thinning off", "shear rate [1/s]", shear_rate, &[factor.len(), slope.len()])?;
        factor.fill(1.0);
        slope.fill(0.0);
        Ok(())
    }
}
