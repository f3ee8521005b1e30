use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of a model of the friction between ring and groove flanks, which resists radial motion.
#[register_kind(
    name = "flank_friction",
    summary = "friction on the groove flanks against the ring's radial motion"
)]
pub trait FlankFrictionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn FlankFriction>, BuildError>;
}

/// A running flank-friction model.
pub trait FlankFriction: Send {
    /// Radial force on the ring \[N\] towards the liner, odd in `hdot` \[m/s\] and of its sign (a ring moving away from the liner is
    /// pushed towards it), for the axial load \[N\] that presses the flanks together.
    fn force(&self, hdot: f64, axial_load: f64) -> f64;
    /// Derivative of the force by `hdot` \[N s/m\].
    fn derivative(&self, hdot: f64, axial_load: f64) -> f64;
    /// Whether the force is zero for all inputs.
    fn is_off(&self) -> bool;
}
