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

/// One step: `n` points are left of each of `s` sequences.
fn step_by_four(from: &[Vec<f64>; 2], to: &mut [Vec<f64>; 2], turn: &[Vec<f64>; 2], n: usize, s: usize) {
    let quarter = n / 4;
    let stride = turn[0].len() / n;
    let [re, im] = from;
    let [to_re, to_im] = to;
    let blocks = to_re.chunks_exact_mut(4 * s).zip(to_im.chunks_exact_mut(4 * s));
    for (p, (to_re, to_im)) in blocks.enumerate() {
        let w = |j: usize| [turn[0][j * p * stride], turn[1][j * p * stride]];
        let w = [w(1), w(2), w(3)];
        if s == 1 {
            let at = |x: &[f64], j: usize| x[j * quarter + p];
            let input = [0, 1, 2, 3].map(|j| [at(re, j), at(im, j)]);
            let output = butterfly(input, w);
            for j in 0..4 {
                (to_re[j], to_im[j]) = (output[j][0], output[j][1]);
            }
            continue;
        }
        let part = |j: usize| (j * quarter + p) * s..(j * quarter + p + 1) * s;
        let [ar, br, cr, dr] = [0, 1, 2, 3].map(|j| &re[part(j)][..s]);
        let [ai, bi, ci, di] = [0, 1, 2, 3].map(|j| &im[part(j)][..s]);
        let ([r0, r1, r2, r3], [i0, i1, i2, i3]) = (quarters(to_re, s), quarters(to_im, s));
        for q in 0..s {
            let input = [[ar[q], ai[q]], [br[q], bi[q]], [cr[q], ci[q]], [dr[q], di[q]]];
            let output = butterfly(input, w);
            (r0[q], i0[q]) = (output[0][0], output[0][1]);
            (r1[q], i1[q]) = (output[1][0], output[1][1]);
            (r2[q], i2[q]) = (output[2][0], output[2][1]);
            (r3[q], i3[q]) = (output[3][0], output[3][1]);
        }
    }
}

#[inline(always)]
fn quarters(x: &mut [f64], s: usize) -> [&mut [f64]; 4] {
    let (a, x) = x.split_at_mut(s);
    let (b, x) = x.split_at_mut(s);
    let (c, d) = x.split_at_mut(s);
    [a, b, c, &mut d[..s]]
}

/// Transform of four numbers, and the turn of three of them.
#[inline(always)]
fn butterfly([a, b, c, d]: [[f64; 2]; 4], [w1, w2, w3]: [[f64; 2]; 3]) -> [[f64; 2]; 4] {
    let (x, y) = ([a[0] + c[0], a[1] + c[1]], [a[0] - c[0], a[1] - c[1]]);
    let (u, v) = ([b[0] + d[0], b[1] + d[1]], [b[0] - d[0], b[1] - d[1]]);
    let turned = |w: [f64; 2], z: [f64; 2]| [w[0] * z[0] - w[1] * z[1], w[0] * z[1] + w[1] * z[0]];
    [
        [x[0] + u[0], x[1] + u[1]],
        turned(w1, [y[0] + v[1], y[1] - v[0]]),
        turned(w2, [x[0] - u[0], x[1] - u[1]]),
        turned(w3, [y[0] - v[1], y[1] + v[0]]),
    ]
}
