use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError, register_kind};

/// Configuration of a model of the friction of solid contact.
#[register_kind(name = "boundary_friction", summary = "friction of solid contact against sliding speed")]
pub trait BoundaryFrictionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn BoundaryFriction>, BuildError>;
}

/// A running friction model of solid contact.
pub trait BoundaryFriction: Debug + Send + Sync {
    /// Whether there is no friction at any speed.
    fn is_off(&self) -> bool {
        false
    }

    /// `coefficient[i]`, odd in the sliding speed \[m/s\] and of its sign, so that the force on the slower surface is it times the
    /// contact load; and `slope[i]`, its derivative \[s/m\].
    ///
    /// # Errors
    /// A speed that is not finite (Recoverable), slices of different length (Fatal).
    fn coefficient(&self, speed: &[f64], coefficient: &mut [f64], slope: &mut [f64])
    -> Result<(), EvalError>;
}
