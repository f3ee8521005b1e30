use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of what a ring presses with by its own tension.
#[register_kind(name = "hoop", summary = "radial force of a ring from its tangential closing force")]
pub trait HoopSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Settings outside their range.
    fn build(&self) -> Result<Box<dyn Hoop>, BuildError>;
}

/// A running model of it.
pub trait Hoop: Debug + Send {
    /// Radial force on the whole circumference \[N\] of a ring (or rail) whose ends are pulled together with `tangential` \[N\].
    fn radial_force(&self, tangential: f64) -> f64;
}
