//! The step loop: step-size control, breakpoints, failed evaluations.

use super::coefficients::newton_form;
use super::method::{Method, Span};
use super::newton::{Attempt, ITERATIONS, KEEP_JACOBIAN, Memory};
use super::tolerance::Tolerance;
use crate::EvalError;
use crate::elementary;
use crate::ode::{Flow, IntegrateError, OdeSystem, Options, Stats, StepView};

/// Growth of the step below which the factors serve another step.
const KEEP_STEP: f64 = 1.2;

/// An integration under way.
pub struct Run<'a, S: ?Sized> {
    method: &'a mut Method,
    sys: &'a mut S,
    breakpoints: &'a [f64],
    options: &'a Options,
    stats: &'a mut Stats,
    y: &'a mut [f64],
    q: &'a mut [f64],
    tolerance: Tolerance<'a>,
    t: f64,
    end: f64,
    whole: f64,
    /// Size wanted of the next step.
    h: f64,
    next_break: usize,
    /// Steps tried.
    trials: u64,
    memory: Memory,
    /// The last refusal of the right-hand side since the last accepted step.
    refusal: Option<EvalError>,
    /// Step and error before, which Gustafsson's predictor needs.
    previous: Option<(f64, f64)>,
    rejected_before: bool,
    /// The step whose polynomial continues smoothly into the next one.
    polynomial: Option<f64>,
    guess_failed: bool,
    /// At the start and behind a breakpoint nothing is known of what follows.
    edge: bool,
    rates_known: bool,
    jacobian_usable: bool,
    jacobian_here: bool,
    /// The step whose matrices are factored.
    factored: Option<f64>,
}

/// A step to try.
struct Proposal {
    span: Span,
    t1: f64,
    /// The next breakpoint, or the end.
    stop: f64,
    /// Whether the step is shorter than wanted.
    cut: bool,
}

impl<'a, S: OdeSystem + ?Sized> Run<'a, S> {
    #[expect(clippy::too_many_arguments, reason = "the arguments of Integrator::integrate")]
    pub fn new(
        method: &'a mut Method,
        sys: &'a mut S,
        (t, end): (f64, f64),
        breakpoints: &'a [f64],
        y: &'a mut [f64],
        q: &'a mut [f64],
        options: &'a Options,
        stats: &'a mut Stats,
    ) -> Self {
        let whole = end - t;
        Self {
            method,
            sys,
            breakpoints,
            options,
            stats,
            y,
            q,
            tolerance: Tolerance::new(options),
            t,
            end,
            whole,
            h: if options.h_init > 0.0 { options.h_init } else { 1e-4 * whole }.min(options.h_max),
            next_break: breakpoints.partition_point(|b| *b <= t + 1e-12 * whole.abs()),
            trials: 0,
            memory: Memory { contraction: 1.0, rate: 1.0 },
            refusal: None,
            previous: None,
            rejected_before: false,
            polynomial: None,
            guess_failed: false,
            edge: true,
            rates_known: false,
            jacobian_usable: false,
            jacobian_here: false,
            factored: None,
        }
    }

    pub fn finish(
        mut self,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
    ) -> Result<f64, IntegrateError> {
        while self.t < self.end {
            let step = self.propose();
            self.linearise(&step.span)?;
            self.trials += 1;
            if self.trials > self.options.max_steps {
                return Err(IntegrateError::TooManySteps { t: self.t, max: self.options.max_steps });
            }
            let factor = match self.attempt(&step.span) {
                Ok(Attempt::Solved { error, iterations }) if error <= 1.0 => {
                    if self.advance(&step, error, iterations, observer) == Flow::Stop {
                        break;
                    }
                    continue;
                }
                other => self.shrink(other)?,
            };
            self.reject(step.span.h, factor)?;
        }
        Ok(self.h)
    }

    /// The step to try next.
    fn propose(&self) -> Proposal {
        let (t, h) = (self.t, self.h);
        let stop =
            self.breakpoints.get(self.next_break).copied().filter(|b| *b < self.end).unwrap_or(self.end);
        let left = stop - t;
        // Land on the stop exactly, and never leave a sliver before it.
        let (step, t1) = if h >= left {
            (left, stop)
        } else if 2.0 * h > left {
            (0.5 * left, t + 0.5 * left)
        } else {
            (h, t + h)
        };
        let inside = (8.0 * f64::EPSILON * t.abs().max(stop.abs())).min(1e-3 * step);
        let low = if self.edge { t + inside } else { t };
        let high = if t1 == stop { t1 - inside } else { t1 };
        Proposal { span: Span { t, h: step, low, high }, t1, stop, cut: step < h }
    }

    /// Rates and Jacobian at the start of the step, where they are not known.
    fn linearise(&mut self, span: &Span) -> Result<(), IntegrateError> {
        // The state itself is accepted: nothing smaller can help.
        let t = self.t;
        let fail = |source: EvalError| IntegrateError::Eval { t, source };
        if !self.rates_known {
            self.stats.rhs += 1;
            self.sys.rhs(span.low, self.y, &mut self.method.f0).map_err(fail)?;
            self.rates_known = true;
        }
        if !self.jacobian_usable {
            self.method.jacobian(self.sys, span.low, self.y, self.options, self.stats).map_err(fail)?;
            (self.jacobian_here, self.factored) = (true, None);
        }
        Ok(())
    }

    /// Factors the matrices where that was not done for this step, and solves for the stages.
    fn attempt(&mut self, span: &Span) -> Result<Attempt, EvalError> {
        let step = span.h;
        if self.factored != Some(step) {
            self.factored = None;
            self.method.factor(step, self.stats)?;
            self.factored = Some(step);
        }
        self.method.guess(self.polynomial.filter(|_| !self.guess_failed).map(|before| step / before));
        let again = self.edge || self.rejected_before;
        self.method.attempt(self.sys, span, self.y, &self.tolerance, &mut self.memory, again, self.stats)
    }

    /// Takes an accepted step, shows it to the observer, and chooses the size of the next one.
    fn advance(
        &mut self,
        step: &Proposal,
        error: f64,
        iterations: usize,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
    ) -> Flow {
        let method = &mut *self.method;
        method.prepare_dense();
        method.y0.copy_from_slice(self.y);
        self.y.copy_from_slice(&method.y1);
        for (q, z) in self.q.iter_mut().zip(&method.z[2 * method.rows + method.n..]) {
            *q += z;
        }
        self.stats.steps += 1;
        self.refusal = None;
        let view = View { t0: self.t, t1: step.t1, y0: &method.y0, y1: &method.y1, dense: &method.dense };
        let flow = observer(self.sys, &view);
        let factor = self.growth(step.span.h, error.max(1e-10), iterations);
        // A step cut short by a stop says little about the next one.
        let wanted = step.span.h * factor;
        self.h = if step.cut { self.h.max(wanted) } else { wanted }.min(self.options.h_max);
        self.t = step.t1;
        if self.t >= step.stop && step.stop < self.end {
            // A breakpoint may stand in the list more than once.
            while self.breakpoints.get(self.next_break).is_some_and(|b| *b <= self.t) {
                self.next_break += 1;
            }
            (self.previous, self.polynomial) = (None, None);
            (self.edge, self.jacobian_usable) = (true, false);
        }
        flow
    }

    /// Factor on an accepted step of size `h`, and what is kept of it.
    fn growth(&mut self, h: f64, error: f64, iterations: usize) -> f64 {
        let mut factor = safety(iterations) * elementary::powf(error, -0.25);
        if let Some((h_old, e_old)) = self.previous {
            factor = factor.min(0.9 * (h / h_old) * elementary::powf(e_old / (error * error), 0.25));
        }
        factor = factor.clamp(0.2, 8.0);
        if self.rejected_before {
            factor = factor.min(1.0);
        }
        (self.rejected_before, self.guess_failed, self.edge) = (false, false, false);
        self.previous = Some((h, error.max(1e-2)));
        self.polynomial = Some(h);
        (self.rates_known, self.jacobian_here) = (false, false);
        self.jacobian_usable = self.memory.rate <= KEEP_JACOBIAN;
        if self.jacobian_usable && (1.0..=KEEP_STEP).contains(&factor) {
            // A factorisation saved is worth more than so little growth.
            factor = 1.0;
        }
        factor
    }

    /// Factor on a step that was not accepted.
    fn shrink(&mut self, outcome: Result<Attempt, EvalError>) -> Result<f64, IntegrateError> {
        Ok(match outcome {
            Ok(Attempt::Solved { error, iterations }) if error.is_finite() => {
                (safety(iterations) * elementary::powf(error, -0.25)).clamp(0.1, 0.9)
            }
            Ok(Attempt::Solved { .. }) => 0.25,
            // A Jacobian from elsewhere is the first suspect, the step the second.
            Ok(Attempt::NotConverged { .. }) if !self.jacobian_here => 1.0,
            Ok(Attempt::NotConverged { factor }) => {
                self.guess_failed = true;
                factor
            }
            Err(e) if e.is_recoverable() => {
                self.refusal = Some(e);
                self.guess_failed = true;
                0.25
            }
            Err(source) => return Err(IntegrateError::Eval { t: self.t, source }),
        })
    }

    fn reject(&mut self, h: f64, factor: f64) -> Result<(), IntegrateError> {
        self.stats.rejected += 1;
        self.rejected_before = true;
        self.memory.contraction = 1.0;
        self.jacobian_usable = self.jacobian_here;
        self.h = h * factor;
        let t = self.t;
        if self.h <= self.options.h_min.max(4.0 * f64::EPSILON * t.abs().max(self.whole * 1e-6)) {
            return Err(IntegrateError::StepTooSmall { t, h: self.h, last: self.refusal.take() });
        }
        Ok(())
    }
}

/// Safety factor of the next step: a step that took many iterations should not grow much.
fn safety(iterations: usize) -> f64 {
    let scale = 2.0 * ITERATIONS as f64;
    0.9 * ((scale + 1.0) / (scale + iterations as f64)).min(1.0)
}

/// An accepted step with the collocation polynomial as dense output.
struct View<'a> {
    t0: f64,
    t1: f64,
    y0: &'a [f64],
    y1: &'a [f64],
    dense: &'a [f64],
}

impl StepView for View<'_> {
    fn t0(&self) -> f64 {
        self.t0
    }
    fn t1(&self) -> f64 {
        self.t1
    }
    fn y0(&self) -> &[f64] {
        self.y0
    }
    fn y1(&self) -> &[f64] {
        self.y1
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        let rows = self.dense.len() / 3;
        let s = (t - self.t1) / (self.t1 - self.t0);
        for (k, y) in y.iter_mut().enumerate().take(self.y1.len()) {
            *y = self.y1[k] + newton_form(s, [self.dense[k], self.dense[rows + k], self.dense[2 * rows + k]]);
        }
    }
}
