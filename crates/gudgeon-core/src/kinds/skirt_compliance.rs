use std::fmt::Debug;

use dyn_clone::DynClone;

use super::Film2dGrid;
use crate::file::Files;
use crate::states::Stateful;
use crate::{BuildError, register_kind};

/// What a [`SkirtComplianceSpec`] is built for: one side of the skirt.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct SkirtComplianceCtx<'a> {
    /// Nodes of the whole side: `x` from the upper edge down, `y` along the arc from the middle of the side.
    pub grid: &'a Film2dGrid,
    /// Height of the skirt \[m\].
    pub length: f64,
    /// Radius of the skirt \[m\].
    pub radius: f64,
    /// Half of the angle that the side covers \[rad\].
    pub half_angle: f64,
    /// The files that the case names.
    pub files: &'a Files,
    /// Name of the side for people: `thrust side`.
    pub side: &'a str,
    /// Time \[s\] in which a shape without load comes back to rest.
    pub relaxation: f64,
}

impl<'a> SkirtComplianceCtx<'a> {
    /// A side of a skirt of a height \[m\], a radius \[m\] and half the angle that it covers \[rad\], on the nodes of a grid. Shapes come back to rest at
    /// once until that is set.
    #[must_use]
    pub const fn new(
        grid: &'a Film2dGrid,
        length: f64,
        radius: f64,
        half_angle: f64,
        files: &'a Files,
    ) -> Self {
        Self { grid, length, radius, half_angle, files, side: "side", relaxation: 0.0 }
    }

    /// Sets the name of the side for people.
    #[must_use]
    pub const fn named(mut self, side: &'a str) -> Self {
        self.side = side;
        self
    }

    /// Sets the time in which a shape without load comes back to rest \[s\].
    #[must_use]
    pub const fn relaxing(mut self, relaxation: f64) -> Self {
        self.relaxation = relaxation;
        self
    }
}

/// Configuration of a compliance of the skirt.
#[register_kind(name = "skirt_compliance", summary = "how the skirt yields to the pressure on it")]
pub trait SkirtComplianceSpec: Debug + DynClone + Send + Sync {
    /// Whether the skirt does not yield at all.
    fn is_rigid(&self) -> bool {
        false
    }

    /// Builds the running model of one side.
    ///
    /// # Errors
    /// Files that cannot be read or hold no compliance, shapes that are none.
    fn build(&self, ctx: &SkirtComplianceCtx<'_>) -> Result<Box<dyn SkirtCompliance>, BuildError>;
}

/// A running compliance of one side: shapes in which the surface moves away from the liner, by `Σ q_k φ_k(x, y)`, and how each yields to its load
/// `∫ φ_k (p - p_crankcase) dA`.
///
/// Every state is the amplitude `q_k` of a shape in clearances. Its rate is that at which the load, that of the film's answer to the rate among it, is
/// equal to [`SkirtCompliance::resistance`].
pub trait SkirtCompliance: Stateful + Debug + Send + Sync {
    /// Values of the shapes at the nodes of the grid, shape after shape, each of the order of one; none for a rigid side.
    fn shapes(&self) -> &[f64];

    /// Force \[N\] with which shape `k` resists at the amplitude `q` \[m\] that changes at `rate` \[m/s\].
    fn resistance(&self, k: usize, q: f64, rate: f64) -> f64;

    /// Derivative of that force by the rate \[N s/m\].
    fn resistance_by_rate(&self, k: usize, q: f64, rate: f64) -> f64;

    /// Amplitude \[m\] at which shape `k` rests under `load` \[N\].
    fn rest(&self, k: usize, load: f64) -> f64;
}
