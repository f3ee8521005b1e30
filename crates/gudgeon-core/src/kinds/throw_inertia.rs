use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Geometry and masses of one throw with its rod and piston.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThrowCtx {
    /// Crank radius r \[m\].
    pub crank_radius: f64,
    /// Rod length l between centres \[m\].
    pub rod_length: f64,
    /// Offset of the pin's line of motion from the crank axis \[m\].
    pub offset: f64,
    /// Inertia of the crank throw about its axis \[kg m²\].
    pub crank_inertia: f64,
    /// Rod mass \[kg\].
    pub rod_mass: f64,
    /// Distance of the rod's mass centre from its big end, by the rod length.
    pub rod_centre: f64,
    /// Inertia of the rod about its mass centre \[kg m²\]; `None`: that of its two masses, so that nothing is left over.
    pub rod_inertia: Option<f64>,
    /// Mass of all that moves with the piston \[kg\].
    pub reciprocating_mass: f64,
}

/// Configuration of the inertia that a throw shows to the shaft.
#[register_kind(
    name = "throw_inertia",
    summary = "inertia of crank, rod and piston as the shaft feels it, over the crank angle"
)]
pub trait ThrowInertiaSpec: Debug + DynClone + Send + Sync {
    /// Checks the numbers and builds the running model.
    ///
    /// # Errors
    /// A mechanism that cannot turn.
    fn build(&self, ctx: &ThrowCtx) -> Result<Box<dyn ThrowInertia>, BuildError>;
}

/// A running throw inertia.
pub trait ThrowInertia: Debug + DynClone + Send + Sync {
    /// Inertia \[kg m²\] and its derivative by the angle \[kg m²/rad\] at crank angle `theta` \[rad\] of the throw.
    fn inertia(&self, theta: f64) -> (f64, f64);
    /// Mean over a turn \[kg m²\].
    fn mean(&self) -> f64;
    /// Whether the inertia is the same at all angles.
    fn is_constant(&self) -> bool;
}
dyn_clone::clone_trait_object!(ThrowInertia);
