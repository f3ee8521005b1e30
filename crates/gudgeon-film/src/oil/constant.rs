use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::quantity::PosViscosity;
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A viscosity that does not depend on temperature.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Constant {
    /// Dynamic viscosity at every temperature.
    pub viscosity: PosViscosity,
}

#[register_model(
    name = "constant",
    summary = "one viscosity at every temperature",
    equations = "mu = viscosity",
    validity = "Test benches and films of nearly constant temperature.",
    references = [],
    example = "viscosity = \"5 mPa s\"\n",
)]
impl OilSpec for Constant {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        Ok(Box::new(ConstantOil(self.viscosity.si())))
    }
}

#[derive(Debug)]
struct ConstantOil(f64);

impl Oil for ConstantOil {
    fn viscosity(&self, _: f64) -> f64 {
        self.0
    }
}
