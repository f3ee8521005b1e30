use std::fmt::Debug;

use dyn_clone::DynClone;

use super::Film2dGrid;
use crate::file::Files;
use crate::{BuildError, register_kind};

/// What a [`SkirtComplianceSpec`] is built for: one side of the skirt.
#[derive(Debug, Clone, Copy)]
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
}

/// How a side yields to the pressure on it: shapes, each with a stiffness.
///
/// The surface moves away from the liner by `Σ q_k φ_k`, and `K_k q_k = ∫ φ_k (p - p_crankcase) dA`: the shapes are orthogonal with respect to the
/// compliance, so each yields to its own part of the load alone.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SkirtModes {
    /// Values of the shapes at the nodes of the grid, shape after shape, each of the order of one.
    pub shapes: Vec<f64>,
    /// Stiffness of every shape \[N/m\].
    pub stiffness: Vec<f64>,
}

/// Configuration of a compliance of the skirt.
#[register_kind(name = "skirt_compliance", summary = "how the skirt yields to the pressure on it")]
pub trait SkirtComplianceSpec: Debug + DynClone + Send + Sync {
    /// The shapes of one side; none for a rigid skirt.
    ///
    /// # Errors
    /// Files that cannot be read or hold no compliance, shapes that are none.
    fn build(&self, ctx: &SkirtComplianceCtx<'_>) -> Result<SkirtModes, BuildError>;
}
