//! The step loop shared by all one-step methods: step-size control, breakpoints, failed evaluations, events, observers.

use crate::EvalError;

use super::events::{Events, ScanEnd};
use super::{
    ColumnGroups, Flow, IntegrateError, OdeSystem, Options, Stats, StepView, all_finite, difference,
};

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
    /// Coefficients of the dense output.
    pub cont: [Vec<f64>; 3],
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

/// Distance kept from breakpoints, in units of machine epsilon times |t|.
const NUDGE: f64 = 8.0 * f64::EPSILON;
/// Least order that a rejected step is credited with.
const LEAST_ORDER: f64 = 0.5;

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
            cont: [v(), v(), v()],
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

    pub(crate) fn clamp_time(&self, t: f64) -> f64 {
        // lo <= hi always: segments shorter than two nudges collapse to their middle (see `window`).
        t.max(self.lo).min(self.hi)
    }

    /// Scale of the error of component i.
    #[inline]
    pub(crate) fn scale(&self, opts: &Options, i: usize) -> f64 {
        let a = if i < self.n { self.atol[i] } else { opts.atol_quad[i - self.n] };
        a + opts.relative(i) * self.x0[i].abs().max(self.x1[i].abs())
    }

    /// Absolute errors for the step from `x0`.
    fn set_tolerances<S: OdeSystem + ?Sized>(&mut self, sys: &mut S, t: f64, opts: &Options) {
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

    /// Fills `jac` and, when `with_time`, `dfdt` at `(t, x0)`, with `f0` already there. `h` is the coming step.
    pub(crate) fn linearise<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options,
        with_time: bool,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let n = self.n;
        let te = self.clamp_time(t);
        self.set_tolerances(sys, te, opts);
        stats.jacobians += 1;
        self.jac.fill(0.0);
        if self.structured {
            sys.linearise(te, &self.x0[..n], &self.f0)?;
        } else if !sys.jacobian(te, &self.x0[..n], &self.f0, &mut self.jac)? {
            let (y, moved) = (&self.x0[..n], &mut self.y_tmp[..n]);
            difference(
                sys,
                self.groups.as_ref(),
                te,
                y,
                &self.f0,
                opts,
                &mut self.jac,
                &mut self.f_tmp,
                moved,
                stats,
            )?;
        } else {
            for inv in sys.invariants() {
                for j in 0..n {
                    let entry = inv.pivot_value(|row| self.jac[row * n + j]);
                    self.jac[inv.pivot * n + j] = entry;
                }
            }
        }
        if !with_time {
            return Ok(());
        }
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

fn non_finite() -> EvalError {
    EvalError::recoverable("integrator", NON_FINITE)
}

fn is_non_finite(e: &EvalError) -> bool {
    matches!(e, EvalError::Recoverable { model: "integrator", what } if what == NON_FINITE)
}

/// What one attempted step came to.
pub(crate) enum Trial {
    /// `x1` is there, with this error norm; the controller multiplies its factor by `safety`.
    Done { error: f64, safety: f64 },
    /// No result (singular matrix, no convergence): try again with this factor on the step.
    Retry(f64),
}

/// A one-step method.
pub(crate) trait Scheme {
    /// Largest growth of the step.
    const GROWTH: f64;
    /// 1 / (order of the error estimate + 1).
    fn exponent(&self) -> f64;
    fn core(&mut self) -> &mut Core;
    /// Forget everything about the past: the state or the equations have changed.
    fn restart(&mut self);
    /// From `x0` at `t` to `x1` at `t + h`.
    fn attempt<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<Trial, EvalError>;
    /// Fill `cont` for the step just accepted.
    fn dense(&mut self, h: f64);
    /// The step was accepted; `x0`, `f0` will be the next start. Answers whether a small growth should be skipped.
    fn accepted(&mut self, h: f64) -> bool;
}

fn check<S: OdeSystem + ?Sized>(
    c: &Core,
    sys: &S,
    (t0, t1): (f64, f64),
    breakpoints: &[f64],
    y: &[f64],
    q: &[f64],
    o: &Options,
) -> Result<(), IntegrateError> {
    let (n, nq) = (c.n, c.m - c.n);
    let bad = |what| Err(IntegrateError::Input { what });
    if sys.dim() != n || sys.quad_dim() != nq {
        return bad("the system's dimensions are not those the integrator was made for");
    }
    if y.len() != n || q.len() != nq {
        return bad("the state or the quadratures have the wrong length");
    }
    if !(t0.is_finite() && t1.is_finite() && t1 >= t0) {
        return bad("the interval is not finite or runs backwards");
    }
    if !(o.rtol >= 0.0 && o.rtol.is_finite()) {
        return bad("the relative tolerance is negative or not finite");
    }
    if !(o.absolute.is_empty() || o.absolute.len() == n)
        || o.atol.len() != n
        || !(o.atol_quad.is_empty() || o.atol_quad.len() == nq)
    {
        return bad("an absolute tolerance has the wrong length");
    }
    if o.atol.iter().chain(&o.atol_quad).any(|a| !(*a >= 0.0 && a.is_finite())) {
        return bad("an absolute tolerance is negative or not finite");
    }
    if o.atol.iter().chain(&o.atol_quad).enumerate().any(|(i, a)| *a == 0.0 && o.relative(i) == 0.0) {
        return bad("relative and absolute tolerance are both zero");
    }
    if breakpoints.iter().any(|b| b.is_nan()) || breakpoints.windows(2).any(|w| w[1] < w[0]) {
        return bad("the breakpoints are not ascending");
    }
    if !(all_finite(y) && all_finite(q)) {
        return bad("the initial state is not finite");
    }
    if let Some(g) = &c.groups
        && (g.rows.len() != n
            || g.groups.iter().flatten().any(|&j| j >= n)
            || g.rows.iter().flatten().any(|&r| r >= c.m))
    {
        return bad("the column groups do not fit the system");
    }
    for inv in sys.invariants() {
        let pivot: f64 = inv.terms.iter().filter(|t| t.0 == inv.pivot).map(|t| t.1).sum();
        if inv.terms.iter().any(|t| t.0 >= c.m || !t.1.is_finite()) || pivot == 0.0 {
            return bad("an invariant has a row outside the system or no pivot");
        }
    }
    Ok(())
}

/// A first step from the sizes of the solution and its first two derivatives (Hairer, Nørsett & Wanner, II.4).
fn initial_step<M: Scheme, S: OdeSystem + ?Sized>(
    m: &mut M,
    sys: &mut S,
    t: f64,
    span: f64,
    o: &Options,
    stats: &mut Stats,
) -> f64 {
    let c = m.core();
    let k = if o.atol_quad.is_empty() { c.n } else { c.m };
    c.set_tolerances(sys, t, o);
    c.x1.copy_from_slice(&c.x0);
    let (mut d0, mut d1) = (0.0_f64, 0.0_f64);
    for i in 0..k {
        let s = c.scale(o, i).max(f64::MIN_POSITIVE);
        d0 = d0.max((c.x0[i] / s).abs());
        d1 = d1.max((c.f0[i] / s).abs());
    }
    let mut h0 = if d0 < 1e-5 || d1 < 1e-5 / span { 1e-6 * span } else { 0.01 * d0 / d1 };
    h0 = h0.min(span);
    for _ in 0..8 {
        for i in 0..c.n {
            c.y_tmp[i] = c.x0[i] + h0 * c.f0[i];
        }
        let te = c.clamp_time(t + h0);
        let n = c.n;
        if Core::checked_rhs(sys, te, &c.y_tmp[..n], &mut c.f_tmp, stats).is_ok() {
            let mut d2 = 0.0_f64;
            for i in 0..k {
                let s = c.scale(o, i).max(f64::MIN_POSITIVE);
                d2 = d2.max(((c.f_tmp[i] - c.f0[i]) / (s * h0)).abs());
            }
            // d1 is 1/time, d2 1/time²: the error of a first-order step of size h is about h² d2.
            let h1 = if d1 <= 1e-15 / span && d2 <= 1e-15 / (span * span) {
                1e-3 * span
            } else {
                let a = if d1 > 0.0 { 0.01 / d1 } else { span };
                let b = if d2 > 0.0 { (0.01 / d2).sqrt() } else { span };
                // The methods here are of order 5: the higher derivatives are guessed from these two.
                a.min(b).max(a.min(b).powf(0.4) * h0.powf(0.6).min(span))
            };
            return (100.0 * h0).min(h1).min(span);
        }
        h0 *= 0.1;
    }
    h0
}

/// Integrates with method `m`; arguments and result as in [`super::Integrator::integrate`].
#[expect(clippy::too_many_arguments, reason = "the arguments of Integrator::integrate")]
pub(crate) fn drive<M: Scheme, S: OdeSystem + ?Sized>(
    m: &mut M,
    sys: &mut S,
    interval: (f64, f64),
    breakpoints: &[f64],
    y: &mut [f64],
    q: &mut [f64],
    opts: &Options,
    stats: &mut Stats,
    observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
) -> Result<f64, IntegrateError> {
    check(m.core(), sys, interval, breakpoints, y, q, opts)?;
    let n = m.core().n;
    let c = m.core();
    c.x0[..n].copy_from_slice(y);
    c.x0[n..].copy_from_slice(q);
    m.restart();
    let result = run(m, sys, interval, breakpoints, opts, stats, observer);
    let c = m.core();
    y.copy_from_slice(&c.x0[..n]);
    q.copy_from_slice(&c.x0[n..]);
    result
}

fn run<M: Scheme, S: OdeSystem + ?Sized>(
    m: &mut M,
    sys: &mut S,
    (t0, t1): (f64, f64),
    breakpoints: &[f64],
    opts: &Options,
    stats: &mut Stats,
    observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
) -> Result<f64, IntegrateError> {
    let n = m.core().n;
    let exponent = m.exponent();
    let mut trials = 0;
    let mut t = t0;
    // Time of the last restart by an event.
    let mut since = t0;
    let near = |a: f64, b: f64| (a - b).abs() <= NUDGE * a.abs().max(b.abs());
    // Next breakpoint, and whether the current segment starts at one.
    let mut next_bp = breakpoints.partition_point(|&b| b <= t0 && !near(b, t0));
    let mut seg_start_is_bp = false;
    while next_bp < breakpoints.len() && (breakpoints[next_bp] <= t0 || near(breakpoints[next_bp], t0)) {
        seg_start_is_bp = true;
        next_bp += 1;
    }
    let mut seg_start = t0;
    m.core().events.resize(sys.n_events());
    let mut h = opts.h_init;
    let h_max = if opts.h_max > 0.0 { opts.h_max } else { f64::INFINITY };
    let mut f0_known = false;
    let mut events_known = false;
    let mut rejected_before = false;
    // Step and error of the last rejection since the last accepted step.
    let mut rejected: Option<(f64, f64)> = None;
    let mut cause: Option<EvalError> = None;
    let eval_error = |t: f64, source: EvalError| {
        if is_non_finite(&source) {
            IntegrateError::NonFinite { t }
        } else {
            IntegrateError::Eval { t, source }
        }
    };

    while t < t1 {
        // The segment this step belongs to.
        let bp = breakpoints.get(next_bp).copied().filter(|&b| b < t1 && !near(b, t1));
        let stop = bp.unwrap_or(t1);
        let stop_is_bp = bp.is_some() || breakpoints.get(next_bp).is_some_and(|&b| near(b, t1));
        {
            let c = m.core();
            let nudge = NUDGE * seg_start.abs().max(stop.abs());
            let mid = 0.5 * (seg_start + stop);
            c.lo = if seg_start_is_bp { (seg_start + nudge).min(mid) } else { f64::NEG_INFINITY };
            c.hi = if stop_is_bp { (stop - nudge).max(mid) } else { stop };
        }
        if !f0_known {
            let c = m.core();
            let te = c.clamp_time(t);
            Core::checked_rhs(sys, te, &c.x0[..n], &mut c.f0, stats).map_err(|e| eval_error(t, e))?;
            c.jac_current = false;
            f0_known = true;
        }
        if !events_known {
            let c = m.core();
            c.events.start(sys, t, &c.x0[..n]).map_err(|e| IntegrateError::Eval { t, source: e })?;
            events_known = true;
        }
        if h <= 0.0 || !h.is_finite() {
            h = initial_step(m, sys, t, stop - t, opts, stats);
        }
        h = h.min(h_max);
        let remaining = stop - t;
        let (h_try, last) = if h >= remaining * (1.0 - 1e-9) {
            (remaining, true)
        } else if 2.0 * h > remaining {
            // Two equal steps rather than a whole one and a crumb.
            (0.5 * remaining, false)
        } else {
            (h, false)
        };
        let cut = h_try < h;
        trials += 1;
        if trials > opts.max_steps {
            return Err(IntegrateError::TooManySteps { t, max: opts.max_steps });
        }
        let resolution = 16.0 * f64::EPSILON * t.abs();
        if !last && (h_try < opts.h_min || h_try <= resolution) {
            return Err(match cause {
                Some(e) if is_non_finite(&e) => IntegrateError::NonFinite { t },
                last => IntegrateError::StepTooSmall { t, h: h_try, last },
            });
        }
        let t_new = if last { stop } else { t + h_try };

        // Attempt, and check that the new state can be evaluated.
        let trial = m.attempt(sys, t, h_try, opts, stats);
        let (error, safety) = match trial {
            Ok(Trial::Done { error, safety }) if error.is_finite() => (error, safety),
            Ok(Trial::Done { .. }) => {
                cause = Some(non_finite());
                reject(stats, &mut h, h_try, 0.2, &mut rejected_before);
                continue;
            }
            Ok(Trial::Retry(f)) => {
                reject(stats, &mut h, h_try, f, &mut rejected_before);
                continue;
            }
            Err(e) if e.is_recoverable() => {
                cause = Some(e);
                reject(stats, &mut h, h_try, 0.25, &mut rejected_before);
                continue;
            }
            Err(e) => return Err(IntegrateError::Eval { t, source: e }),
        };
        let power = error.max(1e-10).powf(exponent);
        if error > 1.0 {
            // Across a kink the error falls slower than the order of the method says: from the second rejection on, the
            // order seen since the last one.
            let seen =
                rejected.map_or(f64::INFINITY, |(h0, e0): (f64, f64)| (e0 / error).ln() / (h0 / h_try).ln());
            let shrink = if seen.is_nan() {
                0.1
            } else {
                safety * error.powf(-1.0 / seen.clamp(LEAST_ORDER, 1.0 / exponent))
            };
            reject(stats, &mut h, h_try, shrink.clamp(0.1, 0.9), &mut rejected_before);
            rejected = Some((h_try, error));
            cause = None;
            continue;
        }
        rejected = None;
        {
            let c = m.core();
            let te = c.clamp_time(t_new);
            match Core::checked_rhs(sys, te, &c.x1[..n], &mut c.f1, stats) {
                Ok(()) => {}
                Err(e) if e.is_recoverable() => {
                    cause = Some(e);
                    reject(stats, &mut h, h_try, 0.25, &mut rejected_before);
                    continue;
                }
                Err(e) => return Err(IntegrateError::Eval { t, source: e }),
            }
        }
        stats.steps += 1;
        cause = None;
        let mut factor = safety / power;
        factor = factor.clamp(0.2, if rejected_before { 1.0 } else { M::GROWTH });
        rejected_before = false;

        m.dense(h_try);
        let hold = m.accepted(h_try);
        if hold && (1.0..=1.2).contains(&factor) {
            factor = 1.0;
        }
        let mut h_next = if cut { h.max(factor * h_try) } else { factor * h_try };

        let c = m.core();
        let end = Events::scan(c, sys, t, h_try, t_new, opts, observer, stats)?;
        match end {
            ScanEnd::Through => {
                std::mem::swap(&mut c.x0, &mut c.x1);
                std::mem::swap(&mut c.f0, &mut c.f1);
                c.jac_current = false;
                t = t_new;
            }
            // `scan` left the final state in x0.
            ScanEnd::Stopped => return Ok(h_next),
            ScanEnd::Restart { t: te } => {
                // `scan` left the new state in x0. A step much longer than the time between events would lose that
                // time's digits in its dense output.
                h_next = h_next.min((M::GROWTH * (te - since)).max(1e-3 * h_next));
                since = te;
                t = te;
                f0_known = false;
                c.jac_current = false;
                m.restart();
            }
        }
        if bp.is_some() && t >= stop {
            // The other side of the kink.
            seg_start = stop;
            seg_start_is_bp = true;
            while breakpoints.get(next_bp).is_some_and(|&b| b <= stop || near(b, stop)) {
                next_bp += 1;
            }
            f0_known = false;
            m.restart();
        }
        h = h_next;
    }
    Ok(h)
}

fn reject(stats: &mut Stats, h: &mut f64, h_try: f64, factor: f64, rejected_before: &mut bool) {
    stats.rejected += 1;
    *h = h_try * factor;
    *rejected_before = true;
}
