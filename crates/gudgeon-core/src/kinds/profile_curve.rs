use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of a curve through the ordinates of a piston skirt.
#[register_kind(name = "profile_curve", summary = "curve of a skirt profile through a few ordinates")]
pub trait ProfileCurveSpec: Debug + DynClone + Send + Sync {
    /// The curve through `(x, y)`, `x` \[m\] increasing.
    ///
    /// # Errors
    /// Fewer than two points, points that do not increase, more points than the method admits.
    fn build(&self, x: &[f64], y: &[f64]) -> Result<Box<dyn ProfileCurve>, BuildError>;
}

/// A running profile curve.
pub trait ProfileCurve: Debug + Send + Sync {
    /// Ordinate \[m\] at `x` \[m\]; beyond the outermost points the curve goes on as its model says.
    fn value(&self, x: f64) -> f64;
}
