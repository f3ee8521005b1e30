//! The film at a squeeze velocity and the film under a load: the quick way first, else searches that always end.

use gudgeon_core::EvalError;

use super::errors::{MODEL, finite, no_convergence};
use super::flow::Flow;
use super::quick::Quick;
use super::reformation::Start;
use super::rupture::{Lead, Minimum};
use super::ruptured::Ruptured;
use super::shape::Shape;
use super::side::{Ask, Side, Warm};
use crate::cavitation::Cavitation;

impl<S: Shape> Side<S> {
    /// Fills `islands` for the film at the given squeeze velocity.
    pub(super) fn solve(&mut self, f: &mut Flow, cavitation: Cavitation) -> Result<(), EvalError> {
        if self.crowned(f, cavitation, None, Ask::Rate) {
            return Ok(());
        }
        self.warm = self.starts[Ask::Rate as usize];
        if let Some(found) = self.quick_rate(f, cavitation) {
            self.keep_found(f, &found, Ask::Rate);
            return Ok(());
        }
        self.search(f, cavitation)?;
        self.starts[Ask::Rate as usize] = self.warm;
        Ok(())
    }

    /// [`Self::solve`] by searches that always end.
    pub(super) fn search(&mut self, f: &Flow, cavitation: Cavitation) -> Result<(), EvalError> {
        self.islands.clear();
        let last = self.face.pieces() - 1;
        let len = self.face.length();
        match cavitation {
            Cavitation::FullSommerfeld => {
                let q = self.full_q(f);
                self.push_full(f, q);
            }
            Cavitation::HalfSommerfeld => self.clip(f),
            Cavitation::MassConserving | Cavitation::SwiftStieber => match self.lead(f)? {
                Lead::Full { q } => {
                    self.warm = None;
                    self.push_full(f, q);
                }
                Lead::Rupture { q, at: Minimum { i, x, head, .. } } => {
                    let m = self.face.complete(i, x, &head);
                    let w = if x > 0.0 { m.x3 / m.i3 } else { self.face.s(0.0) };
                    self.push_lead(f, i, x, 0.0, q, w, m);
                    let mut xf = len;
                    // The trailing edge has a film if there is pressure, or if the gap narrows towards it.
                    let trailing = f.pb > 0.0 || self.n(f, last, len, q) < 0.0;
                    if (cavitation == Cavitation::MassConserving || f.u == 0.0) && trailing {
                        let start = self.reform(f, q, i, x, last, len, f.pb, true);
                        xf = start.x;
                        self.push_trailing(f, start, last, len, f.pb, w);
                        self.middle(f, q, w, i, x, start);
                    } else if cavitation == Cavitation::MassConserving {
                        let start = Start { i: last, x: len, q, dry: false };
                        self.middle(f, q, w, i, x, start);
                    }
                    self.warm = Some(Warm { v: f.v, xr: x, xf, xr_v: 0.0, xf_v: 0.0 });
                }
            },
        }
        Ok(())
    }

    /// Sets `f.v` to the squeeze velocity at which the film carries `target` (over `12 μ`), and finds that film.
    pub(super) fn squeeze(
        &mut self,
        f: &mut Flow,
        cavitation: Cavitation,
        target: f64,
    ) -> Result<(), EvalError> {
        if target <= 0.0 && cavitation != Cavitation::FullSommerfeld {
            return Err(EvalError::recoverable(MODEL, "a cavitating film carries no load of zero or less"));
        }
        if self.crowned(f, cavitation, Some(target), Ask::Load) {
            return Ok(());
        }
        self.warm = self.starts[Ask::Load as usize];
        if let Some(found) = self.quick_load(f, cavitation, target) {
            f.v = match found {
                Quick::Full { v, .. } | Quick::Ruptured(Ruptured { v, .. }) => v,
            };
            self.keep_found(f, &found, Ask::Load);
            return Ok(());
        }
        let full = finite(self.full_v(f, target), "squeeze velocity")?;
        let m = self.face.whole();
        let unit = target / (m.xx3 - m.x3 * m.x3 / m.i3);
        if cavitation == Cavitation::HalfSommerfeld
            && let Some(v) = self.v_cut
        {
            f.v = v;
            if self.bracketed(f, cavitation, target, unit).is_ok() {
                self.v_cut = Some(f.v);
                return Ok(());
            }
        }
        f.v = full;
        self.search(f, cavitation)?;
        if cavitation != Cavitation::FullSommerfeld
            && !matches!(self.islands.as_slice(), [l] if l.xa <= 0.0 && l.xb >= self.face.length())
        {
            self.bracketed(f, cavitation, target, unit)?;
            self.v_cut = Some(f.v);
        }
        self.starts[Ask::Load as usize] = self.warm;
        Ok(())
    }

    /// Safeguarded Newton on the load, which never rises with `v`, from `f.v`; leaves the film that carries it.
    pub(super) fn bracketed(
        &mut self,
        f: &mut Flow,
        cavitation: Cavitation,
        target: f64,
        unit: f64,
    ) -> Result<(), EvalError> {
        let (mut lo, mut hi) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut v = f.v;
        let mut reach = 0.0_f64;
        for _ in 0..400 {
            f.v = v;
            self.search(f, cavitation)?;
            let c = self.carried(f);
            let g = c.load - target;
            if !(g.is_finite() && c.rate.is_finite()) {
                return Err(EvalError::recoverable(MODEL, "film out of range"));
            }
            // The rate of a film of no length is zero, of either sign.
            let step = g / c.rate.abs();
            if g.abs() <= 4.0 * f64::EPSILON * c.size || step.abs() <= 1e-15 * v.abs() {
                return Ok(());
            }
            if g > 0.0 {
                lo = v;
            } else {
                hi = v;
            }
            let mut next = v + step;
            if lo.is_finite() && hi.is_finite() {
                if !(next > lo && next < hi) {
                    next = 0.5 * (lo + hi);
                    if next == lo || next == hi {
                        f.v = next;
                        return self.search(f, cavitation);
                    }
                }
            } else {
                // A film that carries next to nothing does not show where it would carry more.
                reach = (4.0 * reach).max(v.abs()).max(unit);
                next = next.clamp(v - reach, v + reach);
            }
            if next.abs() > 1e30 {
                return Err(EvalError::recoverable(MODEL, "no squeeze velocity gives this load"));
            }
            v = next;
        }
        Err(no_convergence("squeeze velocity"))
    }
}
