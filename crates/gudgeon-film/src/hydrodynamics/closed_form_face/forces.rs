//! Friction, flux and highest pressure of the films found last.

use gudgeon_core::kinds::FaceForces;

use super::cavity_shear::CavityShear;
use super::flow::Flow;
use super::load::Carried;
use super::shape::Shape;
use super::side::Side;
use crate::cavitation::Cavitation;

impl<S: Shape> Side<S> {
    /// Load and friction of the films found last, in this sliding direction.
    pub(super) fn forces(
        &mut self,
        f: &Flow,
        cavitation: Cavitation,
        shear: CavityShear,
        mu: f64,
    ) -> FaceForces {
        let h0 = self.face.film();
        let mut c = Carried::default();
        let (mut gradient, mut sheared, mut ends) = (0.0, 0.0, 0.0);
        for l in &self.islands {
            let m = &l.m;
            self.carry(f, l, &mut c);
            gradient += f.u * (m.i1 - h0 * m.i2) + f.v * m.x2 - l.q * m.i2;
            sheared += m.i1;
            // Most ends have no pressure.
            if l.pa != 0.0 {
                ends -= l.pa * (h0 + self.face.drop(l.ia, l.xa));
            }
            if l.pb != 0.0 {
                ends += l.pb * (h0 + self.face.drop(l.ib, l.xb));
            }
        }
        let mut couette = 2.0 * f.u * sheared;
        if shear != CavityShear::None && f.u != 0.0 {
            couette += self.gaps_shear(f, cavitation, shear);
        }
        let k = 12.0 * mu;
        let (j, viscous) = (k * gradient, mu * couette);
        FaceForces {
            load: k * c.load,
            squeeze_damping: -(k * c.rate).min(0.0),
            ring_shear: viscous - 0.5 * j,
            liner_shear: viscous + 0.5 * j,
            slope_force: j - k * ends,
            flux: self.flux(f),
        }
    }

    /// Flux at the leading edge in this sliding direction; that of the cut film where it is cut.
    pub(super) fn flux(&self, f: &Flow) -> f64 {
        let q = self.islands.first().map_or(0.0, |l| l.q);
        f.u * self.face.film() + q - f.v * self.face.s(0.0)
    }

    /// Highest pressure over `12 μ` and extent of the film that has it, of the films found last.
    pub(super) fn peak(&self, f: &Flow) -> (f64, (f64, f64)) {
        let mut high = f64::NEG_INFINITY;
        let mut extent = (0.0, 0.0);
        for l in &self.islands {
            let mut p = l.pa.max(l.pb);
            for i in l.ia..=l.ib {
                if let Some(x) = self.face.pressure_maximum(i, f.u, f.v, l.q)
                    && x > l.xa
                    && x < l.xb
                {
                    p = p.max(self.pressure_in(f, l, i, x));
                }
            }
            if p > high {
                high = p;
                extent = (l.xa, l.xb);
            }
        }
        (if self.islands.is_empty() { 0.0 } else { high }, extent)
    }

    /// `∫ u w/h dx` over the gaps between the films, in order along the face.
    pub(super) fn gaps_shear(&mut self, f: &Flow, cavitation: Cavitation, shear: CavityShear) -> f64 {
        let (last, len) = (self.face.pieces() - 1, self.face.length());
        let lead = self.islands.first().filter(|l| l.xa <= 0.0).map(|l| (l.q, l.ib, l.xb));
        if let (
            Some((q, i, x)),
            Cavitation::MassConserving | Cavitation::SwiftStieber,
            CavityShear::Streamers,
        ) = (lead, cavitation, shear)
            && self.islands.len() <= 2
        {
            // One gap: all but the films. Its digits count beside those of the films.
            let front = self.islands.get(1).map_or((last, len), |l| (l.ia, l.xa));
            if front.1 <= x {
                return 0.0;
            }
            let q0 = q + f.u * self.face.film();
            if q0 - f.v * self.face.s(front.1) >= 0.0 {
                let whole = self.face.whole();
                let (mut i2, mut x2) = (whole.i2, whole.x2);
                for l in &self.islands {
                    i2 -= l.m.i2;
                    x2 -= l.m.x2;
                }
                return 2.0 * (q0 * i2 - f.v * x2);
            }
            return self.gap_shear(f, cavitation, shear, Some(q), (i, x), front);
        }
        self.islands.sort_unstable_by(|a, b| a.xa.total_cmp(&b.xa));
        let q = lead.map(|l| l.0);
        let mut sum = 0.0;
        let (mut i, mut x) = (0, 0.0);
        for k in 0..=self.islands.len() {
            let next = self.islands.get(k).map_or((last, len, last, len), |l| (l.ia, l.xa, l.ib, l.xb));
            if next.1 > x {
                sum += self.gap_shear(f, cavitation, shear, q, (i, x), (next.0, next.1));
            }
            (i, x) = (next.2, next.3);
        }
        sum
    }

    /// `∫ u w/h dx` over a stretch without full film, `w` the filled fraction.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn gap_shear(
        &self,
        f: &Flow,
        cavitation: Cavitation,
        shear: CavityShear,
        lead: Option<f64>,
        a: (usize, f64),
        b: (usize, f64),
    ) -> f64 {
        let h0 = self.face.film();
        if shear == CavityShear::Full {
            return 2.0 * f.u * self.face.span(a.0, a.1, b.0, b.1).i1;
        }
        if let (true, Some(q)) = (cavitation != Cavitation::HalfSommerfeld, lead) {
            // θ = (q0 - v s)/(u h), until it runs dry.
            let q0 = q + f.u * h0;
            let mut b = b;
            if f.v > 0.0 {
                let dry = self.face.x_ref() + q0 / f.v;
                if dry <= a.1 {
                    return 0.0;
                }
                if dry < b.1 {
                    b = (self.face.piece_of(dry), dry);
                }
            }
            let m = self.face.span(a.0, a.1, b.0, b.1);
            return 2.0 * (q0 * m.i2 - f.v * m.x2);
        }
        // The clip has no flux of its own: what passes the narrowest place fills the rest to that height.
        let m = self.face.span(a.0, a.1, b.0, b.1);
        2.0 * f.u * (h0 + self.face.lowest_between(a.0, a.1, b.0, b.1)) * m.i2
    }
}
