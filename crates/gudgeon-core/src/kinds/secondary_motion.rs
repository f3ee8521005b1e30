use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// Configuration of a model of the piston's lateral motion.
#[register_kind(
    name = "secondary_motion",
    summary = "how the lateral position and the tilt of the piston follow from the forces on it"
)]
pub trait SecondaryMotionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self) -> Result<Box<dyn SecondaryMotion>, BuildError>;
}

/// How lateral position and tilt come about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lateral {
    /// Positions and velocities are states: mass times acceleration is the sum of the forces.
    Inertial,
    /// Positions are states; the velocities are those at which all forces are in balance.
    QuasiStatic,
    /// The skirt stands at these displacements of its upper and lower edge \[m\], towards the anti-thrust side positive.
    Held {
        /// Displacement of the upper edge.
        e_top: f64,
        /// Displacement of the lower edge.
        e_bottom: f64,
    },
}

/// A running model of the piston's lateral motion.
pub trait SecondaryMotion: Debug + Send + Sync {
    /// How position and tilt come about.
    fn lateral(&self) -> Lateral;
}
