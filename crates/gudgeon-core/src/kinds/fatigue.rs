use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError};

/// Configuration of a fatigue criterion.
#[typetag::serde(tag = "model")]
pub trait FatigueSpec: Debug + DynClone + Send + Sync {
    /// Builds the running criterion.
    ///
    /// # Errors
    /// Strengths that contradict each other.
    fn build(&self) -> Result<Box<dyn Fatigue>, BuildError>;
}
dyn_clone::clone_trait_object!(FatigueSpec);
crate::register_kind!(dyn FatigueSpec, "fatigue", "safety of an alternating stress against fatigue");

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
