//! A positive function that falls over many powers of ten, as a cubic of its logarithm.

use gudgeon_numerics::elementary;
use gudgeon_numerics::quadrature::GaussLegendre;

use crate::summits::FADED;

/// Where the table begins: summits pressed eight of their deviations deep.
const FROM: f64 = -8.0;
/// Rows for each unit of distance, a power of two so that their places are exact. The logarithm of a Gaussian's tail is nearly a parabola, and what a cubic
/// misses of the rest is below 1e-6 of the value.
const PER_UNIT: f64 = 8.0;
/// Rows.
const ROWS: usize = ((FADED - FROM) * PER_UNIT) as usize + 1;
/// Distance beyond which `exp(-s²/2)` is below 1e-22 of what it is at zero.
const TAIL: f64 = 10.5;
/// Longest piece of the integral: on it ten nodes give a Gaussian to rounding.
const PIECE: f64 = 0.5;

/// `G(d) = (2π)^(-1/2) ∫_0^∞ g(t) exp(-(d + t)²/2) dt`, what summits of Gaussian heights do together where one does `g(t)` at the overlap `t`, all lengths in
/// deviations of the heights; zero from `d` = 10 on, straight on below -8.
#[derive(Debug)]
pub struct LogTable {
    /// `ln G` and its derivative over the length of a row, at each row.
    rows: Vec<[f64; 2]>,
}

impl LogTable {
    /// The integral of `g`, which is zero at zero, rises, and is smooth but for `kinks`, ascending.
    pub fn new(kinks: &[f64], g: impl Fn(f64) -> f64) -> Self {
        let nodes = nodes(kinks, TAIL - FROM, g);
        let row = |k: usize| {
            let d = FROM + k as f64 / PER_UNIT;
            let (mut value, mut slope) = (0.0, 0.0);
            for (t, w) in &nodes {
                let s = d + t;
                let part = w * elementary::exp(-0.5 * s * s);
                value += part;
                slope -= s * part;
            }
            [elementary::ln(value), slope / (value * PER_UNIT)]
        };
        Self { rows: (0..ROWS).map(row).collect() }
    }

    /// `G(d)`.
    pub fn value(&self, d: f64) -> f64 {
        let x = (d - FROM) * PER_UNIT;
        if x < 0.0 {
            let [y, slope] = self.rows[0];
            return elementary::exp(y) * (1.0 + slope * x);
        }
        let k = x as usize;
        let Some([[y0, s0], [y1, s1]]) =
            self.rows.get(k..k + 2).and_then(|r| <[[f64; 2]; 2]>::try_from(r).ok())
        else {
            return 0.0;
        };
        let t = x - k as f64;
        let rise = y1 - y0;
        elementary::exp(y0 + t * (s0 + t * (3.0 * rise - 2.0 * s0 - s1 + t * (s0 + s1 - 2.0 * rise))))
    }
}

/// Places `t` and weights of `(2π)^(-1/2) ∫_0^to g(t) … dt`, by Gauss's rule on pieces that end at the kinks.
fn nodes(kinks: &[f64], to: f64, g: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let rule = GaussLegendre::new(10);
    let mut out = Vec::new();
    let mut from = 0.0;
    for end in kinks.iter().copied().filter(|k| *k < to).chain([to]) {
        let pieces = ((end - from) / PIECE).ceil();
        for k in 0..pieces as usize {
            let [a, b] = [k, k + 1].map(|k| from + (end - from) * k as f64 / pieces);
            // What begins like a root is smooth over the square root of the overlap.
            let (a, b) = (a.sqrt(), b.sqrt());
            for (x, w) in rule.nodes().iter().zip(rule.weights()) {
                let u = 0.5 * (a + b + (b - a) * x);
                out.push((u * u, w * (b - a) * u * g(u * u) / std::f64::consts::TAU.sqrt()));
            }
        }
        from = end;
    }
    out
}
