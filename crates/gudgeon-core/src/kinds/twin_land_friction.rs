use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of how the friction of a twin-land ring counts.
#[register_kind(
    name = "twin_land_friction",
    summary = "how the running faces of a twin-land ring share its friction"
)]
pub trait TwinLandFrictionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Settings outside their range.
    fn build(&self) -> Result<Box<dyn TwinLandFriction>, BuildError>;
}

/// A running model of it.
pub trait TwinLandFriction: Debug + Send {
    /// Factors of the friction of the upper and the lower running face of a ring with two.
    fn shares(&self) -> [f64; 2];
}
