use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::file::Files;
use crate::{BuildError, register_kind};

/// What a [`SkirtProfileSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct SkirtProfileCtx<'a> {
    /// Height of the skirt \[m\].
    pub length: f64,
    /// Radius of the skirt \[m\].
    pub radius: f64,
    /// The files that the case names.
    pub files: &'a Files,
}

/// Configuration of a skirt's shape.
#[register_kind(name = "skirt_profile", summary = "shape of the piston skirt, hot")]
pub trait SkirtProfileSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Tables that are none, files that cannot be read.
    fn build(&self, ctx: &SkirtProfileCtx<'_>) -> Result<Box<dyn SkirtProfile>, BuildError>;
}

/// A running skirt shape.
pub trait SkirtProfile: Debug + Send + Sync {
    /// How far the surface stands behind the cylinder of nominal radius \[m\], at the height `x` below the upper edge \[m\] and the angle
    /// `angle` from the middle of the side \[rad\].
    fn depth(&self, x: f64, angle: f64) -> f64;
    /// Whether it is the same at `angle` and `-angle`: half of each side is then solved.
    fn is_symmetric(&self) -> bool;
}
