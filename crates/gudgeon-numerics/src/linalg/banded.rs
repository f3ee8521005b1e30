//! Banded matrices.

use super::{Singular, dot};

/// A banded matrix with `kl` sub- and `ku` super-diagonals, factorised with partial pivoting.
///
/// Rows are stored with `2 kl + ku + 1` entries: the extra `kl` take the fill of the row exchanges.
#[derive(Debug, Clone)]
pub struct Banded {
    n: usize,
    kl: usize,
    ku: usize,
    width: usize,
    a: Vec<f64>,
    piv: Vec<usize>,
    factored: bool,
}

impl Banded {
    /// A zero matrix of size `n` with the given bandwidths.
    #[must_use]
    pub fn new(n: usize, kl: usize, ku: usize) -> Self {
        let width = 2 * kl + ku + 1;
        Self { n, kl, ku, width, a: vec![0.0; n * width], piv: vec![0; n], factored: false }
    }

    /// Number of rows.
    #[must_use]
    pub fn size(&self) -> usize {
        self.n
    }

    /// Sets every entry to zero, ready to be assembled again.
    pub fn clear(&mut self) {
        self.a.fill(0.0);
        self.factored = false;
    }

    /// Adds `value` to entry `(i, j)`.
    ///
    /// # Panics
    /// When `(i, j)` lies outside the band: that is a mistake of the program, not of its user.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        assert!(j + self.kl >= i && j <= i + self.ku && i < self.n && j < self.n, "outside the band");
        // Column j of row i sits at offset j - (i - kl).
        self.a[i * self.width + (j + self.kl - i)] += value;
        self.factored = false;
    }

    /// Entry `(i, j)` of a matrix that is not yet factorised.
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> f64 {
        if j + self.kl < i || j > i + self.ku { 0.0 } else { self.a[i * self.width + (j + self.kl - i)] }
    }

    /// LU factorisation in place.
    ///
    /// # Errors
    /// [`Singular`] when a column has no finite non-zero pivot.
    pub fn factor(&mut self) -> Result<(), Singular> {
        let (n, kl, w) = (self.n, self.kl, self.width);
        // Shift each row so that its first stored entry is column max(0, i - kl) of the remaining matrix: during the
        // elimination row i starts at column `k`, and its multiplier of column k is kept at slot kl + k - i as before.
        for k in 0..n {
            let last = (k + kl).min(n - 1);
            let mut best = k;
            let mut best_size = -1.0;
            for i in k..=last {
                let size = self.a[i * w + (k + kl - i)].abs();
                if size > best_size {
                    best_size = size;
                    best = i;
                }
            }
            if !(best_size > 0.0 && best_size < f64::INFINITY) {
                return Err(Singular { column: k });
            }
            self.piv[k] = best;
            let reach = (k + self.ku + kl).min(n - 1);
            if best != k {
                for j in k..=reach {
                    self.a.swap(k * w + (j + kl - k), best * w + (j + kl - best));
                }
            }
            let pivot = self.a[k * w + kl];
            for i in k + 1..=last {
                let l = self.a[i * w + (k + kl - i)] / pivot;
                self.a[i * w + (k + kl - i)] = l;
                if l != 0.0 {
                    let (top, bottom) = self.a.split_at_mut(i * w);
                    let src = &top[k * w + kl + 1..=k * w + (reach + kl - k)];
                    let dst = &mut bottom[k + 1 + kl - i..=reach + kl - i];
                    for (x, p) in dst.iter_mut().zip(src) {
                        *x -= l * p;
                    }
                }
            }
        }
        self.factored = true;
        Ok(())
    }

    /// Solves `A x = b` in place with the factors of [`Banded::factor`].
    ///
    /// # Panics
    /// When the matrix was not factorised since it was last changed: a mistake of the program.
    pub fn solve(&self, b: &mut [f64]) {
        assert!(self.factored, "solve before factor");
        let (n, kl, w) = (self.n, self.kl, self.width);
        for k in 0..n {
            b.swap(k, self.piv[k]);
            let x = b[k];
            let last = (k + kl).min(n - 1);
            for (i, b) in b.iter_mut().enumerate().take(last + 1).skip(k + 1) {
                *b -= self.a[i * w + (k + kl - i)] * x;
            }
        }
        for i in (0..n).rev() {
            let reach = (i + self.ku + kl).min(n - 1) - i;
            let row = &self.a[i * w + kl..=i * w + kl + reach];
            b[i] = (b[i] - dot(&row[1..], &b[i + 1..=i + reach])) / row[0];
        }
    }
}
