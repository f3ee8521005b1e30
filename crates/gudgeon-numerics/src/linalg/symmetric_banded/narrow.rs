//! Bands of a width that is known when the program is built: what a row takes of the rows before it is summed in registers.
//!
//! Rows stand one after the other, each with its diagonal, its band and zeros that whole groups of [`LANES`] reach into, with as many rows of zeros before the
//! first one as the band is wide. One row further and one entry back is the same column: the entries that meet one row of the matrix are found by a
//! step of fixed length.

use super::{BLOCK, Singular};
use crate::vectors::{Vectorised, widest};

/// Entries of a row that are found together; widths are multiples of it.
pub(super) const LANES: usize = 8;

/// Entries of a row of a band that is `width` wide.
pub(super) const fn stride(width: usize) -> usize {
    width + 1 + LANES
}

/// Factorises a band of width `W`; `S` is its [`stride`]. Every row is left with the inverse of its pivot and its part of `L`; `pivots` takes
/// the pivots, behind as many zeros as there are rows of zeros.
pub(super) fn factor<const W: usize, const S: usize>(
    rows: &mut [[f64; S]],
    pivots: &mut [f64],
) -> Result<(), Singular> {
    widest(Factor::<W, S> { rows, pivots })
}

/// Solves for [`BLOCK`] right-hand sides side by side with the rows of [`factor`], `W` of zeros before the first and after the last one.
pub(super) fn solve_block<const W: usize, const S: usize>(rows: &[[f64; S]], x: &mut [[f64; BLOCK]]) {
    widest(SolveBlock::<W, S> { rows, x });
}

/// The same for one right-hand side.
pub(super) fn solve<const W: usize, const S: usize>(rows: &[[f64; S]], x: &mut [f64]) {
    widest(Solve::<W, S> { rows, x });
}

struct Factor<'a, const W: usize, const S: usize> {
    rows: &'a mut [[f64; S]],
    pivots: &'a mut [f64],
}

impl<const W: usize, const S: usize> Vectorised for Factor<'_, W, S> {
    type Output = Result<(), Singular>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { rows, pivots } = self;
        for k in 0..rows.len().min(pivots.len()).saturating_sub(W) {
            let ((before, rest), (past, here)) = (rows.split_at_mut(k + W), pivots.split_at_mut(k + W));
            let (Some(before), Some(past)) = (before.last_chunk::<W>(), past.last_chunk::<W>()) else {
                break;
            };
            let (Some(own), Some(here)) = (rest.first_mut(), here.first_mut()) else { break };
            let (mut taken, mut pivot) = ([0.0; W], own[0]);
            for i in 0..W {
                let l = before[i][W - i];
                taken[i] = l * past[i];
                pivot -= taken[i] * l;
            }
            if !(pivot > 0.0 && pivot < f64::INFINITY) {
                return Err(Singular { column: k });
            }
            let inverse = 1.0 / pivot;
            (*here, own[0]) = (pivot, inverse);
            for first in (0..W).step_by(LANES) {
                let Some(block) = own[1 + first..].first_chunk_mut::<LANES>() else { break };
                let mut sum = *block;
                // Rows further before end in front of these entries.
                for i in 0..W - first {
                    let Some(l) = before[first + i][W + 1 - i..].first_chunk::<LANES>() else { break };
                    for c in 0..LANES {
                        sum[c] -= taken[first + i] * l[c];
                    }
                }
                for c in 0..LANES {
                    block[c] = sum[c] * inverse;
                }
            }
        }
        Ok(())
    }
}

struct SolveBlock<'a, const W: usize, const S: usize> {
    rows: &'a [[f64; S]],
    x: &'a mut [[f64; BLOCK]],
}

impl<const W: usize, const S: usize> Vectorised for SolveBlock<'_, W, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { rows, x } = self;
        let n = rows.len().saturating_sub(W);
        for k in 0..n {
            let (before, rest) = x.split_at_mut(k + W);
            let (Some(before), Some(own)) = (before.last_chunk::<W>(), rest.first_mut()) else { break };
            let Some(rows) = rows[k..].first_chunk::<W>() else { break };
            let mut sum = *own;
            for i in 0..W {
                for c in 0..BLOCK {
                    sum[c] -= rows[i][W - i] * before[i][c];
                }
            }
            *own = sum;
        }
        for k in (0..n).rev() {
            let (own, after) = x.split_at_mut(k + W + 1);
            let (Some(own), Some(after)) = (own.last_mut(), after.first_chunk::<W>()) else { break };
            let row = &rows[k + W];
            let mut sum = *own;
            for c in 0..BLOCK {
                sum[c] *= row[0];
            }
            // What was found last comes last: the others do not wait for it.
            for i in (0..W).rev() {
                for c in 0..BLOCK {
                    sum[c] -= row[1 + i] * after[i][c];
                }
            }
            *own = sum;
        }
    }
}

struct Solve<'a, const W: usize, const S: usize> {
    rows: &'a [[f64; S]],
    x: &'a mut [f64],
}

impl<const W: usize, const S: usize> Vectorised for Solve<'_, W, S> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { rows, x } = self;
        let n = rows.len().saturating_sub(W);
        for k in 0..n {
            let (done, rest) = x.split_at_mut(k + W + 1);
            let (Some(own), Some(rest)) = (done.last(), rest.first_chunk_mut::<W>()) else { break };
            let row = &rows[k + W];
            for i in 0..W {
                rest[i] -= row[1 + i] * own;
            }
        }
        for k in (0..n).rev() {
            let (own, after) = x.split_at_mut(k + W + 1);
            let (Some(own), Some(after)) = (own.last_mut(), after.first_chunk::<W>()) else { break };
            let row = &rows[k + W];
            let mut sum = [0.0; LANES];
            for first in (0..W).step_by(LANES) {
                for c in 0..LANES {
                    sum[c] += row[1 + first + c] * after[first + c];
                }
            }
            let half = [sum[0] + sum[4], sum[1] + sum[5], sum[2] + sum[6], sum[3] + sum[7]];
            *own = *own * row[0] - ((half[0] + half[1]) + (half[2] + half[3]));
        }
    }
}
