//! The films that a search has found, as stretches with their integrals.

use super::flow::{Flow, Island};
use super::moments::Moments;
use super::reformation::Start;
use super::shape::Shape;
use super::side::Side;

impl<S: Shape> Side<S> {
    pub(super) fn push_full(&mut self, f: &Flow, q: f64) {
        let m = self.face.whole();
        self.push_lead(f, self.face.pieces() - 1, self.face.length(), f.pb, q, m.x3 / m.i3, m);
    }

    /// The film at the leading edge, to `x` in piece `i`.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn push_lead(&mut self, f: &Flow, i: usize, x: f64, pb: f64, q: f64, w: f64, m: Moments) {
        self.islands.push(Island {
            ia: 0,
            xa: 0.0,
            pa: f.pa,
            ib: i,
            xb: x,
            pb,
            q,
            w,
            ra: 0.0,
            rb: 0.0,
            upwards: true,
            m,
        });
    }

    pub(super) fn push_trailing(&mut self, f: &Flow, start: Start, ie: usize, xe: f64, pe: f64, w: f64) {
        let m = self.face.span(start.i, start.x, ie, xe);
        self.push_behind(f, start, ie, xe, pe, w, m);
    }

    #[allow(clippy::too_many_arguments)]
    pub(super) fn push_behind(
        &mut self,
        f: &Flow,
        start: Start,
        ie: usize,
        xe: f64,
        pe: f64,
        w: f64,
        m: Moments,
    ) {
        let w = if start.dry {
            // The flux constant moves with the front, and the front with v.
            let s = self.face.s(start.x);
            let h = self.face.film() + self.face.drop(start.i, start.x);
            let n = self.n(f, start.i, start.x, start.q);
            s + f.v * (m.x3 - s * m.i3) / (n / (h * h * h) + f.v * m.i3)
        } else {
            w
        };
        self.islands.push(Island {
            ia: start.i,
            xa: start.x,
            pa: 0.0,
            ib: ie,
            xb: xe,
            pb: pe,
            q: start.q,
            w,
            ra: w * m.i3 - m.x3,
            rb: 0.0,
            upwards: false,
            m,
        });
    }

    /// Films inside the cavity of a face that waves: each ends at a pressure minimum.
    #[allow(clippy::too_many_arguments)]
    pub(super) fn middle(&mut self, f: &Flow, q: f64, w: f64, ir: usize, xr: f64, from: Start) {
        if self.face.convex() {
            return;
        }
        let (mut i, mut below) = (from.i, from.x);
        // At a minimum the film carries u h/2 > 0: the cavity before it has not run dry.
        loop {
            let minimum =
                self.face.pressure_minimum(i, f.u, f.v, q).filter(|x| *x < below && (i > ir || *x > xr));
            if let Some(xe) = minimum
                && i > ir
            {
                let start = self.reform(f, q, ir, xr, i, xe, 0.0, false);
                if start.x < xe {
                    self.push_trailing(f, start, i, xe, 0.0, w);
                    i = start.i;
                    below = start.x;
                    if i > ir {
                        continue;
                    }
                    return;
                }
            }
            if i <= ir {
                return;
            }
            i -= 1;
        }
    }
}
