use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError, register_kind};

/// Configuration of a pressure dependence of viscosity.
#[register_kind(name = "piezoviscosity", summary = "rise of viscosity with pressure")]
pub trait PiezoviscositySpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn Piezoviscosity>, BuildError>;
}

/// A running pressure dependence of viscosity.
pub trait Piezoviscosity: Debug + Send + Sync {
    /// Whether the factor is one everywhere: a solver need not ask then.
    fn is_off(&self) -> bool {
        false
    }

    /// `factor[i] = μ(p)/μ0` and `slope[i]`, its derivative \[1/Pa\], for pressures above ambient \[Pa\]. `mu0` is the viscosity
    /// \[Pa s\] at ambient pressure and the temperature of the film. Positive, finite, with continuous slope.
    ///
    /// # Errors
    /// Pressure or viscosity outside the range of the model (Recoverable), slices of different length (Fatal).
    fn factor(
        &self,
        mu0: f64,
        pressure: &[f64],
        factor: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError>;
}
