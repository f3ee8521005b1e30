use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::states::Stateful;
use crate::{BuildError, EvalError, register_kind};

/// What a [`FilmTemperatureSpec`] is built for.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct FilmTemperatureCtx<'a> {
    /// Gas temperatures of the spaces above each ring and of the crankcase \[K\].
    pub land_temperatures: &'a [f64],
    /// Stroke \[m\].
    pub stroke: f64,
    /// Lengths of the running faces of the rings, all lands together \[m\].
    pub face_lengths: &'a [f64],
    /// Circumference of the bore \[m\].
    pub circumference: f64,
    /// Crank speed \[rad/s\].
    pub omega: f64,
}

impl<'a> FilmTemperatureCtx<'a> {
    /// Temperatures of the lands \[K\] and the stroke \[m\]; faces, circumference and speed are unknown until they are set.
    #[must_use]
    pub const fn new(land_temperatures: &'a [f64], stroke: f64) -> Self {
        Self { land_temperatures, stroke, face_lengths: &[], circumference: 0.0, omega: 0.0 }
    }

    /// Sets the lengths of the faces, the circumference \[m\] and the crank speed \[rad/s\].
    #[must_use]
    pub const fn faces(mut self, lengths: &'a [f64], circumference: f64, omega: f64) -> Self {
        (self.face_lengths, self.circumference, self.omega) = (lengths, circumference, omega);
        self
    }
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

/// One ring's film at an instant, for a temperature with states of its own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct FilmHeat {
    /// Film thickness \[m\].
    pub h: f64,
    /// Friction power of the ring \[W\].
    pub power: f64,
    /// Sliding speed \[m/s\].
    pub speed: f64,
    /// Way of the face below the place of ring 1 at top dead centre \[m\].
    pub travel: f64,
}

impl FilmHeat {
    /// Film thickness \[m\], friction power \[W\], sliding speed \[m/s\], way below the place of ring 1 at top dead centre \[m\].
    #[must_use]
    pub const fn new(h: f64, power: f64, speed: f64, travel: f64) -> Self {
        Self { h, power, speed, travel }
    }
}

/// A running film-temperature model. It may have states, those of every ring together; each of them names its ring in
/// [`FilmTemperature::ring_of`].
pub trait FilmTemperature: Stateful + Debug + Send + Sync {
    /// Film temperature \[K\] of ring `ring` (zero-based) whose face is `travel` \[m\] below the place of **ring 1** at top
    /// dead centre (0 for ring 1 at top dead centre, `stroke` at bottom dead centre, more for lower rings), for the states `y` of the model.
    fn temperature(&self, ring: usize, travel: f64, y: &[f64]) -> f64;

    /// Temperature \[K\] of the bare liner at a place `travel` \[m\] below that of ring 1 at top dead centre, which the film there has; `None`
    /// where the model does not know it.
    fn liner(&self, _travel: f64) -> Option<f64> {
        None
    }

    /// Whether the temperature depends neither on `travel` nor on states: viscosities are then evaluated once.
    fn is_constant(&self) -> bool;

    /// The ring whose temperature state `k` changes.
    fn ring_of(&self, k: usize) -> usize {
        k
    }

    /// Rates \[1/rad\] of the states that belong to ring `ring`, into their places in `dy`, which is as long as all states.
    ///
    /// # Errors
    /// States for which the model has no answer.
    fn rates(
        &mut self,
        _ring: usize,
        _y: &[f64],
        _heat: &FilmHeat,
        _dy: &mut [f64],
    ) -> Result<(), EvalError> {
        Ok(())
    }
}
