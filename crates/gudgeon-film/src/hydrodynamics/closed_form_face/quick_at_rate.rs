//! The ruptured film at a squeeze velocity, by third-order steps from the last one.

use super::flow::Flow;
use super::reformation::Start;
use super::ruptured::Ruptured;
use super::shape::Shape;
use super::side::{Side, Warm};
use crate::cavitation::Cavitation;

impl<S: Shape> Side<S> {
    /// The ruptured film at `f.v`, by third-order steps from `start`.
    pub(super) fn ruptured(&mut self, f: &Flow, cavitation: Cavitation, start: Warm) -> Option<Ruptured> {
        let len = self.face.length();
        // Straight on from the last film, when that is not far.
        let on = |x: f64, slope: f64| {
            let (step, room) = (slope * (f.v - start.v), 0.2 * x.min(len - x));
            if step.abs() <= room { x + step } else { x }
        };
        let found = self.rupture_from(f, on(start.xr, start.xr_v))?;
        if f.pb <= 0.0 {
            return Some(found);
        }
        if cavitation == Cavitation::SwiftStieber {
            return self.has_ruptured(f, &found).then_some(found);
        }
        let mut xf = on(start.xf, start.xf_v);
        if !(xf > found.x && xf < len) {
            xf = 0.5 * (found.x + len);
        }
        self.front_from(f, found, xf)
    }

    /// The film at the leading edge, with a rupture near `x`.
    fn rupture_from(&mut self, f: &Flow, mut x: f64) -> Option<Ruptured> {
        let len = self.face.length();
        let mut settled = false;
        for _ in 0..10 {
            let i = self.face.piece_of(x);
            let m = self.lead_to(i, x);
            let (s, d, slope) = (self.face.s(x), self.face.drop(i, x), self.face.slope(i, x));
            let h = self.face.film() + d;
            let rising = f.u * slope + f.v;
            // A film of almost no length: too few digits here.
            if !(x > 0.0 && x < len && rising > 0.0 && s * m.i3 - m.x3 > 1e-3 * m.x3.abs()) {
                return None;
            }
            let e = f.pa + m.pressure().rise(f.u, f.v, f.u * d + f.v * s);
            let newton = e / (rising * m.i3);
            let curve = f.u * self.face.bend() / rising + 1.0 / (h * h * h * m.i3);
            let dx = newton / (1.0 + 0.5 * newton * curve).max(0.25);
            settled = newton.abs() * (curve.abs() + 1.0 / x) <= 3e-5;
            let next = (x + dx).clamp(0.25 * x, 0.5 * (x + len));
            settled &= self.face.piece_of(next) == i;
            x = next;
            if settled {
                break;
            }
        }
        let i = self.face.piece_of(x);
        let q = f.u * self.face.drop(i, x) + f.v * self.face.s(x);
        if !settled || f.u * self.face.slope(i, x) + f.v <= 0.0 {
            return None;
        }
        Some(Ruptured { v: f.v, i, x, q, front: None })
    }

    /// Completes `found` by the film at the trailing edge, with a front near `xf`.
    fn front_from(&mut self, f: &Flow, found: Ruptured, mut xf: f64) -> Option<Ruptured> {
        let len = self.face.length();
        let Ruptured { x, q, .. } = found;
        for k in 0..10 {
            let j = self.face.piece_of(xf);
            let n = self.trail_from(j, xf).pressure();
            let (qf, dry) = self.carried_to(f, q, xf, true);
            let (hf, slope) = (self.face.film() + self.face.drop(j, xf), self.face.slope(j, xf));
            let (nf, ih) = (self.n(f, j, xf, qf), 1.0 / hf);
            let ih3 = ih * ih * ih;
            let p = f.pb - n.rise(f.u, f.v, qf);
            let (p_x, bend) = if dry {
                (nf * ih3 + f.v * n.i3, 0.0)
            } else {
                (nf * ih3, (f.u * slope + f.v - 3.0 * nf * slope * ih) * ih3)
            };
            let newton = -p / p_x;
            let r = newton * bend / p_x;
            let dx = newton / (1.0 + 0.5 * r).max(0.25);
            let next = xf + dx;
            if next.is_nan() || (next <= x && k > 0 && !self.has_ruptured(f, &found)) {
                return None;
            }
            let inside = next > x && next < len && self.face.piece_of(next) == j;
            if inside && dx.abs() <= (if dry { 1e-9 } else { 3e-5 }) * (len - next) && r.abs() <= 3e-5 {
                let (qf, late) = self.carried_to(f, q, next, true);
                return (late == dry)
                    .then_some(Ruptured { front: Some(Start { i: j, x: next, q: qf, dry }), ..found });
            }
            xf = next.clamp(0.5 * (x + xf), 0.5 * (xf + len));
        }
        None
    }
}
