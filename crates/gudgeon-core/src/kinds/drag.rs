use std::fmt::Debug;

use dyn_clone::DynClone;

use super::FaceForces;
use crate::{BuildError, register_kind};

/// Configuration of the friction of a ring that friction power counts.
#[register_kind(name = "drag", summary = "viscous friction that counts as friction of a ring, and its power")]
pub trait DragSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Settings outside their range.
    fn build(&self) -> Result<Box<dyn Drag>, BuildError>;
}

/// A running model of it.
pub trait Drag: Debug + Send {
    /// Viscous force that counts, per circumference \[N/m\], positive against the motion of the liner seen from the ring.
    fn shear(&self, film: &FaceForces) -> f64;
    /// Power \[W\] of a friction force \[N\] at the velocity `u` of the liner seen from the ring \[m/s\].
    fn power(&self, friction: f64, u: f64) -> f64 {
        friction * u
    }
}
