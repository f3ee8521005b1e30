//! Noise on a measured trace: how it is recognised, and the filter that takes it off.
//!
//! # Recognition
//! Over twice the spacing the second differences of a smooth curve are four times as large; those of white noise are as large as before.
//! Rows whose median second difference grows by less than [`SMOOTH_GROWTH`] are noisy, when the noise is more than the last digit of
//! a trace: its standard deviation, from the median fourth difference (`|δ⁴p|/(0.6745 √70)`), above [`LEAST_NOISE`] of the range. Medians
//! pass over combustion and other short events, which are a small part of a cycle.
//!
//! # Filter
//! Every harmonic `k` of the cycle is multiplied by `1/(1 + (k/k_c)⁶)`, which is a Butterworth filter of third order run forwards and
//! backwards: no shift of phase, periodic, the mean kept to rounding. White noise has the same power in all harmonics, which the highest tell; the
//! cut-off `k_c` is the lowest at which the filter bends the trace itself by no more than half of the noise it leaves (root mean squares).

use std::f64::consts::TAU;

/// Growth of the median second difference over twice the spacing, 4 for a smooth curve and 1 for white noise, below which rows are noisy.
const SMOOTH_GROWTH: f64 = 2.0;
/// Least standard deviation of noise, over the range of the rows: a trace of 100 bar printed to 0.01 bar has 3e-5.
const LEAST_NOISE: f64 = 5e-5;
/// Median of the magnitude of a normal variable over its standard deviation, times the root of the sum of squares of (1, -4, 6, -4, 1).
const FOURTH_DIFFERENCE: f64 = 0.674_489_750_196_081_7 * 8.366_600_265_340_756;
/// Part of the cut-off harmonic beyond which nothing is left to speak of: 1.4e-3 of an amplitude.
const TAIL: f64 = 3.0;

/// Bend of the trace over the noise left, at most.
const BEND: f64 = 0.5;
/// Most harmonics that are looked at; what is beyond is taken off.
const MOST_HARMONICS: usize = 2000;

/// What the filter did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Smoothed {
    /// Standard deviation of the noise before.
    pub noise: f64,
    /// Cut-off: harmonic of the cycle whose amplitude is halved.
    pub harmonic: f64,
    /// Root mean square and largest magnitude of the change.
    pub change: (f64, f64),
    /// Change of the highest value.
    pub peak: f64,
}

/// Standard deviation of the noise on equally spaced periodic rows; `None` when they are smooth.
pub(crate) fn noise(rows: &[f64]) -> Option<f64> {
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
    (far < SMOOTH_GROWTH * near && deviation > LEAST_NOISE * (high - low)).then_some(deviation)
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut v: Vec<f64> = values.map(f64::abs).collect();
    let middle = v.len() / 2;
    *v.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Filters equally spaced periodic rows with the cut-off at `harmonic` of the cycle, or where their noise asks for it.
pub(crate) fn smooth(rows: &mut [f64], harmonic: Option<f64>) -> Smoothed {
    let n = rows.len();
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
                let (sin, cos) = (TAU * j as f64 / n as f64).sin_cos();
                [cos, sin]
            })
            .collect();
        let c = (0..=(n / 2).min(MOST_HARMONICS))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Uniform noise of standard deviation `s`.
    fn noisy(rows: &[f64], s: f64) -> Vec<f64> {
        let mut seed = 1_u64;
        rows.iter()
            .map(|p| {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let unit = (seed >> 11) as f64 / (1_u64 << 53) as f64;
                p + s * 12f64.sqrt() * (unit - 0.5)
            })
            .collect()
    }

    /// A pulse of 60 on a base of 1 with ripple.
    fn clean(n: usize) -> Vec<f64> {
        let bump = |x: f64| 60.0 * (-((x - 0.52) / 0.03).powi(2)).exp();
        (0..n).map(|j| j as f64 / n as f64).map(|x| 1.0 + 0.2 * (3.0 * TAU * x).sin() + bump(x)).collect()
    }

    #[test]
    fn noise_is_told_from_a_smooth_trace_and_from_its_last_digit() {
        for n in [720, 1440, 7200] {
            let rows = clean(n);
            assert_eq!(noise(&rows), None);
            // Printed to 0.001 of 60.
            let printed: Vec<f64> = rows.iter().map(|p| (p * 1e3).round() / 1e3).collect();
            assert_eq!(noise(&printed), None, "{n}");
            let found = noise(&noisy(&rows, 0.03)).expect("noisy");
            // Fourth differences that share rows tell as much as n/5 of their own: 10 % at 720 rows; uniform noise is not normal: 7 %.
            assert!((found / 0.03 - 1.0).abs() < 0.25, "{n}: {found}");
        }
    }

    #[test]
    fn the_filter_takes_off_the_noise_and_leaves_the_trace() {
        let truth = clean(1440);
        let mut rows = noisy(&truth, 0.03);
        let before = rows.clone();
        let done = smooth(&mut rows, None);
        let rms = |a: &[f64]| {
            (a.iter().zip(&truth).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
        };
        // A pulse of 30 degrees needs some 60 of 720 harmonics: a quarter of the noise and as much bend at most.
        assert!(rms(&rows) < 0.5 * rms(&before), "{} {}", rms(&rows), rms(&before));
        assert!(noise(&rows).is_none());
        let mean = |a: &[f64]| a.iter().sum::<f64>() / a.len() as f64;
        // Rounding of sums of 1440 numbers up to 60.
        assert!((mean(&rows) - mean(&before)).abs() < 1e-12);
        // The peak within three standard deviations of the noise.
        assert!(done.peak.abs() < 3.0 * 0.03, "{}", done.peak);
        // The upper 360 of 720 harmonics know the noise to 4 %; six standard deviations of 1440 changes.
        assert!((done.noise / 0.03 - 1.0).abs() < 0.1 && done.change.0 <= 1.1 * done.noise, "{done:?}");
        assert!(done.change.1 < 6.0 * 0.03, "{done:?}");
    }

    #[test]
    fn no_phase_is_shifted_and_the_cut_off_is_halved() {
        let n = 360;
        for k in [2, 20, 60] {
            let wave: Vec<f64> = (0..n).map(|j| (TAU * (k * j) as f64 / n as f64 + 0.7).cos()).collect();
            let mut rows = wave.clone();
            smooth(&mut rows, Some(20.0));
            let share = 1.0 / (1.0 + (k as f64 / 20.0).powi(6));
            for (a, b) in rows.iter().zip(&wave) {
                // Rounding of sums of 180 terms; harmonics from 60 on are left out, where 1.4e-3 would be left.
                let within = if k == 60 { 1.5e-3 } else { 1e-12 };
                assert!((a - share * b).abs() < within, "{k}");
            }
        }
    }
}
