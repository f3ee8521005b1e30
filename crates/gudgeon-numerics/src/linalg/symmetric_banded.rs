//! Symmetric positive definite banded matrices.

use super::Singular;

mod narrow;
mod wide;

use narrow::LANES;
use wide::PANEL;

/// A symmetric positive definite banded matrix, factorised as `L D Lᵀ` without pivoting: half the storage of [`super::Banded`], and a quarter of the work or less.
#[derive(Debug, Clone)]
pub struct SymmetricBanded {
    n: usize,
    half: usize,
    /// Rows of zeros before the first one, as many as a narrow band is wide; none in a wide one.
    lead: usize,
    stride: usize,
    /// Row i holds the entries of columns i to i + half.
    a: Vec<f64>,
    /// Pivots of a narrow band, rows of a panel of a wide one.
    work: Vec<f64>,
    /// One right-hand side, and several side by side.
    one: Vec<f64>,
    block: Vec<[f64; BLOCK]>,
    factored: bool,
}

/// Right-hand sides that [`SymmetricBanded::solve_block`] solves for at once.
pub const BLOCK: usize = 4;
/// Widest band with a program of its own.
const NARROW: usize = 32;

/// Calls a function of the module `narrow` for a band that is `$width` wide.
macro_rules! narrow {
    ($width:expr, $call:ident($rows:expr, $rest:expr)) => {
        match $width {
            8 => narrow::$call::<8, { narrow::stride(8) }>($rows.0, $rest),
            16 => narrow::$call::<16, { narrow::stride(16) }>($rows.0, $rest),
            24 => narrow::$call::<24, { narrow::stride(24) }>($rows.0, $rest),
            _ => narrow::$call::<32, { narrow::stride(32) }>($rows.0, $rest),
        }
    };
}

impl SymmetricBanded {
    /// A zero matrix of size `n` with `half` sub-diagonals.
    #[must_use]
    pub fn new(n: usize, half: usize) -> Self {
        let width = half.max(1).next_multiple_of(LANES);
        let (lead, stride, work) = if width <= NARROW {
            (width, narrow::stride(width), width + n)
        } else {
            (0, half + 1, PANEL * (half + PANEL))
        };
        Self {
            n,
            half,
            lead,
            stride,
            a: vec![0.0; (lead + n) * stride],
            work: vec![0.0; work],
            one: vec![0.0; n + 2 * lead],
            block: vec![[0.0; BLOCK]; n + 2 * lead],
            factored: false,
        }
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
        self.factored = false;
        self.a[(self.lead + j) * self.stride + i - j] += value;
    }

    /// Sets the entries `(i, i)`, and all others to zero.
    pub fn write_diagonal(&mut self, values: impl Iterator<Item = f64>) {
        self.factored = false;
        let rows = self.a[self.lead * self.stride..].chunks_exact_mut(self.stride);
        for (row, value) in rows.zip(values) {
            if self.lead > 0 {
                row[1..=self.lead].as_chunks_mut::<LANES>().0.fill([0.0; LANES]);
            } else {
                row.fill(0.0);
            }
            row[0] = value;
        }
    }

    /// Sets entry `(i, i + further)` and its mirror image, `further` being no more than the sub-diagonals.
    ///
    /// # Panics
    /// When there is no such entry.
    #[inline]
    pub fn couple(&mut self, i: usize, further: usize, value: f64) {
        self.factored = false;
        self.a[(self.lead + i) * self.stride..][..=self.half][further] = value;
    }

    /// Factorisation in place.
    ///
    /// # Errors
    /// [`Singular`] when the matrix is not positive definite.
    pub fn factor(&mut self) -> Result<(), Singular> {
        let outcome = if self.lead > 0 {
            narrow!(self.lead, factor(self.a.as_chunks_mut(), &mut self.work))
        } else {
            wide::factor(&mut self.a, self.stride, &mut self.work)
        };
        if outcome.is_err() {
            // What stands behind the rows must stay zero, whatever was in them.
            self.clear();
        }
        self.factored = outcome.is_ok();
        outcome
    }

    /// Solves `A x = b` in place with the factors of [`SymmetricBanded::factor`].
    ///
    /// # Panics
    /// When the matrix was not factorised since it was last changed, or `b` has another length: mistakes of the program.
    pub fn solve(&mut self, b: &mut [f64]) {
        assert!(self.factored, "solve before factor");
        if self.lead == 0 {
            return wide::solve(&self.a, self.stride, b);
        }
        let own = self.lead..self.lead + self.n;
        self.one[own.clone()].copy_from_slice(b);
        self.one[own.end..].fill(0.0);
        narrow!(self.lead, solve(self.a.as_chunks(), &mut self.one));
        b.copy_from_slice(&self.one[own]);
    }

    /// Right-hand sides for [`SymmetricBanded::solve_block`], side by side, and then its solutions. Those of the call before stand in them.
    pub fn block(&mut self) -> &mut [[f64; BLOCK]] {
        &mut self.block[self.lead..self.lead + self.n]
    }

    /// Solves `A X = B` in place for the right-hand sides in [`SymmetricBanded::block`].
    ///
    /// # Panics
    /// As [`SymmetricBanded::solve`].
    pub fn solve_block(&mut self) {
        assert!(self.factored, "solve before factor");
        if self.lead == 0 {
            return wide::solve_block(&self.a, self.stride, &mut self.block);
        }
        narrow!(self.lead, solve_block(self.a.as_chunks(), &mut self.block));
    }
}
