//! Small dense, banded and tridiagonal linear systems. Matrices are row-major slices.
//!
//! Factorisations are in place and allocate nothing; a singular matrix is an error, never a NaN in the solution.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The matrix is singular to working precision, or holds a non-finite number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("singular matrix: no usable pivot in column {column}")]
pub struct Singular {
    /// The column (counted from 0) in which elimination stopped.
    pub column: usize,
}

/// A complex number, just enough of one for the linear algebra here.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// `re + i im`.
    #[inline]
    #[must_use]
    pub const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// `|re| + |im|`: within √2 of the modulus, enough to choose a pivot.
    #[inline]
    #[must_use]
    pub fn norm1(self) -> f64 {
        self.re.abs() + self.im.abs()
    }

    /// The modulus.
    #[inline]
    #[must_use]
    pub fn abs(self) -> f64 {
        self.re.hypot(self.im)
    }
}

impl Add for Complex {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Self::new(self.re + o.re, self.im + o.im)
    }
}

impl Sub for Complex {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self::new(self.re - o.re, self.im - o.im)
    }
}

impl Mul for Complex {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        Self::new(self.re * o.re - self.im * o.im, self.re * o.im + self.im * o.re)
    }
}

impl Neg for Complex {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self::new(-self.re, -self.im)
    }
}

impl Div for Complex {
    type Output = Self;
    /// Smith's division: no overflow unless the quotient itself overflows.
    #[inline]
    fn div(self, o: Self) -> Self {
        if o.re.abs() >= o.im.abs() {
            let r = o.im / o.re;
            let d = o.re + o.im * r;
            Self::new((self.re + self.im * r) / d, (self.im - self.re * r) / d)
        } else {
            let r = o.re / o.im;
            let d = o.re * r + o.im;
            Self::new((self.re * r + self.im) / d, (self.im * r - self.re) / d)
        }
    }
}

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
        done[0] /= a[k * n + k];
        let x = done[0];
        for (row, b) in a.chunks_exact(n).zip(rest) {
            *b -= row[k] * x;
        }
    }
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

/// [`lu_factor_weighted`] for a complex matrix.
///
/// # Errors
/// [`Singular`] when a column has no finite non-zero pivot.
pub fn lu_factor_complex(
    a: &mut [Complex],
    n: usize,
    piv: &mut [usize],
    mut weights: Option<&mut [f64]>,
) -> Result<(), Singular> {
    assert!(a.len() >= n * n && piv.len() >= n, "work arrays shorter than the matrix");
    for k in 0..n {
        let mut best = k;
        let mut best_size = -1.0;
        for i in k..n {
            let w = weights.as_ref().map_or(1.0, |w| w[i]);
            let size = a[i * n + k].norm1() * w;
            if size > best_size {
                best_size = size;
                best = i;
            }
        }
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
        let inv = Complex::new(1.0, 0.0) / top[k * n + k];
        for row in bottom[..(n - k - 1) * n].chunks_exact_mut(n) {
            let l = row[k] * inv;
            row[k] = l;
            if l != Complex::default() {
                for (x, p) in row[k + 1..].iter_mut().zip(pivot_row) {
                    *x = *x - l * *p;
                }
            }
        }
    }
    Ok(())
}

/// Solves `A x = b` in place with the factors of [`lu_factor_complex`].
pub fn lu_solve_complex(a: &[Complex], n: usize, piv: &[usize], b: &mut [Complex]) {
    for (k, &p) in piv[..n].iter().enumerate() {
        b.swap(k, p);
    }
    for i in 1..n {
        let mut s = b[i];
        for j in 0..i {
            s = s - a[i * n + j] * b[j];
        }
        b[i] = s;
    }
    for i in (0..n).rev() {
        let mut s = b[i];
        for j in i + 1..n {
            s = s - a[i * n + j] * b[j];
        }
        b[i] = s / a[i * n + i];
    }
}

/// Solves a tridiagonal system in place by elimination without pivoting (Thomas), for diagonally dominant matrices.
///
/// `lower[i]` multiplies `x[i-1]` in row i (`lower[0]` unused), `upper[i]` multiplies `x[i+1]` (`upper[n-1]` unused).
/// `rhs` becomes the solution, `work` (length n) is overwritten.
///
/// # Errors
/// [`Singular`] when a pivot is zero or not finite; use [`Banded`] when the matrix is not diagonally dominant.
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

/// A symmetric positive definite banded matrix, factorised as `L D Lᵀ` without pivoting: half the storage and a quarter of the work of
/// [`Banded`].
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
