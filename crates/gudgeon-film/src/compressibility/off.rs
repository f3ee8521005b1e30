use gudgeon_core::kinds::{Compressibility, CompressibilitySpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::slices::check;

/// Density does not depend on pressure.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "density does not depend on pressure",
    equations = "rho = rho0",
    validity = "Film pressures below about 50 MPa, where oil is 3 % denser.",
    references = [],
    example = "",
)]
impl CompressibilitySpec for Off {
    fn build(&self) -> Result<Box<dyn Compressibility>, BuildError> {
        Ok(Box::new(Incompressible))
    }
}

#[derive(Debug)]
struct Incompressible;

impl Compressibility for Incompressible {
    fn is_off(&self) -> bool {
        true
    }
    fn factor(&self, pressure: &[f64], factor: &mut [f64], slope: &mut [f64]) -> Result<(), EvalError> {
        check("compressibility off", "pressure [Pa]", pressure, &[factor.len(), slope.len()])?;
        factor.fill(1.0);
        slope.fill(0.0);
        Ok(())
    }
}
