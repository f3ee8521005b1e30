//! Where the film at the leading edge ruptures: the search that always ends.

use gudgeon_core::EvalError;

use super::errors::no_convergence;
use super::flow::Flow;
use super::shape::Shape;
use super::side::Side;

/// A pressure minimum, and the integrals up to it.
pub(super) struct Minimum<S: Shape> {
    pub p: f64,
    pub i: usize,
    pub x: f64,
    pub head: S::Head,
}

impl<S: Shape> Clone for Minimum<S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Shape> Copy for Minimum<S> {}

/// How the film that begins at the leading edge ends.
pub(super) enum Lead<S: Shape> {
    /// At the trailing edge.
    Full { q: f64 },
    /// Where pressure and gradient vanish.
    Rupture { q: f64, at: Minimum<S> },
}

impl<S: Shape> Side<S> {
    /// The lowest of the pressure minima of the film that starts with `pa` at 0 and has the flux `q`.
    pub(super) fn lowest_minimum(&self, f: &Flow, q: f64) -> Option<Minimum<S>> {
        let mut low: Option<Minimum<S>> = None;
        for i in 0..self.face.pieces() {
            if let Some(x) = self.face.pressure_minimum(i, f.u, f.v, q) {
                let head = self.face.head(i, x);
                let p = f.pa + S::three(&head).rise(f.u, f.v, q);
                if low.as_ref().is_none_or(|l| p < l.p) {
                    low = Some(Minimum { p, i, x, head });
                }
            }
        }
        low
    }

    /// The film at the leading edge.
    ///
    /// As a function of the flux, every pressure minimum is concave and falls (`dp/dq = -∫dx/h³` up to it, which grows), and
    /// so does the lowest of them. The flux sought is the largest that leaves no pressure negative; from the full film,
    /// where the lowest is negative, second-order steps on a concave function approach it from one side.
    pub(super) fn lead(&mut self, f: &Flow) -> Result<Lead<S>, EvalError> {
        // Without pressure at the leading edge the pressure has to rise from there.
        let limit = f.u * self.face.drop(0, 0.0) + f.v * self.face.s(0.0);
        if let Some(w) = self.warm
            && self.face.convex()
            && f.u > 0.0
        {
            // One minimum only: if the film ruptures at all, it is there, and the start does not matter.
            let i = self.face.piece_of(w.xr);
            let q = f.u * self.face.drop(i, w.xr) + f.v * self.face.s(w.xr);
            if (f.pa > 0.0 || q < limit)
                && let Some(Lead::Rupture { q, at }) = self.film_with_zero_minimum(f, q, f64::NAN)
                && self.face.tail(at.i, at.x).rise(f.u, f.v, q) >= f.pb
            {
                return Ok(Lead::Rupture { q, at });
            }
        }
        let full = self.full_q(f);
        let held = f.pa <= 0.0 && full > limit;
        let q = if held { limit } else { full };
        let minimum = self.lowest_minimum(f, q);
        if minimum.is_none_or(|v| v.p >= 0.0) {
            return Ok(if held {
                let head = self.face.head(0, 0.0);
                Lead::Rupture { q, at: Minimum { p: 0.0, i: 0, x: 0.0, head } }
            } else {
                Lead::Full { q }
            });
        }
        self.film_with_zero_minimum(f, q, q).ok_or_else(|| no_convergence("rupture"))
    }

    /// The film whose lowest minimum is zero, from the flux `q`; `hi` is a flux known to be too large, if any. `None`: no
    /// convergence.
    pub(super) fn film_with_zero_minimum(&self, f: &Flow, mut q: f64, mut hi: f64) -> Option<Lead<S>> {
        let mut lo = f64::NAN;
        let mut minimum = self.lowest_minimum(f, q);
        for _ in 0..200 {
            let mut close = None;
            let next = match minimum {
                Some(at) => {
                    let Minimum { p, i, x, head } = at;
                    let t = S::three(&head);
                    let scale = f.pa.abs() + (f.u * t.d2).abs() + (f.v * t.x3).abs() + (q * t.i3).abs();
                    if p.abs() <= 2.0 * f64::EPSILON * scale {
                        return Some(Lead::Rupture { q, at });
                    }
                    if p < 0.0 {
                        hi = q;
                    } else {
                        lo = q;
                    }
                    let h = self.face.film() + self.face.drop(i, x);
                    let slope = self.face.slope(i, x);
                    let rising = f.u * slope + f.v;
                    let bend = -1.0 / (h * h * h * rising);
                    let newton = p / t.i3;
                    // Quadratic model of p(q): exact where the film is short and p has a double zero.
                    let r = newton * bend / -t.i3;
                    let step = 2.0 * newton / (1.0 + (1.0 + 2.0 * r).max(0.0).sqrt());
                    // Both the bend itself and what it changes with have to be small over the step.
                    let dx = (step / rising).abs();
                    if r.abs() < 1e-5 && dx <= 1e-6 * x && dx * slope.abs() <= 1e-6 * h {
                        close = Some(i);
                    }
                    q + step
                }
                None => {
                    lo = q;
                    f64::NAN
                }
            };
            let inside = next.is_finite() && (hi.is_nan() || next < hi) && (lo.is_nan() || next > lo);
            let next = if inside { next } else { 0.5 * (lo + hi) };
            if !next.is_finite() {
                return None;
            }
            if next == q || next == hi || next == lo {
                // The bracket has closed to neighbouring numbers.
                return minimum.map(|at| Lead::Rupture { q, at });
            }
            q = next;
            minimum = self.lowest_minimum(f, q);
            // The step was of third order if it stayed in one piece: what is left is below rounding.
            if let (Some(c), Some(at)) = (close, minimum)
                && c == at.i
                && inside
            {
                return Some(Lead::Rupture { q, at });
            }
        }
        None
    }
}
