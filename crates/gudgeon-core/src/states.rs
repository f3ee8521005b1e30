//! States of running models: what a model integrates, how its error is judged, and what depends on it.
//!
//! A running model that owns states implements [`Stateful`]; one that has none writes `impl Stateful for X {}`. The scene lays the states of all
//! its models out in one vector, hands every model its own part of it, derives from [`StateInfo::changes`] and [`Stateful::reads`] which rates
//! a state can change, and records. It has no branch for a particular model.
//!
//! Rates are by the independent variable of the scene: by crank angle \[1/rad\] in a ring pack.
//!
//! # Modes
//! A model may leave a state out of the integration while it follows from a balance, and take it in again at an event: the model says where
//! ([`Stateful::event`]), the integrator finds the place and calls [`Stateful::switch`]. A ring that the oil on a flank holds is the first case.
//!
//! # Memory
//! What an evaluation depends on beside the states is *memory*: the mode, a seat that was decided, oil that was booked. [`Stateful::save`] and
//! [`Stateful::restore`] keep it, so that an instant of a finished cycle can be evaluated again.

use std::ops::{BitOr, BitOrAssign};

pub use gudgeon_numerics::ode::Stage;

/// Quantities that couple the models of a ring at an instant: a set of them says what a state changes and what a model reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Signals(u16);

impl Signals {
    /// Nothing.
    pub const NONE: Self = Self(0);
    /// Axial height of the ring in its groove.
    pub const LIFT: Self = Self(1);
    /// Its axial velocity.
    pub const AXIAL_VELOCITY: Self = Self(2);
    /// Twist of the section.
    pub const TWIST: Self = Self(4);
    /// Film thickness under the face.
    pub const FILM_THICKNESS: Self = Self(8);
    /// Extent of the film along the face.
    pub const EXTENT: Self = Self(16);
    /// Temperature of the film.
    pub const TEMPERATURE: Self = Self(32);
    /// Gas pressures above, below and behind the ring.
    pub const PRESSURE: Self = Self(64);
    /// Forces, friction and fluxes of the film, and the rate of its thickness.
    pub const FILM_FORCE: Self = Self(128);
    /// Velocity of the film thickness, where it is a state.
    pub const RADIAL_VELOCITY: Self = Self(256);
    /// Oil on the flanks.
    pub const FLANK_OIL: Self = Self(512);

    /// Whether both have something in common.
    #[inline]
    #[must_use]
    pub const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Both together.
    #[inline]
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOr for Signals {
    type Output = Self;
    #[inline]
    fn bitor(self, other: Self) -> Self {
        self.with(other)
    }
}

impl BitOrAssign for Signals {
    #[inline]
    fn bitor_assign(&mut self, other: Self) {
        *self = self.with(other);
    }
}

/// One state of a running model.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct StateInfo {
    /// Name for people: `lift of ring1`.
    pub name: String,
    /// Unit of the value in the state vector; `1` when it is scaled.
    pub unit: &'static str,
    /// Value that counts as one in the error of a step: errors are admitted up to `tolerance × scale`, and for relative states up to
    /// `tolerance × |value|` beside it.
    pub scale: f64,
    /// Whether the error of a step is judged relative to the value too.
    pub relative: bool,
    /// Value that counts as one in the distance between the start and the end of a cycle.
    pub cycle_scale: f64,
    /// Whether that distance is judged relative to values above `cycle_scale`.
    pub cycle_relative: bool,
    /// Minimum value with which a cycle may start.
    pub cycle_min: f64,
    /// Range in which a cycle starts that was not reached by one before: the search of the periodic state extrapolates no further, unless the state itself
    /// was beyond.
    pub cycle_range: (f64, f64),
    /// What a change of the state changes at once.
    pub changes: Signals,
}

impl StateInfo {
    /// A state of a name that is of the order of one, judged relative to its value, and changes nothing but the rates of its own model.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: "1",
            scale: 1.0,
            relative: true,
            cycle_scale: 1.0,
            cycle_relative: false,
            cycle_min: f64::NEG_INFINITY,
            cycle_range: (f64::NEG_INFINITY, f64::INFINITY),
            changes: Signals::NONE,
        }
    }

    /// Sets the unit.
    #[must_use]
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// Judges the error of a step by `tolerance × (scale + |value|)`.
    #[must_use]
    pub const fn relative(mut self, scale: f64) -> Self {
        (self.scale, self.relative) = (scale, true);
        self
    }

    /// Judges the error of a step by `tolerance × scale` alone.
    #[must_use]
    pub const fn absolute(mut self, scale: f64) -> Self {
        (self.scale, self.relative) = (scale, false);
        self
    }

    /// Judges the distance between the ends of a cycle by `scale`, or by the value where `relative` and that is larger.
    #[must_use]
    pub const fn over_cycle(mut self, scale: f64, relative: bool) -> Self {
        (self.cycle_scale, self.cycle_relative) = (scale, relative);
        self
    }

    /// A cycle starts with at least this value.
    #[must_use]
    pub const fn at_least(mut self, min: f64) -> Self {
        self.cycle_min = min;
        self
    }

    /// The search of the periodic state extrapolates to no value outside.
    #[must_use]
    pub const fn within(mut self, least: f64, largest: f64) -> Self {
        self.cycle_range = (least, largest);
        self
    }

    /// What a change of the state changes at once.
    #[must_use]
    pub const fn changes(mut self, changes: Signals) -> Self {
        self.changes = changes;
        self
    }
}

/// The states of a running model, its modes and its memory. Every part has a default: a model without states needs none of it.
///
/// *The last instant* is the one for which the rates of the model were asked last: a model keeps what it needs to answer about it.
pub trait Stateful {
    /// The states, in the order in which they stand in the part of the state vector that belongs to the model.
    fn states(&self) -> &[StateInfo] {
        &[]
    }

    /// What the rates of the model depend on, beside its own states and the crank angle.
    fn reads(&self) -> Signals {
        Signals::NONE
    }

    /// States with which the first cycle starts.
    fn initial(&mut self, y: &mut [f64]) {
        y.fill(0.0);
    }

    /// Relative accuracy of the integration that follows; a model may leave out what does not matter at that accuracy. 0: nothing is left out.
    fn set_accuracy(&mut self, _tolerance: f64) {}

    /// Multiplies the admitted absolute errors `atol` of the states by factors of at least one that follow from the last instant.
    fn ease(&self, _atol: &mut [f64]) {}

    /// Whether state `k` is integrated in the present mode; one that is not follows from a balance, has the rate zero and changes nothing.
    fn is_integrated(&self, _k: usize) -> bool {
        true
    }

    /// Whether state `k` at the instant of the last [`Stateful::start`] follows the others within a fraction of a degree: what a cycle starts with then
    /// does not count between cycles.
    fn follows_at_once(&self, _k: usize) -> bool {
        false
    }

    /// Number of event functions.
    fn n_events(&self) -> usize {
        0
    }

    /// Event function `k` at the last instant: the model wants to change its mode where it goes through zero from below.
    fn event(&self, _k: usize) -> f64 {
        -1.0
    }

    /// Whether the place of event `k` has to be found; otherwise the mode may change any time after it.
    fn event_is_located(&self, _k: usize) -> bool {
        true
    }

    /// Changes the mode at event `k` of the last instant; `y` are the states, which may jump.
    fn switch(&mut self, _k: usize, _y: &mut [f64]) {}

    /// Leaves every mode that leaves something out.
    fn free(&mut self) {}

    /// Chooses the modes with which a cycle starts from the last instant, which was evaluated after [`Stateful::free`]: a function of the state alone.
    fn start(&mut self, _y: &mut [f64]) {}

    /// Crank angle \[rad\] between decisions, for a model that decides something in steps and holds it in between.
    fn decision_interval(&self) -> Option<f64> {
        None
    }

    /// What was decided last: part of the periodic state.
    fn decided(&self) -> &[f64] {
        &[]
    }

    /// Appends the memory to `out`: always the same number of values.
    fn save(&self, _out: &mut Vec<f64>) {}

    /// Takes the memory from the front of `saved`; the number of values that were taken.
    fn restore(&mut self, _saved: &[f64]) -> usize {
        0
    }

    /// Names, units and meanings of the columns that the model adds to the series.
    fn columns(&self) -> Vec<ColumnInfo> {
        Vec::new()
    }

    /// Values of these columns at the last instant, whose states are `y`.
    fn record(&self, _y: &[f64], _row: &mut Vec<f64>) {}
}

/// A column that a model adds to the series.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ColumnInfo {
    /// Name behind that of the part it belongs to: `twist` becomes `ring1.twist`.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
}

impl ColumnInfo {
    /// A column.
    #[must_use]
    pub fn new(name: impl Into<String>, unit: &'static str) -> Self {
        Self { name: name.into(), unit }
    }
}
