use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::geometry::RingSection;
use crate::{BuildError, register_kind};

/// Configuration of the axial gas force on a ring.
#[register_kind(
    name = "axial_gas",
    summary = "area and pressure distribution of the axial gas force on a ring"
)]
pub trait AxialGasSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Settings outside their range.
    fn build(&self) -> Result<Box<dyn AxialGas>, BuildError>;
}

/// A running model of it.
pub trait AxialGas: Debug + Send {
    /// Axial force of the gas on the whole ring \[N\], positive towards the head.
    fn force(&self, ring: &RingSection<'_>) -> f64;
}
