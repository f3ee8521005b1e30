//! The simplified Newton iteration for the stages, and the error estimate: one attempted step.

use super::coefficients::E;
use super::method::{Method, Span};
use super::tolerance::{Tolerance, scaled_norm};
use crate::EvalError;
use crate::elementary;
use crate::linalg::lu_solve;
use crate::ode::{OdeSystem, Stats};

/// Iterations before a step is given up.
pub const ITERATIONS: usize = 10;
/// Rate of convergence below which the Jacobian serves another step.
pub const KEEP_JACOBIAN: f64 = 1e-3;
/// Increment, in units of the iteration's tolerance, below which an iteration that no longer contracts counts as stopped by the
/// rounding of the right-hand side.
const STALLED: f64 = 1e3;

/// How an attempted step went.
pub enum Attempt {
    /// Solved: the error norm and the iterations it took.
    Solved { error: f64, iterations: usize },
    /// The iteration would need a step smaller by this factor.
    NotConverged { factor: f64 },
}

/// What the Newton iteration remembers from step to step.
pub struct Memory {
    /// θ/(1 - θ): error after an iteration per increment of it.
    pub contraction: f64,
    /// Rate of convergence θ of the last iteration.
    pub rate: f64,
}

/// How an iteration goes on.
enum Verdict {
    /// The stages are solved for.
    Solved,
    /// Another iteration.
    Again,
    /// The iteration would need a step smaller by this factor.
    Shrink(f64),
}

/// Increments of a Newton iteration so far.
#[derive(Default)]
struct Increments {
    count: usize,
    last: f64,
    ratio: f64,
}

impl Increments {
    /// Judges the iteration by the scaled size of its newest increment; `kappa` is the size of error it may leave.
    fn judge(&mut self, size: f64, kappa: f64, memory: &mut Memory) -> Verdict {
        self.count += 1;
        if !size.is_finite() {
            return Verdict::Shrink(0.25);
        }
        if self.count > 1 {
            let ratio = size / self.last;
            memory.rate = if self.count == 2 { ratio } else { (ratio * self.ratio).sqrt() };
            self.ratio = ratio;
            if memory.rate < 0.99 {
                memory.contraction = memory.rate / (1.0 - memory.rate);
                let left = (ITERATIONS - self.count) as i32;
                // Error to be expected when the iterations run out, in units of what is allowed.
                let expected = memory.contraction * size * memory.rate.powi(left) / kappa;
                if expected >= 1.0 && memory.contraction * size > STALLED * kappa {
                    let factor =
                        0.8 * elementary::powf(expected.clamp(1e-4, 20.0), -1.0 / (4.0 + f64::from(left)));
                    return Verdict::Shrink(factor);
                }
                if expected >= 1.0 {
                    return Verdict::Solved;
                }
            } else if size <= STALLED * kappa {
                // Rounding of the right-hand side moves the iterates, not the error.
                return Verdict::Solved;
            } else {
                return Verdict::Shrink(0.5);
            }
        }
        self.last = size.max(f64::MIN_POSITIVE);
        if memory.contraction * size <= kappa {
            Verdict::Solved
        } else if self.count == ITERATIONS {
            Verdict::Shrink(0.5)
        } else {
            Verdict::Again
        }
    }
}

impl Method {
    /// Solves for the stages of one step and estimates its error; the new state is left in `y1`. `again`: the estimate may be filtered
    /// twice.
    #[allow(clippy::too_many_arguments, reason = "the memory of the iteration lives in the step loop")]
    pub fn attempt<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        span: &Span,
        y: &[f64],
        tolerance: &Tolerance<'_>,
        memory: &mut Memory,
        again: bool,
        stats: &mut Stats,
    ) -> Result<Attempt, EvalError> {
        for k in 0..self.n {
            self.scale[k] = tolerance.of(k, y[k].abs());
        }
        memory.contraction = elementary::powf(memory.contraction.max(f64::EPSILON), 0.8);
        memory.rate = KEEP_JACOBIAN;
        let mut increments = Increments::default();
        loop {
            self.rates(sys, span, y, stats)?;
            let size = self.iterate(span.h, stats);
            match increments.judge(size, tolerance.newton * self.newton, memory) {
                Verdict::Solved => break,
                Verdict::Again => {}
                Verdict::Shrink(factor) => return Ok(Attempt::NotConverged { factor }),
            }
        }
        let error = self.estimate(sys, span, y, tolerance, again, stats)?;
        Ok(Attempt::Solved { error, iterations: increments.count })
    }

    /// The new state in `y1`, and the norm of its error.
    fn estimate<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        span: &Span,
        y: &[f64],
        tolerance: &Tolerance<'_>,
        again: bool,
        stats: &mut Stats,
    ) -> Result<f64, EvalError> {
        let (n, rows, h) = (self.n, self.rows, span.h);
        for k in 0..n {
            self.y1[k] = y[k] + self.z[2 * rows + k];
            self.scale[k] = tolerance.of(k, y[k].abs().max(self.y1[k].abs()));
        }
        // (λ/h - J)⁻¹ (f(t, y) + Σ e_i Z_i / h): difference to an embedded formula, filtered so that it stays bounded for stiff modes.
        for k in 0..n {
            let stages = (E[0] * self.z[k] + E[1] * self.z[rows + k] + E[2] * self.z[2 * rows + k]) / h;
            self.moved[k] = stages;
            self.error[k] = stages + self.f0[k];
        }
        let error = self.filtered(stats);
        if !(error >= 1.0 && error.is_finite() && again) {
            return Ok(error);
        }
        // At the first step and after a rejection the filter is applied once more: the estimate then vanishes for stiff modes.
        for ((s, y), e) in self.stage.iter_mut().zip(y).zip(&self.error) {
            *s = y + e;
        }
        stats.rhs += 1;
        match sys.rhs(span.low, &self.stage, &mut self.f[..rows]) {
            Ok(()) => {
                for ((e, f), stages) in self.error.iter_mut().zip(&self.f[..n]).zip(&self.moved) {
                    *e = f + stages;
                }
                Ok(self.filtered(stats))
            }
            // The first estimate stands, and rejects the step.
            Err(e) if e.is_recoverable() => Ok(error),
            Err(e) => Err(e),
        }
    }

    /// Multiplies `error` by `(λ/h - J)⁻¹`; its norm.
    fn filtered(&mut self, stats: &mut Stats) -> f64 {
        lu_solve(&self.lu, self.n, &self.pivot, &mut self.error);
        stats.solves += 1;
        scaled_norm(&self.error, &self.scale)
    }
}
