use std::fmt::Debug;
use std::path::Path;

use dyn_clone::DynClone;

use super::Kinematics;
use crate::BuildError;

/// What a [`CylinderPressureSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct CylinderPressureCtx<'a> {
    /// Piston motion; cylinder volume is `piston_area * (y_tdc - y) + clearance volume`.
    pub kinematics: &'a (dyn Kinematics + 'static),
    /// Piston area \[m²\].
    pub piston_area: f64,
    /// Folder that relative file names in the case refer to.
    pub folder: &'a Path,
}

/// Configuration of a cylinder-pressure model.
#[typetag::serde(tag = "model")]
pub trait CylinderPressureSpec: Debug + DynClone + Send + Sync {
    /// Checks the numbers and builds the running model.
    ///
    /// # Errors
    /// Tables that are not monotone or not positive, files that cannot be read, a compression ratio that cannot be.
    fn build(&self, ctx: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError>;
}
dyn_clone::clone_trait_object!(CylinderPressureSpec);
crate::register_kind!(
    dyn CylinderPressureSpec,
    "cylinder_pressure",
    "gas pressure in the cylinder over the cycle"
);

/// A running cylinder-pressure model.
pub trait CylinderPressure: Debug + DynClone + Send + Sync {
    /// Absolute pressure \[Pa\] at crank angle `theta` \[rad\], any real number.
    fn pressure(&self, theta: f64) -> f64;
    /// Pressure at `theta` of a model that goes by fixed crank angles, with the choice between these made at the angle
    /// `decided_at`. A published program evaluates its stages that way; other models have nothing to decide.
    fn pressure_decided_at(&self, decided_at: f64, theta: f64) -> f64 {
        let _ = decided_at;
        self.pressure(theta)
    }
    /// Crank angles in `[0, period)` \[rad\], ascending, where the pressure or its slope jumps: an integrator restarts there.
    fn kinks(&self) -> &[f64];
    /// Length of the cycle \[rad\]: 4π for four strokes.
    fn period(&self) -> f64;
}
dyn_clone::clone_trait_object!(CylinderPressure);
