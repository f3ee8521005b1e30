//! Small dense, banded and tridiagonal linear systems. Matrices are row-major slices.
//!
//! Factorisations are in place and allocate nothing; a singular matrix is an error, never a NaN in the solution.

mod banded;
pub(crate) mod columns;
mod complex;
mod complex_lu;
mod dense;
mod symmetric_banded;
mod tridiagonal;

pub use banded::Banded;
pub use complex::Complex;
pub use complex_lu::ComplexLu;
pub(crate) use dense::lu_solve_by_products;
pub use dense::{lu_factor, lu_factor_weighted, lu_solve, lu_solve_rows};
pub use symmetric_banded::{BLOCK, SymmetricBanded};
pub use tridiagonal::solve_tridiagonal;

/// The matrix is singular to working precision, or holds a non-finite number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("singular matrix: no usable pivot in column {column}")]
pub struct Singular {
    /// The column (counted from 0) in which elimination stopped.
    pub column: usize,
}

/// Inner product with four partial sums: the order of summation is fixed, so results do not depend on the optimiser.
#[inline]
#[must_use]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    let mut s = [0.0; 4];
    let (ca, cb) = (a.chunks_exact(4), b.chunks_exact(4));
    let tail: f64 = ca.remainder().iter().zip(cb.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in ca.zip(cb) {
        for i in 0..4 {
            s[i] += x[i] * y[i];
        }
    }
    (s[0] + s[1]) + (s[2] + s[3]) + tail
}
