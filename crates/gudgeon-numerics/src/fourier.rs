//! Sums of orders over a cycle and back: the fast Fourier transform of two real waves at once.

use crate::elementary;
use crate::linalg::Complex;
use crate::vectors::{Vectorised, widest};

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
    /// For at least `points` points: the next power of two, from 16 on.
    #[must_use]
    pub fn new(points: usize) -> Self {
        let points = points.max(4 * LANES).next_power_of_two();
        let angle = |t: usize| 2.0 * std::f64::consts::PI * t as f64 / points as f64;
        let zero = || vec![0.0; points];
        Self {
            points,
            turn: [
                (0..points).map(|t| elementary::cos(angle(t))).collect(),
                (0..points).map(|t| -elementary::sin(angle(t))).collect(),
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
        widest(Transform(self));
        self.z.swap(0, 1);
        x.copy_from_slice(&self.z[0]);
        y.copy_from_slice(&self.z[1]);
    }

    /// The orders of two waves given at the points; as many as `a` and `b` have places.
    pub fn orders(&mut self, x: &[f64], y: &[f64], a: &mut [Complex], b: &mut [Complex]) {
        let m = self.points;
        self.z[0].copy_from_slice(x);
        self.z[1].copy_from_slice(y);
        widest(Transform(self));
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
}

/// `z_k ← Σ z_s e^{-2πiks/points}`: steps by four, and one by two where the points ask it, sorted as they go (Stockham).
struct Transform<'f>(&'f mut Fourier);

impl Vectorised for Transform<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Fourier { points, turn, z, other } = self.0;
        let (mut n, mut s) = (*points, 1);
        while n >= 4 {
            step_by_four(z, other, turn, n, s);
            std::mem::swap(z, other);
            n /= 4;
            s *= 4;
        }
        if n == 2 {
            for (z, o) in z.iter().zip(&mut *other) {
                let (low, high) = z.split_at(s);
                let (sum, difference) = o.split_at_mut(s);
                for q in 0..s {
                    sum[q] = low[q] + high[q];
                    difference[q] = low[q] - high[q];
                }
            }
            std::mem::swap(z, other);
        }
    }
}

/// Sequences that are transformed side by side.
const LANES: usize = 4;
type Lanes = [f64; LANES];
/// A complex number of each of them.
type Pair = [Lanes; 2];

/// One step: `n` points are left of each of `s` sequences.
#[inline(always)]
fn step_by_four(from: &[Vec<f64>; 2], to: &mut [Vec<f64>; 2], turn: &[Vec<f64>; 2], n: usize, s: usize) {
    let [re, im] = to;
    if s == 1 {
        first_step(from, re, im, turn);
        return;
    }
    let (quarter, stride) = (n / 4, turn[0].len() / n);
    for (p, (re, im)) in re.chunks_exact_mut(4 * s).zip(im.chunks_exact_mut(4 * s)).enumerate() {
        let w = [1, 2, 3].map(|j| turn.each_ref().map(|t| [t[j * p * stride]; LANES]));
        let part = |x: usize, j: usize| &from[x][(j * quarter + p) * s..][..s];
        let input = [0, 1, 2, 3].map(|j| [part(0, j), part(1, j)]);
        for q in (0..s).step_by(LANES) {
            let output = butterfly(pairs(&input, q), w);
            for (j, z) in output.into_iter().enumerate() {
                re[j * s + q..][..LANES].copy_from_slice(&z[0]);
                im[j * s + q..][..LANES].copy_from_slice(&z[1]);
            }
        }
    }
}

/// The step of one sequence of all points: what stands side by side are its points.
#[inline(always)]
fn first_step(from: &[Vec<f64>; 2], re: &mut [f64], im: &mut [f64], turn: &[Vec<f64>; 2]) {
    let quarter = re.len() / 4;
    let input = [0, 1, 2, 3].map(|j| from.each_ref().map(|x| &x[j * quarter..][..quarter]));
    for p in (0..quarter).step_by(LANES) {
        let w = [1, 2, 3].map(|j| turn.each_ref().map(|t| std::array::from_fn(|l| t[j * (p + l)])));
        let output = butterfly(pairs(&input, p), w);
        for (j, z) in output.into_iter().enumerate() {
            for l in 0..LANES {
                re[4 * (p + l) + j] = z[0][l];
                im[4 * (p + l) + j] = z[1][l];
            }
        }
    }
}

/// Numbers of four sequences from a place on. Without `map`, which becomes a function of its own here.
#[inline(always)]
fn pairs([a, b, c, d]: &[[&[f64]; 2]; 4], at: usize) -> [Pair; 4] {
    let pair = |z: &[&[f64]; 2]| [lanes(z[0], at), lanes(z[1], at)];
    [pair(a), pair(b), pair(c), pair(d)]
}

#[inline(always)]
fn lanes(x: &[f64], at: usize) -> Lanes {
    let mut out = [0.0; LANES];
    out.copy_from_slice(&x[at..at + LANES]);
    out
}

/// Transform of four numbers, and the turn of three of them.
#[inline(always)]
fn butterfly([a, b, c, d]: [Pair; 4], [w1, w2, w3]: [Pair; 3]) -> [Pair; 4] {
    let add = |a: Lanes, b: Lanes| -> Lanes { std::array::from_fn(|l| a[l] + b[l]) };
    let less = |a: Lanes, b: Lanes| -> Lanes { std::array::from_fn(|l| a[l] - b[l]) };
    let times = |a: Lanes, b: Lanes| -> Lanes { std::array::from_fn(|l| a[l] * b[l]) };
    let (x, y) = ([add(a[0], c[0]), add(a[1], c[1])], [less(a[0], c[0]), less(a[1], c[1])]);
    let (u, v) = ([add(b[0], d[0]), add(b[1], d[1])], [less(b[0], d[0]), less(b[1], d[1])]);
    let turned = |w: Pair, z: Pair| -> Pair {
        [less(times(w[0], z[0]), times(w[1], z[1])), add(times(w[0], z[1]), times(w[1], z[0]))]
    };
    [
        [add(x[0], u[0]), add(x[1], u[1])],
        turned(w1, [add(y[0], v[1]), less(y[1], v[0])]),
        turned(w2, [less(x[0], u[0]), less(x[1], u[1])]),
        turned(w3, [less(y[0], v[1]), add(y[1], v[0])]),
    ]
}
