use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// What an [`EvaporationSpec`] is built for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EvaporationCtx {
    /// Swept volume of the cylinder \[m³\].
    pub swept: f64,
    /// Mean speed of the piston \[m/s\].
    pub mean_speed: f64,
}

/// Configuration of a model of the oil that evaporates from the liner.
#[register_kind(
    name = "evaporation",
    summary = "oil that evaporates from the liner into the combustion chamber"
)]
pub trait EvaporationSpec: Debug + DynClone + Send + Sync {
    /// Whether nothing evaporates: [`EvaporationSpec::build`] then gives `None`.
    fn is_off(&self) -> bool {
        false
    }

    /// Builds the running model; `None` when nothing evaporates.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self, ctx: &EvaporationCtx) -> Result<Option<Box<dyn Evaporation>>, BuildError>;
}

/// A running model of evaporation: an oil of one or more fractions, and the gas that takes their vapour away.
///
/// What depends on the temperature of the liner alone ([`Evaporation::volatility`]) is asked once a place, what depends on the gas
/// ([`Evaporation::transfer`]) once a step, so that the film of a whole liner is thinned at little cost ([`Evaporation::thin`]).
pub trait Evaporation: Debug + DynClone + Send + Sync {
    /// Mass shares of the fractions of fresh oil, which add up to one.
    fn shares(&self) -> &[f64];

    /// How readily every fraction leaves a liner of `temperature` \[K\], in units of the model.
    fn volatility(&self, temperature: f64, out: &mut [f64]);

    /// What the gas takes away at an absolute pressure \[Pa\]: with a volatility the flux of a fraction alone \[kg/(m² s)\].
    fn transfer(&self, pressure: f64) -> f64;

    /// Thins a film, of `masses` \[kg/m²\] by fraction, at places of a `volatility` while the integral of the transfer over time grows by `exposure`.
    /// What is left is never negative.
    fn thin(&self, volatility: &[f64], exposure: f64, masses: &mut [f64]);
}
dyn_clone::clone_trait_object!(Evaporation);
