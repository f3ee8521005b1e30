use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// What a [`FilmTemperatureSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct FilmTemperatureCtx<'a> {
    /// Gas temperatures of the spaces above each ring and of the crankcase \[K\].
    pub land_temperatures: &'a [f64],
    /// Stroke \[m\].
    pub stroke: f64,
}

/// Configuration of a film-temperature model.
#[register_kind(name = "film_temperature", summary = "temperature of the oil film under each ring")]
pub trait FilmTemperatureSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Lists whose length does not fit the number of rings.
    fn build(&self, ctx: &FilmTemperatureCtx<'_>) -> Result<Box<dyn FilmTemperature>, BuildError>;
}

/// A running film-temperature model.
pub trait FilmTemperature: Debug + Send + Sync {
    /// Film temperature \[K\] of ring `ring` (zero-based) whose face is `travel` \[m\] below the place of **ring 1** at top
    /// dead centre (0 for ring 1 at top dead centre, `stroke` at bottom dead centre, more for lower rings).
    fn temperature(&self, ring: usize, travel: f64) -> f64;
    /// Whether the temperature does not depend on `travel`: viscosities are then evaluated once.
    fn is_constant(&self) -> bool;
}
