//! Newton's method on the determinant of a damped line.

use gudgeon_numerics::linalg::Complex;

use crate::tree::{Tree, Work};

/// Iterations towards the eigenvalue of a mode, from the undamped one.
const ITERATIONS: usize = 40;
/// Iterations towards the rate at which the whole line slows down.
const RIGID_ITERATIONS: usize = 60;

/// The determinant of `z² J + z C + K` by its logarithmic derivative, with a count of its evaluations.
pub(super) struct Determinant<'a> {
    tree: &'a Tree,
    work: Work,
    pub evaluations: u64,
}

pub(super) fn real(v: f64) -> Complex {
    Complex::new(v, 0.0)
}

pub(super) fn is_finite(z: Complex) -> bool {
    z.re.is_finite() && z.im.is_finite()
}

/// Whether a step no longer changes a digit that is worth having.
pub(super) fn converged(step: Complex, z: Complex) -> bool {
    step.norm1() <= 8.0 * f64::EPSILON * z.norm1()
}

impl<'a> Determinant<'a> {
    pub fn new(tree: &'a Tree) -> Self {
        Self { tree, work: Work::new(tree.len()), evaluations: 0 }
    }

    /// Derivative of the logarithm of the determinant at `z`.
    pub fn log_derivative(&mut self, z: Complex) -> Complex {
        self.evaluations += 1;
        self.tree.log_derivative(z, &mut self.work)
    }

    /// The real root of a free line that is braked against the ground, from a first value: beside the known root zero, which is deflated.
    pub fn rigid_decay(&mut self, from: f64) -> Complex {
        let mut z = real(from);
        for _ in 0..RIGID_ITERATIONS {
            let n = self.log_derivative(z) - real(1.0) / z;
            let step = real(1.0) / n;
            if !is_finite(step) {
                break;
            }
            z = z - step;
            if converged(step, z) {
                break;
            }
        }
        z.im = 0.0;
        z
    }

    /// The root of a multiplicity near `from`, and whether it was found.
    pub fn root(&mut self, from: Complex, multiplicity: f64) -> (Complex, bool) {
        let mut z = from;
        for _ in 0..ITERATIONS {
            let n = self.log_derivative(z);
            let step = real(multiplicity) / n;
            if !is_finite(step) {
                // The determinant is zero to the last digit, or the point is a saddle of it.
                return (z, n.norm1().is_nan() || n.norm1() > 0.0);
            }
            z = z - step;
            if converged(step, z) {
                return (z, true);
            }
        }
        (z, false)
    }
}
