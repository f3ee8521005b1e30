//! Periodic monotone cubic interpolation.

use crate::reduced;

/// A continuously differentiable periodic curve through given points that has no extremum between them.
///
/// Piecewise cubic Hermite; the slope at a point is the weighted harmonic mean of the slopes of the two chords that meet
/// there, zero where they differ in sign (Fritsch & Carlson 1980, in the form of Fritsch and Butland). The curve stays
/// between neighbouring values, so positive data give a positive curve. Third-order accurate, second-order next to
/// extrema.
#[derive(Debug, Clone)]
pub(crate) struct PeriodicCubic {
    period: f64,
    origin: f64,
    /// Left ends of the segments, from 0, ascending, below the period.
    left: Vec<f64>,
    /// Power-series coefficients of each segment about its left end.
    coefficients: Vec<[f64; 4]>,
    /// For each of `left.len()` equal parts of the period, the segment in which the part begins; one entry more at the
    /// end. Equally spaced points leave at most one comparison to do, any others a binary search among those of one part.
    guide: Vec<u32>,
    parts_per_radian: f64,
}

/// Two points that cannot be told apart, by the index of the second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TooClose(pub usize);

impl PeriodicCubic {
    /// Through `(x[i], y[i])` and their repetitions. `x` ascends, starts anywhere and spans less than one period; `y` is
    /// finite; there are at least two points.
    pub(crate) fn new(x: &[f64], y: &[f64], period: f64) -> Result<Self, TooClose> {
        Self::through(x, y, period, false)
    }

    /// Straight lines through the same points.
    pub(crate) fn straight(x: &[f64], y: &[f64], period: f64) -> Result<Self, TooClose> {
        Self::through(x, y, period, true)
    }

    fn through(x: &[f64], y: &[f64], period: f64, straight: bool) -> Result<Self, TooClose> {
        let n = x.len();
        let origin = x[0];
        let left: Vec<f64> = x.iter().map(|x| x - origin).collect();
        let width = |i: usize| if i + 1 < n { left[i + 1] - left[i] } else { period - left[i] };
        let mut chord = Vec::with_capacity(n);
        for i in 0..n {
            let slope = (y[(i + 1) % n] - y[i]) / width(i);
            if !(width(i) > 0.0 && slope.is_finite()) {
                return Err(TooClose((i + 1) % n));
            }
            chord.push(slope);
        }
        let slope: Vec<f64> = (0..n)
            .map(|i| {
                let before = (i + n - 1) % n;
                let (d0, d1, h0, h1) = (chord[before], chord[i], width(before), width(i));
                if d0 * d1 > 0.0 {
                    let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
                    (w0 + w1) / (w0 / d0 + w1 / d1)
                } else {
                    0.0
                }
            })
            .collect();
        let coefficients = (0..n)
            .map(|i| {
                let (h, d) = (width(i), chord[i]);
                let (s0, s1) = if straight { (d, d) } else { (slope[i], slope[(i + 1) % n]) };
                [y[i], s0, (3.0 * d - 2.0 * s0 - s1) / h, (s0 + s1 - 2.0 * d) / (h * h)]
            })
            .collect();
        let mut guide = Vec::with_capacity(n + 1);
        let mut segment = 0;
        for part in 0..=n {
            let at = period * part as f64 / n as f64;
            while segment + 1 < n && left[segment + 1] <= at {
                segment += 1;
            }
            guide.push(segment as u32);
        }
        Ok(Self { period, origin, left, coefficients, guide, parts_per_radian: n as f64 / period })
    }

    /// The curve at any `x`.
    pub(crate) fn value(&self, x: f64) -> f64 {
        let u = reduced(x - self.origin, self.period);
        let part = ((u * self.parts_per_radian) as usize).min(self.left.len() - 1);
        let (mut low, mut high) = (self.guide[part] as usize, self.guide[part + 1] as usize);
        while low < high {
            let middle = (low + high).div_ceil(2);
            if self.left[middle] <= u {
                low = middle;
            } else {
                high = middle - 1;
            }
        }
        let t = u - self.left[low];
        let [a, b, c, d] = self.coefficients[low];
        a + t * (b + t * (c + t * d))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn sampled(n: usize, f: impl Fn(f64) -> f64) -> PeriodicCubic {
        let x: Vec<f64> = (0..n).map(|i| TAU * i as f64 / n as f64).collect();
        let y: Vec<f64> = x.iter().map(|&x| f(x)).collect();
        PeriodicCubic::new(&x, &y, TAU).expect("distinct")
    }

    #[test]
    fn passes_through_the_points_in_every_period() {
        let x = [-1.0, 0.5, 0.6, 2.0, 4.9];
        let y = [3.0, 1.0, 1.5, 1.5, -2.0];
        let c = PeriodicCubic::new(&x, &y, TAU).expect("distinct");
        for (x, y) in x.iter().zip(y) {
            for turn in [-3.0, 0.0, 1.0, 1000.0] {
                // Reducing 1000 turns costs 1000 ulp of 2π, 1e-12; the steepest chord is 5 per radian.
                assert!((c.value(x + turn * TAU) - y).abs() < 2e-11, "{x} {turn}");
            }
        }
    }

    #[test]
    fn never_overshoots() {
        // A step, a plateau and a spike on uneven abscissae.
        let x = [0.0, 0.1, 1.0, 1.01, 2.0, 4.0, 4.5, 6.0];
        let y = [1.0, 1.0, 1.0, 9.0, 9.0, 2.0, 30.0, 2.0];
        let c = PeriodicCubic::new(&x, &y, TAU).expect("distinct");
        for i in 0..x.len() {
            let (a, b) = (x[i], if i + 1 < x.len() { x[i + 1] } else { TAU });
            let (ya, yb) = (y[i], y[(i + 1) % y.len()]);
            for k in 0..=200 {
                let v = c.value(a + (b - a) * f64::from(k) / 200.0);
                // Rounding of the cubic in units of the largest value.
                assert!(v >= ya.min(yb) - 1e-13 && v <= ya.max(yb) + 1e-13, "segment {i}: {v}");
            }
        }
    }

    #[test]
    fn is_continuously_differentiable() {
        let x = [0.0, 0.3, 1.0, 2.2, 2.5, 5.0];
        let y = [1.0, 2.0, 2.5, 7.0, 1.0, 0.5];
        let c = PeriodicCubic::new(&x, &y, TAU).expect("distinct");
        for x in x.iter().map(|x| x + TAU) {
            let h = 1e-6;
            let (l, r) = ((c.value(x) - c.value(x - h)) / h, (c.value(x + h) - c.value(x)) / h);
            // Second derivatives up to 300 times h, and rounding 1e-15/h.
            assert!((l - r).abs() < 1e-3, "{x}: {l} {r}");
        }
    }

    #[test]
    fn converges_with_the_stated_order() {
        // sin on a monotone stretch and everywhere: orders 3 and 2.
        let error = |n: usize, from: f64, to: f64| {
            let c = sampled(n, f64::sin);
            (0..5000)
                .map(|i| from + (to - from) * f64::from(i) / 5000.0)
                .fold(0.0_f64, |w, x| w.max((c.value(x) - x.sin()).abs()))
        };
        let inner = (error(128, -1.0, 1.0) / error(256, -1.0, 1.0)).log2();
        let all = (error(128, 0.0, TAU) / error(256, 0.0, TAU)).log2();
        assert!((inner - 3.0).abs() < 0.5, "{inner}");
        assert!((all - 2.0).abs() < 0.3, "{all}");
    }

    #[test]
    fn a_constant_and_a_pair_of_points() {
        assert_eq!(sampled(4, |_| 7.0).value(1.234), 7.0);
        let c = PeriodicCubic::new(&[1.0, 2.0], &[0.0, 1.0], 2.0).expect("distinct");
        assert_eq!((c.value(1.0), c.value(2.0), c.value(1.5)), (0.0, 1.0, 0.5));
    }

    #[test]
    fn finds_the_segment_in_clustered_data() {
        // 1000 points within 1e-3 of each other and a few far away: the guide alone would be useless.
        let mut x: Vec<f64> = (0..1000).map(|i| 3.0 + 1e-6 * f64::from(i)).collect();
        x.insert(0, 0.0);
        x.push(6.0);
        let y: Vec<f64> = x.iter().map(|x| 10.0 + x).collect();
        let c = PeriodicCubic::new(&x, &y, TAU).expect("distinct");
        for x in &x {
            assert!((c.value(*x) - (10.0 + x)).abs() < 1e-13);
        }
    }

    #[test]
    fn refuses_points_that_coincide() {
        assert_eq!(PeriodicCubic::new(&[0.0, 1.0, 1.0], &[1.0, 2.0, 3.0], TAU).err(), Some(TooClose(2)));
        // Distinct as numbers, but not after the shift to the origin.
        let tiny = PeriodicCubic::new(&[1e9, 1e9 + 1e-7], &[1.0, 2.0], 1e-7).err();
        assert!(tiny.is_some());
    }
}
