//! Quick searches for films with one cavity at most, from where the cavity was last.

use super::crown::{Asked, Crowned};
use super::flow::Flow;
use super::reformation::Start;
use super::ruptured::Ruptured;
use super::shape::Shape;
use super::side::{Ask, Side, Warm};
use crate::cavitation::Cavitation;

/// What the quick searches find.
#[derive(Debug, Clone, Copy)]
pub(super) enum Quick {
    Full { v: f64, q: f64 },
    Ruptured(Ruptured),
}

impl<S: Shape> Side<S> {
    /// Whether the quick searches know this film: one cavity at most.
    pub(super) fn simple(&self, f: &Flow, cavitation: Cavitation) -> bool {
        self.face.convex()
            && f.u > 0.0
            && matches!(cavitation, Cavitation::MassConserving | Cavitation::SwiftStieber)
    }

    /// The squeeze velocity at which a full film, which is linear in it, carries `target`.
    pub(super) fn full_v(&mut self, f: &Flow, target: f64) -> f64 {
        let m = self.face.whole();
        let w = m.x3 / m.i3;
        let ends = self.face.s(self.face.length()) * f.pb - self.face.s(0.0) * f.pa;
        let still = ends - f.u * m.e2 + w * (f.pa - f.pb + f.u * m.d2);
        (still - target) / (m.xx3 - m.x3 * w)
    }

    /// Fills `islands` with what a quick search found and keeps it as a start.
    pub(super) fn keep_found(&mut self, f: &Flow, found: &Quick, ask: Ask) {
        self.islands.clear();
        self.starts[ask as usize] = match found {
            Quick::Full { q, .. } => {
                self.push_full(f, *q);
                None
            }
            Quick::Ruptured(r) => {
                let m = self.lead_to(r.i, r.x);
                let w = m.x3 / m.i3;
                self.push_lead(f, r.i, r.x, 0.0, r.q, w, m);
                let rising = f.u * self.face.slope(r.i, r.x) + f.v;
                let xr_v = (w - self.face.s(r.x)) / rising;
                let (mut xf, mut xf_v) = (self.face.length(), 0.0);
                if let Some(start) = r.front {
                    let m = self.trail_from(start.i, start.x);
                    self.push_behind(f, start, self.face.pieces() - 1, xf, f.pb, w, m);
                    xf = start.x;
                    if !start.dry {
                        let h = self.face.film() + self.face.drop(start.i, xf);
                        xf_v = (m.x3 - w * m.i3) * (h * h * h) / self.n(f, start.i, xf, start.q);
                    }
                }
                Some(Warm { v: f.v, xr: r.x, xf, xr_v, xf_v })
            }
        };
    }

    /// The film at a squeeze velocity, from where its cavity was last; `None` sends to the safe search.
    ///
    /// A convex face has one pressure minimum, so that each of the two places is the only zero of a monotone function, and a
    /// film that has both is ruptured: whatever start converges, converges to the one film, and only rounding depends on it.
    pub(super) fn quick_rate(&mut self, f: &Flow, cavitation: Cavitation) -> Option<Quick> {
        if !self.simple(f, cavitation) {
            return None;
        }
        if let Some(w) = self.warm
            && let Some(r) = self.ruptured(f, cavitation, w)
        {
            return Some(Quick::Ruptured(r));
        }
        match self.full(f)? {
            Ok(q) => Some(Quick::Full { v: f.v, q }),
            Err(start) => self.ruptured(f, cavitation, start).map(Quick::Ruptured),
        }
    }

    /// The film under a load, as [`Self::quick_rate`].
    pub(super) fn quick_load(&mut self, f: &Flow, cavitation: Cavitation, target: f64) -> Option<Quick> {
        if !self.simple(f, cavitation) {
            return None;
        }
        if let Some(w) = self.warm
            && let Some(r) = self.loaded(f, cavitation, target, w)
        {
            return Some(Quick::Ruptured(r));
        }
        let mut f = *f;
        f.v = self.full_v(&f, target);
        if !f.v.is_finite() {
            return None;
        }
        match self.full(&f)? {
            Ok(q) => Some(Quick::Full { v: f.v, q }),
            Err(start) => self.loaded(&f, cavitation, target, start).map(Quick::Ruptured),
        }
    }

    /// The film of a crowned face at `f.v` or, if one is given, under a load, from where its cavity was last; lays it and says whether
    /// it did.
    #[inline]
    pub(super) fn crowned(
        &mut self,
        f: &mut Flow,
        cavitation: Cavitation,
        load: Option<f64>,
        ask: Ask,
    ) -> bool {
        let (Some(w), true) = (self.starts[ask as usize], self.simple(f, cavitation)) else { return false };
        let Some(crown) = self.face.crown() else { return false };
        let trailing = cavitation == Cavitation::MassConserving && f.pb > 0.0;
        let asked = Asked { u: f.u, pa: f.pa, pb: f.pb, trailing };
        let found = match load {
            Some(load) => crown.under_load(&asked, load, w.xr, w.xf),
            None => crown.at_rate(&asked, f.v, w.xr, w.xf),
        };
        let Some(Crowned { v, x, q, w, ref lead, ref front }) = found else { return false };
        f.v = v;
        self.islands.clear();
        self.push_lead(f, 0, x, 0.0, q, w, *lead);
        let mut xf = self.face.length();
        if let Some((x, m)) = front {
            self.push_behind(f, Start { i: 0, x: *x, q, dry: false }, 0, xf, f.pb, w, *m);
            xf = *x;
        }
        self.starts[ask as usize] = Some(Warm { v, xr: x, xf, xr_v: 0.0, xf_v: 0.0 });
        true
    }

    /// Flux of the full film, or where it would rupture. `None` when it does at the edge itself.
    pub(super) fn full(&mut self, f: &Flow) -> Option<Result<f64, Warm>> {
        let q = self.full_q(f);
        if f.pa <= 0.0 && q > f.u * self.face.drop(0, 0.0) + f.v * self.face.s(0.0) {
            return None;
        }
        for i in 0..self.face.pieces() {
            if let Some(x) = self.face.pressure_minimum(i, f.u, f.v, q) {
                let m = self.lead_to(i, x);
                let p = f.pa + m.pressure().rise(f.u, f.v, q);
                if p >= 0.0 {
                    break;
                }
                return Some(Err(Warm { v: f.v, xr: x, xf: self.behind(f, i, x, p), xr_v: 0.0, xf_v: 0.0 }));
            }
        }
        Some(Ok(q))
    }

    /// Where the pressure is zero again that has the minimum `p < 0` at `x` in piece `i`, by its curvature there.
    pub(super) fn behind(&self, f: &Flow, i: usize, x: f64, p: f64) -> f64 {
        let h = self.face.film() + self.face.drop(i, x);
        let rising = f.u * self.face.slope(i, x) + f.v;
        (x + (-2.0 * p * h * h * h / rising).sqrt()).min(0.5 * (x + self.face.length()))
    }
}
