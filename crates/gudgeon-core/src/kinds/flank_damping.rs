use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of a model of the oil between ring and groove flanks.
#[register_kind(
    name = "flank_damping",
    summary = "resistance of the oil in the groove to the ring's axial motion"
)]
pub trait FlankDampingSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self, ctx: &FlankDampingCtx) -> Result<Box<dyn FlankDamping>, BuildError>;
}

/// What a [`FlankDampingSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct FlankDampingCtx {
    /// Zero-based number of the ring.
    pub ring: usize,
    /// Number of rings.
    pub rings: usize,
    /// Oil-filled fraction of the groove flanks, 0 to 1.
    pub oil_fill: f64,
    /// Radial width of the flank contact \[m\].
    pub width: f64,
    /// Viscosity of the oil in the groove \[Pa s\], at the temperature behind the ring.
    pub mu: f64,
}

/// A running flank-damping model of one ring.
pub trait FlankDamping: Send {
    /// Force on the ring \[N\], towards the head positive, opposing `v`. `s` height above the lower flank \[m\], `clearance`
    /// \[m\], `area` flank annulus \[m²\].
    fn force(&self, s: f64, v: f64, clearance: f64, area: f64) -> f64;
}
