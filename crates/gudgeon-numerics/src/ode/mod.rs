//! Stiff initial-value problems `y' = f(t, y)`, `q' = g(t, y)` with fallible right-hand sides, breakpoints, directed events
//! and dense output.
//!
//! Two one-step methods share one interface: [`Rodas`] (linearly implicit, order 5, no Newton iteration; the default at
//! relative tolerances of 1e-2 to 1e-6) and [`crate::radau::Radau5`] (fully implicit, order 5, for tight tolerances and
//! reference runs).
//!
//! # Error control
//! The norm is the largest component of `|error_i| / (atol_i + rtol * max(|y_i| before, |y_i| after))`, not a root mean square: a
//! component that does not matter can then never loosen the control of one that does.
//!
//! # Kinks
//! A right-hand side may jump or have a kink at the times listed in [`Options::breakpoints`]. Steps end exactly there, and
//! no step of one side evaluates the other: times within 8 units in the last place of a breakpoint are moved that far
//! inside the interval before they reach the right-hand side.
//!
//! # Linear invariants
//! When `c·(f, g) = 0` for all arguments, the methods keep `c·(y, q)` constant to rounding, provided the Jacobian satisfies the same
//! relation. Finite differences do so only to about 1e-8; [`OdeSystem::invariants`] names the relations, and the
//! integrator rewrites one row of the Jacobian by each of them. It never touches the solution itself, so the closure of
//! the balance remains an honest check.

mod driver;
mod events;
mod jacobian;
mod rodas;

pub use jacobian::ColumnGroups;
pub use rodas::Rodas;

pub use crate::radau::Radau5;
use gudgeon_core::EvalError;

/// A system of ordinary differential equations with quadratures and events.
pub trait OdeSystem {
    /// Number of states.
    fn dim(&self) -> usize;

    /// Number of quadratures: integrals of functions of time and state that nothing feeds back on. They are integrated by the
    /// same method, and cost a matrix-vector product instead of a larger factorisation.
    fn quad_dim(&self) -> usize {
        0
    }

    /// Rates of the states, then of the quadratures: `f` has `dim + quad_dim` entries, `y` has `dim`.
    ///
    /// # Errors
    /// [`EvalError::Recoverable`] when these arguments have no answer but nearer ones may (the step is repeated smaller);
    /// [`EvalError::Fatal`] when nothing helps. A non-finite rate counts as recoverable.
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError>;

    /// The Jacobian `∂f/∂y`, row-major with `dim + quad_dim` rows and `dim` columns, and `∂f/∂t`. `f` holds the rates at
    /// `(t, y)`; both outputs come zeroed. `Ok(false)` leaves the work to finite differences.
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        f: &[f64],
        jac: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<bool, EvalError> {
        let _ = (t, y, f, jac, dfdt);
        Ok(false)
    }

    /// Columns that finite differences may perturb together. `None`: a dense Jacobian, column by column.
    fn column_groups(&self) -> Option<&ColumnGroups> {
        None
    }

    /// Whether `f` does not depend on `t`: saves the differences in time.
    fn is_autonomous(&self) -> bool {
        false
    }

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
    fn events(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        let _ = (t, y, g);
        Ok(())
    }

    /// Which crossings of event function `k` count.
    fn event_direction(&self, k: usize) -> Direction {
        let _ = k;
        Direction::Either
    }

    /// Event `k` happened at `t`. `y` may be changed when the answer is [`EventAction::Restart`].
    ///
    /// # Errors
    /// Any error ends the integration.
    fn on_event(&mut self, k: usize, t: f64, y: &mut [f64]) -> Result<EventAction, EvalError> {
        let _ = (k, t, y);
        Ok(EventAction::Continue)
    }
}

/// `Σ coefficient · (f, g)[row] = 0` for all times and states.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearInvariant {
    /// The row of the Jacobian that is rewritten by the relation; preferably a quadrature (row ≥ `dim`), which leaves
    /// the linear systems untouched. It must be one of `terms`.
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
    /// The event is armed again once its function has left a band of rounding width around zero. When `y` was changed and the
    /// function then leaves the band on the far side without having come back (a ball that is pushed into the floor), the
    /// event happens again; 100 such repeats without progress in time are [`IntegrateError::Chatter`].
    Restart,
    /// The integration ends here, successfully.
    Stop,
}

/// Settings of one call of an integrator.
#[derive(Debug, Clone, Copy)]
pub struct Options<'a> {
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance per state, or one for all.
    pub atol: &'a [f64],
    /// Absolute tolerance per quadrature, or one for all; empty: quadratures do not take part in the error control.
    pub atol_quad: &'a [f64],
    /// Magnitude per state for finite-difference increments (used where `|y|` is smaller); empty: `atol / rtol`.
    pub typical: &'a [f64],
    /// First step; 0: found from the solution's first and second derivative. Hand over [`Outcome::last_step`] of a previous call.
    pub h_init: f64,
    /// Largest step; 0: none.
    pub h_max: f64,
    /// Smallest step; 0: what `t` can resolve.
    pub h_min: f64,
    /// Steps (accepted and rejected) of one call.
    pub max_steps: usize,
    /// Times, ascending, where the right-hand side jumps or has a kink. Those outside the interval are ignored.
    pub breakpoints: &'a [f64],
    /// Points inside each step at which event functions are looked at, beside its ends: finds a function that goes through
    /// zero and back within a step.
    pub event_samples: usize,
}

impl<'a> Options<'a> {
    /// Options with these tolerances; quadratures outside the error control, no breakpoints.
    #[must_use]
    pub const fn new(rtol: f64, atol: &'a [f64]) -> Self {
        Self {
            rtol,
            atol,
            atol_quad: &[],
            typical: &[],
            h_init: 0.0,
            h_max: 0.0,
            h_min: 0.0,
            max_steps: 1_000_000,
            breakpoints: &[],
            event_samples: 3,
        }
    }
}

/// What an integration cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stats {
    /// Accepted steps.
    pub steps: usize,
    /// Steps repeated because of their error, a failed evaluation, or a Newton iteration that did not converge.
    pub rejected: usize,
    /// Right-hand sides, those of finite differences included.
    pub rhs: usize,
    /// Jacobians, analytic or by differences.
    pub jacobians: usize,
    /// Factorisations (a real and a complex one of the same matrix pencil count as one).
    pub lu: usize,
    /// Solutions of linear systems with a factorised matrix.
    pub solves: usize,
    /// Events that happened.
    pub events: usize,
}

impl std::ops::AddAssign for Stats {
    fn add_assign(&mut self, o: Self) {
        self.steps += o.steps;
        self.rejected += o.rejected;
        self.rhs += o.rhs;
        self.jacobians += o.jacobians;
        self.lu += o.lu;
        self.solves += o.solves;
        self.events += o.events;
    }
}

/// How an integration ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At the end of the interval.
    Reached,
    /// At an event that answered [`EventAction::Stop`].
    Stopped {
        /// Which.
        event: usize,
    },
}

/// A successful integration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Where it ended.
    pub t: f64,
    /// Why.
    pub end: End,
    /// The step size that the error control would use next: the `h_init` of a continuation.
    pub last_step: f64,
    /// What it cost.
    pub stats: Stats,
}

/// An integration that failed. `y` and `q` hold the last accepted state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntegrateError {
    /// The right-hand side, the Jacobian, an event or an observer failed for good.
    #[error("at t = {t}: {source}")]
    Eval {
        /// Start of the step.
        t: f64,
        /// What the model said.
        source: EvalError,
    },
    /// The step size fell below what `h_min` or the resolution of `t` allows.
    #[error("at t = {t}: step size {h} is too small")]
    StepTooSmall {
        /// Start of the step.
        t: f64,
        /// The step that would be next.
        h: f64,
        /// The evaluation failure that forced it down, if that was the cause.
        #[source]
        cause: Option<EvalError>,
    },
    /// `max_steps` was reached.
    #[error("at t = {t}: too many steps")]
    TooManySteps {
        /// Start of the step.
        t: f64,
    },
    /// The right-hand side is not finite at an accepted state, or stays so for any step.
    #[error("at t = {t}: the right-hand side is not finite")]
    NonFinite {
        /// Start of the step.
        t: f64,
    },
    /// An event restarts the integration again and again without progress in time.
    #[error("at t = {t}: event {event} repeats without progress")]
    Chatter {
        /// Where.
        t: f64,
        /// Which.
        event: usize,
    },
    /// Options or array lengths that contradict the system.
    #[error("invalid integrator input: {what}")]
    Input {
        /// What is wrong.
        what: &'static str,
    },
}

/// Receives every accepted step (cut at events).
pub trait Observer<S: ?Sized> {
    /// One piece of the solution, from `view.t0` to `view.t1`.
    ///
    /// # Errors
    /// Any error ends the integration.
    fn step(&mut self, sys: &mut S, view: &StepView<'_>) -> Result<(), EvalError>;
}

/// Looks at nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoObserver;

impl<S: ?Sized> Observer<S> for NoObserver {
    fn step(&mut self, _: &mut S, _: &StepView<'_>) -> Result<(), EvalError> {
        Ok(())
    }
}

impl<S: ?Sized, F: FnMut(&mut S, &StepView<'_>) -> Result<(), EvalError>> Observer<S> for F {
    fn step(&mut self, sys: &mut S, view: &StepView<'_>) -> Result<(), EvalError> {
        self(sys, view)
    }
}

/// A piece of the solution with its dense output.
#[derive(Debug, Clone, Copy)]
pub struct StepView<'a> {
    /// Start.
    pub t0: f64,
    /// End.
    pub t1: f64,
    /// States at the start.
    pub y0: &'a [f64],
    /// States at the end (before an event changed them).
    pub y1: &'a [f64],
    /// Quadratures at the start.
    pub q0: &'a [f64],
    /// Quadratures at the end.
    pub q1: &'a [f64],
    pub(crate) dense: Dense<'a>,
}

impl StepView<'_> {
    /// States at `t` in `[t0, t1]`: order 4 ([`Rodas`]) or the collocation polynomial of degree 3 ([`Radau5`]).
    pub fn interpolate(&self, t: f64, y: &mut [f64]) {
        self.dense.eval(t, 0, y);
    }

    /// Quadratures at `t`.
    pub fn interpolate_quad(&self, t: f64, q: &mut [f64]) {
        self.dense.eval(t, self.y0.len(), q);
    }

    /// One state at `t`.
    #[must_use]
    pub fn interpolate_one(&self, t: f64, i: usize) -> f64 {
        let mut v = [0.0];
        self.dense.eval(t, i, &mut v);
        v[0]
    }
}

/// `x(θ) = (1-θ) x0 + θ (x1 + (1-θ)(c0 + θ (c1 + θ c2)))`, states first, then quadratures.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dense<'a> {
    pub t: f64,
    pub h: f64,
    pub x0: &'a [f64],
    pub x1: &'a [f64],
    pub c: [&'a [f64]; 3],
}

impl Dense<'_> {
    pub(crate) fn eval(&self, t: f64, from: usize, out: &mut [f64]) {
        let th = (t - self.t) / self.h;
        let om = 1.0 - th;
        let k = out.len();
        let r = from..from + k;
        let (x0, x1) = (&self.x0[r.clone()], &self.x1[r.clone()]);
        let (c0, c1, c2) = (&self.c[0][r.clone()], &self.c[1][r.clone()], &self.c[2][r]);
        for i in 0..k {
            // Written around x0 so that a constant stays that constant.
            out[i] = x0[i] + th * ((x1[i] - x0[i]) + om * (c0[i] + th * (c1[i] + th * c2[i])));
        }
    }
}

/// A method that integrates an [`OdeSystem`]; implemented by [`Rodas`], [`Radau5`] and the choice between them, [`AnyIntegrator`].
pub trait Integrator {
    /// Integrates from `t0` to `t1 >= t0`. `y` and `q` come with the initial values and leave with the final ones.
    ///
    /// # Errors
    /// [`IntegrateError`]; `y` and `q` then hold the last accepted state.
    fn integrate<S: OdeSystem + ?Sized, O: Observer<S> + ?Sized>(
        &mut self,
        sys: &mut S,
        t0: f64,
        t1: f64,
        y: &mut [f64],
        q: &mut [f64],
        opts: &Options<'_>,
        observer: &mut O,
    ) -> Result<Outcome, IntegrateError>;
}

/// The methods of this crate, to be chosen by value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Method {
    /// [`Rodas`].
    #[default]
    Rodas,
    /// [`Radau5`].
    Radau5,
}

/// An integrator whose method was chosen at run time.
#[derive(Debug, Clone)]
pub enum AnyIntegrator {
    /// [`Rodas`].
    Rodas(Box<Rodas>),
    /// [`Radau5`].
    Radau5(Box<Radau5>),
}

impl AnyIntegrator {
    /// The integrator for `method`, with work arrays for these dimensions.
    #[must_use]
    pub fn new(method: Method, dim: usize, quad_dim: usize) -> Self {
        match method {
            Method::Rodas => Self::Rodas(Box::new(Rodas::new(dim, quad_dim))),
            Method::Radau5 => Self::Radau5(Box::new(Radau5::new(dim, quad_dim))),
        }
    }
}

impl Integrator for AnyIntegrator {
    fn integrate<S: OdeSystem + ?Sized, O: Observer<S> + ?Sized>(
        &mut self,
        sys: &mut S,
        t0: f64,
        t1: f64,
        y: &mut [f64],
        q: &mut [f64],
        opts: &Options<'_>,
        observer: &mut O,
    ) -> Result<Outcome, IntegrateError> {
        match self {
            Self::Rodas(m) => m.integrate(sys, t0, t1, y, q, opts, observer),
            Self::Radau5(m) => m.integrate(sys, t0, t1, y, q, opts, observer),
        }
    }
}
