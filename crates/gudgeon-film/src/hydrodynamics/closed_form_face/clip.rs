//! The full film cut off at the cavitation pressure (half-Sommerfeld).

use super::flow::{Flow, Island};
use super::shape::Shape;
use super::side::Side;

impl<S: Shape> Side<S> {
    /// The parts of the full film above zero pressure.
    pub(super) fn clip(&mut self, f: &Flow) {
        let q = self.full_q(f);
        let whole = self.face.whole();
        let w = whole.x3 / whole.i3;
        let len = self.face.len();
        let mid = self.face.x_ref();
        let last = self.face.pieces() - 1;
        // (pressure, ∂p/∂v); counted from the nearer end, for the sake of digits.
        let at = |i: usize, x: f64| {
            if x >= len {
                (f.pb, 0.0)
            } else if x <= 0.0 {
                (f.pa, 0.0)
            } else if x <= mid {
                let t = S::three(&self.face.head(i, x));
                (f.pa + t.rise(f.u, f.v, q), t.x3 - w * t.i3)
            } else {
                let t = self.face.tail(i, x);
                (f.pb - t.rise(f.u, f.v, q), w * t.i3 - t.x3)
            }
        };
        let mut cuts = self.cuts;
        let mut open: Option<(usize, f64, f64, f64)> = (f.pa > 0.0).then_some((0, 0.0, f.pa, 0.0));
        let (mut i0, mut x0, mut p0) = (0, 0.0, f.pa);
        let islands = &mut self.islands;
        let face = &self.face;
        let mut visit = |i: usize, x: f64, islands: &mut Vec<Island>| {
            let (p, r) = at(i, x);
            let island = |a: (usize, f64, f64, f64), b: (usize, f64, f64, f64)| Island {
                ia: a.0,
                xa: a.1,
                pa: a.2,
                ib: b.0,
                xb: b.1,
                pb: b.2,
                q,
                w,
                ra: a.3,
                rb: b.3,
                upwards: a.1 <= 0.0,
                m: face.span(a.0, a.1, b.0, b.1),
            };
            // Rises or falls monotonically since the last visit.
            if p > 0.0 && open.is_none() {
                let z = if p0 < 0.0 { clip_zero(face, f, q, i, (x0, p0), (x, p), cuts[1], &at) } else { x0 };
                cuts[1] = z;
                open = Some((if z > x0 { i } else { i0 }, z, 0.0, if z > 0.0 { at(i, z).1 } else { 0.0 }));
            } else if p <= 0.0
                && let Some(a) = open
            {
                let z = if p < 0.0 { clip_zero(face, f, q, i, (x0, p0), (x, p), cuts[0], &at) } else { x };
                cuts[0] = z;
                let rb = if z < len { at(i, z).1 } else { 0.0 };
                islands.push(island(a, (i, z, 0.0, rb)));
                open = None;
            }
            if x >= len
                && let Some(a) = open
            {
                islands.push(island(a, (i, x, p, r)));
                open = None;
            }
            (i0, x0, p0) = (i, x, p);
        };
        for i in 0..=last {
            let c = self.face.crest(i, f.u, f.v, q);
            let v = self.face.valley(i, f.u, f.v, q);
            let (first, second) = match (c, v) {
                (Some(c), Some(v)) if c > v => (Some(v), Some(c)),
                both => both,
            };
            for x in [first, second].into_iter().flatten() {
                visit(i, x, islands);
            }
            visit(i, self.face.node(i + 1), islands);
        }
        self.cuts = cuts;
    }
}

/// Zero of the pressure between `(x0, p0)` and `(x1, p1)`, where it is monotone.
#[allow(clippy::too_many_arguments)]
fn clip_zero<S: Shape>(
    face: &S,
    f: &Flow,
    q: f64,
    i: usize,
    (x0, p0): (f64, f64),
    (x1, p1): (f64, f64),
    guess: f64,
    at: &impl Fn(usize, f64) -> (f64, f64),
) -> f64 {
    let (mut lo, mut hi) = (x0, x1);
    let falls = p0 > p1;
    let mut x = if guess > x0 && guess < x1 { guess } else { x0 + (x1 - x0) * (p0 / (p0 - p1)) };
    for _ in 0..200 {
        let p = at(i, x).0;
        if (p > 0.0) == falls {
            lo = x;
        } else {
            hi = x;
        }
        let h = face.film() + face.drop(i, x);
        let slope = (f.u * face.drop(i, x) + f.v * face.s(x) - q) / (h * h * h);
        let step = -p / slope;
        let next = x + step;
        if p == 0.0 || hi - lo <= 2.0 * f64::EPSILON * face.len() {
            return x;
        }
        if next > lo && next < hi {
            x = next;
            // Second order: what is left is below rounding.
            if step.abs() <= 1e-9 * (x1 - x).min(x - x0) {
                return x;
            }
        } else {
            x = 0.5 * (lo + hi);
        }
    }
    x
}
