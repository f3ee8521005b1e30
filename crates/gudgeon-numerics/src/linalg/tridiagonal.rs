//! Tridiagonal systems.

use super::Singular;

/// Solves a tridiagonal system in place by elimination without pivoting (Thomas), for diagonally dominant matrices.
///
/// `lower[i]` multiplies `x[i-1]` in row i (`lower[0]` unused), `upper[i]` multiplies `x[i+1]` (`upper[n-1]` unused).
/// `rhs` becomes the solution, `work` (length n) is overwritten.
///
/// # Errors
/// [`Singular`] when a pivot is zero or not finite; use [`super::Banded`] when the matrix is not diagonally dominant.
pub fn solve_tridiagonal(
    lower: &[f64],
    diagonal: &[f64],
    upper: &[f64],
    rhs: &mut [f64],
    work: &mut [f64],
) -> Result<(), Singular> {
    let n = diagonal.len();
    if n == 0 {
        return Ok(());
    }
    let usable = |p: f64| p != 0.0 && p.is_finite();
    let mut pivot = diagonal[0];
    if !usable(pivot) {
        return Err(Singular { column: 0 });
    }
    rhs[0] /= pivot;
    for i in 1..n {
        work[i] = upper[i - 1] / pivot;
        pivot = diagonal[i] - lower[i] * work[i];
        if !usable(pivot) {
            return Err(Singular { column: i });
        }
        rhs[i] = (rhs[i] - lower[i] * rhs[i - 1]) / pivot;
    }
    for i in (0..n - 1).rev() {
        rhs[i] -= work[i + 1] * rhs[i + 1];
    }
    Ok(())
}
