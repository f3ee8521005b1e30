//! Dense LU factorisation of matrices that stand by columns: the same numbers as by rows ([`super::dense`]), several at a time.
//!
//! A column is in one piece, so that an elimination subtracts it from its neighbour, and a solution from what is left, two or more entries at once. Of sparse
//! matrices, columns without an entry in the row of the pivot are left as they are.
//! At 27 unknowns, four solutions for each factorisation, this takes a fifth of the instructions off.

use super::Singular;

/// Fewest unknowns for which columns cost less than rows.
pub const WORTH: usize = 7;

/// [`lu_factor_weighted`](super::lu_factor_weighted) of a matrix that stands by columns.
///
/// # Errors
/// [`Singular`] when a column has no finite non-zero pivot.
pub fn factor(a: &mut [f64], n: usize, piv: &mut [usize], weights: &mut [f64]) -> Result<(), Singular> {
    for k in 0..n {
        let (done, right) = a.split_at_mut((k + 1) * n);
        let column = &mut done[k * n..];
        let best = pivot(column, weights, k).ok_or(Singular { column: k })?;
        piv[k] = best;
        if best != k {
            weights.swap(k, best);
            done.chunks_exact_mut(n).chain(right.chunks_exact_mut(n)).for_each(|c| c.swap(k, best));
        }
        let (pivot, below) = done[k * n + k..].split_at_mut(1);
        let inverse = 1.0 / pivot[0];
        below.iter_mut().for_each(|l| *l *= inverse);
        for other in right.chunks_exact_mut(n) {
            let (top, rest) = other.split_at_mut(k + 1);
            subtract(rest, top[k], below);
        }
    }
    Ok(())
}

/// Row of the largest weighted entry of a column from row `k` on; none where no entry is above zero or one is infinite.
fn pivot(column: &[f64], weights: &[f64], k: usize) -> Option<usize> {
    let (mut best, mut most) = (k, -1.0);
    for (i, (x, w)) in column.iter().zip(weights).enumerate().skip(k) {
        let size = x.abs() * w;
        if size > most {
            (best, most) = (i, size);
        }
    }
    (most > 0.0 && most < f64::INFINITY).then_some(best)
}

/// `to -= factor * column`.
#[inline]
fn subtract(to: &mut [f64], factor: f64, column: &[f64]) {
    if factor != 0.0 {
        to.iter_mut().zip(column).for_each(|(x, l)| *x -= factor * l);
    }
}

/// Solves `A x = b` in place with the factors of [`factor`]; `by_pivot` divides by pivot `k`.
pub fn solve(a: &[f64], n: usize, piv: &[usize], b: &mut [f64], by_pivot: impl Fn(usize, f64) -> f64) {
    for (k, &p) in piv[..n].iter().enumerate() {
        b.swap(k, p);
    }
    let b = &mut b[..n];
    for (k, column) in a.chunks_exact(n).enumerate() {
        let (done, rest) = b.split_at_mut(k + 1);
        subtract(rest, done[k], &column[k + 1..]);
    }
    for (k, column) in a.chunks_exact(n).enumerate().rev() {
        let (rest, done) = b.split_at_mut(k);
        done[0] = by_pivot(k, done[0]);
        subtract(rest, done[0], &column[..k]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{lu_factor_weighted, lu_solve};
    use super::*;

    /// Entries between -1 and 1, a part of them zero; the same every time.
    fn matrix(n: usize, full: f64) -> Vec<f64> {
        let number = |k: usize| (k as f64 + 1.0).powi(2).sin();
        (0..n * n)
            .map(|k| if number(3 * k + 1).abs() < full || k % (n + 1) == 0 { number(k) } else { 0.0 })
            .collect()
    }

    #[test]
    fn rows_and_columns_lead_to_the_same_bits() {
        for n in [7, 8, 13, 27] {
            for full in [0.3, 2.0] {
                let mut rows = matrix(n, full);
                let mut columns: Vec<f64> = (0..n * n).map(|k| rows[k % n * n + k / n]).collect();
                let weights: Vec<f64> = (0..n).map(|k| 1.0 + (k as f64).cos().abs()).collect();
                let (mut by_rows, mut by_columns) = (vec![0; n], vec![0; n]);
                lu_factor_weighted(&mut rows, n, &mut by_rows, Some(&mut weights.clone())).unwrap();
                factor(&mut columns, n, &mut by_columns, &mut weights.clone()).unwrap();
                assert_eq!(by_rows, by_columns);
                let mut b: Vec<f64> = (0..n).map(|k| (k as f64).sin()).collect();
                let mut x = b.clone();
                lu_solve(&rows, n, &by_rows, &mut b);
                solve(&columns, n, &by_columns, &mut x, |k, x| x / columns[k * n + k]);
                assert_eq!(b, x, "{n} unknowns");
            }
        }
    }

    #[test]
    fn a_column_without_a_pivot_is_told() {
        let n = 7;
        let mut a = matrix(n, 2.0);
        a[3 * n..4 * n].fill(0.0);
        let told = factor(&mut a, n, &mut [0; 7], &mut [1.0; 7]);
        assert_eq!(told.unwrap_err().column, 3);
    }
}
