use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of a friction of the gudgeon pin.
#[register_kind(name = "pin_friction", summary = "moment of the gudgeon pin on the piston")]
pub trait PinFrictionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn PinFriction>, BuildError>;
}

/// A running friction of the gudgeon pin.
pub trait PinFriction: Debug + Send + Sync {
    /// Whether there is no friction.
    fn is_off(&self) -> bool {
        false
    }
    /// Moment on the piston \[N m\] when the rod presses with `load` \[N\] and turns at `rotation` \[rad/s\] against the piston; of the sign of
    /// `rotation`.
    fn moment(&self, load: f64, rotation: f64) -> f64;
}
