//! The ruptured film under a load, by Newton's method from the last one.

use super::flow::Flow;
use super::reformation::Start;
use super::ruptured::Ruptured;
use super::shape::Shape;
use super::side::{Side, Warm};
use crate::cavitation::Cavitation;

impl<S: Shape> Side<S> {
    /// The ruptured film that carries `target`: Newton's method on the squeeze velocity and both places at once, `f.v` and
    /// `start` being the start.
    ///
    /// With the film at the leading edge ending where its gradient vanishes, its pressure there, `e`, changes by
    /// `-i3 dq + x3 dv`, and the load of both films does not change with the places themselves.
    pub(super) fn loaded(
        &mut self,
        f: &Flow,
        cavitation: Cavitation,
        target: f64,
        start: Warm,
    ) -> Option<Ruptured> {
        let len = self.face.len();
        let (s0, s_len) = (self.face.s(0.0), self.face.s(len));
        let trailing = cavitation == Cavitation::MassConserving && f.pb > 0.0;
        let (mut v, mut x, mut xf) = (start.v, start.xr, start.xf);
        if !(xf > x && xf < len) {
            xf = 0.5 * (x + len);
        }
        for k in 0..16 {
            let i = self.face.piece_of(x);
            let m = self.lead_to(i, x);
            let (s, d) = (self.face.s(x), self.face.drop(i, x));
            let arm = s * m.i3 - m.x3;
            // A film of almost no length: too few digits here.
            if !(x > 0.0 && x < len && arm > 1e-3 * m.x3.abs()) {
                return None;
            }
            if k == 0 && x > 0.05 * len {
                // The velocity that belongs to a place changes less from film to film than the velocity.
                v = (f.pa + f.u * (m.d2 - d * m.i3)) / arm;
            }
            let rising = f.u * self.face.slope(i, x) + v;
            if rising.is_nan() || rising <= 0.0 {
                return None;
            }
            let q = f.u * d + v * s;
            let e = f.pa + m.pressure().rise(f.u, v, q);
            let (w, e_q) = (m.x3 / m.i3, e / m.i3);
            let mut g = w * e - s0 * f.pa - (f.u * m.e2 + v * m.xx3 - q * m.x3) - target;
            let mut g_v = w * m.x3 - m.xx3;
            let mut front = None;
            if trailing {
                let j = self.face.piece_of(xf);
                let n = self.trail_from(j, xf);
                let (sf, hf) = (self.face.s(xf), self.face.film() + self.face.drop(j, xf));
                let ih3 = 1.0 / (hf * hf * hf);
                let fv = Flow { v, ..*f };
                let (qf, dry) = self.carried_to(&fv, q, xf, true);
                let nf = self.n(&fv, j, xf, qf);
                // Flux of the trailing film: by itself, and with v.
                let (q_e, wf) = if dry { (0.0, sf) } else { (e_q, w) };
                let lever = n.x3 - sf * n.i3;
                let p = f.pb - n.pressure().rise(f.u, v, qf);
                let p_x = nf * ih3 + if dry { v * n.i3 } else { 0.0 };
                let (p_e, p_v) = (p + n.i3 * q_e, wf * n.i3 - n.x3);
                g += s_len * f.pb - sf * p - (f.u * n.e2 + v * n.xx3 - qf * n.x3) + lever * q_e;
                g_v += sf * n.x3 - n.xx3 + lever * wf;
                if dry {
                    // The flux moves with the front: dq = v dx.
                    g -= lever * v * p_e / p_x;
                    g_v -= lever * v * p_v / p_x;
                } else {
                    // What the load is off by while the front is.
                    g += 0.5 * p * p / p_x;
                }
                front = Some((j, p_e, p_v, p_x, nf, sf, dry));
            }
            let dv = -g / g_v;
            let dq = e_q + w * dv;
            let dx = (dq - s * dv) / rising;
            let next = x + dx;
            if !next.is_finite() {
                return None;
            }
            // Second order: what is left of steps of 1e-7 is near rounding.
            let mut settled = dx.abs() <= 1e-7 * x.min(len - x);
            let mut next_f = xf;
            if let Some((j, p_e, p_v, p_x, nf, sf, dry)) = front {
                let dxf = -(p_e + p_v * dv) / p_x;
                let drift = if dry { 0.0 } else { sf * dv - dq };
                settled &= dxf.abs() <= 1e-7 * (len - xf).min(xf - x) && drift.abs() <= 1e-7 * nf.abs();
                next_f = xf + dxf;
                if next_f.is_nan() {
                    return None;
                }
                settled &= self.face.piece_of(next_f) == j;
            }
            v += dv;
            if settled && self.face.piece_of(next) == i {
                let q = f.u * self.face.drop(i, next) + v * self.face.s(next);
                let mut found = Ruptured { v, i, x: next, q, front: None };
                let f = Flow { v, ..*f };
                if let Some((j, .., dry)) = front {
                    let (qf, late) = self.carried_to(&f, q, next_f, true);
                    if late != dry || next_f <= next || next_f >= len {
                        return None;
                    }
                    found.front = Some(Start { i: j, x: next_f, q: qf, dry });
                } else if f.pb > 0.0 && !self.let_go(&f, &found) {
                    return None;
                }
                return Some(found);
            }
            x = next.clamp(0.25 * x, 0.5 * (x + len));
            xf = next_f.clamp(0.5 * (x + xf.max(x)), 0.5 * (xf.max(x) + len));
        }
        None
    }
}
