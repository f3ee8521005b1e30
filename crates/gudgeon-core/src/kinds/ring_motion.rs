use std::fmt::Debug;

use dyn_clone::DynClone;

use super::FlankLaw;
use crate::geometry::{FlankOil, RingPlace};
use crate::states::{Stage, Stateful};
use crate::{BuildError, EvalError, register_kind};

/// What a [`RingMotionSpec`] is built for.
#[non_exhaustive]
pub struct RingMotionCtx {
    /// Mass of the ring \[kg\].
    pub mass: f64,
    /// Nominal axial clearance \[m\].
    pub clearance: f64,
    /// Area of the flanks \[m²\].
    pub flank_area: f64,
    /// Axial thickness of the ring \[m\].
    pub height: f64,
    /// Radial thickness of the ring \[m\].
    pub width: f64,
    /// Radius of the middle of the section \[m\].
    pub radius: f64,
    /// Zero-based number of the ring.
    pub ring: usize,
    /// Crank speed \[rad/s\].
    pub omega: f64,
    /// Oil between the ring and the flanks of its groove.
    pub damping: Box<dyn FlankLaw>,
    /// The flank that an expander presses the ring onto, as a fraction of the clearance: 0 the lower, 1 the upper one.
    pub pressed_onto: Option<f64>,
}

impl RingMotionCtx {
    /// A ring of a mass \[kg\] with a nominal clearance \[m\], at a crank speed \[rad/s\]; sections and areas are zero until they are set.
    #[must_use]
    pub fn new(ring: usize, mass: f64, clearance: f64, omega: f64, damping: Box<dyn FlankLaw>) -> Self {
        Self {
            mass,
            clearance,
            flank_area: 0.0,
            height: 0.0,
            width: 0.0,
            radius: 0.0,
            ring,
            omega,
            damping,
            pressed_onto: None,
        }
    }

    /// A rail that an expander presses onto the lower (0) or the upper (1) flank.
    #[must_use]
    pub const fn pressed_onto(mut self, fraction: f64) -> Self {
        self.pressed_onto = Some(fraction);
        self
    }

    /// Sets axial and radial thickness, the radius of the middle of the section \[m\] and the area of a flank \[m²\].
    #[must_use]
    pub fn section(mut self, height: f64, width: f64, radius: f64, flank_area: f64) -> Self {
        (self.height, self.width, self.radius, self.flank_area) = (height, width, radius, flank_area);
        self
    }
}

/// Configuration of a ring-motion model.
#[register_kind(name = "ring_motion", summary = "motion of a ring in its groove")]
pub trait RingMotionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model of one ring.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self, ctx: RingMotionCtx) -> Result<Box<dyn RingMotion>, BuildError>;
}

/// Where a ring is in its groove.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct RingPose {
    /// Height of the middle of the section above the lower flank \[m\].
    pub s: f64,
    /// Its velocity \[m/s\], towards the head positive.
    pub v: f64,
    /// `s` over the clearance, 0 on the lower flank to 1 on the upper one.
    pub lift_fraction: f64,
    /// Twist of the section \[rad\], positive when the outer edge rises towards the head.
    pub twist: f64,
    /// Its rate \[rad/s\].
    pub twist_rate: f64,
}

impl RingPose {
    /// Puts a ring into the pose.
    #[inline]
    pub fn put(self, place: &mut RingPlace) {
        (place.s, place.v, place.lift_fraction) = (self.s, self.v, self.lift_fraction);
        (place.twist, place.twist_rate) = (self.twist, self.twist_rate);
    }

    /// A ring at height `s` \[m\] with velocity `v` \[m/s\] in a groove that leaves it a `clearance` \[m\].
    #[inline]
    #[must_use]
    pub fn at_height(s: f64, v: f64, clearance: f64) -> Self {
        let lift_fraction = if clearance > 0.0 { (s / clearance).clamp(0.0, 1.0) } else { 0.0 };
        Self { s, v, lift_fraction, ..Self::default() }
    }

    /// A ring that rests at a fraction of its `clearance` \[m\].
    #[inline]
    #[must_use]
    pub fn seated(lift_fraction: f64, clearance: f64) -> Self {
        Self { s: lift_fraction * clearance, v: 0.0, lift_fraction, ..Self::default() }
    }

    /// The same, twisted by an angle \[rad\] that changes at a rate \[rad/s\].
    #[must_use]
    pub const fn twisted(mut self, twist: f64, twist_rate: f64) -> Self {
        (self.twist, self.twist_rate) = (twist, twist_rate);
        self
    }
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
    /// Expander of a three-piece oil ring on a rail.
    pub expander: f64,
    /// Oil in the groove.
    pub damping: f64,
}

impl AxialForces {
    /// Their sum.
    #[inline]
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.gas + self.inertia + self.gravity + self.film + self.expander + self.damping
    }
}

/// Moments about the middle of the section of the whole ring \[N m\], positive where they twist the outer edge towards the head.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct TwistMoments {
    /// Gas pressure on the flanks, on the back and on the face.
    pub gas: f64,
    /// Film and rubbing on the running face.
    pub film: f64,
}

impl TwistMoments {
    /// Moments of gas and film \[N m\].
    #[must_use]
    pub const fn new(gas: f64, film: f64) -> Self {
        Self { gas, film }
    }
}

/// What acts on a ring at an instant.
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct RingForces {
    /// Geometry that follows from the pose and the film thickness.
    pub place: RingPlace,
    /// Axial forces; that of the oil in the groove is the model's to find.
    pub axial: AxialForces,
    /// Moments that twist the section; zero until the scene knows them.
    pub twist: TwistMoments,
}

impl RingForces {
    /// Axial forces at a place.
    #[inline]
    #[must_use]
    pub fn new(place: RingPlace, axial: AxialForces) -> Self {
        Self { place, axial, ..Self::default() }
    }

    /// The same with moments.
    #[must_use]
    pub const fn with_twist(mut self, twist: TwistMoments) -> Self {
        self.twist = twist;
        self
    }
}

/// What a stage of an implicit step is solved under, by trials of where the ring is.
#[non_exhaustive]
pub struct RingTrials<'a> {
    /// What acts on the ring; its place is that of the last trial.
    pub forces: &'a mut RingForces,
    /// The oil on the flanks of the ring at a place.
    pub oil: &'a mut dyn FnMut(&RingPlace) -> FlankOil,
}

impl<'a> RingTrials<'a> {
    /// Trials under forces, beginning at their place, with what is on the flanks at a place.
    #[inline]
    pub fn new(forces: &'a mut RingForces, oil: &'a mut dyn FnMut(&RingPlace) -> FlankOil) -> Self {
        Self { forces, oil }
    }
}

/// What the motion adds to the forces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct RingResponse {
    /// Axial velocity \[m/s\]: that of the states, or of the balance of forces while it follows from that.
    pub v: f64,
    /// Force of the oil in the groove \[N\].
    pub damping: f64,
    /// Reaction of the flanks \[N\].
    pub reaction: f64,
}

impl RingResponse {
    /// Velocity \[m/s\], force of the oil and reaction of the flanks \[N\].
    #[inline]
    #[must_use]
    pub const fn new(v: f64, damping: f64, reaction: f64) -> Self {
        Self { v, damping, reaction }
    }
}

/// A running ring-motion model of one ring. Its states, when it has some, are its own; rates are by crank angle \[1/rad\].
pub trait RingMotion: Stateful + Send {
    /// Whether the ring can change its place: otherwise no axial force is needed.
    fn moves(&self) -> bool;

    /// Whether the force of the film on the face is part of the balance. When it is not, no film is needed for the motion.
    fn uses_film_force(&self) -> bool;

    /// Whether gravity is part of the balance.
    fn uses_gravity(&self) -> bool;

    /// Whether the oil in the groove is part of the balance.
    fn uses_damping(&self) -> bool {
        false
    }

    /// Where the ring is for its states `y`, in a groove that leaves it a `clearance` \[m\].
    fn pose(&self, y: &[f64], clearance: f64) -> RingPose;

    /// Rates `dy` of the states `y`, and what the motion adds to the forces.
    ///
    /// # Errors
    /// States for which the model has no answer.
    fn rates(&mut self, y: &[f64], forces: &RingForces, dy: &mut [f64]) -> Result<RingResponse, EvalError>;

    /// Decides what the model holds until the next decision, from the forces of now; whether it is something else than before.
    fn decide(&mut self, _forces: &AxialForces) -> bool {
        false
    }

    /// Until [`RingMotion::end_differences`], rates are asked for states and forces that differ by little from the last instant: what is searched
    /// for may be found by one step of Newton's method from there.
    fn begin_differences(&mut self) {}

    /// Ends what [`RingMotion::begin_differences`] began.
    fn end_differences(&mut self) {}

    /// Whether [`RingMotion::stage`] finds the states of the model.
    fn solves_stages(&self) -> bool {
        self.states().is_empty()
    }

    /// Solves a stage of an implicit step for the states `y`, which come as a guess. The forces of the groove at the answer, where `trials` leaves the ring.
    ///
    /// # Errors
    /// No states at which the stage closes; a model with states that does not solve stages.
    fn stage(
        &mut self,
        _stage: &Stage<'_>,
        y: &mut [f64],
        trials: &mut RingTrials<'_>,
    ) -> Result<RingResponse, EvalError> {
        if !y.is_empty() {
            return Err(EvalError::fatal("ring_motion", "the model does not solve stages of implicit steps"));
        }
        self.rates(y, trials.forces, &mut [])
    }

    /// The same law as one of second order in the height, `m s'' = F + F_damping(s, v)` between rigid flanks, for schemes that step it
    /// themselves; `None` for a model that is anything else.
    fn second_order(&self) -> Option<&dyn SecondOrder> {
        None
    }
}

/// A ring as a mass between rigid flanks.
pub trait SecondOrder {
    /// Force of the oil in the groove \[N\], which stands as `oil` says, at height `s` \[m\] and velocity `v` \[m/s\], for a clearance \[m\] and an area of the flanks \[m²\].
    fn damping(&self, oil: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> f64;
}
