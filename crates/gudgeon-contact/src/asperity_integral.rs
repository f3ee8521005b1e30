//! The integrals of a Gaussian height distribution that asperity-contact models are made of.
//!
//! ```text
//! F_n(λ) = (2π)^(-1/2) ∫_λ^∞ (s - λ)^n exp(-s²/2) ds
//! F_n' = -n F_(n-1),   F_n'' + λ F_n' - n F_n = 0,   F_(n+1) = n F_(n-1) - λ F_n
//! ```
//!
//! (Greenwood & Tripp 1970; the second line is the equation of the parabolic cylinder functions.)
//!
//! [`asperity_integral`] evaluates the definition by quadrature, for any order. [`f_1`], [`f_3_2`], [`f_2`] and [`f_5_2`] are the orders
//! that contact models need at every point of every film at every step; they read piecewise Taylor polynomials, which
//! need no exponential, no root and no logarithm.

use gudgeon_numerics::elementary;
use std::sync::LazyLock;

/// Below this separation the asymptotic series of `F_n` for deep overlap is exact to rounding.
const DEEP: f64 = -8.0;
/// Above this separation [`f_1`], [`f_3_2`], [`f_2`] and [`f_5_2`] return zero: their values are below 1e-24 there, 1e-24 of the value at
/// zero separation, and no sum of contact pressures can see them.
const FAR: f64 = 10.0;
/// Segments per unit of `λ`, a power of two so that segment bounds are exact.
const PER_UNIT: f64 = 8.0;
/// Number of Taylor coefficients per segment. With half a segment of 1/16 and a function that falls like `exp(-λ²/2)`
/// the first neglected term is `(λ/16)^12 / 12!`: 7e-12 of the value at λ = 10, 6e-14 at 6.7, rounding below 5.
const TERMS: usize = 12;

/// `F_n(λ)` from its definition, to about 13 digits.
///
/// The substitution `s = λ + exp(x - exp(-x))` turns the half-infinite integral into one over the whole line whose
/// integrand dies at both ends faster than exponentially; the trapezoidal rule is then exponentially exact. Deeper than
/// λ = -8 the asymptotic series `Σ C(n, 2k) (2k-1)!! |λ|^(n-2k)` is used: what it leaves out is of the order `exp(-λ²/2)`.
///
/// Meant for tables and tests, about 1 µs per call; `n >= 0`.
#[must_use]
pub fn asperity_integral(n: f64, lambda: f64) -> f64 {
    if lambda < DEEP {
        return deep(n, lambda);
    }
    nodes()
        .map(|(t, w)| w * elementary::powf(t, n) * elementary::exp(-0.5 * (lambda + t) * (lambda + t)))
        .sum()
}

/// Nodes `t` and weights of `(2π)^(-1/2) ∫_0^∞ … dt` for integrands that decay like `exp(-(λ+t)²/2)` with `λ >= DEEP`.
fn nodes() -> impl Iterator<Item = (f64, f64)> {
    // Step 1/16 is far finer than double precision needs (halving it changes nothing). At the lower end t = exp(-3.5 - 33)
    // = 1e-16; at the upper end t = 24.5, sixteen standard deviations beyond the deepest mean.
    let (h, from, to) = (1.0 / 16.0, -56, 52);
    (from..=to).map(move |j| {
        let x = h * f64::from(j);
        let e = elementary::exp(-x);
        let t = elementary::exp(x - e);
        (t, h * t * (1.0 + e) / std::f64::consts::TAU.sqrt())
    })
}

#[cold]
#[inline(never)]
fn deep(n: f64, lambda: f64) -> f64 {
    let (l, mut term, mut sum) = (-lambda, 1.0, 1.0);
    // Ten terms of the asymptotic series; at |λ| = 8 the last is below 1e-16 for the orders in use.
    for k in 0..10 {
        let k2 = f64::from(2 * k);
        term *= (n - k2) * (n - k2 - 1.0) / ((k2 + 2.0) * l * l);
        sum += term;
    }
    sum * elementary::powf(l, n)
}

/// Piecewise Taylor polynomials of one `F_n` over `[DEEP, FAR]`.
#[derive(Debug)]
struct Pieces {
    order: f64,
    pieces: Vec<[[f64; 2]; TERMS / 2]>,
}

impl Pieces {
    fn new(order: f64) -> Self {
        let nodes: Vec<_> = nodes()
            .map(|(t, w)| (t, w * elementary::powf(t, order), w * elementary::powf(t, order - 1.0)))
            .collect();
        let count = ((FAR - DEEP) * PER_UNIT) as usize;
        let middle = |i: usize| DEEP + (i as f64 + 0.5) / PER_UNIT;
        // exp(-(c+t)²/2) at the nodes, from one centre c to the next as exp(-(c+t)²/2) exp(-d(c + d/2)) exp(-dt): a few roundings a step.
        let gauss = |t: f64| elementary::exp(-0.5 * (middle(0) + t) * (middle(0) + t));
        let mut at: Vec<[f64; 2]> =
            nodes.iter().map(|(t, ..)| [gauss(*t), elementary::exp(-t / PER_UNIT)]).collect();
        let pieces = (0..count)
            .map(|i| {
                let centre = middle(i);
                let (mut value, mut lower) = (0.0, 0.0);
                let on = elementary::exp(-(centre + 0.5 / PER_UNIT) / PER_UNIT);
                for (&(_, w, w_lower), [g, shrink]) in nodes.iter().zip(&mut at) {
                    value += w * *g;
                    lower += w_lower * *g;
                    *g *= on * *shrink;
                }
                // F'' = n F - λ F' about the centre: (k+2)(k+1) a_(k+2) = (n - k) a_k - λ (k+1) a_(k+1).
                let mut a = [0.0; TERMS];
                (a[0], a[1]) = (value, -order * lower);
                for k in 0..TERMS - 2 {
                    let kf = k as f64;
                    a[k + 2] =
                        ((order - kf) * a[k] - centre * (kf + 1.0) * a[k + 1]) / ((kf + 2.0) * (kf + 1.0));
                }
                // In units of a segment: exact, because PER_UNIT is a power of two.
                std::array::from_fn(|j| {
                    std::array::from_fn(|i| a[2 * j + i] * PER_UNIT.powi(-((2 * j + i) as i32)))
                })
            })
            .collect();
        Self { order, pieces }
    }

    fn value(&self, lambda: f64) -> f64 {
        self.at((lambda - DEEP) * PER_UNIT - 0.5)
    }

    /// The value where the centre of segment `i` is at `u = i`.
    #[inline]
    fn at(&self, u: f64) -> f64 {
        // Added to a small number, it leaves that rounded to the nearest integer in the last bits of the sum.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        if (-0.5..(FAR - DEEP) * PER_UNIT - 0.5).contains(&u) {
            let rounded = u + ROUND;
            let i = rounded.to_bits() as u32 as usize;
            self.pieces.get(i).map_or(0.0, |a| polynomial(a, u - (rounded - ROUND)))
        } else if u > 0.0 {
            0.0
        } else {
            deep(self.order, (u + 0.5) / PER_UNIT + DEEP)
        }
    }
}

/// The polynomial in pairs of coefficients, two halves at a time: short chains, and each step one instruction for both of a pair.
#[inline]
fn polynomial(a: &[[f64; 2]; TERMS / 2], x: f64) -> f64 {
    let x2 = x * x;
    let x4 = x2 * x2;
    let (mut even, mut odd) = (a[4], a[5]);
    for k in [2, 0] {
        for i in 0..2 {
            even[i] = even[i] * x4 + a[k][i];
            odd[i] = odd[i] * x4 + a[k + 1][i];
        }
    }
    let pair: [f64; 2] = std::array::from_fn(|i| even[i] + odd[i] * x2);
    pair[0] + pair[1] * x
}

static ONE: LazyLock<Pieces> = LazyLock::new(|| Pieces::new(1.0));
static THREE_HALVES: LazyLock<Pieces> = LazyLock::new(|| Pieces::new(1.5));
static TWO: LazyLock<Pieces> = LazyLock::new(|| Pieces::new(2.0));
static FIVE_HALVES: LazyLock<Pieces> = LazyLock::new(|| Pieces::new(2.5));

/// `F_1(λ)`: with `λ = -h/σ`, the mean gap over σ of Gaussian surfaces whose mean planes are `h` apart. Relative error below 1e-9 up to
/// λ = 10, zero beyond.
#[must_use]
pub fn f_1(lambda: f64) -> f64 {
    ONE.value(lambda)
}

/// `F_(3/2)(λ)`: the contact pressure of rough against smooth. Relative error below 1e-9 up to λ = 10, zero beyond.
#[must_use]
pub fn f_3_2(lambda: f64) -> f64 {
    THREE_HALVES.value(lambda)
}

/// `F_2(λ)`: the real area of contact. Relative error below 1e-9 up to λ = 10, zero beyond.
#[must_use]
pub fn f_2(lambda: f64) -> f64 {
    TWO.value(lambda)
}

/// `F_(5/2)(λ)`: the contact pressure. Relative error below 1e-9 up to λ = 10 (1e-11 up to 6.7, overlapping mean planes of any depth
/// included), zero beyond.
#[must_use]
pub fn f_5_2(lambda: f64) -> f64 {
    FIVE_HALVES.value(lambda)
}

/// `scale * F_(5/2)(separation * inverse_roughness)` for a whole film.
pub(crate) fn f_5_2_field(separation: &[f64], inverse_roughness: f64, scale: f64, out: &mut [f64]) {
    let pieces: &Pieces = &FIVE_HALVES;
    let per_metre = inverse_roughness * PER_UNIT;
    for (p, &h) in out.iter_mut().zip(separation) {
        *p = scale * pieces.at(h * per_metre - (DEEP * PER_UNIT + 0.5));
    }
}
