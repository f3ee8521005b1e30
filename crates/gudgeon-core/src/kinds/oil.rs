use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::BuildError;

/// Configuration of an oil.
#[typetag::serde(tag = "model")]
pub trait OilSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants that give no positive viscosity.
    fn build(&self) -> Result<Box<dyn Oil>, BuildError>;
}
dyn_clone::clone_trait_object!(OilSpec);
crate::register_kind!(dyn OilSpec, "oil", "dynamic viscosity of the lubricant");

/// A running oil.
pub trait Oil: Debug + Send + Sync {
    /// Dynamic viscosity \[Pa s\] at temperature \[K\].
    fn viscosity(&self, temperature: f64) -> f64;
}
