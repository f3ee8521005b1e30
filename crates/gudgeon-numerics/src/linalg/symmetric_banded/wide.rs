//! Bands of any width: pivots are eliminated in panels.

use super::super::dot;
use super::{BLOCK, Singular};

/// Pivots that are eliminated together: what follows them is read and written once for all of them.
pub(super) const PANEL: usize = 4;

/// Factorises the matrix whose rows of `w` entries stand in `a`; `panel` holds [`PANEL`] times `w + PANEL - 1` values, zeros behind its rows.
pub(super) fn factor(a: &mut [f64], w: usize, panel: &mut [f64]) -> Result<(), Singular> {
    let (n, half, wide) = (a.len() / w, w - 1, w + PANEL - 1);
    for k in (0..n).step_by(PANEL) {
        let count = PANEL.min(n - k);
        let (done, rest) = a.split_at_mut((k + count) * w);
        let mut inverse = [0.0; PANEL];
        for p in 0..count {
            let (before, own) = done.split_at_mut((k + p) * w);
            let own = &mut own[..w];
            for (q, inverse) in inverse.iter().enumerate().take(p) {
                let m = p - q;
                if m <= half {
                    let pivot = &before[(k + q) * w..][..w];
                    let l = pivot[m] * inverse;
                    own[..w - m].iter_mut().zip(&pivot[m..]).for_each(|(x, p)| *x -= l * p);
                }
            }
            if !(own[0] > 0.0 && own[0] < f64::INFINITY) {
                return Err(Singular { column: k + p });
            }
            inverse[p] = 1.0 / own[0];
            panel[p * wide..][..w].copy_from_slice(own);
        }
        let (u, more) = panel.split_at(wide);
        let (v, more) = more.split_at(wide);
        let (x, y) = more.split_at(wide);
        for (r, row) in rest.chunks_exact_mut(w).enumerate().take(half) {
            // The panel is full whenever rows follow it.
            let m = r + 1;
            let l = [u[m + 3] * inverse[0], v[m + 2] * inverse[1], x[m + 1] * inverse[2], y[m] * inverse[3]];
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
    Ok(())
}

/// Solves for one right-hand side with the rows of [`factor`].
pub(super) fn solve(a: &[f64], w: usize, b: &mut [f64]) {
    let n = b.len();
    let reach = |k: usize| (w - 1).min(n - 1 - k);
    for (k, row) in a.chunks_exact(w).enumerate() {
        let (done, rest) = b.split_at_mut(k + 1);
        let x = done[k];
        rest[..reach(k)].iter_mut().zip(&row[1..]).for_each(|(y, l)| *y -= l * x);
        done[k] = x * row[0];
    }
    for (k, row) in a.chunks_exact(w).enumerate().rev() {
        let reach = reach(k);
        b[k] -= dot(&row[1..=reach], &b[k + 1..=k + reach]);
    }
}

/// The same for [`BLOCK`] of them side by side.
pub(super) fn solve_block(a: &[f64], w: usize, b: &mut [[f64; BLOCK]]) {
    let n = b.len();
    let reach = |k: usize| (w - 1).min(n - 1 - k);
    for (k, row) in a.chunks_exact(w).enumerate() {
        let (done, rest) = b.split_at_mut(k + 1);
        let own = done[k];
        for (y, l) in rest[..reach(k)].iter_mut().zip(&row[1..]) {
            for c in 0..BLOCK {
                y[c] -= l * own[c];
            }
        }
        done[k] = own.map(|x| x * row[0]);
    }
    for (k, row) in a.chunks_exact(w).enumerate().rev() {
        let (own, after) = b.split_at_mut(k + 1);
        let mut sum = own[k];
        for (x, l) in after[..reach(k)].iter().zip(&row[1..]).rev() {
            for c in 0..BLOCK {
                sum[c] -= l * x[c];
            }
        }
        own[k] = sum;
    }
}
