use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of an oil.
#[register_kind(name = "oil", summary = "dynamic viscosity of the lubricant")]
pub trait OilSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants that give no positive viscosity.
    fn build(&self) -> Result<Box<dyn Oil>, BuildError>;
}

/// A running oil.
pub trait Oil: Debug + Send + Sync {
    /// Dynamic viscosity \[Pa s\] at temperature \[K\].
    fn viscosity(&self, temperature: f64) -> f64;
}
