use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::geometry::RingSection;
use crate::{BuildError, register_kind};

/// Configuration of where gas presses on a ring radially.
#[register_kind(name = "radial_gas", summary = "surfaces on which gas presses a ring outwards and inwards")]
pub trait RadialGasSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Settings outside their range.
    fn build(&self) -> Result<Box<dyn RadialGas>, BuildError>;
}

/// A running model of it.
pub trait RadialGas: Debug + Send {
    /// Circumference \[m\] that turns loads per length into forces on the ring.
    fn circumference(&self, ring: &RingSection<'_>) -> f64;
    /// Radial load of the gas, per circumference \[N/m\], that the running face must carry above `p_cav`. Outwards positive.
    fn load(&self, ring: &RingSection<'_>) -> f64;
}
