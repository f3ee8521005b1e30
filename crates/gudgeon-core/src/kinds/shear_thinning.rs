use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError, register_kind};

/// Configuration of a shear dependence of viscosity.
#[register_kind(name = "shear_thinning", summary = "fall of viscosity with shear rate")]
pub trait ShearThinningSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn ShearThinning>, BuildError>;
}

/// A running shear dependence of viscosity.
pub trait ShearThinning: Debug + Send + Sync {
    /// Whether the factor is one everywhere: a solver need not ask then.
    fn is_off(&self) -> bool {
        false
    }

    /// `factor[i] = μ(γ̇)/μ0` and `slope[i]`, its derivative \[s\], for shear rates of either sign \[1/s\]. Between the high-shear ratio
    /// of the model and one, falling with the magnitude of the rate.
    ///
    /// # Errors
    /// A rate that is not finite (Recoverable), slices of different length (Fatal).
    fn factor(&self, shear_rate: &[f64], factor: &mut [f64], slope: &mut [f64]) -> Result<(), EvalError>;
}
