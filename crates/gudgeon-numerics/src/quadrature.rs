//! Numerical integration: Gauss–Legendre rules, and an adaptive Gauss–Kronrod integrator for tests and construction.

use crate::elementary;

/// Gauss–Legendre rule of `n` nodes on `[-1, 1]`: exact for polynomials up to degree `2 n - 1`.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussLegendre {
    nodes: Vec<f64>,
    weights: Vec<f64>,
}

impl GaussLegendre {
    /// The rule with `n` nodes (at least 1).
    ///
    /// Nodes by Newton's method on the Legendre polynomial, from the asymptotic estimate cos(π (i - 1/4)/(n + 1/2)).
    #[must_use]
    pub fn new(n: usize) -> Self {
        let n = n.max(1);
        let mut nodes = vec![0.0; n];
        let mut weights = vec![2.0; n];
        for i in 0..n.div_ceil(2) {
            let mut x = elementary::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            if 2 * i + 1 == n {
                x = 0.0;
            }
            let mut derivative = 1.0;
            // Converges quadratically from 1e-2 or better: four steps reach rounding.
            for _ in 0..6 {
                let (mut p0, mut p1) = (1.0, x);
                for k in 2..=n {
                    let k = k as f64;
                    (p0, p1) = (p1, ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k);
                }
                derivative = n as f64 * (p0 - x * p1) / (1.0 - x * x);
                x -= p1 / derivative;
            }
            let w = 2.0 / ((1.0 - x * x) * derivative * derivative);
            (nodes[i], nodes[n - 1 - i]) = (-x, x);
            (weights[i], weights[n - 1 - i]) = (w, w);
        }
        Self { nodes, weights }
    }

    /// Nodes on `[-1, 1]`, ascending.
    #[must_use]
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Weights; their sum is 2.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// `∫_a^b f(x) dx` by this rule.
    pub fn integrate(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
        half * self.nodes.iter().zip(&self.weights).map(|(x, w)| w * f(mid + half * x)).sum::<f64>()
    }
}

/// An integral that was not reached.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum QuadratureError {
    /// The integrand is not finite.
    #[error("the integrand is not finite near {x}")]
    NotFinite {
        /// Middle of the interval.
        x: f64,
    },
    /// The error estimate stays above the tolerance.
    #[error("no convergence: {value} with an estimated error of {error}")]
    NoConvergence {
        /// Best value.
        value: f64,
        /// Estimated absolute error.
        error: f64,
    },
}

/// Nodes of the 15-point Kronrod rule in (0, 1], descending; every second one belongs to the 7-point Gauss rule.
const XK: [f64; 7] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
];
const WK: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_83,
];
const WG: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_64, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

fn kronrod(f: &mut impl FnMut(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
    let centre = f(mid);
    let (mut k, mut g) = (WK[7] * centre, WG[3] * centre);
    for i in 0..7 {
        let s = f(mid - half * XK[i]) + f(mid + half * XK[i]);
        k += WK[i] * s;
        if i % 2 == 1 {
            g += WG[i / 2] * s;
        }
    }
    (half * k, (half * (k - g)).abs())
}

/// `∫_a^b f(x) dx` by globally adaptive Gauss–Kronrod 7–15, to `max(abs_tol, rel_tol |result|)`.
///
/// The error estimate is the difference of the two rules, pessimistic by many digits for smooth integrands. Allocates: not for hot
/// calls.
///
/// # Errors
/// [`QuadratureError`] when the integrand is not finite, or 2000 bisections are not enough.
pub fn integrate_adaptive(
    mut f: impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    abs_tol: f64,
    rel_tol: f64,
) -> Result<f64, QuadratureError> {
    // Intervals with value and error, in order of creation: sums are deterministic.
    let mut parts = Vec::new();
    let mut add = |parts: &mut Vec<(f64, f64, f64, f64)>, a: f64, b: f64| {
        let (v, e) = kronrod(&mut f, a, b);
        parts.push((a, b, v, e));
        if v.is_finite() { Ok(()) } else { Err(QuadratureError::NotFinite { x: 0.5 * (a + b) }) }
    };
    add(&mut parts, a, b)?;
    for _ in 0..2000 {
        let value: f64 = parts.iter().map(|p| p.2).sum();
        let error: f64 = parts.iter().map(|p| p.3).sum();
        // Below rounding of the terms no refinement helps.
        let floor = 4.0 * f64::EPSILON * parts.iter().map(|p| p.2.abs()).sum::<f64>();
        if error <= abs_tol.max(rel_tol * value.abs()).max(floor) {
            return Ok(value);
        }
        let largest = (0..parts.len()).max_by(|i, j| parts[*i].3.total_cmp(&parts[*j].3)).unwrap_or(0);
        let (a, b, _, _) = parts.swap_remove(largest);
        let mid = 0.5 * (a + b);
        add(&mut parts, a, mid)?;
        add(&mut parts, mid, b)?;
    }
    let value = parts.iter().map(|p| p.2).sum();
    Err(QuadratureError::NoConvergence { value, error: parts.iter().map(|p| p.3).sum() })
}
