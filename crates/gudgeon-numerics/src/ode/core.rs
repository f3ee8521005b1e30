//! What the methods that share the step loop work on: arrays of one step, and the linearisation at its start.

use super::difference::{all_finite, difference};
use super::events::Events;
use super::options::{Options, Stats};
use super::system::{ColumnGroups, OdeSystem};
use crate::EvalError;

/// Arrays and flags every method works with. `m = n + quad_dim`; vectors of length `m` hold states, then quadratures.
#[derive(Debug, Clone)]
pub(crate) struct Core {
    pub n: usize,
    pub m: usize,
    /// Start and (trial) end of the step.
    pub x0: Vec<f64>,
    pub x1: Vec<f64>,
    /// Rates at the start and at the accepted end.
    pub f0: Vec<f64>,
    pub f1: Vec<f64>,
    /// m × n, row-major; empty when the system solves for itself.
    pub jac: Vec<f64>,
    /// Whether the system has a linear solver of its own.
    pub structured: bool,
    pub dfdt: Vec<f64>,
    /// Whether `jac` and `dfdt` belong to `x0`.
    pub jac_current: bool,
    pub y_tmp: Vec<f64>,
    pub f_tmp: Vec<f64>,
    pub groups: Option<ColumnGroups>,
    /// Absolute errors of the states in the current step.
    pub atol: Vec<f64>,
    /// Row weights of the pivot search.
    pub weight: Vec<f64>,
    /// Times handed to the right-hand side are kept in here.
    lo: f64,
    hi: f64,
    pub(super) events: Events,
}

/// An end of a step.
#[derive(Debug, Clone, Copy)]
pub(crate) enum End {
    Start,
    /// The end that is tried.
    Trial,
}

impl Core {
    pub(crate) fn new(n: usize, quad: usize, groups: Option<ColumnGroups>, structured: bool) -> Self {
        let m = n + quad;
        let v = || vec![0.0; m];
        Self {
            n,
            m,
            x0: v(),
            x1: v(),
            f0: v(),
            f1: v(),
            jac: vec![0.0; if structured { 0 } else { m * n }],
            structured,
            dfdt: v(),
            jac_current: false,
            y_tmp: v(),
            f_tmp: v(),
            groups,
            atol: vec![0.0; n],
            weight: vec![1.0; n],
            lo: f64::NEG_INFINITY,
            hi: f64::INFINITY,
            events: Events::new(m),
        }
    }

    /// Keeps the times of the coming evaluations between `lo` and `hi`.
    pub(super) fn set_window(&mut self, lo: f64, hi: f64) {
        (self.lo, self.hi) = (lo, hi);
    }

    pub(crate) fn clamp_time(&self, t: f64) -> f64 {
        // lo <= hi always: segments shorter than two nudges collapse to their middle (see `Run::enter_segment`).
        t.max(self.lo).min(self.hi)
    }

    /// Scale of the error of component i.
    #[inline]
    pub(crate) fn scale(&self, opts: &Options, i: usize) -> f64 {
        let a = if i < self.n { self.atol[i] } else { opts.atol_quad[i - self.n] };
        a + opts.relative(i) * self.x0[i].abs().max(self.x1[i].abs())
    }

    /// Absolute errors for the step from `x0`.
    pub(crate) fn set_tolerances<S: OdeSystem + ?Sized>(&mut self, sys: &mut S, t: f64, opts: &Options) {
        self.atol.copy_from_slice(&opts.atol);
        sys.tolerances(t, &self.x0[..self.n], &mut self.atol);
    }

    /// Sets the pivot weights from the scales at the start of the step.
    pub(crate) fn set_weights(&mut self, opts: &Options) {
        for i in 0..self.n {
            let s = self.atol[i] + opts.relative(i) * self.x0[i].abs();
            self.weight[i] = if s > 0.0 { 1.0 / s } else { 1.0 };
        }
    }

    /// Fills `jac` and `dfdt` at `(t, x0)`, with `f0` already there, and sets tolerances. `h` is the coming step.
    pub(crate) fn linearise<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let te = self.clamp_time(t);
        self.set_tolerances(sys, te, opts);
        self.linearise_states(sys, te, End::Start, opts, stats)?;
        self.time_derivative(sys, (t, te), h, stats)
    }

    /// `jac` alone, at one end of the step, where the rates are known.
    pub(crate) fn linearise_states<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        te: f64,
        end: End,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        stats.jacobians += 1;
        self.jac.fill(0.0);
        if self.structured {
            let (y, f) = match end {
                End::Start => (&self.x0, &self.f0),
                End::Trial => (&self.x1, &self.f1),
            };
            sys.linearise(te, &y[..self.n], f)
        } else {
            self.jacobian(sys, te, end, opts, stats)
        }
    }

    /// `jac` at one end of the step, by the system or by differences.
    fn jacobian<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        te: f64,
        end: End,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let n = self.n;
        let (y, f0) = match end {
            End::Start => (&self.x0[..n], &self.f0),
            End::Trial => (&self.x1[..n], &self.f1),
        };
        let jac = &mut self.jac;
        if !sys.jacobian(te, y, f0, jac)? {
            let (groups, moved) = (self.groups.as_ref(), &mut self.y_tmp[..n]);
            return difference(sys, groups, te, y, f0, opts, jac, &mut self.f_tmp, moved, stats);
        }
        for inv in sys.invariants() {
            for j in 0..n {
                let entry = inv.pivot_value(|row| jac[row * n + j]);
                jac[inv.pivot * n + j] = entry;
            }
        }
        Ok(())
    }

    /// `dfdt` at `(t, x0)`, by the system or by a difference; `te` is `t` inside the segment.
    fn time_derivative<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        (t, te): (f64, f64),
        h: f64,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let n = self.n;
        self.dfdt.fill(0.0);
        if sys.time_derivative(te, &self.x0[..n], &self.f0, &mut self.dfdt)? {
            return Ok(());
        }
        // Small beside the step, large beside the resolution of t (and what a rate computed from t loses to rounding);
        // forward, into the coming step, so that a kink behind t is never seen.
        let d = (1e-5 * h).max((0.1 * h).min(1.5e-8 * t.abs()));
        let t2 = self.clamp_time(te + d);
        let d = t2 - te;
        if d > 0.0 {
            Self::checked_rhs(sys, t2, &self.x0[..n], &mut self.f_tmp, stats)?;
            for ((ft, f), f0) in self.dfdt.iter_mut().zip(&self.f_tmp).zip(&self.f0) {
                *ft = (f - f0) / d;
            }
            for inv in sys.invariants() {
                self.dfdt[inv.pivot] = inv.pivot_value(|row| self.dfdt[row]);
            }
        }
        Ok(())
    }

    /// Calls the right-hand side and checks that its answer is finite.
    pub(crate) fn checked_rhs<S: OdeSystem + ?Sized>(
        sys: &mut S,
        t: f64,
        y: &[f64],
        f: &mut [f64],
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        stats.rhs += 1;
        sys.rhs(t, y, f)?;
        if all_finite(f) { Ok(()) } else { Err(non_finite()) }
    }
}

/// What marks a non-finite rate among the recoverable failures.
const NON_FINITE: &str = "the right-hand side is not finite";

pub(crate) fn non_finite() -> EvalError {
    EvalError::recoverable("integrator", NON_FINITE)
}

pub(super) fn is_non_finite(e: &EvalError) -> bool {
    matches!(e, EvalError::Recoverable { model: "integrator", what } if what == NON_FINITE)
}
