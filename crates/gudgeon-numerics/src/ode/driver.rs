//! The step loop shared by all one-step methods: step-size control, breakpoints, failed evaluations, events, observers.

use crate::EvalError;
use crate::elementary;

use super::check::{Shape, check};
use super::core::{Core, is_non_finite, non_finite};
use super::dense::{Coefficients, Dense, Interpolant};
use super::events::{Events, ScanEnd, Step};
use super::first_step::first_step;
use super::integrator::{Flow, StepView};
use super::options::{IntegrateError, Options, Stats};
use super::system::OdeSystem;

/// Distance kept from breakpoints, in units of machine epsilon times |t|.
const NUDGE: f64 = 8.0 * f64::EPSILON;
/// Lowest order that a rejected step is credited with.
const MIN_ORDER: f64 = 0.5;
/// Part of the step that the error estimate admits which is taken.
const SAFETY: f64 = 0.9;

/// What one attempted step came to.
pub(crate) enum Trial {
    /// `x1` is there, with this error norm.
    Done { error: f64 },
    /// No result (singular matrix): try again with this factor on the step.
    Retry(f64),
}

/// A one-step method.
pub(crate) trait Scheme: Interpolant {
    /// Largest growth of the step.
    const GROWTH: f64;
    /// Whether a step begins with the rates at its start.
    const RATES: bool;
    /// Whether quadratures must take part in the error control.
    const JUDGES_QUADRATURES: bool;
    /// 1 / (order of the error estimate + 1).
    fn exponent(&self) -> f64;
    fn core(&mut self) -> &mut Core;
    /// The same, to look at.
    fn tried(&self) -> &Core;
    /// Forget everything about the past: the state or the equations have changed. The part of the step that is left.
    fn restart(&mut self) -> f64;
    /// Takes the step just tried, of size `h`, whose error was within the tolerance. The factor on it that gives the next.
    fn accept(&mut self, _h: f64, error: f64) -> f64 {
        SAFETY / elementary::powf(error.max(1e-10), self.exponent())
    }
    /// Gives up the step just tried, whose error was above the tolerance. The factor on it, where the method knows better than its order.
    fn reject(&mut self) -> Option<f64> {
        None
    }
    /// From `x0` at `t` to `x1` at `t + h`.
    fn attempt<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<Trial, EvalError>;
}

/// Integrates with `method`; arguments and result as in [`super::Integrator::integrate`].
#[expect(clippy::too_many_arguments, reason = "the arguments of Integrator::integrate")]
pub(crate) fn drive<M: Scheme, S: OdeSystem + ?Sized>(
    method: &mut M,
    sys: &mut S,
    interval: (f64, f64),
    breakpoints: &[f64],
    y: &mut [f64],
    q: &mut [f64],
    opts: &Options,
    stats: &mut Stats,
    observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
) -> Result<f64, IntegrateError> {
    let c = method.core();
    let n = c.n;
    let shape = Shape { n, quad: c.m - n, groups: c.groups.as_ref() };
    check(&shape, sys, interval, breakpoints, y, q, opts)?;
    if M::JUDGES_QUADRATURES && c.m > n && opts.atol_quad.is_empty() {
        return Err(IntegrateError::Input {
            what: "this method needs the accuracy of its quadratures, `atol_quad`",
        });
    }
    c.x0[..n].copy_from_slice(y);
    c.x0[n..].copy_from_slice(q);
    let mut events = std::mem::take(&mut c.events);
    events.resize(sys.n_events());
    method.restart();
    let mut run = Run::new(method, sys, interval, breakpoints, opts, stats, events);
    let result = run.finish(observer);
    let events = run.events;
    let c = method.core();
    c.events = events;
    y.copy_from_slice(&c.x0[..n]);
    q.copy_from_slice(&c.x0[n..]);
    result
}

/// Whether two times are one within the distance kept from breakpoints.
fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= NUDGE * a.abs().max(b.abs())
}

/// An integration under way.
struct Run<'a, M, S: ?Sized> {
    method: &'a mut M,
    sys: &'a mut S,
    breakpoints: &'a [f64],
    opts: &'a Options,
    stats: &'a mut Stats,
    end: f64,
    /// Time reached; the state there is in `x0`.
    t: f64,
    /// Size wanted of the next step.
    h: f64,
    /// Next breakpoint, start of the current segment, and whether that is a breakpoint.
    next_bp: usize,
    /// Next end of a known step.
    next_end: usize,
    seg_start: f64,
    seg_start_is_bp: bool,
    /// Time of the last restart by an event.
    since: f64,
    f0_known: bool,
    events_known: bool,
    /// Steps tried.
    trials: u64,
    /// Whether a step was rejected since the last accepted one; step and error of the last rejection for its error.
    rejected_before: bool,
    rejected: Option<(f64, f64)>,
    /// The last refusal of the right-hand side since the last accepted step.
    cause: Option<EvalError>,
    events: Events,
    coefficients: Coefficients,
}

/// Where the current segment ends.
struct Stop {
    at: f64,
    /// Whether a breakpoint before the end of the integration.
    inner: bool,
}

/// A step to try.
struct Proposal {
    h: f64,
    t_new: f64,
    /// Whether it is shorter than wanted.
    cut: bool,
}

impl<'a, M: Scheme, S: OdeSystem + ?Sized> Run<'a, M, S> {
    fn new(
        method: &'a mut M,
        sys: &'a mut S,
        (t0, end): (f64, f64),
        breakpoints: &'a [f64],
        opts: &'a Options,
        stats: &'a mut Stats,
        events: Events,
    ) -> Self {
        let mut next_bp = breakpoints.partition_point(|&b| b <= t0 && !near(b, t0));
        let mut seg_start_is_bp = false;
        while next_bp < breakpoints.len() && (breakpoints[next_bp] <= t0 || near(breakpoints[next_bp], t0)) {
            seg_start_is_bp = true;
            next_bp += 1;
        }
        Self {
            method,
            sys,
            breakpoints,
            opts,
            stats,
            end,
            t: t0,
            h: if opts.ends.is_empty() { opts.h_init } else { f64::INFINITY },
            next_bp,
            next_end: 0,
            seg_start: t0,
            seg_start_is_bp,
            since: t0,
            f0_known: false,
            events_known: false,
            trials: 0,
            rejected_before: false,
            rejected: None,
            cause: None,
            events,
            coefficients: Coefficients::default(),
        }
    }

    fn finish(
        &mut self,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
    ) -> Result<f64, IntegrateError> {
        while self.t < self.end {
            let stop = self.enter_segment();
            self.evaluate_start()?;
            let step = self.propose(stop.at)?;
            let Some(error) = self.attempt(&step)? else { continue };
            if error > self.opts.slack {
                self.reject_for_error(step.h, error);
                continue;
            }
            if !self.evaluate_end(&step)? {
                continue;
            }
            if self.advance(&step, error, observer)? == Flow::Stop {
                break;
            }
            if stop.inner && self.t >= stop.at {
                self.leave_segment(stop.at);
            }
        }
        Ok(self.h)
    }

    /// Finds the end of the segment this step belongs to, and keeps evaluations inside.
    fn enter_segment(&mut self) -> Stop {
        let (end, next) = (self.end, self.breakpoints.get(self.next_bp).copied());
        let inner = next.filter(|&b| b < end && !near(b, end));
        let at = inner.unwrap_or(end);
        let stop_is_bp = inner.is_some() || next.is_some_and(|b| near(b, end));
        let nudge = NUDGE * self.seg_start.abs().max(at.abs());
        // Segments shorter than two nudges collapse to their middle.
        let mid = 0.5 * (self.seg_start + at);
        let lo = if self.seg_start_is_bp { (self.seg_start + nudge).min(mid) } else { f64::NEG_INFINITY };
        let hi = if stop_is_bp { (at - nudge).max(mid) } else { at };
        self.method.core().set_window(lo, hi);
        Stop { at, inner: inner.is_some() }
    }

    /// Goes over to the other side of a kink.
    fn leave_segment(&mut self, stop: f64) {
        self.seg_start = stop;
        self.seg_start_is_bp = true;
        while self.breakpoints.get(self.next_bp).is_some_and(|&b| b <= stop || near(b, stop)) {
            self.next_bp += 1;
        }
        self.f0_known = false;
        self.h *= self.method.restart();
    }

    /// Rates and event functions at the start of the step, where the step before does not tell them.
    fn evaluate_start(&mut self) -> Result<(), IntegrateError> {
        let (t, c) = (self.t, self.method.core());
        let n = c.n;
        if !self.f0_known {
            let te = c.clamp_time(t);
            Core::checked_rhs(self.sys, te, &c.x0[..n], &mut c.f0, self.stats).map_err(|source| {
                if is_non_finite(&source) {
                    IntegrateError::NonFinite { t }
                } else {
                    IntegrateError::Eval { t, source }
                }
            })?;
            c.jac_current = false;
            self.f0_known = true;
        }
        if !self.events_known {
            self.events
                .start(self.sys, t, &c.x0[..n])
                .map_err(|source| IntegrateError::Eval { t, source })?;
            self.events_known = true;
        }
        Ok(())
    }

    /// The step to try next, which ends at `stop` at the latest.
    fn propose(&mut self, stop: f64) -> Result<Proposal, IntegrateError> {
        let (t, opts) = (self.t, self.opts);
        let stop = self.known_end().map_or(stop, |end| end.min(stop));
        if self.h <= 0.0 || !self.h.is_finite() && opts.ends.is_empty() {
            self.h = first_step(self.method.core(), self.sys, t, stop - t, opts, self.stats);
        }
        let h_max = if opts.h_max > 0.0 { opts.h_max } else { f64::INFINITY };
        self.h = self.h.min(h_max);
        let remaining = stop - t;
        let (h, last) = if self.h >= remaining * (1.0 - 1e-9) {
            (remaining, true)
        } else if 2.0 * self.h > remaining {
            // Two equal steps rather than a whole one and a crumb.
            (0.5 * remaining, false)
        } else {
            (self.h, false)
        };
        self.trials += 1;
        if self.trials > opts.max_steps {
            return Err(IntegrateError::TooManySteps { t, max: opts.max_steps });
        }
        let resolution = 16.0 * f64::EPSILON * t.abs();
        if !last && (h < opts.h_min || h <= resolution) {
            return Err(match self.cause.take() {
                Some(e) if is_non_finite(&e) => IntegrateError::NonFinite { t },
                last => IntegrateError::StepTooSmall { t, h, last },
            });
        }
        Ok(Proposal { h, t_new: if last { stop } else { t + h }, cut: h < self.h })
    }

    /// Where the step ends that was taken from here before.
    fn known_end(&mut self) -> Option<f64> {
        let ends = &self.opts.ends;
        while ends.get(self.next_end).is_some_and(|&e| e <= self.t || near(e, self.t)) {
            self.next_end += 1;
        }
        ends.get(self.next_end).copied()
    }

    /// Attempts the step: its error norm, or `None` when it was rejected without one.
    fn attempt(&mut self, step: &Proposal) -> Result<Option<f64>, IntegrateError> {
        match self.method.attempt(self.sys, self.t, step.h, self.opts, self.stats) {
            Ok(Trial::Done { error }) if error.is_finite() => return Ok(Some(error)),
            Ok(Trial::Done { .. }) => {
                self.cause = Some(non_finite());
                self.reject(step.h, 0.2);
            }
            Ok(Trial::Retry(factor)) => self.reject(step.h, factor),
            Err(e) => self.refused(step.h, e)?,
        }
        Ok(None)
    }

    /// Evaluates the rates at the new state; false when it was refused and the step rejected.
    fn evaluate_end(&mut self, step: &Proposal) -> Result<bool, IntegrateError> {
        self.rejected = None;
        if !M::RATES {
            return Ok(true);
        }
        let c = self.method.core();
        let (n, te) = (c.n, c.clamp_time(step.t_new));
        if let Err(e) = Core::checked_rhs(self.sys, te, &c.x1[..n], &mut c.f1, self.stats) {
            self.refused(step.h, e)?;
            return Ok(false);
        }
        Ok(true)
    }

    /// Rejects a step for a refusal of the right-hand side, unless no step can help.
    fn refused(&mut self, h: f64, source: EvalError) -> Result<(), IntegrateError> {
        if !source.is_recoverable() {
            return Err(IntegrateError::Eval { t: self.t, source });
        }
        self.cause = Some(source);
        self.reject(h, 0.25);
        Ok(())
    }

    fn reject(&mut self, h: f64, factor: f64) {
        self.stats.rejected += 1;
        self.h = h * factor;
        self.rejected_before = true;
    }

    /// Rejects a step whose error is above the tolerance.
    fn reject_for_error(&mut self, h: f64, error: f64) {
        // Across a kink the error falls slower than the order of the method says: from the second rejection on, the
        // order seen since the last one.
        if let Some(factor) = self.method.reject() {
            return self.reject(h, factor);
        }
        let seen = self
            .rejected
            .map_or(f64::INFINITY, |(h0, e0)| elementary::ln(e0 / error) / elementary::ln(h0 / h));
        let shrink = if seen.is_nan() {
            0.1
        } else {
            SAFETY * elementary::powf(error, -1.0 / seen.clamp(MIN_ORDER, 1.0 / self.method.exponent()))
        };
        self.reject(h, shrink.clamp(0.1, 0.9));
        self.rejected = Some((h, error));
        self.cause = None;
    }

    /// Takes an accepted step: dense output, events and observer, and the size of the next one.
    fn advance(
        &mut self,
        step: &Proposal,
        error: f64,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
    ) -> Result<Flow, IntegrateError> {
        self.stats.steps += 1;
        self.cause = None;
        let most = if self.rejected_before { 1.0 } else { M::GROWTH };
        let factor = self.method.accept(step.h, error).clamp(0.2, most);
        self.rejected_before = false;
        self.h = if !self.opts.ends.is_empty() {
            f64::INFINITY
        } else if step.cut {
            self.h.max(factor * step.h)
        } else {
            factor * step.h
        };

        self.coefficients.forget();
        let (source, c): (&dyn Interpolant, _) = (&*self.method, self.method.tried());
        let (coefficients, x0, x1) = (&self.coefficients, &c.x0, &c.x1);
        let dense = Dense { t: self.t, h: step.h, x0, x1, coefficients, source };
        let scanned = Step { n: c.n, dense, t_new: step.t_new };
        let end = self.events.scan(&scanned, self.sys, self.opts, observer, self.stats)?;
        let c = self.method.core();
        match end {
            ScanEnd::Through => {
                std::mem::swap(&mut c.x0, &mut c.x1);
                std::mem::swap(&mut c.f0, &mut c.f1);
                c.jac_current = false;
                self.t = step.t_new;
            }
            ScanEnd::StoppedAtEnd => {
                std::mem::swap(&mut c.x0, &mut c.x1);
                return Ok(Flow::Stop);
            }
            ScanEnd::Stopped => {
                c.x0.copy_from_slice(self.events.state());
                return Ok(Flow::Stop);
            }
            ScanEnd::Chatter { t, event } => {
                c.x0.copy_from_slice(self.events.state());
                return Err(IntegrateError::Chatter { t, event });
            }
            ScanEnd::Restart { t } => {
                c.x0.copy_from_slice(self.events.state());
                self.restart(t);
            }
        }
        Ok(Flow::Continue)
    }

    /// Goes on from the state that an event left at `t`.
    fn restart(&mut self, t: f64) {
        // A step much longer than the time between events would lose that time's digits in its dense output.
        self.h = self.h.min((M::GROWTH * (t - self.since)).max(1e-3 * self.h));
        self.since = t;
        self.t = t;
        self.f0_known = false;
        self.h *= self.method.restart();
    }
}
