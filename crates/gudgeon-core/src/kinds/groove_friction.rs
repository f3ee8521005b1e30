use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// What a [`GrooveFrictionSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct GrooveFrictionCtx {
    /// Cylinder bore \[m\].
    pub bore: f64,
}

/// Configuration of a friction between rings and their grooves that hinders the lateral motion of the piston.
#[register_kind(
    name = "groove_friction",
    summary = "force of the rings on the piston when it moves across the bore"
)]
pub trait GrooveFrictionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self, ctx: &GrooveFrictionCtx) -> Result<Box<dyn GrooveFriction>, BuildError>;
}

/// A running friction between rings and grooves.
pub trait GrooveFriction: Debug + Send + Sync {
    /// Whether there is no friction.
    fn is_off(&self) -> bool {
        false
    }
    /// Height of the grooves above the upper edge of the skirt \[m\].
    fn height(&self) -> f64;
    /// Lateral force on the piston \[N\] and its derivative \[N s/m\] when the groove moves at `v` \[m/s\] across the bore and the gas presses on the
    /// ring with `pressure` \[Pa\] above that of the crankcase.
    fn force(&self, pressure: f64, v: f64) -> (f64, f64);
}
