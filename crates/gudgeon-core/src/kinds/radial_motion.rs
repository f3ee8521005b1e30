use std::fmt::Debug;

use dyn_clone::DynClone;

use super::FaceForces;
use crate::states::{Stage, Stateful};
use crate::{BuildError, EvalError, register_kind};

/// What a [`RadialMotionSpec`] is built for: one ring whose film is solved.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct RadialMotionCtx {
    /// Zero-based number of the ring.
    pub ring: usize,
    /// Mass of the ring \[kg\].
    pub mass: f64,
    /// Circumference of the ring \[m\].
    pub circumference: f64,
    /// Crank speed \[rad/s\].
    pub omega: f64,
    /// Film thickness of the first instant \[m\].
    pub first_film: f64,
    /// Floors, caps and drags.
    pub limits: RadialLimits,
}

impl RadialMotionCtx {
    /// A ring at a crank speed \[rad/s\] whose first film is `first_film` \[m\] thick; mass and circumference are zero until they are set.
    #[must_use]
    pub const fn new(ring: usize, omega: f64, first_film: f64, limits: RadialLimits) -> Self {
        Self { ring, mass: 0.0, circumference: 0.0, omega, first_film, limits }
    }

    /// Sets mass \[kg\] and circumference \[m\].
    #[must_use]
    pub const fn body(mut self, mass: f64, circumference: f64) -> Self {
        (self.mass, self.circumference) = (mass, circumference);
        self
    }
}

/// Floors, caps and drags of the radial motion, as the case says them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadialLimits {
    /// Least load of a film over that of the ring's tension.
    pub min_load: f64,
    /// Radial speed that a ring does not exceed \[m/s\].
    pub radial_speed: f64,
    /// Drag per circumference of a ring off the liner \[N s/m²\].
    pub radial_drag: f64,
    /// Drag per circumference of surfaces in contact that move apart \[N s/m²\].
    pub contact_drag: f64,
    /// Parts of the load between which the drag of a ring off the liner begins to count and counts in full.
    pub drag_counts: (f64, f64),
    /// Film thicknesses over the range of contact between which it begins to count and counts in full.
    pub drag_gap: (f64, f64),
    /// Part of the way of a retreating ring over which it comes to rest.
    pub retreat_band: f64,
}

/// Configuration of a model of the radial motion of a ring.
#[register_kind(name = "radial_motion", summary = "motion of a ring towards the liner and off it")]
pub trait RadialMotionSpec: Debug + DynClone + Send + Sync {
    /// Builds the running model of one ring.
    ///
    /// # Errors
    /// Constants outside their range.
    fn build(&self, ctx: &RadialMotionCtx) -> Result<Box<dyn RadialMotion>, BuildError>;
}

/// What presses a ring against the liner at an instant, and what is known of what carries it. Loads are per circumference of one rail and count
/// above the pressure at which the film cavitates.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RadialState {
    /// Film thickness \[m\].
    pub thickness: f64,
    /// Load of tension and gas \[N/m\].
    pub load: f64,
    /// Load of tension alone \[N/m\].
    pub tension: f64,
    /// Load of the solid contact \[N/m\].
    pub contact: f64,
    /// Film thickness above which there is no contact \[m\].
    pub contact_range: f64,
    /// Part of the load that gas on dry parts of the face carries \[N/m\].
    pub dry: f64,
    /// Film thickness that the ring does not go below \[m\], and the part of it over which the approach to it fades out.
    pub lowest: (f64, f64),
    /// Film thickness at which the ring is flush with its land or touches the groove root \[m\].
    pub furthest: f64,
    /// Whether a film resists being squeezed.
    pub resists: bool,
    /// Whether anything could carry the ring: a film or contact.
    pub carries: bool,
    /// Whether friction on the flanks resists radial motion.
    pub has_friction: bool,
    /// Number of running faces.
    pub faces: usize,
}

/// The films and flanks of a ring at an instant, for as long as its radial motion asks. Forces are per circumference of one rail.
pub trait RadialLoads {
    /// The instant.
    fn state(&self) -> &RadialState;
    /// Friction on the flanks at `hdot` \[m/s\], towards the liner \[N/m\], and its derivative \[N s/m²\].
    fn friction(&self, hdot: f64) -> (f64, f64);
    /// Forces of the films at `hdot` \[m/s\], summed over the faces.
    ///
    /// # Errors
    /// What the film refuses.
    fn film(&mut self, hdot: f64) -> Result<FaceForces, EvalError>;
    /// Load of the films \[N/m\] at `hdot` \[m/s\] and its derivative \[N s/m²\].
    ///
    /// # Errors
    /// What the film refuses.
    fn film_load(&mut self, hdot: f64) -> Result<(f64, f64), EvalError>;
    /// The velocity \[m/s\] at which the film of the only face carries `load` \[N/m\], and its forces there.
    ///
    /// # Errors
    /// What the film refuses.
    fn carry(&mut self, load: f64) -> Result<(f64, FaceForces), EvalError>;
    /// Flux at the lower end of each face's film \[m²/s\], as of the last film.
    fn flux(&mut self) -> &mut [f64; 2];
}

/// The same for a ring whose film may be tried at other thicknesses, all else as it is. What contact carries is known from the first trial on.
pub trait RadialTrials: RadialLoads {
    /// Sets the film thickness \[m\], and the loads of contact and gas that go with it.
    ///
    /// # Errors
    /// What the film refuses.
    fn set_thickness(&mut self, h: f64) -> Result<(), EvalError>;
}

/// What limits did to a ring at an instant.
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct Limited {
    /// Load on the least film or on the floor of a contact model \[N/m\].
    pub floor: f64,
    /// Load that the drag took \[N/m\].
    pub drag: f64,
    /// Load that the drag of surfaces in contact took \[N/m\].
    pub contact_drag: f64,
    /// Part of the velocity that the cap took.
    pub slowed: f64,
    /// Load that the film is given beyond what it has to carry \[N/m\].
    pub lifted: f64,
    /// Load that the upper end of a search interval took \[N/m\].
    pub thickest: f64,
}

/// How a ring moves off the liner or towards it.
#[derive(Debug, Clone, Copy, Default)]
#[non_exhaustive]
pub struct RadialResponse {
    /// Rate of the film thickness \[m/s\].
    pub hdot: f64,
    /// Film at that rate, where it came with it.
    pub film: Option<FaceForces>,
    /// What limits did.
    pub limited: Limited,
}

impl RadialResponse {
    /// A rate \[m/s\], its film, what limits did.
    #[inline]
    #[must_use]
    pub const fn new(hdot: f64, film: Option<FaceForces>, limited: Limited) -> Self {
        Self { hdot, film, limited }
    }
}

/// A running model of the radial motion of one ring. Its states are its own; rates are by crank angle \[1/rad\].
pub trait RadialMotion: Stateful + Send {
    /// Film thickness \[m\] for the states.
    fn thickness(&self, y: &[f64]) -> f64;

    /// Rates `dy` of the states `y`, and the motion.
    ///
    /// # Errors
    /// No motion at which the forces balance.
    fn rates(
        &mut self,
        y: &[f64],
        loads: &mut dyn RadialLoads,
        dy: &mut [f64],
    ) -> Result<RadialResponse, EvalError>;

    /// Whether [`RadialMotion::stage`] finds the states of the model.
    fn solves_stages(&self) -> bool {
        false
    }

    /// Solves a stage of an implicit step for the states `y`, which come as a guess. The motion at the answer, with its film; `loads` is left there.
    ///
    /// # Errors
    /// No states at which the stage closes; a model that does not solve stages.
    fn stage(
        &mut self,
        _stage: &Stage<'_>,
        _y: &mut [f64],
        _loads: &mut dyn RadialTrials,
    ) -> Result<(RadialResponse, FaceForces), EvalError> {
        Err(EvalError::fatal("radial_motion", "the model does not solve stages of implicit steps"))
    }

    /// A trial of a stage: what the states `y` lack in it goes into `r`, in units of the states. The motion there, with its film; none where a limit acts, of which
    /// [`RadialMotion::stage`] alone knows, and of models that do not answer this way.
    ///
    /// # Errors
    /// What the film refuses.
    fn try_stage(
        &mut self,
        _stage: &Stage<'_>,
        _y: &[f64],
        _loads: &mut dyn RadialTrials,
        _r: &mut [f64],
    ) -> Result<Option<(RadialResponse, FaceForces)>, EvalError> {
        Ok(None)
    }

    /// Until [`RadialMotion::end_differences`], rates are asked for states and loads that differ by little from the last instant, whose loads and
    /// film are given and where `on_floor` says whether a floor carried anything: what is searched for may be found by one step of Newton's
    /// method from there.
    ///
    /// # Errors
    /// What the film refuses.
    fn begin_differences(
        &mut self,
        _loads: &mut dyn RadialLoads,
        _film: &FaceForces,
        _on_floor: bool,
    ) -> Result<(), EvalError> {
        Ok(())
    }

    /// Ends what [`RadialMotion::begin_differences`] began.
    fn end_differences(&mut self) {}
}
