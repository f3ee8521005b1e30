use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError, register_kind};

/// Configuration of a pressure dependence of density.
#[register_kind(name = "compressibility", summary = "rise of the density of oil with pressure")]
pub trait CompressibilitySpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn Compressibility>, BuildError>;
}

/// A running pressure dependence of density.
pub trait Compressibility: Debug + Send + Sync {
    /// Whether the factor is one everywhere: a solver need not ask then.
    fn is_off(&self) -> bool {
        false
    }

    /// `factor[i] = ρ(p)/ρ0` and `slope[i]`, its derivative \[1/Pa\], for pressures above ambient \[Pa\]. Positive, finite, with
    /// continuous slope.
    ///
    /// # Errors
    /// A pressure outside the range of the model (Recoverable), slices of different length (Fatal).
    fn factor(&self, pressure: &[f64], factor: &mut [f64], slope: &mut [f64]) -> Result<(), EvalError>;
}
