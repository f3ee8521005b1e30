//! Average gap between rough surfaces whose heights are Gaussian.
//!
//! ```text
//! G(H) = ∫_{-H}^∞ (H + s) exp(-s²/2)/√(2π) ds = H/2 [1 + erf(H/√2)] + exp(-H²/2)/√(2π)
//! G' = ½ [1 + erf(H/√2)]         G'' = exp(-H²/2)/√(2π)
//! ```
//!
//! with the separation `H` of the mean planes in units of the composite roughness; where surfaces would overlap they touch, and the
//! gap is zero. Read from piecewise Taylor polynomials, which need no exponential and no error function.

use gudgeon_numerics::elementary;
use std::sync::LazyLock;

/// `G` is below 1e-16 of its value at zero separation under `-REACH`, and `H` itself to rounding above `REACH`.
const REACH: f64 = 8.5;
/// Pieces per unit of `H`, a power of two so that their ends are exact.
const PER_UNIT: f64 = 8.0;
/// Taylor coefficients per piece. Half a piece is 1/16; the first neglected term is at most `(H/16)^12/12!` of the value: 1e-18
/// near zero, 3e-12 at -8.5.
const TERMS: usize = 12;

static PIECES: LazyLock<Vec<[f64; TERMS]>> = LazyLock::new(|| {
    let count = (2.0 * REACH * PER_UNIT) as usize;
    (0..count).map(|i| taylor(-REACH + (i as f64 + 0.5) / PER_UNIT)).collect()
});

/// Coefficients about `c`.
fn taylor(c: f64) -> [f64; TERMS] {
    let density = elementary::exp(-0.5 * c * c) / std::f64::consts::TAU.sqrt();
    let (value, slope) = if c > -2.0 {
        // Φ = ½ + φ Σ c^(2k+1)/(2k+1)!!; terms of one sign, or small ones.
        let (mut term, mut sum) = (c, 0.0);
        let mut k = 1.0;
        while f64::abs(term) > 1e-18 * f64::abs(sum) && k < 500.0 {
            sum += term;
            k += 2.0;
            term *= c * c / k;
        }
        let slope = 0.5 + density * sum;
        (c * slope + density, slope)
    } else {
        // Φ(c) = φ R(-c) with Mills' ratio R = 1/(x + 1/(x + 2/(x + ...))), and G = φ (1 - x R) without cancelling:
        // 1 - x R = R (1/R - x) = R/(x + 2/(x + 3/(x + ...))).
        let x = -c;
        let tail = (2..400).rev().fold(x, |t, k| x + f64::from(k) / t);
        let ratio = 1.0 / (x + 1.0 / tail);
        (density * ratio / tail, density * ratio)
    };
    let mut a = [0.0; TERMS];
    (a[0], a[1], a[2]) = (value, slope, 0.5 * density);
    // φ' = -H φ about c, for d_k = k! times the coefficient of φ: (k+1) b_(k+1) = -c b_k - b_(k-1), b = Taylor of φ.
    let (mut before, mut b) = (0.0, density);
    for k in 0..TERMS - 3 {
        let kf = k as f64;
        (before, b) = (b, -(c * b + before) / (kf + 1.0));
        a[k + 3] = b / ((kf + 2.0) * (kf + 3.0));
    }
    a
}

/// The table, to be taken once per slice.
#[derive(Debug, Clone, Copy)]
pub struct GaussianGap {
    pieces: &'static [[f64; TERMS]],
}

impl Default for GaussianGap {
    fn default() -> Self {
        Self::new()
    }
}

impl GaussianGap {
    /// The table, computed once in a program.
    pub fn new() -> Self {
        Self { pieces: &PIECES }
    }

    /// `G(H)` and `G'(H)`. Absolute error below 1e-15 and 2e-15; `G` to 1e-11 of itself down to `H = -8.5`, zero below.
    #[inline]
    pub fn at(&self, gap: f64) -> (f64, f64) {
        let u = (gap + REACH) * PER_UNIT;
        if u < 0.0 {
            return (0.0, 0.0);
        }
        // A saturating cast: beyond the table no piece is found. To 32 bits it is the cheapest one.
        let i = u as u32;
        self.pieces.get(i as usize).map_or((gap, 1.0), |a| {
            let x = (u - f64::from(i) - 0.5) / PER_UNIT;
            let (mut value, mut slope) = (a[TERMS - 1], 0.0);
            for &c in a[..TERMS - 1].iter().rev() {
                slope = slope * x + value;
                value = value * x + c;
            }
            (value, slope)
        })
    }
}
