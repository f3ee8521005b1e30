use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::states::Stateful;
use crate::{BuildError, EvalError, register_kind};

/// What a [`SecondaryMotionSpec`] is built for: one piston in its bore.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct SecondaryMotionCtx {
    /// Radial clearance of the centred skirt \[m\].
    pub clearance: f64,
    /// Crank speed \[rad/s\].
    pub omega: f64,
    /// Mass matrix of the displacements of the upper and the lower edge of the skirt \[kg\].
    pub mass: [[f64; 2]; 2],
    /// Displacements of both edges with which the first cycle starts \[m\], as the case gives them.
    pub start: [f64; 2],
}

impl SecondaryMotionCtx {
    /// A piston with a radial clearance \[m\] at a crank speed \[rad/s\], centred at the start, with the mass matrix of the displacements of both
    /// edges \[kg\].
    #[must_use]
    pub const fn new(clearance: f64, omega: f64, mass: [[f64; 2]; 2]) -> Self {
        Self { clearance, omega, mass, start: [0.0; 2] }
    }

    /// Sets the displacements of both edges at the start of the first cycle \[m\].
    #[must_use]
    pub const fn starting_at(mut self, start: [f64; 2]) -> Self {
        self.start = start;
        self
    }
}

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
    fn build(&self, ctx: &SecondaryMotionCtx) -> Result<Box<dyn SecondaryMotion>, BuildError>;
}

/// Where the piston stands in its bore. Displacements of the upper and the lower edge of the skirt count towards the anti-thrust side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct LateralPose {
    /// Displacements of both edges \[m\].
    pub e: [f64; 2],
    /// Velocities of both edges \[m/s\], where the states give them; none: they follow from the balance of forces.
    pub v: Option<[f64; 2]>,
}

impl LateralPose {
    /// A piston displaced by `e` \[m\], whose velocities follow from the balance of forces.
    #[must_use]
    pub const fn new(e: [f64; 2]) -> Self {
        Self { e, v: None }
    }

    /// The same with velocities \[m/s\] that the states give.
    #[must_use]
    pub const fn moving(mut self, v: [f64; 2]) -> Self {
        self.v = Some(v);
        self
    }
}

/// Forces on the displacements of both edges that a lateral motion adds to those of the piston: `constant - damping · v`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct AddedForces {
    /// Part that does not depend on the velocities \[N\].
    pub constant: [f64; 2],
    /// Damping matrix \[N s/m\], row after row.
    pub damping: [[f64; 2]; 2],
}

impl AddedForces {
    /// Forces \[N\] and a damping matrix \[N s/m\].
    #[must_use]
    pub const fn new(constant: [f64; 2], damping: [[f64; 2]; 2]) -> Self {
        Self { constant, damping }
    }
}

/// The piston between both sides of its skirt, at an instant and a place, as its lateral motion asks it. Elastic shapes of the skirt follow: they
/// yield at the rates at which their own forces are in balance.
///
/// Ask one question an instant: [`LateralLoads::balance`], or [`LateralLoads::forces`] for velocities that are known, or neither.
pub trait LateralLoads {
    /// Velocities of both edges \[m/s\] at which all forces on the piston, the added ones among them, are in balance.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance.
    fn balance(&mut self) -> Result<[f64; 2], EvalError>;

    /// Velocities of both edges \[m/s\] at which the forces on the piston leave `force` \[N\] on each, such as mass times acceleration.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance.
    fn balance_against(&mut self, force: [f64; 2]) -> Result<[f64; 2], EvalError>;

    /// Sums of all forces on both edges \[N\], the added ones among them, when they move at `v` \[m/s\].
    ///
    /// # Errors
    /// A film that cannot be solved, no balance of the shapes.
    fn forces(&mut self, v: [f64; 2]) -> Result<[f64; 2], EvalError>;

    /// Forces of films and solid contact alone on both edges \[N\], as of the last question.
    fn skirt_forces(&self) -> [f64; 2];
}

/// Partial derivatives of what the piston answered last, at fixed states otherwise: of the velocities of both edges \[m/s\] after
/// [`LateralLoads::balance`], of the forces on both edges \[N\] after [`LateralLoads::forces`].
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct LateralPartials<'a> {
    /// With respect to the displacement of each edge, per metre.
    pub by_e: [[f64; 2]; 2],
    /// With respect to the velocity of each edge, per m/s; zero where velocities are what was answered.
    pub by_v: [[f64; 2]; 2],
    /// With respect to an added force on each edge, per newton.
    pub by_force: [[f64; 2]; 2],
    /// With respect to the amplitude of every elastic shape, per metre.
    pub by_shape: &'a [[f64; 2]],
}

impl<'a> LateralPartials<'a> {
    /// Derivatives with respect to displacements, velocities, added forces and shapes.
    #[must_use]
    pub const fn new(
        by_e: [[f64; 2]; 2],
        by_v: [[f64; 2]; 2],
        by_force: [[f64; 2]; 2],
        by_shape: &'a [[f64; 2]],
    ) -> Self {
        Self { by_e, by_v, by_force, by_shape }
    }
}

/// A lateral motion as a law of the displacements of both edges alone, `M dv/dt = forces`, for schemes that step it themselves.
pub trait EdgeLaw {
    /// Mass matrix \[kg\]; none where the velocities follow from the balance of forces.
    fn mass(&self) -> Option<[[f64; 2]; 2]>;

    /// States `y` at displacements `e` \[m\] and velocities `v` \[m/s\] of both edges.
    fn states_at(&self, e: [f64; 2], v: [f64; 2], y: &mut [f64]);
}

/// A part of the physics that a lateral motion computes or leaves out, for people.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct MotionPart {
    /// What: `inertia across the bore`.
    pub what: &'static str,
    /// Why.
    pub why: &'static str,
    /// Whether it is computed.
    pub runs: bool,
}

impl MotionPart {
    /// A part that is computed.
    #[must_use]
    pub const fn runs(what: &'static str, why: &'static str) -> Self {
        Self { what, why, runs: true }
    }

    /// A part that is left out.
    #[must_use]
    pub const fn left_out(what: &'static str, why: &'static str) -> Self {
        Self { what, why, runs: false }
    }
}

/// A running model of the piston's lateral motion. Its states are its own; rates are by crank angle \[1/rad\].
///
/// A state that changes the gap says so by [`Signals::FILM_THICKNESS`](crate::states::Signals::FILM_THICKNESS): its error is judged by the part of the
/// clearance that is left.
pub trait SecondaryMotion: Stateful + Send {
    /// Where the piston stands for the states `y`: an affine function of them.
    fn pose(&self, y: &[f64]) -> LateralPose;

    /// Forces that the motion adds to those of the piston for the states `y`; `constant` is an affine function of them, `damping` does not depend
    /// on them.
    fn added(&self, _y: &[f64]) -> AddedForces {
        AddedForces::default()
    }

    /// Rates `dy` of the states `y`.
    ///
    /// # Errors
    /// What the piston refuses.
    fn rates(&mut self, y: &[f64], piston: &mut dyn LateralLoads, dy: &mut [f64]) -> Result<(), EvalError>;

    /// Partial derivatives of the rates that [`SecondaryMotion::rates`] found last at the same states: row after row, first by the own states, then
    /// by the amplitudes of the elastic shapes, which count in clearances. False: difference quotients are taken instead.
    fn partials(&mut self, _y: &[f64], _piston: &LateralPartials<'_>, _jac: &mut [f64]) -> bool {
        false
    }

    /// Derivatives of the same rates by crank angle at fixed states; `by_time` are those of what the piston answered, per radian.
    /// False: a difference quotient is taken instead.
    fn time_partials(&mut self, _by_time: [f64; 2], _dfdt: &mut [f64]) -> bool {
        false
    }

    /// Number of states, the first ones, with which a cycle ends as it began when it is periodic. The others follow from them, by
    /// [`SecondaryMotion::begin`].
    fn n_periodic(&self) -> usize {
        self.states().len()
    }

    /// Completes the states `y` with which a cycle begins, whose first [`SecondaryMotion::n_periodic`] are given.
    fn begin(&mut self, _y: &mut [f64], _piston: &mut dyn LateralLoads) {}

    /// Velocities of both edges \[m/s\] at an instant of a finished cycle. `y` are the states there and `slope(k)` is the derivative of state `k` by
    /// crank angle, both of the polynomial that the integrator found.
    ///
    /// # Errors
    /// What the piston refuses.
    fn velocities(
        &mut self,
        y: &[f64],
        _slope: &dyn Fn(usize) -> f64,
        piston: &mut dyn LateralLoads,
    ) -> Result<[f64; 2], EvalError> {
        match self.pose(y).v {
            Some(v) => Ok(v),
            None => piston.balance(),
        }
    }

    /// Whether the piston moves across its bore.
    fn moves(&self) -> bool {
        true
    }

    /// Whether forces on both edges accelerate the piston.
    fn has_inertia(&self) -> bool {
        false
    }

    /// The motion as a law of the displacements of both edges alone; none for one that is anything else.
    fn edge_law(&self) -> Option<&dyn EdgeLaw> {
        None
    }

    /// Keys of the specification that give the displacements of both edges at the start; none where the case gives them.
    fn start_keys(&self) -> Option<[&'static str; 2]> {
        None
    }

    /// What is computed and what is left out, for people.
    fn parts(&self) -> Vec<MotionPart> {
        Vec::new()
    }
}
