//! Undamped natural frequencies.

use gudgeon_core::EvalError;

use super::chain::chain_values;
use super::rigid::rigid_modes;
use crate::tree::Tree;

/// Undamped natural frequencies ω \[rad/s\], ascending, at most `max_modes` of them, those of the rigid modes exactly zero.
///
/// Chains: root-free QL on the shafts' differences. Values far below the largest, and all values of branched or held lines, come
/// from bisection by counts of negative pivots, to the last digit (see [`crate::tree`]).
///
/// # Errors
/// No convergence (Fatal).
pub fn natural_frequencies(tree: &Tree, max_modes: usize) -> Result<Vec<f64>, EvalError> {
    let n = tree.len();
    // A chain that turns freely, without inertias of zero, rigid links and links of fluid alone: one rigid mode.
    let plain = tree.chain
        && n > 1
        && !tree.is_grounded()
        && tree.inertia.iter().all(|j| *j > 0.0)
        && tree.k[..n - 1].iter().all(|k| k.is_finite() && *k > 0.0);
    let mut squares;
    if plain {
        // The zero, the values, and room for the off-diagonal.
        squares = vec![0.0; 2 * n - 1];
        let (a, b) = squares[1..].split_at_mut(n - 1);
        chain_values(&tree.inertia, &tree.k[..n - 1], a, b)?;
        a.sort_unstable_by(f64::total_cmp);
        let top = a[n - 2];
        squares.truncate(max_modes.min(n));
        refine(tree, &mut squares, 10.0 * f64::EPSILON * top);
    } else {
        let mut s = vec![0.0; n];
        // Every inertia that moves by itself has a mode.
        let rigid = rigid_modes(tree);
        let all = tree.count_below(f64::MAX.sqrt(), &mut s).max(rigid);
        squares = vec![0.0; all.min(max_modes)];
        let upto = squares.len();
        bisect(tree, rigid, upto, &mut squares);
    }
    Ok(squares.iter().map(|v| v.sqrt()).collect())
}

/// Takes the error `bound` of the values of a chain out of those it matters for.
fn refine(tree: &Tree, squares: &mut [f64], bound: f64) {
    for k in 1..squares.len() {
        let v = squares[k];
        // Half of this is the relative error of the frequency.
        if v > bound * 1e12 {
            break;
        }
        let above = squares.get(k + 1).map_or(f64::INFINITY, |a| a - v);
        let gap = above.min(v - squares[k - 1]);
        let mut found = v;
        let mut good = gap > 1e4 * bound;
        for _ in 0..3 {
            if !good {
                break;
            }
            let step = tree.newton_step(found);
            if step.is_nan() || step.abs() > 10.0 * bound {
                good = false;
            } else {
                found += step;
                if step.abs() <= 1e-8 * found {
                    break;
                }
            }
        }
        if good {
            squares[k] = found;
        } else {
            bisect(tree, k, k + 1, squares);
        }
    }
}

/// Eigenvalues `from..to` by bisection.
fn bisect(tree: &Tree, from: usize, to: usize, squares: &mut [f64]) {
    let mut s = vec![0.0; tree.len()];
    if from >= to {
        return;
    }
    // Powers of two that enclose all that are wanted.
    let mut high = 1.0_f64;
    while tree.count_below(high, &mut s) < to && high < f64::MAX.sqrt() {
        high *= 1024.0;
    }
    let mut low = high;
    while tree.count_below(low, &mut s) > from && low > f64::MIN_POSITIVE.sqrt() {
        low /= 1024.0;
    }
    // Brackets are shared: a count narrows those of all eigenvalues still to come.
    let mut lows = vec![low; to];
    let mut highs = vec![high; to];
    for k in from..to {
        loop {
            let (a, b) = (lows[k], highs[k]);
            let middle = if b > 4.0 * a { (a * b).sqrt() } else { a + 0.5 * (b - a) };
            if middle <= a || middle >= b {
                break;
            }
            let count = tree.count_below(middle, &mut s);
            for j in k..to {
                if j < count {
                    highs[j] = highs[j].min(middle);
                } else {
                    lows[j] = lows[j].max(middle);
                }
                if j > count && lows[j] > middle {
                    break;
                }
            }
        }
        squares[k] = highs[k];
    }
}
