//! Where a film forms again behind a cavity: the search that always ends.

use super::flow::Flow;
use super::moments::PressureMoments;
use super::shape::Shape;
use super::side::Side;

/// Beginning of a film behind a cavity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    pub i: usize,
    pub x: f64,
    pub q: f64,
    /// The cavity has run dry before.
    pub dry: bool,
}

impl<S: Shape> Side<S> {
    /// Beginning of the film that ends at `(ie, xe)` with pressure `pe`, behind the rupture at `(ir, xr)`.
    ///
    /// The largest place where the pressure, counted back from the end, comes down to zero: with the flux that the cavity
    /// carries there, which is that of the rupture unless the cavity has run dry.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn reform(
        &self,
        f: &Flow,
        q: f64,
        ir: usize,
        xr: f64,
        ie: usize,
        xe: f64,
        pe: f64,
        may_dry: bool,
    ) -> Start {
        let end = if xe >= self.face.length() { PressureMoments::default() } else { self.face.tail(ie, xe) };
        // Pressure at x counted back from the end, with its first and second derivative there.
        let at = |i: usize, x: f64| {
            let t = self.face.tail(i, x).minus(end);
            let (qx, dry) = self.carried_to(f, q, x, may_dry);
            let (h, dh) = (self.face.film() + self.face.drop(i, x), self.face.slope(i, x));
            let (n, ih) = (self.n(f, i, x, qx), 1.0 / h);
            let ih3 = ih * ih * ih;
            let p = pe - t.rise(f.u, f.v, qx);
            if dry {
                // Second derivative not worth its terms: zero asks for plain Newton steps.
                (p, n * ih3 + f.v * t.i3, 0.0)
            } else {
                (p, n * ih3, (f.u * dh + f.v - 3.0 * n * dh * ih) * ih3)
            }
        };
        let mut i = ie;
        let mut hi = xe;
        loop {
            let mut lo = if i == ir { xr } else { self.face.node(i) };
            let minimum = if i == ir {
                // The pressure there is zero or, counted back from the end, less: the film has ruptured.
                Some(xr)
            } else {
                self.face
                    .pressure_minimum(i, f.u, f.v, q)
                    .filter(|x| *x > lo && *x < hi && at(i, *x).0 <= 0.0)
            };
            if minimum.is_some() || at(i, lo).0 <= 0.0 {
                lo = minimum.unwrap_or(lo);
                // From here the pressure only rises as far as its maximum, if it has one.
                let maximum = self.face.pressure_maximum(i, f.u, f.v, q).filter(|x| *x > lo && *x < hi);
                let x = self.reform_between(i, lo, maximum.unwrap_or(hi), xe, at);
                let (q, dry) = self.carried_to(f, q, x, may_dry);
                return Start { i, x, q, dry };
            }
            hi = lo;
            i -= 1;
        }
    }

    /// Flux constant of a film that begins at `x` behind a cavity, and whether the cavity has run dry before.
    #[inline]
    pub(super) fn carried_to(&self, f: &Flow, q: f64, x: f64, may_dry: bool) -> (f64, bool) {
        let dry_q = f.v * self.face.s(x) - f.u * self.face.film();
        if may_dry && dry_q > q { (dry_q, true) } else { (q, false) }
    }

    pub(super) fn reform_between(
        &self,
        i: usize,
        mut lo: f64,
        mut hi: f64,
        xe: f64,
        at: impl Fn(usize, f64) -> (f64, f64, f64),
    ) -> f64 {
        let mut x = self.warm.map_or(f64::NAN, |w| w.xf);
        if !(x > lo && x < hi) {
            x = hi;
        }
        for _ in 0..200 {
            let (p, slope, bend) = at(i, x);
            if p > 0.0 {
                hi = x;
            } else {
                lo = x;
            }
            if p == 0.0 || hi - lo <= 2.0 * f64::EPSILON * self.face.length() {
                return x;
            }
            // Halley's step, third order.
            let newton = -p / slope;
            let r = newton * bend / slope;
            let step = newton / (1.0 + 0.5 * r);
            let next = x + step;
            if next > lo && next < hi {
                x = next;
                // Small beside the length of the film and beside that over which the slope changes: what is left is below
                // rounding.
                let small = if bend == 0.0 { 1e-9 } else { 1e-6 };
                if step.abs() <= small * (xe - x) && r.abs() <= 1e-6 {
                    return x;
                }
            } else {
                x = 0.5 * (lo + hi);
            }
        }
        x
    }
}
