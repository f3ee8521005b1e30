//! Small square matrices, row-major, of a size that is known when a kernel begins: loops of known length take a quarter off what Newton's
//! method for the few unknowns of a stage costs beside its residuals.

use crate::linalg::dot;

/// Runs a kernel with the size as a constant, up to eight rows.
macro_rules! of_size {
    ($n:expr, $kernel:ident ( $($given:expr),* )) => {
        match $n {
            2 => $kernel(2, $($given),*),
            3 => $kernel(3, $($given),*),
            4 => $kernel(4, $($given),*),
            5 => $kernel(5, $($given),*),
            6 => $kernel(6, $($given),*),
            7 => $kernel(7, $($given),*),
            8 => $kernel(8, $($given),*),
            n => $kernel(n, $($given),*),
        }
    };
}

/// `out = a x`.
pub fn times(a: &[f64], x: &[f64], out: &mut [f64]) {
    of_size!(x.len(), times_of(a, x, out));
}

#[inline(always)]
fn times_of(n: usize, a: &[f64], x: &[f64], out: &mut [f64]) {
    let (a, x, out) = (&a[..n * n], &x[..n], &mut out[..n]);
    for k in 0..n {
        out[k] = dot(&a[k * n..(k + 1) * n], x);
    }
}

/// `out = aᵀ x`.
pub fn transposed_times(a: &[f64], x: &[f64], out: &mut [f64]) {
    of_size!(x.len(), transposed_times_of(a, x, out));
}

#[inline(always)]
fn transposed_times_of(n: usize, a: &[f64], x: &[f64], out: &mut [f64]) {
    let (a, x, out) = (&a[..n * n], &x[..n], &mut out[..n]);
    out.fill(0.0);
    for k in 0..n {
        for j in 0..n {
            out[j] += x[k] * a[k * n + j];
        }
    }
}

/// `a += left rightᵀ`.
pub fn add_outer(a: &mut [f64], left: &[f64], right: &[f64]) {
    of_size!(right.len(), add_outer_of(a, left, right));
}

#[inline(always)]
fn add_outer_of(n: usize, a: &mut [f64], left: &[f64], right: &[f64]) {
    let (a, left, right) = (&mut a[..n * n], &left[..n], &right[..n]);
    for k in 0..n {
        for j in 0..n {
            a[k * n + j] += left[k] * right[j];
        }
    }
}

/// Inverts `a` in place, by Gauss and Jordan's elimination with pivots from its columns; false where it is singular. `pivots` and `row`, of a row's length, are scratch.
pub fn invert(a: &mut [f64], pivots: &mut [usize], row: &mut [f64]) -> bool {
    of_size!(row.len(), invert_of(a, pivots, row))
}

#[inline(always)]
fn invert_of(n: usize, a: &mut [f64], pivots: &mut [usize], row: &mut [f64]) -> bool {
    let (a, pivots, row) = (&mut a[..n * n], &mut pivots[..n], &mut row[..n]);
    for k in 0..n {
        let p = pivot(n, a, k);
        pivots[k] = p;
        if p != k {
            for j in 0..n {
                a.swap(k * n + j, p * n + j);
            }
        }
        let per = 1.0 / a[k * n + k];
        if !per.is_finite() {
            return false;
        }
        a[k * n + k] = 1.0;
        for j in 0..n {
            a[k * n + j] *= per;
            row[j] = a[k * n + j];
        }
        for i in (0..n).filter(|i| *i != k) {
            let factor = a[i * n + k];
            if factor == 0.0 {
                continue;
            }
            a[i * n + k] = 0.0;
            for j in 0..n {
                a[i * n + j] -= factor * row[j];
            }
        }
    }
    for k in (0..n).rev().filter(|k| pivots[*k] != *k) {
        for i in 0..n {
            a.swap(i * n + k, i * n + pivots[k]);
        }
    }
    true
}

/// Row at or below `k` with the largest entry of column `k`, the last of equal ones; one that is no number counts as the largest.
#[inline(always)]
fn pivot(n: usize, a: &[f64], k: usize) -> usize {
    let mut p = k;
    for i in k + 1..n {
        if a[i * n + k].abs().total_cmp(&a[p * n + k].abs()).is_ge() {
            p = i;
        }
    }
    p
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries between -1 and 1, the same every time.
    fn matrix(n: usize) -> Vec<f64> {
        (0..n * n).map(|k| (k as f64 + 1.0).powi(2).sin()).collect()
    }

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        for n in 1..=10 {
            let a = matrix(n);
            let mut inverse = a.clone();
            assert!(invert(&mut inverse, &mut vec![0; n], &mut vec![0.0; n]));
            for k in 0..n {
                let unit: Vec<f64> = (0..n).map(|j| f64::from(u8::from(j == k))).collect();
                let (mut column, mut back) = (vec![0.0; n], vec![0.0; n]);
                times(&inverse, &unit, &mut column);
                times(&a, &column, &mut back);
                // Rounding times the condition of these matrices, 145 at most.
                assert!(unit.iter().zip(&back).all(|(u, b)| (u - b).abs() < 1e-12), "{n}: {back:?}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_no_inverse() {
        let mut a = [1.0, 2.0, 2.0, 4.0];
        assert!(!invert(&mut a, &mut [0; 2], &mut [0.0; 2]));
    }

    #[test]
    fn a_product_of_vectors_is_added() {
        for n in 1..=10 {
            let (mut a, x) = (matrix(n), matrix(n)[..n].to_vec());
            let mut before = vec![0.0; n];
            transposed_times(&a, &x, &mut before);
            add_outer(&mut a, &x, &x);
            let (mut after, square) = (vec![0.0; n], dot(&x, &x));
            transposed_times(&a, &x, &mut after);
            // Rounding of a sum of ten products.
            assert!((0..n).all(|j| (after[j] - before[j] - square * x[j]).abs() < 1e-14), "{n}");
        }
    }
}
