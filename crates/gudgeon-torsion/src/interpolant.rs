//! Piecewise polynomial interpolation of a periodic function of the crank angle, built where it is first asked for.
//!
//! Harmonic balance evaluates gas torque and inertia of a throw at some hundred thousand angles. Over a segment of 1/512 turn such a function is
//! a polynomial of degree 6 to rounding, which costs a few multiplications instead of a slider crank and an indicator diagram.

use gudgeon_numerics::elementary;
use std::f64::consts::PI;

/// Segments per turn: the functions of a crank vary over a tenth of a turn at the fastest. Multiples of their width stand in their middle, so that angles near
/// equidistant points of a turn, where the motion of a cycle is looked at, are in one segment each and not on both sides of an end.
const PER_TURN: usize = 512;
/// Segments per radian, of every interpolant.
const PER_RADIAN: f64 = PER_TURN as f64 / (2.0 * PI);
/// Coefficients of a segment.
const TERMS: usize = 7;
/// Points besides the nodes at which a polynomial must agree with its function, over the segment from -1 to 1.
const CHECKED: [f64; 3] = [-0.93, -0.27, 0.65];
/// Angle \[rad\] to either side that a derivative is taken over where there is no polynomial: it loses the rounding of an angle by this, some 1e-9.
const BESIDE: f64 = 1e-6;
/// Admitted error at these points, relative to the maximum of the function.
const TOLERANCE: f64 = 1e-13;

/// Interpolant of periodic functions `f`, several that are evaluated at once. Segments are built when they are first asked for. Where no polynomial
/// agrees (a valve opens there), `f` itself is evaluated.
#[derive(Debug, Clone)]
pub struct Interpolant<const N: usize> {
    scale: [f64; N],
    segments: Vec<Segment>,
    coefficients: Vec<[[f64; TERMS]; N]>,
    fit: Fit,
}

/// Nodes of a segment, each with the coefficients of the polynomial that is one there and zero at the others.
type Fit = [(f64, [f64; TERMS]); TERMS];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Segment {
    NotBuilt,
    Polynomial,
    /// The function is not smooth enough here: it is evaluated itself.
    Direct,
}

/// Where an angle lies among the segments, which are the same of all interpolants but for their number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// Segments from that about angle zero on.
    segment: i64,
    /// Coordinate in the segment, from -1 to 1.
    inside: f64,
}

impl Place {
    /// Of an angle \[rad\].
    #[inline]
    pub fn of(angle: f64) -> Self {
        let u = angle * PER_RADIAN + 0.5;
        // The floor, which is no machine instruction everywhere.
        let segment = u as i64 - i64::from(u < 0.0);
        Self { segment, inside: 2.0 * (u - segment as f64) - 1.0 }
    }
}

/// Node `i` of a segment: Chebyshev-Lobatto points, ends included.
fn node(i: usize) -> f64 {
    -elementary::cos(PI * i as f64 / (TERMS - 1) as f64)
}

/// Lagrange's polynomials, multiplied out factor by factor.
fn fit() -> Fit {
    std::array::from_fn(|i| {
        let own = node(i);
        let mut terms = [0.0; TERMS];
        terms[0] = 1.0;
        for other in (0..TERMS).filter(|j| *j != i).map(node) {
            for k in (0..TERMS).rev() {
                let below = if k > 0 { terms[k - 1] } else { 0.0 };
                terms[k] = (below - other * terms[k]) / (own - other);
            }
        }
        (own, terms)
    })
}

impl<const N: usize> Interpolant<N> {
    /// Interpolant of `f` with a period of `turns` turns (rounded up to a power of two).
    pub fn new(turns: usize, f: impl Fn(f64) -> [f64; N]) -> Self {
        let count = PER_TURN * turns.next_power_of_two();
        let period = 2.0 * PI * turns.next_power_of_two() as f64;
        let sampled = (0..64).map(|i| f(period * (f64::from(i) + 0.37) / 64.0));
        Self {
            scale: sampled
                .fold([0.0; N], |most, own| std::array::from_fn(|k| f64::max(most[k], own[k].abs()))),
            segments: vec![Segment::NotBuilt; count],
            coefficients: vec![[[0.0; TERMS]; N]; count],
            fit: fit(),
        }
    }

    /// Admitted difference from each function at the points where a polynomial is checked, in its unit.
    #[must_use]
    pub fn tolerance(&self) -> [f64; N] {
        self.scale.map(|scale| TOLERANCE * scale)
    }

    /// Number of segments, among those asked for so far, in which the functions themselves are evaluated.
    #[must_use]
    pub fn direct_segments(&self) -> usize {
        self.segments.iter().filter(|s| **s == Segment::Direct).count()
    }

    /// Values at an angle \[rad\]; `f` are the functions that the interpolant was made for.
    pub fn value(&mut self, angle: f64, f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        self.value_at(Place::of(angle), angle, f)
    }

    /// The same at an angle whose place is known.
    #[inline]
    pub(crate) fn value_at(&mut self, place: Place, angle: f64, f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        let i = self.segment(place);
        if self.segments[i] == Segment::NotBuilt {
            self.build(i, &f);
        }
        if self.segments[i] == Segment::Direct {
            return f(angle);
        }
        let c = &self.coefficients[i];
        std::array::from_fn(|k| value(&c[k], place.inside))
    }

    /// Derivatives with respect to the angle \[rad\]; where a function is not smooth, a difference over so little that its corners are nearly always beside.
    pub fn derivative(&mut self, angle: f64, f: impl Fn(f64) -> [f64; N]) -> [f64; N] {
        self.derivative_at(Place::of(angle), angle, f)
    }

    /// The same at a place.
    #[inline]
    pub(crate) fn derivative_at(
        &mut self,
        place: Place,
        angle: f64,
        f: impl Fn(f64) -> [f64; N],
    ) -> [f64; N] {
        let i = self.segment(place);
        if self.segments[i] == Segment::NotBuilt {
            self.build(i, &f);
        }
        if self.segments[i] == Segment::Direct {
            let (before, after) = (f(angle - BESIDE), f(angle + BESIDE));
            return std::array::from_fn(|k| (after[k] - before[k]) / (2.0 * BESIDE));
        }
        let c = &self.coefficients[i];
        std::array::from_fn(|k| 2.0 * PER_RADIAN * derivative(&c[k], place.inside))
    }

    /// Segment of a place: their number is a power of two.
    #[inline]
    fn segment(&self, place: Place) -> usize {
        (place.segment & (self.segments.len() as i64 - 1)) as usize
    }

    #[inline(never)]
    fn build(&mut self, i: usize, f: &impl Fn(f64) -> [f64; N]) {
        let angle = |t: f64| (i as f64 + 0.5 * t) / PER_RADIAN;
        let mut all = [[0.0; TERMS]; N];
        for (at, by_term) in self.fit.iter() {
            for (terms, own) in all.iter_mut().zip(f(angle(*at))) {
                terms.iter_mut().zip(by_term).for_each(|(t, part)| *t += part * own);
            }
        }
        self.coefficients[i] = all;
        let tolerance = self.tolerance();
        let agrees = CHECKED.iter().all(|t| {
            let exact = f(angle(*t));
            (0..N).all(|k| (value(&all[k], *t) - exact[k]).abs() <= tolerance[k])
        });
        self.segments[i] = if agrees { Segment::Polynomial } else { Segment::Direct };
    }
}

#[inline]
fn value(c: &[f64; TERMS], t: f64) -> f64 {
    let s = t * t;
    // Two short sums that do not wait for each other.
    let even = c[0] + s * (c[2] + s * (c[4] + s * c[6]));
    let odd = c[1] + s * (c[3] + s * c[5]);
    even + t * odd
}

#[inline]
fn derivative(c: &[f64; TERMS], t: f64) -> f64 {
    (1..TERMS).rev().fold(0.0, |sum, k| sum * t + k as f64 * c[k])
}
