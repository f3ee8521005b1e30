use gudgeon_core::kinds::{BoundaryFriction, BoundaryFrictionSpec, Rubbing};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::check::check;

/// Solid contact without friction.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "solid contact without friction",
    equations = "mu = 0",
    validity = "Comparisons.",
    references = [],
    example = "",
)]
impl BoundaryFrictionSpec for Off {
    fn build(&self) -> Result<Box<dyn BoundaryFriction>, BuildError> {
        Ok(Box::new(Frictionless))
    }
}

#[derive(Debug)]
struct Frictionless;

impl BoundaryFriction for Frictionless {
    fn is_off(&self) -> bool {
        true
    }
    fn coefficient(
        &self,
        at: &Rubbing<'_>,
        coefficient: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError> {
        check("boundary_friction off", at, [coefficient.len(), slope.len()])?;
        coefficient.fill(0.0);
        slope.fill(0.0);
        Ok(())
    }
}
