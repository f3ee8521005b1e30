use std::fmt::Debug;

use dyn_clone::DynClone;

use super::Line;
use crate::{BuildError, EvalError, register_kind};

/// Configuration of how natural frequencies are found.
#[register_kind(
    name = "natural_frequencies",
    summary = "natural frequencies and mode shapes of a shaft line"
)]
pub trait NaturalFrequenciesSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model for a shaft line.
    ///
    /// # Errors
    /// A shaft line that is not connected, closes on itself or has no inertia.
    fn build(&self, line: &Line) -> Result<Box<dyn NaturalFrequencies>, BuildError>;
    /// Whether what it gives are the natural frequencies of the line; not so for a published mistake.
    fn are_of_the_line(&self) -> bool {
        true
    }
}

/// One natural mode.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mode {
    /// Undamped angular frequency \[rad/s\]; exactly zero for a rigid mode.
    pub omega: f64,
    /// Decay rate and angular frequency \[rad/s\] with damping: eigenvalue `-decay ± i omega_damped`; `None` where there is none
    /// to be had (rigid modes, modes that no longer oscillate, models that do not compute it).
    pub damped: Option<(f64, f64)>,
    /// Angles of the inertias, the largest being 1; empty when the model gives no shape.
    pub shape: Vec<f64>,
    /// Residual of the balance of torques, by the largest torque.
    pub residual: f64,
}

/// A running solver of natural frequencies.
pub trait NaturalFrequencies: Debug + Send {
    /// The modes by ascending frequency, the rigid ones first.
    ///
    /// # Errors
    /// No convergence (Fatal).
    fn modes(&mut self) -> Result<Vec<Mode>, EvalError>;
}
