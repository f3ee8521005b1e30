use std::fmt::Debug;

use dyn_clone::DynClone;

use super::FaceForces;
use crate::{BuildError, register_kind};

/// Configuration of the force of the film in the axial balance of a ring.
#[register_kind(name = "film_force", summary = "force of the film in the axial balance of a ring")]
pub trait FilmForceSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Settings outside their range.
    fn build(&self) -> Result<Box<dyn FilmForce>, BuildError>;
}

/// A running model of it.
pub trait FilmForce: Debug + Send {
    /// Viscous and pressure force on the ring along `+x`, per circumference \[N/m\]. `beside` is the pressure force on the slope of
    /// the face beside the film \[N/m\].
    fn per_length(&self, film: &FaceForces, beside: f64) -> f64;
}
