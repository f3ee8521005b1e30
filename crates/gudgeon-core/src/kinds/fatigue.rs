use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError, register_kind};

/// Configuration of a fatigue criterion.
#[register_kind(name = "fatigue", summary = "safety of an alternating stress against fatigue")]
pub trait FatigueSpec: Debug + DynClone + Send + Sync {
    /// Whether nothing is judged.
    fn is_off(&self) -> bool {
        false
    }

    /// Builds the running criterion.
    ///
    /// # Errors
    /// Strengths that contradict each other.
    fn build(&self) -> Result<Box<dyn Fatigue>, BuildError>;
}

/// A running fatigue criterion.
pub trait Fatigue: Debug + Send + Sync {
    /// Whether nothing is judged.
    fn is_off(&self) -> bool {
        false
    }
    /// Factor by which mean and amplitude \[Pa\] may both grow: above one the stress is endured for ever. A compressive mean counts as
    /// none.
    ///
    /// # Errors
    /// A stress that is not finite, a negative amplitude (Recoverable), no stress at all (Fatal).
    fn safety(&self, mean: f64, amplitude: f64) -> Result<f64, EvalError>;
}
