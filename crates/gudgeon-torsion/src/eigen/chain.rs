//! Natural frequencies of chains by the root-free QL method.

use gudgeon_core::EvalError;
use gudgeon_numerics::elementary;

/// Iterations per eigenvalue; the method needs about two.
const ITERATIONS: usize = 60;

/// Squared frequencies of a chain by the differences of its shafts: the matrix `k_i (1/J_i + 1/J_{i+1})` with `√(k_i k_{i+1})/J_{i+1}`
/// beside the diagonal has the eigenvalues of the line without the rigid mode. By the root-free QL method (reinsch1973); errors are of
/// the order of rounding times the largest value. `a`, `b` are the work arrays, `a` receives the values in no order.
pub(super) fn chain_values(
    inertia: &[f64],
    k: &[f64],
    a: &mut [f64],
    b: &mut [f64],
) -> Result<(), EvalError> {
    let m = k.len();
    for i in 0..m {
        a[i] = k[i] * (1.0 / inertia[i] + 1.0 / inertia[i + 1]);
        // Squares of the off-diagonal, b[i] between i and i + 1.
        b[i] = if i + 1 < m { k[i] * k[i + 1] / (inertia[i + 1] * inertia[i + 1]) } else { 0.0 };
    }
    for l in 0..m {
        let mut iterations = 0;
        loop {
            let end = block_end(a, b, l);
            if end == l {
                break;
            }
            iterations += 1;
            if iterations > ITERATIONS {
                return Err(EvalError::fatal("eigenvalues", "the QL iteration does not converge"));
            }
            sweep(a, b, l, end);
        }
    }
    Ok(())
}

/// Last row of the unreduced block that starts at `l`.
fn block_end(a: &[f64], b: &[f64], l: usize) -> usize {
    let mut end = l;
    while end + 1 < a.len() {
        let size = a[end].abs() + a[end + 1].abs();
        if b[end] <= (f64::EPSILON * size) * (f64::EPSILON * size) {
            break;
        }
        end += 1;
    }
    end
}

/// One implicit sweep on squares (Pal, Walker and Kahan), with the shift from the leading 2 x 2 block.
fn sweep(a: &mut [f64], b: &mut [f64], l: usize, end: usize) {
    let g = b[l].sqrt();
    let x = (a[l + 1] - a[l]) / (2.0 * g);
    let r = elementary::hypot(x, 1.0);
    let sigma = a[l] - g / (x + r.copysign(x));
    let (mut c, mut s) = (1.0, 0.0);
    let mut gamma = a[end] - sigma;
    let mut p = gamma * gamma;
    for i in (l..end).rev() {
        let bb = b[i];
        let r = p + bb;
        if i + 1 < end {
            b[i + 1] = s * r;
        }
        let old = c;
        c = p / r;
        s = bb / r;
        let old_gamma = gamma;
        let alpha = a[i];
        gamma = c * (alpha - sigma) - s * old_gamma;
        a[i + 1] = old_gamma + (alpha - gamma);
        p = if c == 0.0 { old * bb } else { gamma * gamma / c };
    }
    b[l] = s * p;
    a[l] = sigma + gamma;
}
