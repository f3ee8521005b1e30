//! The ruptured film under a load, by Newton's method from the last one.

use super::flow::Flow;
use super::reformation::Start;
use super::ruptured::Ruptured;
use super::shape::Shape;
use super::side::{Side, Warm};
use crate::cavitation::Cavitation;

/// The film at the leading edge ending at `x`, where its gradient vanishes, and what its load is off by.
///
/// Its pressure at the end, `e`, changes by `-i3 dq + x3 dv`; the load of both films does not change with the places themselves.
struct LeadRow {
    i: usize,
    /// `s` at the end.
    s: f64,
    /// Second derivative of the pressure there, times `h³`.
    rising: f64,
    v: f64,
    q: f64,
    /// Flux that the pressure at the end asks for, and `∂q/∂v`.
    q_e: f64,
    w: f64,
    /// Load less the one wanted, and its derivative with respect to `v`.
    g: f64,
    g_v: f64,
}

/// The film at the trailing edge beginning at a front where its pressure should vanish.
struct FrontRow {
    j: usize,
    s: f64,
    /// Pressure at the front as the flux of the leading film will change it, and its derivatives with respect to `v` and the place.
    p_e: f64,
    p_v: f64,
    p_x: f64,
    /// Pressure gradient at the front, times `h³`.
    n: f64,
    dry: bool,
}

/// Where the next iteration is, and whether it is the last.
struct Step {
    x: f64,
    xf: f64,
    settled: bool,
}

impl<S: Shape> Side<S> {
    /// The ruptured film that carries `target`: Newton's method on the squeeze velocity and both places at once, `f.v` and
    /// `start` being the start.
    pub(super) fn loaded(
        &mut self,
        f: &Flow,
        cavitation: Cavitation,
        target: f64,
        start: Warm,
    ) -> Option<Ruptured> {
        let len = self.face.length();
        let trailing = cavitation == Cavitation::MassConserving && f.pb > 0.0;
        let (mut v, mut x, mut xf) = (start.v, start.xr, start.xf);
        if !(xf > x && xf < len) {
            xf = 0.5 * (x + len);
        }
        for k in 0..16 {
            let mut lead = self.lead_row(f, target, v, x, k == 0)?;
            let front = if trailing { Some(self.front_row(f, xf, &mut lead)) } else { None };
            let dv = -lead.g / lead.g_v;
            let next = self.step(&lead, front.as_ref(), dv, x, xf)?;
            v = lead.v + dv;
            if next.settled && self.face.piece_of(next.x) == lead.i {
                return self.complete(f, v, lead.i, &next, front.as_ref());
            }
            x = next.x.clamp(0.25 * x, 0.5 * (x + len));
            xf = next.xf.clamp(0.5 * (x + xf.max(x)), 0.5 * (xf.max(x) + len));
        }
        None
    }

    /// The film at the leading edge that ends at `x`. `None` for a film of almost no length, which leaves too few digits.
    #[inline]
    fn lead_row(&mut self, f: &Flow, target: f64, mut v: f64, x: f64, first: bool) -> Option<LeadRow> {
        let len = self.face.length();
        let i = self.face.piece_of(x);
        let m = self.lead_to(i, x);
        let (s, d) = (self.face.s(x), self.face.drop(i, x));
        let arm = s * m.i3 - m.x3;
        if !(x > 0.0 && x < len && arm > 1e-3 * m.x3.abs()) {
            return None;
        }
        if first && x > 0.05 * len {
            // The velocity that belongs to a place changes less from film to film than the velocity.
            v = (f.pa + f.u * (m.d2 - d * m.i3)) / arm;
        }
        let rising = f.u * self.face.slope(i, x) + v;
        if rising.is_nan() || rising <= 0.0 {
            return None;
        }
        let q = f.u * d + v * s;
        let e = f.pa + m.pressure().rise(f.u, v, q);
        let (w, q_e) = (m.x3 / m.i3, e / m.i3);
        let g = w * e - self.face.s(0.0) * f.pa - (f.u * m.e2 + v * m.xx3 - q * m.x3) - target;
        let g_v = w * m.x3 - m.xx3;
        Some(LeadRow { i, s, rising, v, q, q_e, w, g, g_v })
    }

    /// The film at the trailing edge that begins at `xf`; adds its load to that of the leading film.
    #[inline]
    fn front_row(&mut self, f: &Flow, xf: f64, lead: &mut LeadRow) -> FrontRow {
        let (v, w) = (lead.v, lead.w);
        let j = self.face.piece_of(xf);
        let n = self.trail_from(j, xf);
        let (s, h) = (self.face.s(xf), self.face.film() + self.face.drop(j, xf));
        let ih3 = 1.0 / (h * h * h);
        let f = Flow { v, ..*f };
        let (q, dry) = self.carried_to(&f, lead.q, xf, true);
        let gradient = self.n(&f, j, xf, q);
        // Flux of the trailing film: by itself, and with v.
        let (q_e, wf) = if dry { (0.0, s) } else { (lead.q_e, w) };
        let lever = n.x3 - s * n.i3;
        let p = f.pb - n.pressure().rise(f.u, v, q);
        let p_x = gradient * ih3 + if dry { v * n.i3 } else { 0.0 };
        let (p_e, p_v) = (p + n.i3 * q_e, wf * n.i3 - n.x3);
        lead.g += self.face.s(self.face.length()) * f.pb - s * p - (f.u * n.e2 + v * n.xx3 - q * n.x3)
            + lever * q_e;
        lead.g_v += s * n.x3 - n.xx3 + lever * wf;
        if dry {
            // The flux moves with the front: dq = v dx.
            lead.g -= lever * v * p_e / p_x;
            lead.g_v -= lever * v * p_v / p_x;
        } else {
            // What the load is off by while the front is.
            lead.g += 0.5 * p * p / p_x;
        }
        FrontRow { j, s, p_e, p_v, p_x, n: gradient, dry }
    }

    /// The next places, after a change `dv` of the velocity. `None` when they are not numbers.
    #[inline]
    fn step(&self, lead: &LeadRow, front: Option<&FrontRow>, dv: f64, x: f64, xf: f64) -> Option<Step> {
        let len = self.face.length();
        let dq = lead.q_e + lead.w * dv;
        let dx = (dq - lead.s * dv) / lead.rising;
        let mut next = Step { x: x + dx, xf, settled: dx.abs() <= 1e-7 * x.min(len - x) };
        if !next.x.is_finite() {
            return None;
        }
        // Second order: what is left of steps of 1e-7 is near rounding.
        if let Some(r) = front {
            let dxf = -(r.p_e + r.p_v * dv) / r.p_x;
            let drift = if r.dry { 0.0 } else { r.s * dv - dq };
            next.settled &= dxf.abs() <= 1e-7 * (len - xf).min(xf - x) && drift.abs() <= 1e-7 * r.n.abs();
            next.xf = xf + dxf;
            if next.xf.is_nan() {
                return None;
            }
            next.settled &= self.face.piece_of(next.xf) == r.j;
        }
        Some(next)
    }

    /// The film with its last places. `None` when it is not the one that was searched for.
    #[inline]
    fn complete(&self, f: &Flow, v: f64, i: usize, at: &Step, front: Option<&FrontRow>) -> Option<Ruptured> {
        let q = f.u * self.face.drop(i, at.x) + v * self.face.s(at.x);
        let mut found = Ruptured { v, i, x: at.x, q, front: None };
        let f = Flow { v, ..*f };
        if let Some(r) = front {
            let (qf, late) = self.carried_to(&f, q, at.xf, true);
            if late != r.dry || at.xf <= at.x || at.xf >= self.face.length() {
                return None;
            }
            found.front = Some(Start { i: r.j, x: at.xf, q: qf, dry: r.dry });
        } else if f.pb > 0.0 && !self.has_ruptured(&f, &found) {
            return None;
        }
        Some(found)
    }
}
