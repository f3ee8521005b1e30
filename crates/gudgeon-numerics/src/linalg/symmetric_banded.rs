//! Symmetric positive definite banded matrices.

use super::{Singular, dot};

/// A symmetric positive definite banded matrix, factorised as `L D Lᵀ` without pivoting: half the storage and a quarter of the work of
/// [`super::Banded`].
#[derive(Debug, Clone)]
pub struct SymmetricBanded {
    n: usize,
    half: usize,
    /// Row i holds the entries of columns i to i + half.
    a: Vec<f64>,
    /// Rows of the pivots that are eliminated together, with zeros behind them.
    panel: Vec<f64>,
    factored: bool,
}

/// Pivots that are eliminated together: what follows them is read and written once for all of them.
const PANEL: usize = 4;
/// Right-hand sides that [`SymmetricBanded::solve_block`] carries at once.
const BLOCK: usize = 4;

impl SymmetricBanded {
    /// A zero matrix of size `n` with `half` sub-diagonals.
    #[must_use]
    pub fn new(n: usize, half: usize) -> Self {
        let panel = vec![0.0; PANEL * (half + PANEL)];
        Self { n, half, a: vec![0.0; n * (half + 1)], panel, factored: false }
    }

    /// Sets every entry to zero, ready to be assembled again.
    pub fn clear(&mut self) {
        self.a.fill(0.0);
        self.factored = false;
    }

    /// Adds `value` to entry `(i, j)` of the lower triangle and, where `i` is not `j`, to its mirror image.
    ///
    /// # Panics
    /// When `(i, j)` lies outside the lower half of the band: that is a mistake of the program, not of its user.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        assert!(j <= i && i <= j + self.half && i < self.n, "outside the lower half of the band");
        self.a[j * (self.half + 1) + (i - j)] += value;
        self.factored = false;
    }

    /// Factorisation in place.
    ///
    /// # Errors
    /// [`Singular`] when the matrix is not positive definite.
    pub fn factor(&mut self) -> Result<(), Singular> {
        let (w, wide) = (self.half + 1, self.half + PANEL);
        for k in (0..self.n).step_by(PANEL) {
            let count = PANEL.min(self.n - k);
            let (done, rest) = self.a.split_at_mut((k + count) * w);
            let mut inverse = [0.0; PANEL];
            for p in 0..count {
                let (before, own) = done.split_at_mut((k + p) * w);
                let own = &mut own[..w];
                for (q, inverse) in inverse.iter().enumerate().take(p) {
                    let m = p - q;
                    if m <= self.half {
                        let pivot = &before[(k + q) * w..][..w];
                        let l = pivot[m] * inverse;
                        own[..w - m].iter_mut().zip(&pivot[m..]).for_each(|(x, p)| *x -= l * p);
                    }
                }
                if !(own[0] > 0.0 && own[0] < f64::INFINITY) {
                    return Err(Singular { column: k + p });
                }
                inverse[p] = 1.0 / own[0];
                self.panel[p * wide..][..w].copy_from_slice(own);
            }
            let (u, more) = self.panel.split_at(wide);
            let (v, more) = more.split_at(wide);
            let (x, y) = more.split_at(wide);
            for (r, row) in rest.chunks_exact_mut(w).enumerate().take(self.half) {
                // The panel is full whenever rows follow it.
                let m = r + 1;
                let l =
                    [u[m + 3] * inverse[0], v[m + 2] * inverse[1], x[m + 1] * inverse[2], y[m] * inverse[3]];
                let length = w - m;
                let (u, v) = (&u[m + 3..][..length], &v[m + 2..][..length]);
                let (x, y) = (&x[m + 1..][..length], &y[m..][..length]);
                for (j, a) in row[..length].iter_mut().enumerate() {
                    *a -= (l[0] * u[j] + l[1] * v[j]) + (l[2] * x[j] + l[3] * y[j]);
                }
            }
            for (p, inverse) in inverse.iter().enumerate().take(count) {
                let own = &mut done[(k + p) * w..][..w];
                own[0] = *inverse;
                own[1..].iter_mut().for_each(|x| *x *= inverse);
            }
        }
        self.factored = true;
        Ok(())
    }

    /// Solves `A x = b` in place with the factors of [`SymmetricBanded::factor`].
    ///
    /// # Panics
    /// When the matrix was not factorised since it was last changed: a mistake of the program.
    pub fn solve(&self, b: &mut [f64]) {
        assert!(self.factored, "solve before factor");
        let w = self.half + 1;
        for k in 0..self.n {
            let reach = self.half.min(self.n - 1 - k);
            let (done, rest) = b.split_at_mut(k + 1);
            let x = done[k];
            for (y, l) in rest[..reach].iter_mut().zip(&self.a[k * w + 1..]) {
                *y -= l * x;
            }
            done[k] = x * self.a[k * w];
        }
        for k in (0..self.n).rev() {
            let reach = self.half.min(self.n - 1 - k);
            b[k] -= dot(&self.a[k * w + 1..=k * w + reach], &b[k + 1..=k + reach]);
        }
    }

    /// Solves `A X = B` in place for several right-hand sides, one after the other in `b`; `work` is overwritten.
    ///
    /// # Panics
    /// As [`SymmetricBanded::solve`].
    pub fn solve_block(&self, b: &mut [f64], work: &mut Vec<[f64; BLOCK]>) {
        assert!(self.factored, "solve before factor");
        let (n, w) = (self.n, self.half + 1);
        work.resize(n, [0.0; BLOCK]);
        for group in b.chunks_mut(BLOCK * n) {
            if group.len() == n {
                self.solve(group);
                continue;
            }
            for (c, column) in group.chunks_exact(n).enumerate() {
                work.iter_mut().zip(column).for_each(|(x, b)| x[c] = *b);
            }
            for k in 0..n {
                let reach = self.half.min(n - 1 - k);
                let (done, rest) = work.split_at_mut(k + 1);
                let own = done[k];
                for (y, l) in rest[..reach].iter_mut().zip(&self.a[k * w + 1..]) {
                    for c in 0..BLOCK {
                        y[c] -= l * own[c];
                    }
                }
                done[k] = own.map(|x| x * self.a[k * w]);
            }
            for k in (0..n).rev() {
                let reach = self.half.min(n - 1 - k);
                let mut sum = [0.0; BLOCK];
                for (x, l) in work[k + 1..=k + reach].iter().zip(&self.a[k * w + 1..]) {
                    for c in 0..BLOCK {
                        sum[c] += l * x[c];
                    }
                }
                for c in 0..BLOCK {
                    work[k][c] -= sum[c];
                }
            }
            for (c, column) in group.chunks_exact_mut(n).enumerate() {
                column.iter_mut().zip(&*work).for_each(|(b, x)| *b = x[c]);
            }
        }
    }
}
