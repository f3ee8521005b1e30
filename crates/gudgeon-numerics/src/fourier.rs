//! Sums of orders over a cycle and back: the fast Fourier transform of two real waves at once.

use crate::linalg::Complex;

/// Transforms between orders and `points` equidistant points of a cycle.
#[derive(Debug, Clone)]
pub struct Fourier {
    points: usize,
    /// `cos` and `-sin` of `2π t/points`.
    turn: [Vec<f64>; 2],
    z: [Vec<f64>; 2],
    other: [Vec<f64>; 2],
}

impl Fourier {
    /// For at least `points` points: the next power of two.
    #[must_use]
    pub fn new(points: usize) -> Self {
        let points = points.max(4).next_power_of_two();
        let angle = |t: usize| 2.0 * std::f64::consts::PI * t as f64 / points as f64;
        let zero = || vec![0.0; points];
        Self {
            points,
            turn: [
                (0..points).map(|t| angle(t).cos()).collect(),
                (0..points).map(|t| -angle(t).sin()).collect(),
            ],
            z: [zero(), zero()],
            other: [zero(), zero()],
        }
    }

    /// Number of points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points
    }

    /// `x = a_0 + Re Σ a_k e^{2πik s/points}` at the points s, and y from b in the same way. Fewer orders than half the points.
    pub fn waves(&mut self, a: &[Complex], b: &[Complex], x: &mut [f64], y: &mut [f64]) {
        let m = self.points;
        let [re, im] = &mut self.z;
        re.fill(0.0);
        im.fill(0.0);
        re[0] = a[0].re;
        im[0] = b[0].re;
        for (k, (a, b)) in a.iter().zip(b).enumerate().skip(1) {
            re[k] = 0.5 * (a.re - b.im);
            im[k] = 0.5 * (a.im + b.re);
            re[m - k] = 0.5 * (a.re + b.im);
            im[m - k] = 0.5 * (b.re - a.im);
        }
        // With real and imaginary part exchanged the forward transform goes backward.
        self.z.swap(0, 1);
        self.transform();
        self.z.swap(0, 1);
        x.copy_from_slice(&self.z[0]);
        y.copy_from_slice(&self.z[1]);
    }

    /// The orders of two waves given at the points; as many as `a` and `b` have places.
    pub fn orders(&mut self, x: &[f64], y: &[f64], a: &mut [Complex], b: &mut [Complex]) {
        let m = self.points;
        self.z[0].copy_from_slice(x);
        self.z[1].copy_from_slice(y);
        self.transform();
        let [re, im] = &self.z;
        let part = 1.0 / m as f64;
        a[0] = Complex::new(part * re[0], 0.0);
        b[0] = Complex::new(part * im[0], 0.0);
        for (k, (a, b)) in a.iter_mut().zip(b).enumerate().skip(1) {
            let (p, q) = (k, m - k);
            *a = Complex::new(part * (re[p] + re[q]), part * (im[p] - im[q]));
            *b = Complex::new(part * (im[p] + im[q]), part * (re[q] - re[p]));
        }
    }

    /// `z_k ← Σ z_s e^{-2πiks/points}`: steps by four, and one by two where the points ask it, sorted as they go (Stockham).
    fn transform(&mut self) {
        let m = self.points;
        let (mut n, mut s) = (m, 1);
        while n >= 4 {
            step_by_four(&self.z, &mut self.other, &self.turn, n, s);
            std::mem::swap(&mut self.z, &mut self.other);
            n /= 4;
            s *= 4;
        }
        if n == 2 {
            for (z, o) in self.z.iter().zip(&mut self.other) {
                let (low, high) = z.split_at(s);
                let (sum, difference) = o.split_at_mut(s);
                for q in 0..s {
                    sum[q] = low[q] + high[q];
                    difference[q] = low[q] - high[q];
                }
            }
            std::mem::swap(&mut self.z, &mut self.other);
        }
    }
}

fn step_by_four(from: &[Vec<f64>; 2], to: &mut [Vec<f64>; 2], turn: &[Vec<f64>; 2], n: usize, s: usize) {
    let quarter = n / 4;
    let block = quarter * s;
    let stride = turn[0].len() / n;
    let [re, im] = from;
    let [to_re, to_im] = to;
    for p in 0..quarter {
        let w = |j: usize| (turn[0][j * p * stride], turn[1][j * p * stride]);
        let ((c1, s1), (c2, s2), (c3, s3)) = (w(1), w(2), w(3));
        let part = |x: &[f64], j: usize| -> std::ops::Range<usize> {
            debug_assert!(x.len() >= (j + 1) * block);
            j * block + p * s..j * block + (p + 1) * s
        };
        let (ar, br, cr, dr) = (&re[part(re, 0)], &re[part(re, 1)], &re[part(re, 2)], &re[part(re, 3)]);
        let (ai, bi, ci, di) = (&im[part(im, 0)], &im[part(im, 1)], &im[part(im, 2)], &im[part(im, 3)]);
        let (r0, r) = to_re[4 * p * s..4 * (p + 1) * s].split_at_mut(s);
        let (r1, r) = r.split_at_mut(s);
        let (r2, r3) = r.split_at_mut(s);
        let (i0, i) = to_im[4 * p * s..4 * (p + 1) * s].split_at_mut(s);
        let (i1, i) = i.split_at_mut(s);
        let (i2, i3) = i.split_at_mut(s);
        for q in 0..s {
            let (xr, xi, yr, yi) = (ar[q] + cr[q], ai[q] + ci[q], ar[q] - cr[q], ai[q] - ci[q]);
            let (ur, ui, vr, vi) = (br[q] + dr[q], bi[q] + di[q], br[q] - dr[q], bi[q] - di[q]);
            r0[q] = xr + ur;
            i0[q] = xi + ui;
            // -i (b - d) = (vi, -vr)
            let (er, ei) = (yr + vi, yi - vr);
            r1[q] = c1 * er - s1 * ei;
            i1[q] = c1 * ei + s1 * er;
            let (er, ei) = (xr - ur, xi - ui);
            r2[q] = c2 * er - s2 * ei;
            i2[q] = c2 * ei + s2 * er;
            let (er, ei) = (yr - vi, yi + vr);
            r3[q] = c3 * er - s3 * ei;
            i3[q] = c3 * ei + s3 * er;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waves_are_the_sums_they_stand_for_and_orders_come_back() {
        // Powers of four and of two.
        for points in [4_usize, 8, 64, 128, 512] {
            let most = points / 2;
            let some = |i: usize, k: usize| ((7 * i + 3 * k + 1) as f64).sin();
            let row = |i: usize| -> Vec<Complex> {
                (0..most)
                    .map(|k| Complex::new(some(i, k), if k == 0 { 0.0 } else { some(i + 1, k) }))
                    .collect()
            };
            let (a, b) = (row(1), row(5));
            let mut f = Fourier::new(points);
            let (mut x, mut y) = (vec![0.0; points], vec![0.0; points]);
            f.waves(&a, &b, &mut x, &mut y);
            let sum = |c: &[Complex], s: usize| {
                let angle = 2.0 * std::f64::consts::PI * s as f64 / points as f64;
                c.iter()
                    .enumerate()
                    .map(|(k, c)| c.re * (k as f64 * angle).cos() - c.im * (k as f64 * angle).sin())
                    .sum::<f64>()
            };
            for s in 0..points {
                // Rounding of a sum of `most` terms of size one, whose angles are rounded at up to 2π most.
                let most = 1e-15 * (points * points) as f64;
                assert!((x[s] - sum(&a, s)).abs() < most && (y[s] - sum(&b, s)).abs() < most, "{points} {s}");
            }
            let (mut back, mut other) = (vec![Complex::default(); most], vec![Complex::default(); most]);
            f.orders(&x, &y, &mut back, &mut other);
            for k in 0..most {
                // Rounding goes with the logarithm of the points.
                assert!((back[k] - a[k]).abs() < 1e-14 && (other[k] - b[k]).abs() < 1e-14, "{points} {k}");
            }
        }
    }
}
