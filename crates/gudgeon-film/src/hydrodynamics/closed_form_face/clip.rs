//! The full film cut off at the cavitation pressure (half-Sommerfeld).

use super::flow::{Flow, Island};
use super::shape::Shape;
use super::side::Side;

impl<S: Shape> Side<S> {
    /// The parts of the full film above zero pressure.
    pub(super) fn clip(&mut self, f: &Flow) {
        let q = self.full_q(f);
        let whole = self.face.whole();
        let full = Full { face: &self.face, f, q, w: whole.x3 / whole.i3 };
        let start = Cut { i: 0, x: 0.0, p: f.pa, rate: 0.0 };
        let mut clip = Clip {
            full,
            cuts: self.cuts,
            open: (f.pa > 0.0).then_some(start),
            last: start,
            islands: &mut self.islands,
        };
        for i in 0..self.face.pieces() {
            let maximum = self.face.pressure_maximum(i, f.u, f.v, q);
            let minimum = self.face.pressure_minimum(i, f.u, f.v, q);
            let (first, second) = match (maximum, minimum) {
                (Some(a), Some(b)) if a > b => (Some(b), Some(a)),
                both => both,
            };
            for x in [first, second].into_iter().flatten() {
                clip.visit(i, x);
            }
            clip.visit(i, self.face.node(i + 1));
        }
        self.cuts = clip.cuts;
    }
}

/// The full film before it is cut off.
struct Full<'a, S> {
    face: &'a S,
    f: &'a Flow,
    q: f64,
    /// `∂q/∂v`
    w: f64,
}

impl<S: Shape> Full<'_, S> {
    /// Pressure and `∂p/∂v`, counted from the nearer end, which keeps the digits.
    fn pressure(&self, i: usize, x: f64) -> (f64, f64) {
        let f = self.f;
        if x >= self.face.length() {
            (f.pb, 0.0)
        } else if x <= 0.0 {
            (f.pa, 0.0)
        } else if x <= self.face.x_ref() {
            let t = self.face.front(i, x);
            (f.pa + t.rise(f.u, f.v, self.q), t.x3 - self.w * t.i3)
        } else {
            let t = self.face.tail(i, x);
            (f.pb - t.rise(f.u, f.v, self.q), self.w * t.i3 - t.x3)
        }
    }

    /// Zero of the pressure between `(x0, p0)` and `(x1, p1)` in piece `i`, where it is monotone; `guess` is the start if it lies between.
    fn zero(&self, i: usize, (x0, p0): (f64, f64), (x1, p1): (f64, f64), guess: f64) -> f64 {
        let (face, f) = (self.face, self.f);
        let (mut lo, mut hi) = (x0, x1);
        let falls = p0 > p1;
        let mut x = if guess > x0 && guess < x1 { guess } else { x0 + (x1 - x0) * (p0 / (p0 - p1)) };
        for _ in 0..200 {
            let p = self.pressure(i, x).0;
            if (p > 0.0) == falls {
                lo = x;
            } else {
                hi = x;
            }
            let h = face.film() + face.drop(i, x);
            let slope = (f.u * face.drop(i, x) + f.v * face.s(x) - self.q) / (h * h * h);
            let step = -p / slope;
            let next = x + step;
            if p == 0.0 || hi - lo <= 2.0 * f64::EPSILON * face.length() {
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
}

/// A place on the full film: its pressure and `∂p/∂v`.
#[derive(Clone, Copy)]
struct Cut {
    i: usize,
    x: f64,
    p: f64,
    rate: f64,
}

/// The search for the parts above zero, from one extremum of the pressure to the next.
struct Clip<'a, S> {
    full: Full<'a, S>,
    /// Where the pressure fell below zero last and where it rose above it, this time or in the film before.
    cuts: [f64; 2],
    /// Beginning of the part that has not ended yet.
    open: Option<Cut>,
    last: Cut,
    islands: &'a mut Vec<Island>,
}

impl<S: Shape> Clip<'_, S> {
    /// Goes on to `x` in piece `i`: since the last visit the pressure rises or falls monotonically.
    fn visit(&mut self, i: usize, x: f64) {
        let (full, last) = (&self.full, self.last);
        let (p, rate) = full.pressure(i, x);
        let len = full.face.length();
        if p > 0.0 && self.open.is_none() {
            let z = if last.p < 0.0 { full.zero(i, (last.x, last.p), (x, p), self.cuts[1]) } else { last.x };
            self.cuts[1] = z;
            let rate = if z > 0.0 { full.pressure(i, z).1 } else { 0.0 };
            self.open = Some(Cut { i: if z > last.x { i } else { last.i }, x: z, p: 0.0, rate });
        } else if p <= 0.0
            && let Some(from) = self.open.take()
        {
            let z = if p < 0.0 { full.zero(i, (last.x, last.p), (x, p), self.cuts[0]) } else { x };
            self.cuts[0] = z;
            let rate = if z < len { full.pressure(i, z).1 } else { 0.0 };
            self.keep(from, Cut { i, x: z, p: 0.0, rate });
        }
        if x >= len
            && let Some(from) = self.open.take()
        {
            self.keep(from, Cut { i, x, p, rate });
        }
        self.last = Cut { i, x, p, rate };
    }

    /// Keeps the part from `a` to `b`.
    fn keep(&mut self, a: Cut, b: Cut) {
        let Full { face, q, w, .. } = self.full;
        self.islands.push(Island {
            ia: a.i,
            xa: a.x,
            pa: a.p,
            ib: b.i,
            xb: b.x,
            pb: b.p,
            q,
            w,
            ra: a.rate,
            rb: b.rate,
            upwards: a.x <= 0.0,
            m: face.span(a.i, a.x, b.i, b.x),
        });
    }
}
