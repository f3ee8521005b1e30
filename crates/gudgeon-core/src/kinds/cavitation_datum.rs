use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of the pressure at which the films of rings cavitate.
#[register_kind(name = "cavitation_datum", summary = "pressure below which the film of a ring cavitates")]
pub trait CavitationDatumSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Settings outside their range.
    fn build(&self) -> Result<Box<dyn CavitationDatum>, BuildError>;
}

/// A running model of it.
pub trait CavitationDatum: Debug + Send {
    /// Absolute cavitation pressure \[Pa\] for the absolute pressures \[Pa\] of the crankcase and of the lands beside the ring. Not above any
    /// of the latter: the edges of a film are wet.
    fn pressure(&self, p_crankcase: f64, p_above: f64, p_below: f64) -> f64;
}
