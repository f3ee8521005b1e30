//! Dense LU factorisation: the one of the workspace.
//!
//! Against `nalgebra::LU` (0.35, one core, random matrices; nalgebra's time over this one's): factorisation 1.6 at n = 4, 1.8 at 6 to 20,
//! 1.5 at 30 and 40, 1.3 at 60, and 1.7 (n = 8) to 4.8 (n = 60) where the matrix is tridiagonal, because zero multipliers are skipped;
//! solution 0.8 at n = 4, 1.2 at 6 to 12, 1.0 at 16, 0.9 at 20, 0.7 at 40, 0.6 at 60; one factorisation with eight solutions, a step of
//! [`crate::rodas`], 0.9 at n = 4, 1.3 at 6 to 12, 1.2 at 16 and 20, 1.0 from 30 to 60. Residuals are the same to rounding. This one
//! also works in place, without an allocation a step, and takes weights for the choice of pivots. Since then systems of 4 to 6 have loops of their
//! own, to the same bits: at n = 5 a factorisation takes 47 ns instead of 57, a solution 43 instead of 54.

use super::Singular;

/// LU factorisation with partial pivoting of the `n` × `n` matrix `a`, in place; `piv` (length `n`) records the row swaps.
///
/// # Errors
/// [`Singular`] when a column has no finite non-zero pivot.
pub fn lu_factor(a: &mut [f64], n: usize, piv: &mut [usize]) -> Result<(), Singular> {
    lu_factor_weighted(a, n, piv, None)
}

/// [`lu_factor`] whose pivot search compares `|a_ik| * weight_i`: with `weight` = 1 / (magnitude of unknown i) the choice of
/// pivots does not depend on the units of the rows. `weights` (length `n`) is permuted with the rows.
///
/// # Errors
/// [`Singular`] when a column has no finite non-zero pivot.
pub fn lu_factor_weighted(
    a: &mut [f64],
    n: usize,
    piv: &mut [usize],
    weights: Option<&mut [f64]>,
) -> Result<(), Singular> {
    match n {
        4 => factor(a, 4, piv, weights),
        5 => factor(a, 5, piv, weights),
        6 => factor(a, 6, piv, weights),
        _ => factor(a, n, piv, weights),
    }
}

/// The factorisation. Where `n` is a constant, its loops over short rows are unrolled.
#[inline(always)]
fn factor(
    a: &mut [f64],
    n: usize,
    piv: &mut [usize],
    mut weights: Option<&mut [f64]>,
) -> Result<(), Singular> {
    assert!(a.len() >= n * n && piv.len() >= n, "work arrays shorter than the matrix");
    for k in 0..n {
        let mut best = k;
        let mut best_size = -1.0;
        let mut consider = |i: usize, size: f64| {
            if size > best_size {
                best_size = size;
                best = i;
            }
        };
        let column = a[k * n..n * n].chunks_exact(n).map(|row| row[k].abs());
        match &weights {
            Some(w) => column.zip(&w[k..]).enumerate().for_each(|(i, (x, w))| consider(k + i, x * w)),
            None => column.enumerate().for_each(|(i, x)| consider(k + i, x)),
        }
        // Written so that a NaN pivot also fails.
        if !(best_size > 0.0 && best_size < f64::INFINITY) {
            return Err(Singular { column: k });
        }
        piv[k] = best;
        if best != k {
            let (top, bottom) = a.split_at_mut(best * n);
            top[k * n..k * n + n].swap_with_slice(&mut bottom[..n]);
            if let Some(w) = weights.as_mut() {
                w.swap(k, best);
            }
        }
        let (top, bottom) = a.split_at_mut((k + 1) * n);
        let pivot_row = &top[k * n + k + 1..k * n + n];
        let inv = 1.0 / top[k * n + k];
        for row in bottom[..(n - k - 1) * n].chunks_exact_mut(n) {
            let l = row[k] * inv;
            row[k] = l;
            // Sparse Jacobians are common: a zero multiplier needs no row operation.
            if l != 0.0 {
                for (x, p) in row[k + 1..].iter_mut().zip(pivot_row) {
                    *x -= l * p;
                }
            }
        }
    }
    Ok(())
}

/// Solves `A x = b` in place with the factors of [`lu_factor`].
pub fn lu_solve(a: &[f64], n: usize, piv: &[usize], b: &mut [f64]) {
    substitute(a, n, piv, b, |k, x| x / a[k * n + k]);
}

/// [`lu_solve`] with one over every pivot given, for many solutions one after the other: each number waits for the one before, and for a division
/// longer than for a product.
pub(crate) fn lu_solve_by_products(a: &[f64], n: usize, piv: &[usize], inverse: &[f64], b: &mut [f64]) {
    substitute(a, n, piv, b, |k, x| x * inverse[k]);
}

/// Both substitutions; `by_pivot` divides by pivot `k`.
#[inline]
fn substitute(a: &[f64], n: usize, piv: &[usize], b: &mut [f64], by_pivot: impl Fn(usize, f64) -> f64) {
    match n {
        4 => substitute_few::<4>(a, piv, b, by_pivot),
        5 => substitute_few::<5>(a, piv, b, by_pivot),
        6 => substitute_few::<6>(a, piv, b, by_pivot),
        _ => substitute_any(a, n, piv, b, by_pivot),
    }
}

fn substitute_any(a: &[f64], n: usize, piv: &[usize], b: &mut [f64], by_pivot: impl Fn(usize, f64) -> f64) {
    for (k, &p) in piv[..n].iter().enumerate() {
        b.swap(k, p);
    }
    // By columns: every step adds to all that are left, and waits for one only.
    let (a, b) = (&a[..n * n], &mut b[..n]);
    for k in 0..n {
        let (done, rest) = b.split_at_mut(k + 1);
        let x = done[k];
        for (row, b) in a[(k + 1) * n..].chunks_exact(n).zip(rest) {
            *b -= row[k] * x;
        }
    }
    for k in (0..n).rev() {
        let (rest, done) = b.split_at_mut(k);
        let x = by_pivot(k, done[0]);
        done[0] = x;
        for (row, b) in a.chunks_exact(n).zip(rest) {
            *b -= row[k] * x;
        }
    }
}

/// The same to the last bit for few unknowns, which stay in registers.
#[inline]
fn substitute_few<const N: usize>(
    a: &[f64],
    piv: &[usize],
    b: &mut [f64],
    by_pivot: impl Fn(usize, f64) -> f64,
) {
    let (rows, b) = (&a.as_chunks::<N>().0[..N], &mut b.as_chunks_mut::<N>().0[0]);
    for (k, &p) in piv[..N].iter().enumerate() {
        if p != k {
            b.swap(k, p);
        }
    }
    let mut x = *b;
    for k in 0..N {
        for i in k + 1..N {
            x[i] -= rows[i][k] * x[k];
        }
    }
    for k in (0..N).rev() {
        x[k] = by_pivot(k, x[k]);
        for i in 0..k {
            x[i] -= rows[i][k] * x[k];
        }
    }
    *b = x;
}

/// [`lu_solve`] for `columns` right-hand sides at once, which stand side by side: `b` is row-major, `n` × `columns`.
pub fn lu_solve_rows(a: &[f64], n: usize, piv: &[usize], b: &mut [f64], columns: usize) {
    if columns == 0 {
        return;
    }
    let b = &mut b[..n * columns];
    for (k, &p) in piv[..n].iter().enumerate() {
        if p != k {
            let (top, bottom) = b.split_at_mut(p * columns);
            top[k * columns..(k + 1) * columns].swap_with_slice(&mut bottom[..columns]);
        }
    }
    let subtract = |row: &mut [f64], factor: f64, x: &[f64]| {
        if factor != 0.0 {
            row.iter_mut().zip(x).for_each(|(b, x)| *b -= factor * x);
        }
    };
    for k in 0..n {
        let (done, rest) = b.split_at_mut((k + 1) * columns);
        let x = &done[k * columns..];
        for (i, row) in rest.chunks_exact_mut(columns).enumerate() {
            subtract(row, a[(k + 1 + i) * n + k], x);
        }
    }
    for k in (0..n).rev() {
        let (rest, done) = b.split_at_mut(k * columns);
        let x = &mut done[..columns];
        x.iter_mut().for_each(|x| *x /= a[k * n + k]);
        for (i, row) in rest.chunks_exact_mut(columns).enumerate() {
            subtract(row, a[i * n + k], x);
        }
    }
}
