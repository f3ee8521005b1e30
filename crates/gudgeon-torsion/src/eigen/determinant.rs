//! Newton's method on the determinant of a damped line.

use gudgeon_numerics::linalg::Complex;

use crate::tree::{Tree, Work};

/// Iterations towards the eigenvalue of a mode, from the undamped one.
const ITERATIONS: usize = 40;
/// Iterations towards a real root.
const REAL_ITERATIONS: usize = 200;

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

    /// A real root from a first value beside known ones, which are deflated: the rate at which a line that is braked against the ground slows down,
    /// or at which a part that hangs on damping comes to rest. With whether it was found.
    pub fn real_root(&mut self, from: f64, known: &[Complex]) -> (Complex, bool) {
        let mut z = real(from);
        for _ in 0..REAL_ITERATIONS {
            let deflated = known.iter().fold(self.log_derivative(z), |n, k| n - real(1.0) / (z - *k));
            let step = real(1.0) / deflated;
            if !is_finite(step) {
                return (real(z.re), deflated.norm1().is_nan() || deflated.norm1() > 0.0);
            }
            z = real((z - step).re);
            if converged(step, z) {
                return (z, true);
            }
        }
        (z, false)
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
