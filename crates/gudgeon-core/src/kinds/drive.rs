use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of a torque on one inertia of a shaft line: a motor, an engine given by its harmonics, a load.
#[register_kind(name = "drive", summary = "torque of a motor, an engine or a load on one inertia")]
pub trait DriveSpec: Debug + DynClone + Send + Sync {
    /// Checks the numbers and builds the running model.
    ///
    /// # Errors
    /// Tables that are not monotone; speeds and torques that contradict each other.
    fn build(&self) -> Result<Box<dyn Drive>, BuildError>;
}

/// Torque of a drive with its derivative by the speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DriveTorque {
    /// Torque \[N m\], positive in the direction of rotation.
    pub torque: f64,
    /// Derivative by the speed \[N m s/rad\]; negative for a machine that steadies the speed.
    pub slope: f64,
}

/// One harmonic of a torque: `cosine cos(order θ) + sine sin(order θ)`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OrderTorque {
    /// Cycles per turn of the inertia; half orders are admitted.
    pub order: f64,
    /// Amplitude of the cosine \[N m\].
    pub cosine: f64,
    /// Amplitude of the sine \[N m\].
    pub sine: f64,
}

/// A running drive.
pub trait Drive: Debug + DynClone + Send + Sync {
    /// Torque at angle `theta` \[rad\] and speed `omega` \[rad/s\] of its inertia.
    fn torque(&self, theta: f64, omega: f64) -> DriveTorque;
    /// The part of the torque that goes with the angle, as harmonics; empty when there is none.
    fn orders(&self) -> &[OrderTorque] {
        &[]
    }
    /// Whether the torque is linear in speed and without a part that goes with the angle.
    fn is_linear(&self) -> bool;
}
dyn_clone::clone_trait_object!(Drive);
