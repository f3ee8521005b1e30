//! Noise on a measured trace: how it is recognised, and the filter that takes it off.
//!
//! # Recognition
//! Over twice the spacing the second differences of a smooth curve are four times as large; those of white noise are as large as before.
//! Rows whose median second difference grows by less than [`SMOOTH_GROWTH`] are noisy, when the noise is more than the last digit of
//! a trace: its standard deviation, from the median fourth difference (`|δ⁴p|/(0.6745 √70)`), above [`MIN_NOISE`] of the range. Medians
//! pass over combustion and other short events, which are a small part of a cycle.
//!
//! # Filter
//! Every harmonic `k` of the cycle is multiplied by `1/(1 + (k/k_c)⁶)`, which is a Butterworth filter of third order run forwards and
//! backwards: no shift of phase, periodic, the mean kept to rounding. White noise has the same power in all harmonics, which the highest tell; the
//! cut-off `k_c` is the lowest at which the filter bends the trace itself by no more than half of the noise it leaves (root mean squares).

use gudgeon_core::elementary;
use std::f64::consts::TAU;

/// Growth of the median second difference over twice the spacing, 4 for a smooth curve and 1 for white noise, below which rows are noisy.
pub const SMOOTH_GROWTH: f64 = 2.0;
/// Smallest standard deviation of noise, over the range of the rows: a trace of 100 bar printed to 0.01 bar has 3e-5.
pub const MIN_NOISE: f64 = 5e-5;
/// Median of the magnitude of a normal variable over its standard deviation, times the root of the sum of squares of (1, -4, 6, -4, 1).
const FOURTH_DIFFERENCE: f64 = 0.674_489_750_196_081_7 * 8.366_600_265_340_756;
/// Part of the cut-off harmonic beyond which nothing is left to speak of: 1.4e-3 of an amplitude.
const TAIL: f64 = 3.0;

/// Bend of the trace over the noise left, at most.
const BEND: f64 = 0.5;
/// Maximum number of harmonics that are looked at; what is beyond is taken off.
const MAX_HARMONICS: usize = 2000;

/// What the filter did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothed {
    /// Standard deviation of the noise before, in the unit of the rows.
    pub noise: f64,
    /// Cut-off: harmonic of the cycle whose amplitude is halved.
    pub harmonic: f64,
    /// Root mean square and largest magnitude of the change.
    pub change: (f64, f64),
    /// Change of the highest value.
    pub peak: f64,
}

/// Standard deviation of the noise on equally spaced periodic rows, in their unit; `None` when they are smooth, or fewer than 16.
#[must_use]
pub fn noise(rows: &[f64]) -> Option<f64> {
    let n = rows.len();
    if n < 16 {
        return None;
    }
    let at = |k: usize, d: isize| rows[(k as isize + d).rem_euclid(n as isize) as usize];
    let second = |d: isize| median((0..n).map(|k| at(k, d) - 2.0 * at(k, 0) + at(k, -d)));
    let (near, far) = (second(1), second(2));
    let fourth =
        median((0..n).map(|k| at(k, 2) - 4.0 * at(k, 1) + 6.0 * at(k, 0) - 4.0 * at(k, -1) + at(k, -2)));
    let (low, high) =
        rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    let deviation = fourth / FOURTH_DIFFERENCE;
    (far < SMOOTH_GROWTH * near && deviation > MIN_NOISE * (high - low)).then_some(deviation)
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut v: Vec<f64> = values.map(f64::abs).collect();
    let middle = v.len() / 2;
    *v.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Filters equally spaced periodic rows with the cut-off at `harmonic` of the cycle (above zero), or where their noise asks for it.
///
/// Rows are to be finite; none are left as they are. The time goes with their number times the harmonics kept, 2000 at most.
pub fn smooth(rows: &mut [f64], harmonic: Option<f64>) -> Smoothed {
    let n = rows.len();
    if n == 0 {
        return Smoothed { noise: 0.0, harmonic: harmonic.unwrap_or(0.0), change: (0.0, 0.0), peak: 0.0 };
    }
    let spectrum = Spectrum::of(rows);
    let harmonic = harmonic.unwrap_or_else(|| spectrum.cut_off());
    let noise = (spectrum.floor() * n as f64).sqrt();
    let filtered = spectrum.filtered(n, harmonic);
    let top = |r: &[f64]| r.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let before = top(rows);
    let (mut squares, mut largest) = (0.0, 0.0_f64);
    for (row, new) in rows.iter_mut().zip(filtered) {
        squares += (new - *row).powi(2);
        largest = largest.max((new - *row).abs());
        *row = new;
    }
    Smoothed { noise, harmonic, change: ((squares / n as f64).sqrt(), largest), peak: top(rows) - before }
}

/// Fourier coefficients `c_k = (1/n) Σ p_j e^(-2πi jk/n)` from `k` = 0 on.
struct Spectrum {
    n: usize,
    c: Vec<[f64; 2]>,
    /// `cos` and `sin` of `2π j/n`.
    turn: Vec<[f64; 2]>,
}

impl Spectrum {
    fn of(rows: &[f64]) -> Self {
        let n = rows.len();
        let turn: Vec<[f64; 2]> = (0..n)
            .map(|j| {
                let (sin, cos) = elementary::sin_cos(TAU * j as f64 / n as f64);
                [cos, sin]
            })
            .collect();
        let c = (0..=(n / 2).min(MAX_HARMONICS))
            .map(|k| {
                let (mut re, mut im, mut angle) = (0.0, 0.0, 0);
                for p in rows {
                    re += p * turn[angle][0];
                    im -= p * turn[angle][1];
                    angle = (angle + k) % n;
                }
                [re / n as f64, im / n as f64]
            })
            .collect();
        Self { n, c, turn }
    }

    /// Share of a harmonic that the filter leaves.
    fn left(k: usize, harmonic: f64) -> f64 {
        1.0 / (1.0 + (k as f64 / harmonic).powi(6))
    }

    /// How often harmonic `k` counts in the mean square: with its mirror image, but for the mean and the highest of even rows.
    fn copies(&self, k: usize) -> f64 {
        if k == 0 || 2 * k == self.n { 1.0 } else { 2.0 }
    }

    /// Power of the noise in one harmonic: the mean of the upper half.
    fn floor(&self) -> f64 {
        let upper = &self.c[self.c.len() / 2..];
        upper.iter().map(|c| c[0] * c[0] + c[1] * c[1]).sum::<f64>() / upper.len() as f64
    }

    /// The lowest cut-off that bends the trace by no more than [`BEND`] of the noise left.
    fn cut_off(&self) -> f64 {
        let floor = self.floor();
        let mut harmonic = 2.0;
        while harmonic < self.c.len() as f64 {
            let (mut bend, mut kept) = (0.0, 0.0);
            for (k, c) in self.c.iter().enumerate() {
                let left = Self::left(k, harmonic);
                bend += self.copies(k) * (1.0 - left).powi(2) * (c[0] * c[0] + c[1] * c[1] - floor);
                kept += self.copies(k) * left * left * floor;
            }
            if bend <= BEND * BEND * kept {
                break;
            }
            harmonic *= 1.02;
        }
        harmonic
    }

    fn filtered(&self, n: usize, harmonic: f64) -> Vec<f64> {
        let last = ((TAIL * harmonic) as usize).min(self.c.len() - 1);
        (0..n)
            .map(|j| {
                let (mut sum, mut angle) = (0.0, 0);
                for (k, c) in self.c[..=last].iter().enumerate() {
                    let [cos, sin] = self.turn[angle];
                    sum += self.copies(k) * Self::left(k, harmonic) * (c[0] * cos - c[1] * sin);
                    angle = (angle + j) % n;
                }
                sum
            })
            .collect()
    }
}
