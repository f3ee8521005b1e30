//! Maximum and minimum over the cycle of a sum of orders.

mod waves;

use std::f64::consts::PI;

use waves::{Waves, multiples};

/// Least number of points per wave of the highest order.
const POINTS: usize = 8;
/// Maximum over `[-1, 1]` of `|x (x² - 1)|/6`: what a parabola through three points misses of a third derivative of one.
const PARABOLA: f64 = 0.064_150_029_909_958_42;

/// Last step of Newton's method by the distance of the points: its cube, times that of the phase between two points, is lost in rounding.
const LAST: f64 = 1e-5;

/// Finds the extremes of `m + Σ Re(a_k e^{i n_k θ})` over a period of θ.
#[derive(Debug, Clone)]
pub struct Cycle {
    /// Distance of the points \[rad\].
    step: f64,
    waves: Waves,
    /// The sum at the points, with the last one in front and the first one behind.
    wave: Vec<f64>,
    /// Phase that the highest order turns from one point to the next \[rad\].
    turn: f64,
}

impl Cycle {
    /// For some orders, and the period after which their sum repeats \[rad\].
    #[must_use]
    pub fn new(orders: &[f64], period: f64) -> Self {
        let highest = orders.iter().copied().fold(0.0, f64::max) * period / (2.0 * PI);
        let points = (POINTS * highest.ceil() as usize).next_power_of_two().max(64);
        Self {
            step: period / points as f64,
            waves: Waves::new(orders, period, points, &multiples(orders, period)),
            wave: vec![0.0; points + 2],
            turn: 2.0 * PI * highest / points as f64,
        }
    }

    /// The orders it was made for.
    #[must_use]
    pub fn orders(&self) -> &[f64] {
        self.waves.orders()
    }

    /// Maximum and minimum, for a mean and the phasors of the orders.
    pub fn extremes(&mut self, mean: f64, phasors: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
        let n = self.wave.len() - 2;
        self.waves.sum(&phasors, &mut self.wave[1..=n]);
        (self.wave[0], self.wave[n + 1]) = (self.wave[n], self.wave[1]);
        let (mut high, mut low) = (f64::NEG_INFINITY, f64::INFINITY);
        for w in &self.wave {
            high = if *w > high { *w } else { high };
            low = if *w < low { *w } else { low };
        }
        let half = 0.5 * (high - low);
        if half <= 0.0 {
            return [mean + high.max(0.0), mean + low.min(0.0)];
        }
        let top = self.maximum(high, half, 1.0, &phasors);
        let bottom = -self.maximum(-low, half, -1.0, &phasors);
        [mean + top, mean + bottom]
    }

    /// Maximum of `sign` times the wave, whose highest point is `high` and whose points swing by `half` about their middle.
    ///
    /// A sum of waves up to order n that swings by A about some mean falls no faster from its top than `A cos n x` would (a lemma of M. Riesz),
    /// so a point at half a step from the top is no lower than `A (1 - cos)` below it, and A is at most the swing of the points over
    /// that cosine. Its third derivative is at most `n³ A` (Bernstein): no top is higher than that of the parabola through three points by
    /// more than [`PARABOLA`] times that.
    fn maximum(&self, high: f64, half: f64, sign: f64, phasors: &impl Fn(usize) -> [f64; 2]) -> f64 {
        let cosine = (0.5 * self.turn).cos();
        let swing = half / cosine;
        let threshold = high - swing * (1.0 - cosine);
        let missed = PARABOLA * self.turn.powi(3) * swing;
        let mut best = high;
        for (s, w) in self.wave.windows(3).enumerate() {
            let here = sign * w[1];
            if here < threshold {
                continue;
            }
            let (before, after) = (sign * w[0], sign * w[2]);
            if here >= before && here > after {
                let curve = before - 2.0 * here + after;
                let shift = if curve < 0.0 { 0.5 * (before - after) / curve } else { 0.0 };
                if here - 0.25 * (before - after) * shift + missed > best {
                    best = best.max(self.climb(s as f64 + shift, sign, phasors));
                }
            }
        }
        best
    }

    /// The top near the point `s`, by Newton's method on the derivative, at most one point away. A last step, short as it is, adds half of it
    /// times the slope: what is left goes with its cube.
    fn climb(&self, s: f64, sign: f64, phasors: &impl Fn(usize) -> [f64; 2]) -> f64 {
        let step = self.step;
        let mut at = s * step;
        let (from, to) = (at - step, at + step);
        let mut best = f64::NEG_INFINITY;
        for _ in 0..20 {
            let (mut value, mut first, mut second) = (0.0, 0.0, 0.0);
            self.waves.each_order(at, |k, o, sin, cos| {
                let [re, im] = phasors(k);
                let (x, y) = (re * cos - im * sin, re * sin + im * cos);
                value += x;
                first -= o * y;
                second -= o * o * x;
            });
            let (value, first, second) = (sign * value, sign * first, sign * second);
            best = best.max(value);
            let newton = if second < 0.0 { -first / second } else { 0.25 * step * first.signum() };
            let next = (at + newton).clamp(from, to);
            if (next - at).abs() <= LAST * step {
                return best.max(value + 0.5 * first * (next - at));
            }
            at = next;
        }
        best
    }
}
