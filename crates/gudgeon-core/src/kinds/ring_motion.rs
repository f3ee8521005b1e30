use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, register_kind};

/// What a [`RingMotionSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct RingMotionCtx {
    /// Mass of the ring \[kg\].
    pub mass: f64,
    /// Nominal axial clearance \[m\].
    pub clearance: f64,
    /// Area of the flanks \[m²\].
    pub flank_area: f64,
    /// Zero-based number of the ring.
    pub ring: usize,
}

/// Configuration of a ring-motion model.
#[register_kind(name = "ring_motion", summary = "axial motion of a ring in its groove")]
pub trait RingMotionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model of one ring.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self, ctx: &RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError>;
}

/// How a ring's axial position comes about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// Position and velocity are states of the scene (two per ring).
    Dynamic,
    /// A seat is chosen every `interval` \[rad\] of crank angle from the forces then and held in between.
    Discrete {
        /// Crank angle between decisions \[rad\].
        interval: f64,
    },
    /// Always at this fraction of the clearance (0 lower flank, 1 upper flank): no state, no force needed.
    Fixed {
        /// Fraction of the clearance.
        e: f64,
    },
}

/// Axial forces on a ring \[N\], towards the head positive, without the reaction of the flanks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxialForces {
    /// Gas pressure on the flanks.
    pub gas: f64,
    /// Inertia in the frame of the piston, `-m a_piston`.
    pub inertia: f64,
    /// Weight.
    pub gravity: f64,
    /// Film and rubbing on the running face.
    pub film: f64,
    /// Oil in the groove.
    pub damping: f64,
}

impl AxialForces {
    /// Their sum.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.gas + self.inertia + self.gravity + self.film + self.damping
    }
}

/// A running ring-motion model of one ring.
pub trait RingMotion: Send {
    /// How the position comes about.
    fn motion(&self) -> Motion;
    /// Whether the force of the film on the face is part of the balance. When it is not, no film is needed for the motion.
    fn uses_film_force(&self) -> bool;
    /// Whether gravity is part of the balance.
    fn uses_gravity(&self) -> bool;
    /// Reaction of the groove flanks \[N\] at height `s`, velocity `v` and clearance `c` (a [`Motion::Dynamic`] model).
    fn flank_reaction(&self, s: f64, v: f64, clearance: f64) -> f64;
    /// The seat (0 lower, ½ unstable, 1 upper) for these forces (a [`Motion::Discrete`] model).
    fn seat(&self, forces: &AxialForces) -> f64;
}
