use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of what joins two inertias of a shaft line: a shaft, a coupling, a damper.
#[register_kind(
    name = "coupling",
    summary = "torque between two inertias of a shaft line by their twist and its rate"
)]
pub trait CouplingSpec: Debug + DynClone + Send + Sync {
    /// Checks the numbers and builds the running model.
    ///
    /// # Errors
    /// Tables that are not monotone or not positive; numbers that contradict each other.
    fn build(&self) -> Result<Box<dyn Coupling>, BuildError>;
}

/// Torque of a coupling with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CouplingTorque {
    /// Torque \[N m\] that opposes the twist.
    pub torque: f64,
    /// Derivative by the twist \[N m/rad\].
    pub stiffness: f64,
    /// Derivative by the rate of twist \[N m s/rad\].
    pub damping: f64,
}

/// Behaviour in small harmonic vibration: torque amplitude per amplitude of twist is
/// `stiffness (1 + i loss_factor) + i ω damping`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinearCoupling {
    /// Stiffness \[N m/rad\]; infinite for a rigid link.
    pub stiffness: f64,
    /// Viscous damping \[N m s/rad\].
    pub damping: f64,
    /// Loss factor η of the stiffness.
    pub loss_factor: f64,
}

/// A running coupling.
pub trait Coupling: Debug + DynClone + Send + Sync {
    /// Torque at a twist \[rad\] and rate of twist \[rad/s\] of the first inertia against the second. Without meaning for a law that
    /// [`Coupling::is_harmonic_only`], and for a rigid link.
    fn torque(&self, twist: f64, rate: f64) -> CouplingTorque;
    /// Small vibration at angular frequency `omega` \[rad/s\] about a mean torque \[N m\].
    fn linear(&self, omega: f64, mean_torque: f64) -> LinearCoupling;
    /// Twist \[rad\] under a constant torque \[N m\].
    fn static_twist(&self, torque: f64) -> f64;
    /// Whether [`Coupling::linear`] depends on the frequency.
    fn depends_on_frequency(&self) -> bool {
        false
    }
    /// Whether [`Coupling::linear`] depends on the mean torque.
    fn depends_on_load(&self) -> bool {
        !self.is_linear()
    }
    /// Whether the law is one of harmonic motion (a loss factor, a dynamic stiffness) that says nothing about other motion.
    fn is_harmonic_only(&self) -> bool {
        self.depends_on_frequency()
    }
    /// Whether [`Coupling::torque`] is linear in twist and rate.
    fn is_linear(&self) -> bool {
        true
    }
}
dyn_clone::clone_trait_object!(Coupling);
