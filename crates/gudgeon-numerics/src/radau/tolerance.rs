//! The norm of the error: tolerances a step is controlled with.

use crate::elementary;
use crate::ode::Options;

/// Error left by the iteration, in units of the tolerance asked for. It is not controlled by the error estimate, adds up over the
/// steps and is amplified where a small component drives a large one: at ten times this, van der Pol's equation (mu = 1000)
/// at 1e-9 is wrong by ten tolerances instead of less than one, for a seventh fewer right-hand sides.
const NEWTON: f64 = 1e-4;

/// Tolerances the step is controlled with.
pub struct Tolerance<'a> {
    relative: f64,
    /// Ratio to the tolerance asked for.
    ratio: f64,
    options: &'a Options,
    /// Tolerance of the Newton iteration in units of these.
    pub newton: f64,
}

impl<'a> Tolerance<'a> {
    pub fn new(options: &'a Options) -> Self {
        let relative = 0.1 * elementary::powf(options.rtol, 2.0 / 3.0);
        let ratio = if options.rtol > 0.0 { relative / options.rtol } else { 1.0 };
        // Not below what the rounding of the stages allows.
        let newton = (NEWTON / ratio).max(10.0 * f64::EPSILON / relative);
        Self { relative, ratio, options, newton }
    }

    /// Tolerance of state `k` where its magnitude is `size`.
    pub fn of(&self, k: usize, size: f64) -> f64 {
        let relative = if self.options.is_absolute(k) { 0.0 } else { self.relative };
        self.options.atol[k] * self.ratio + relative * size
    }
}

/// The larger of two norms; NaN counts as infinite, it must not compare as small.
pub fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// Maximum norm of `x / scale`; infinite when a component is NaN.
pub fn scaled_norm(x: &[f64], scale: &[f64]) -> f64 {
    x.iter().zip(scale).fold(0.0, |m, (x, s)| larger(m, (x / s).abs()))
}
