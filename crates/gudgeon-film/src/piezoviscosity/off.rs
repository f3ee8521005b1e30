use gudgeon_core::kinds::{Piezoviscosity, PiezoviscositySpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::slices::check;

/// Viscosity does not depend on pressure.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "viscosity does not depend on pressure",
    equations = "mu = mu0",
    validity = "Film pressures below about 10 MPa.",
    references = [],
    example = "",
)]
impl PiezoviscositySpec for Off {
    fn build(&self) -> Result<Box<dyn Piezoviscosity>, BuildError> {
        Ok(Box::new(Isoviscous))
    }
}

#[derive(Debug)]
struct Isoviscous;

impl Piezoviscosity for Isoviscous {
    fn is_off(&self) -> bool {
        true
    }
    fn factor(
        &self,
        _: f64,
        pressure: &[f64],
        factor: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError> {
        check("piezoviscosity off", "pressure [Pa]", pressure, &[factor.len(), slope.len()])?;
        factor.fill(1.0);
        slope.fill(0.0);
        Ok(())
    }
}
