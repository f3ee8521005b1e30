//! Maximum and minimum over the cycle of a sum of orders.

use std::f64::consts::PI;

/// Points per wave of the highest order. A sum of waves bounded by A reaches at least `A cos(π/8)` at one of the points beside its
/// extreme (a lemma of M. Riesz: near an extreme it falls no faster than its highest wave of that amplitude would).
const POINTS: usize = 8;
/// `1 - cos(π/8)`: by this part of the amplitude a point may stand below the extreme beside it.
const MISSED: f64 = 0.076_120_467_488_713_25;
/// Tables up to this size are kept.
const KEPT: usize = 1 << 20;

/// Finds the extremes of `m + Σ Re(a_k e^{i n_k θ})` over a period of θ.
#[derive(Debug, Clone)]
pub struct Cycle {
    orders: Vec<f64>,
    period: f64,
    samples: usize,
    /// Orders as multiples of the order of the period; empty where they are none.
    multiples: Vec<usize>,
    /// Cosine and sine by order and point; empty where it would be too large.
    table: Vec<[f64; 2]>,
    wave: Vec<f64>,
}

impl Cycle {
    /// For some orders, and the period after which their sum repeats \[rad\].
    #[must_use]
    pub fn new(orders: &[f64], period: f64) -> Self {
        let highest = orders.iter().copied().fold(0.0, f64::max) * period / (2.0 * PI);
        let samples = (POINTS * highest.ceil() as usize).next_power_of_two().max(64);
        let mut own = Self {
            orders: orders.to_vec(),
            period,
            samples,
            multiples: multiples(orders, period),
            table: Vec::new(),
            wave: vec![0.0; samples],
        };
        if samples * orders.len() <= KEPT {
            own.table = orders.iter().flat_map(|o| own.row(*o)).collect();
        }
        own
    }

    /// The orders it was made for.
    #[must_use]
    pub fn orders(&self) -> &[f64] {
        &self.orders
    }

    fn row(&self, order: f64) -> Vec<[f64; 2]> {
        let turn = |s: usize| {
            let (sin, cos) = (order * self.period * s as f64 / self.samples as f64).sin_cos();
            [cos, sin]
        };
        (0..self.samples).map(turn).collect()
    }

    /// Maximum and minimum, for a mean and the phasors of the orders.
    pub fn extremes(&mut self, mean: f64, phasors: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
        let mut wave = std::mem::take(&mut self.wave);
        wave.fill(0.0);
        for k in 0..self.orders.len() {
            let [re, im] = phasors(k);
            if re == 0.0 && im == 0.0 {
                continue;
            }
            let own;
            let row = if self.table.is_empty() {
                own = self.row(self.orders[k]);
                &own[..]
            } else {
                &self.table[k * self.samples..(k + 1) * self.samples]
            };
            for (w, [cos, sin]) in wave.iter_mut().zip(row) {
                *w += re * cos - im * sin;
            }
        }
        let top = self.maximum(&wave, 1.0, &phasors);
        let bottom = -self.maximum(&wave, -1.0, &phasors);
        self.wave = wave;
        [mean + top, mean + bottom]
    }

    /// Maximum of `sign` times the wave.
    fn maximum(&self, wave: &[f64], sign: f64, phasors: &impl Fn(usize) -> [f64; 2]) -> f64 {
        let n = self.samples;
        let (high, low) = wave
            .iter()
            .fold((f64::NEG_INFINITY, f64::INFINITY), |(a, b), w| (a.max(sign * w), b.min(sign * w)));
        if high <= low {
            return high.max(0.0);
        }
        let threshold = high - MISSED * (high - low);
        let mut best = high;
        for s in 0..n {
            let (before, here, after) =
                (sign * wave[(s + n - 1) % n], sign * wave[s], sign * wave[(s + 1) % n]);
            if here >= threshold && here >= before && here > after {
                let curve = before - 2.0 * here + after;
                let shift = if curve < 0.0 { 0.5 * (before - after) / curve } else { 0.0 };
                best = best.max(self.climb(s as f64 + shift, sign, phasors));
            }
        }
        best
    }

    /// The top near the point `s`, by Newton's method on the derivative, at most one point away.
    fn climb(&self, s: f64, sign: f64, phasors: &impl Fn(usize) -> [f64; 2]) -> f64 {
        let step = self.period / self.samples as f64;
        let mut at = s * step;
        let (from, to) = (at - step, at + step);
        let mut best = f64::NEG_INFINITY;
        for _ in 0..20 {
            let (mut value, mut first, mut second) = (0.0, 0.0, 0.0);
            self.each_order(at, |k, o, sin, cos| {
                let [re, im] = phasors(k);
                let (x, y) = (re * cos - im * sin, re * sin + im * cos);
                value += sign * x;
                first -= sign * o * y;
                second -= sign * o * o * x;
            });
            best = best.max(value);
            let newton = if second < 0.0 { -first / second } else { 0.25 * step * first.signum() };
            let next = (at + newton).clamp(from, to);
            // The value is flat there: an error of the place counts squared.
            if (next - at).abs() <= 1e-8 * step {
                break;
            }
            at = next;
        }
        best
    }

    /// Every order with its sine and cosine at an angle. Multiples of one order are turned from one to the next.
    #[inline]
    fn each_order(&self, at: f64, mut f: impl FnMut(usize, f64, f64, f64)) {
        let (sin, cos) = (2.0 * PI / self.period * at).sin_cos();
        let (mut multiple, mut x, mut y) = (0, 1.0, 0.0);
        for (k, o) in self.orders.iter().enumerate() {
            match self.multiples.get(k) {
                Some(m) if m - multiple < AFRESH && m / AFRESH == multiple / AFRESH => {
                    for _ in multiple..*m {
                        (x, y) = (x * cos - y * sin, x * sin + y * cos);
                    }
                    multiple = *m;
                }
                m => {
                    (y, x) = (o * at).sin_cos();
                    multiple = m.copied().unwrap_or(multiple);
                }
            }
            f(k, *o, y, x);
        }
    }
}

/// Multiple at which turning starts afresh, so that rounding does not add up.
const AFRESH: usize = 32;

/// Orders as ascending multiples of that of the period; nothing where one is none.
fn multiples(orders: &[f64], period: f64) -> Vec<usize> {
    let base = 2.0 * PI / period;
    let whole: Vec<f64> = orders.iter().map(|o| (o / base).round()).collect();
    let same = orders.iter().zip(&whole).all(|(o, w)| (w * base - o).abs() <= 4.0 * f64::EPSILON * o);
    let ascending = whole.windows(2).all(|w| w[0] < w[1]) && whole.first().is_none_or(|w| *w >= 0.0);
    if same && ascending { whole.into_iter().map(|w| w as usize).collect() } else { Vec::new() }
}
