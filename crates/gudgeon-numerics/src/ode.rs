//! Stiff initial-value problems `y' = f(t, y)`, `q' = g(t, y)` with fallible right-hand sides, breakpoints, directed events
//! and dense output: what every integrator of this crate shares.
//!
//! # Error control
//! The norm is the largest component of `|error_i| / (atol_i + rtol max(|y_i| before, |y_i| after))`, not a root mean square: a
//! component that does not matter can then never loosen the control of one that does.
//!
//! # Kinks
//! A right-hand side may jump or have a kink at the breakpoints. Steps end exactly there, and no step of one side evaluates the
//! other: times within 8 machine epsilons (times `|t|`) of a breakpoint are moved that far inside the interval before they reach
//! the right-hand side.
//!
//! # Linear invariants
//! When `c·(f, g) = 0` for all arguments, the methods keep `c·(y, q)` constant to rounding, provided the Jacobian satisfies the
//! same relation. Finite differences do so only to (rounding of f) / increment; [`OdeSystem::invariants`] names the relations,
//! and one row of the Jacobian is then rewritten by each of them. The solution itself is never touched, so the closure of
//! the balance remains an honest check.
//!
//! # Events
//! Each event function has a *side*, the sign it was last known to have; a crossing is a change of side, and the direction
//! decides whether it counts. Functions are looked at on the dense output of every accepted step, at its ends and at
//! [`Options::event_samples`] points between, and roots are located to the resolution of `t`. After an event that changed the state
//! the function is zero but for rounding and its side unknown until it leaves a band of that width; the step that follows is
//! sampled geometrically from its start, so that a flight much shorter than the step is still seen. Nothing depends on
//! waiting times.

use crate::EvalError;

mod driver;
mod events;

pub(crate) use driver::{Core, Scheme, Trial, drive};

/// Columns of the Jacobian that one difference quotient can serve together: no row depends on two columns of a group.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ColumnGroups {
    /// Groups of columns.
    pub groups: Vec<Vec<usize>>,
    /// For every column the rows (states, then quadratures) it may touch.
    pub rows: Vec<Vec<usize>>,
}

impl ColumnGroups {
    /// Groups the columns greedily, in order, given the rows that each column may touch.
    ///
    /// Greedy colouring is optimal for banded patterns in their natural order.
    #[must_use]
    pub fn from_pattern(rows: Vec<Vec<usize>>) -> Self {
        let n_rows = rows.iter().flatten().max().map_or(0, |r| r + 1);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut taken: Vec<Vec<bool>> = Vec::new();
        for (column, touched) in rows.iter().enumerate() {
            let free = taken.iter().position(|t| touched.iter().all(|&r| !t[r]));
            let g = free.unwrap_or_else(|| {
                groups.push(Vec::new());
                taken.push(vec![false; n_rows]);
                groups.len() - 1
            });
            groups[g].push(column);
            for &r in touched {
                taken[g][r] = true;
            }
        }
        Self { groups, rows }
    }
}

/// `Σ coefficient · (f, g)[row] = 0` for all times and states.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearInvariant {
    /// The row of the Jacobian that is rewritten by the relation; preferably a quadrature (row ≥ `dim`), which leaves the
    /// linear systems untouched. It must be one of `terms`.
    pub pivot: usize,
    /// Rows and their coefficients; rows ≥ `dim` are quadratures.
    pub terms: Vec<(usize, f64)>,
}

/// Which sign changes of an event function count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
    /// Both.
    Either,
}

/// What an event asks of the integrator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventAction {
    /// Nothing: the event was only noted. Changes to `y` are dropped.
    Continue,
    /// The state or the equations changed: the step ends here and integration goes on from the new state.
    ///
    /// When `y` was changed and the function then leaves zero on the far side without having come back (a ball that is
    /// pushed into the floor), the event happens again; 100 such repeats without progress in time are [`IntegrateError::Chatter`].
    Restart,
    /// The integration ends here, successfully. Changes to `y` are kept.
    Stop,
}

/// An initial-value problem `y' = f(t, y)` with quadratures `q' = g(t, y)` that feed nothing back.
pub trait OdeSystem {
    /// Number of states.
    fn dim(&self) -> usize;

    /// Number of quadratures. They are integrated with the same method, so that every linear invariant over states and
    /// quadratures holds to round-off (see [`OdeSystem::invariants`]).
    fn quad_dim(&self) -> usize {
        0
    }

    /// Rates: `f[..dim]` of the states, `f[dim..]` of the quadratures.
    ///
    /// # Errors
    /// Recoverable: the integrator retries with a smaller step. Fatal: it stops. A rate that is not finite counts as
    /// recoverable.
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError>;

    /// Jacobian `∂f/∂y`, row-major `(dim + quad_dim) × dim`; `f` holds the rates at `(t, y)`. `Ok(false)`: the integrator
    /// differences `rhs`.
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn jacobian(&mut self, _t: f64, _y: &[f64], _f: &[f64], _jac: &mut [f64]) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// Takes the Jacobian at `(t, y)`, rates `f`, for [`OdeSystem::factor`]: for systems whose equations have a structure that no general
    /// matrix knows (a chain, a tree). Asked by `Rodas::structured` instead of [`OdeSystem::jacobian`].
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn linearise(&mut self, _t: f64, _y: &[f64], _f: &[f64]) -> Result<(), EvalError> {
        Err(EvalError::fatal("integrator", "the system has no linear solver of its own"))
    }

    /// Prepares [`OdeSystem::solve`] for `d I - J`; false when that is singular.
    fn factor(&mut self, _d: f64) -> bool {
        false
    }

    /// Solves `(d I - J) x = b` in place, with `d` and `J` of the last [`OdeSystem::factor`].
    fn solve(&mut self, _b: &mut [f64]) {}

    /// `∂f/∂t` at fixed state. `Ok(false)`: the integrator differences `rhs` (one call per step).
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn time_derivative(
        &mut self,
        _t: f64,
        _y: &[f64],
        _f: &[f64],
        _dfdt: &mut [f64],
    ) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// Absolute errors per step at the state where a step begins, for systems whose accuracy depends on where they are (a
    /// position beside a wall): `atol` comes as [`Options::atol`] and may be changed. Taken by `Rodas`.
    fn tolerances(&mut self, _t: f64, _y: &[f64], _atol: &mut [f64]) {}

    /// Linear relations between the rates that hold for all arguments (see the module documentation).
    fn invariants(&self) -> &[LinearInvariant] {
        &[]
    }

    /// Number of event functions.
    fn n_events(&self) -> usize {
        0
    }

    /// Values of the event functions; an event happens where one goes through zero in its direction.
    ///
    /// # Errors
    /// Any error ends the integration.
    fn events(&mut self, _t: f64, _y: &[f64], _g: &mut [f64]) -> Result<(), EvalError> {
        Ok(())
    }

    /// Which crossings of event function `k` count.
    fn event_direction(&self, _k: usize) -> Direction {
        Direction::Either
    }

    /// Whether the time of event `k` matters. When it does not, the event happens at the end of the step (or at the sample) in
    /// which it was seen, and nothing is spent on its root.
    fn event_located(&self, _k: usize) -> bool {
        true
    }

    /// Event `k` happened at `t`. Changes to `y` count when the answer is [`EventAction::Restart`] or [`EventAction::Stop`].
    ///
    /// # Errors
    /// Any error ends the integration.
    fn on_event(&mut self, _k: usize, _t: f64, _y: &mut [f64]) -> Result<EventAction, EvalError> {
        Ok(EventAction::Continue)
    }
}

/// Accuracy and limits of an integration.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Relative error per step.
    pub rtol: f64,
    /// Absolute error per step, one per state.
    pub atol: Vec<f64>,
    /// States whose value says nothing about the accuracy they need (a position, whose origin is arbitrary): for them
    /// `atol` alone counts. One per state; empty: none.
    pub absolute: Vec<bool>,
    /// Absolute error per step, one per quadrature; empty: quadratures take no part in the error control.
    pub atol_quad: Vec<f64>,
    /// First step; 0 lets the integrator choose.
    pub h_init: f64,
    /// Largest step.
    pub h_max: f64,
    /// Smallest step.
    pub h_min: f64,
    /// Most steps, rejected ones included.
    pub max_steps: u64,
    /// Points inside each step at which event functions are looked at, beside its ends.
    pub event_samples: u32,
}

impl Options {
    /// Whether `atol` alone counts for state or quadrature `i`.
    pub(crate) fn is_absolute(&self, i: usize) -> bool {
        self.absolute.get(i).copied().unwrap_or(false)
    }

    /// Relative error of state or quadrature `i`.
    pub(crate) fn relative(&self, i: usize) -> f64 {
        if self.is_absolute(i) { 0.0 } else { self.rtol }
    }

    /// Relative tolerance `rtol`, absolute `rtol * scale`; quadratures outside the error control.
    #[must_use]
    pub fn new(rtol: f64, scale: &[f64]) -> Self {
        Self {
            rtol,
            atol: scale.iter().map(|s| s * rtol).collect(),
            absolute: Vec::new(),
            atol_quad: Vec::new(),
            h_init: 0.0,
            h_max: f64::INFINITY,
            h_min: 0.0,
            max_steps: 2_000_000,
            event_samples: 3,
        }
    }
}

/// Work of an integration.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Stats {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Right-hand sides, those for Jacobians included.
    pub rhs: u64,
    /// Jacobians.
    pub jacobians: u64,
    /// Factorisations.
    pub lu: u64,
    /// Triangular solves.
    pub solves: u64,
    /// Events that happened.
    pub events: u64,
}

impl Stats {
    /// Adds the work of another integration.
    pub fn add(&mut self, o: &Self) {
        self.steps += o.steps;
        self.rejected += o.rejected;
        self.rhs += o.rhs;
        self.jacobians += o.jacobians;
        self.lu += o.lu;
        self.solves += o.solves;
        self.events += o.events;
    }
}

/// Why an integration ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntegrateError {
    /// The right-hand side refused.
    #[error("at {t}: {source}")]
    Eval {
        /// Where.
        t: f64,
        /// What it said.
        source: EvalError,
    },
    /// The step would have to be smaller than allowed.
    #[error("at {t} the step would have to be smaller than {h:e}{}", .last.as_ref().map(|e| format!(" ({e})")).unwrap_or_default())]
    StepTooSmall {
        /// Where.
        t: f64,
        /// The step.
        h: f64,
        /// The last refusal of the right-hand side, when that was the cause.
        last: Option<EvalError>,
    },
    /// More steps than allowed.
    #[error("more than {max} steps, stopped at {t}")]
    TooManySteps {
        /// Where.
        t: f64,
        /// The limit.
        max: u64,
    },
    /// The rates are not finite at an accepted state, or for any step from it.
    #[error("at {t} the rates are not finite")]
    NonFinite {
        /// Where.
        t: f64,
    },
    /// An event restarts the integration again and again without progress in time.
    #[error("at {t} event {event} repeats without progress")]
    Chatter {
        /// Where.
        t: f64,
        /// Which event function.
        event: usize,
    },
    /// Options or array lengths that contradict the system.
    #[error("{what}")]
    Input {
        /// What is wrong.
        what: &'static str,
    },
}

/// An accepted step (or a piece of one between two events) with its dense output.
pub trait StepView {
    /// Start of the step.
    fn t0(&self) -> f64;
    /// End of the step.
    fn t1(&self) -> f64;
    /// State at the start.
    fn y0(&self) -> &[f64];
    /// State at the end, before an event changes it.
    fn y1(&self) -> &[f64];
    /// State at `t` inside the step.
    fn interpolate(&self, t: f64, y: &mut [f64]);
    /// Quadratures at the start; empty when there are none.
    fn q0(&self) -> &[f64] {
        &[]
    }
    /// Quadratures at the end; empty when there are none.
    fn q1(&self) -> &[f64] {
        &[]
    }
    /// Quadratures at `t` inside the step, as accurate as the states; the default joins the ends by a straight line.
    fn interpolate_quad(&self, t: f64, q: &mut [f64]) {
        let x = (t - self.t0()) / (self.t1() - self.t0());
        for ((q, a), b) in q.iter_mut().zip(self.q0()).zip(self.q1()) {
            *q = a + x * (b - a);
        }
    }
}

/// Whether to go on after a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop here.
    Stop,
}

/// An integrator with its work arrays.
pub trait Integrator<S: OdeSystem + ?Sized> {
    /// Integrates from `t0` to `t1`, stopping exactly at every one of `breakpoints` (ascending) where the right-hand side has a
    /// kink, and calls `observer` after every accepted step. `y` and `q` are advanced in place. Returns the last step size
    /// that was not cut by an end, a good first step for what follows.
    ///
    /// # Errors
    /// [`IntegrateError`]; `y` and `q` then hold the last accepted state.
    #[allow(
        clippy::too_many_arguments,
        reason = "an interval, a state, its quadratures and the settings belong together"
    )]
    fn integrate(
        &mut self,
        sys: &mut S,
        interval: (f64, f64),
        breakpoints: &[f64],
        y: &mut [f64],
        q: &mut [f64],
        options: &Options,
        stats: &mut Stats,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
    ) -> Result<f64, IntegrateError>;

    /// [`Integrator::integrate`] of a system without quadratures, without breakpoints and without an observer. Returns the work.
    ///
    /// # Errors
    /// [`IntegrateError`]; `y` then holds the last accepted state.
    fn solve(
        &mut self,
        sys: &mut S,
        interval: (f64, f64),
        y: &mut [f64],
        options: &Options,
    ) -> Result<Stats, IntegrateError> {
        let mut stats = Stats::default();
        self.integrate(sys, interval, &[], y, &mut [], options, &mut stats, &mut |_, _| Flow::Continue)?;
        Ok(stats)
    }
}

/// Increment for a difference quotient in state `y` of absolute tolerance `atol` at relative tolerance `rtol`.
pub(crate) fn increment(y: f64, atol: f64, rtol: f64) -> f64 {
    // What is noise in y (atol / rtol) bounds its magnitude from below; a thousandth of it leaves room for a cautious atol.
    let scale = y.abs().max(atol / rtol.max(1e-12) * 1e-3).max(1e-30);
    let d = 1.5e-8 * scale;
    // The difference that is actually applied, free of rounding.
    (y + d) - y
}

/// Jacobian by differences, in groups where these are given, made to satisfy the system's invariants. `moved` has room for
/// one `y`, `work` for one `f`. A perturbed state that is refused is tried on its other side.
#[allow(clippy::too_many_arguments, reason = "scratch is passed in so that nothing is allocated")]
pub(crate) fn difference<S: OdeSystem + ?Sized>(
    sys: &mut S,
    groups: Option<&ColumnGroups>,
    t: f64,
    y: &[f64],
    f: &[f64],
    options: &Options,
    jac: &mut [f64],
    work: &mut [f64],
    moved: &mut [f64],
    stats: &mut Stats,
) -> Result<(), EvalError> {
    let n = y.len();
    // Towards where the solution goes: that side is more likely to be admissible.
    let step = |j: usize| {
        let d = increment(y[j], options.atol[j], options.rtol);
        if f[j] < 0.0 { (y[j] - d) - y[j] } else { d }
    };
    moved.copy_from_slice(y);
    jac.fill(0.0);
    let count = groups.map_or(n, |c| c.groups.len());
    for g in 0..count {
        let single = [g];
        let columns: &[usize] = groups.map_or(&single, |c| &c.groups[g]);
        let mut side = 1.0;
        loop {
            for &j in columns {
                moved[j] = y[j] + side * step(j);
            }
            stats.rhs += 1;
            let refusal = match sys.rhs(t, moved, work) {
                Ok(()) if all_finite(work) => None,
                Ok(()) => Some(EvalError::recoverable("difference", "a perturbed rate is not finite")),
                Err(e) if e.is_recoverable() => Some(e),
                Err(e) => return Err(e),
            };
            match refusal {
                None => break,
                Some(e) if side < 0.0 => return Err(e),
                Some(_) => side = -1.0,
            }
        }
        for &j in columns {
            // The increment that was made, after its own rounding.
            let d = moved[j] - y[j];
            moved[j] = y[j];
            match groups {
                None => {
                    for (i, (w, f)) in work.iter().zip(f).enumerate() {
                        jac[i * n + j] = (w - f) / d;
                    }
                }
                Some(c) => {
                    for &i in &c.rows[j] {
                        jac[i * n + j] = (work[i] - f[i]) / d;
                    }
                }
            }
        }
    }
    for inv in sys.invariants() {
        for j in 0..n {
            jac[inv.pivot * n + j] = inv.pivot_value(|row| jac[row * n + j]);
        }
    }
    Ok(())
}

impl LinearInvariant {
    /// The value of the pivot row that satisfies the relation, given the other rows.
    pub(crate) fn pivot_value(&self, value: impl Fn(usize) -> f64) -> f64 {
        let (mut sum, mut pivot) = (0.0, 0.0);
        for &(row, c) in &self.terms {
            if row == self.pivot {
                pivot += c;
            } else {
                sum += c * value(row);
            }
        }
        -sum / pivot
    }
}

/// Whether no entry is NaN or infinite. A sum of zeros times the entries: one pass without branches.
pub(crate) fn all_finite(v: &[f64]) -> bool {
    v.iter().map(|v| v * 0.0).sum::<f64>() == 0.0
}
