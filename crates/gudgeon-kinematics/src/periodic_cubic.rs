//! Periodic monotone cubic interpolation.

use crate::periodic::reduced;

/// A continuously differentiable periodic curve through given points that has no extremum between them.
///
/// Piecewise cubic Hermite; the slope at a point is the weighted harmonic mean of the slopes of the two chords that meet
/// there, zero where they differ in sign (Fritsch & Carlson 1980, in the form of Fritsch and Butland). The curve stays
/// between neighbouring values, so positive data give a positive curve. Third-order accurate, second-order next to
/// extrema.
#[derive(Debug, Clone)]
pub struct PeriodicCubic {
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
pub struct TooClose(pub usize);

impl PeriodicCubic {
    /// Through `(x[i], y[i])` and their repetitions. `x` ascends, starts anywhere and spans less than one `period`; `y` is
    /// finite; there are at least two points, as many of `y` as of `x`.
    ///
    /// # Errors
    /// Two points too close to each other, or not ascending; fewer than two points, or another number of values, as the point 0.
    pub fn new(x: &[f64], y: &[f64], period: f64) -> Result<Self, TooClose> {
        Self::through(x, y, period, false)
    }

    /// Straight lines through the same points.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn straight(x: &[f64], y: &[f64], period: f64) -> Result<Self, TooClose> {
        Self::through(x, y, period, true)
    }

    fn through(x: &[f64], y: &[f64], period: f64, straight: bool) -> Result<Self, TooClose> {
        let n = x.len();
        if n < 2 || y.len() != n {
            return Err(TooClose(0));
        }
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
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
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
