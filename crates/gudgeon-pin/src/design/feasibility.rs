//! Which diameters and lengths the limits leave. Every limit is monotone in every dimension, so all of it is found by bisection.

use gudgeon_core::kinds::{PinQuantity, PinSize};

use super::{Design, GROWING_WITH_LENGTH};

/// What a limit asks of the length of a pin \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LengthBound {
    /// At least so long.
    AtLeast(f64),
    /// At most so long.
    AtMost(f64),
}

/// A limit that leaves no pin of an outer diameter, alone or together with another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockingLimit {
    /// The limit.
    pub limit: PinQuantity,
    /// The lengths that it leaves to a pin with the thickest wall; `None` when no length keeps it.
    pub length: Option<LengthBound>,
}

/// Halves the interval between an argument that is kept and one that is not, `steps` times or until no number is between them; returns
/// both ends, the kept one first.
fn bisect(mut kept: f64, mut broken: f64, steps: u32, keeps: impl Fn(f64) -> bool) -> (f64, f64) {
    for _ in 0..steps {
        let middle = 0.5 * (kept + broken);
        if middle == kept || middle == broken {
            break;
        }
        if keeps(middle) {
            kept = middle;
        } else {
            broken = middle;
        }
    }
    (kept, broken)
}

/// Whether a limit bounds the length from one side.
const fn by_length(q: PinQuantity) -> bool {
    !matches!(q, PinQuantity::RodPressure | PinQuantity::ShearStress | PinQuantity::ResultantStress)
}

/// What the limits leave of the length of a pin with the thickest wall.
#[derive(Default)]
struct Lengths {
    /// Limits that no length keeps.
    never: Vec<BlockingLimit>,
    /// The limit with the largest minimum length \[m\].
    min: Option<(PinQuantity, f64)>,
    /// The limit with the smallest maximum length \[m\].
    max: Option<(PinQuantity, f64)>,
}

/// Utilisations less one of pins of one outer diameter with the thickest wall, over their length.
struct Excess<'a, 'b> {
    design: &'a Design<'b>,
    outer: f64,
    inner: f64,
}

impl Excess<'_, '_> {
    /// Utilisation of a limit less one; infinite outside the model.
    fn of(&self, q: PinQuantity, length: f64) -> f64 {
        let size = PinSize { length, outer: self.outer, inner: self.inner };
        self.design.utilisation(&size).map_or(f64::INFINITY, |u| u[q as usize]) - 1.0
    }

    fn breaks(&self, q: PinQuantity, length: f64) -> bool {
        self.of(q, length) > 0.0
    }

    /// What the limits that depend on the length leave of it; the resultant stress, which falls and rises again, is judged apart.
    fn lengths(&self) -> Lengths {
        let (low, high) = (self.design.length.low, self.design.length.high);
        let mut out = Lengths::default();
        for limit in PinQuantity::ALL.into_iter().filter(|q| by_length(*q)) {
            let grows = GROWING_WITH_LENGTH.contains(&limit);
            let (worst, best) = if grows { (high, low) } else { (low, high) };
            if self.breaks(limit, best) {
                out.never.push(BlockingLimit { limit, length: None });
            } else if self.breaks(limit, worst) {
                let at = bisect(best, worst, 80, |l| !self.breaks(limit, l)).0;
                if grows && out.max.is_none_or(|(_, v)| at < v) {
                    out.max = Some((limit, at));
                } else if !grows && out.min.is_none_or(|(_, v)| at > v) {
                    out.min = Some((limit, at));
                }
            }
        }
        out
    }

    /// Whether the resultant stress exceeds its limit at every length of an interval. It falls and rises again: its minimum is searched by
    /// golden sections.
    fn resultant_never_kept(&self, from: f64, to: f64) -> bool {
        let resultant = |l: f64| self.of(PinQuantity::ResultantStress, l);
        let (mut a, mut b) = (from, to);
        for _ in 0..100 {
            let (x, y) = (a + 0.382 * (b - a), a + 0.618 * (b - a));
            // Nothing is left between them.
            if x <= a || y >= b {
                break;
            }
            let (at_x, at_y) = (resultant(x), resultant(y));
            if at_x <= 0.0 || at_y <= 0.0 {
                return false;
            }
            if at_x < at_y {
                b = y;
            } else {
                a = x;
            }
        }
        [from, a, b, to].into_iter().all(|l| resultant(l) > 0.0)
    }
}

impl Design<'_> {
    /// The maximum inner diameter that all limits admit at a length and an outer diameter \[m\], to rounding; `None` when even the minimum
    /// is too large.
    #[must_use]
    pub fn max_feasible_inner(&self, length: f64, outer: f64) -> Option<f64> {
        self.max_feasible_inner_over(length, length, outer, 1e-16)
    }

    /// As [`Design::max_feasible_inner`] for the best length of a range, to `rounding` of the outer diameter, from above.
    pub(crate) fn max_feasible_inner_over(
        &self,
        shortest: f64,
        longest: f64,
        outer: f64,
        rounding: f64,
    ) -> Option<f64> {
        let keeps = |inner: f64| {
            // Limits that fall with the length are kept best by the longest pin, the others by the shortest.
            let t = &self.tolerance;
            let worn = |length: f64| PinSize { length, outer: outer - t.outer, inner: inner + t.inner };
            self.utilisation_between(&worn(longest - t.length), &worn(shortest + t.length))
                .is_ok_and(|u| u.iter().all(|u| *u <= 1.0))
        };
        let (mut lo, mut hi) = (self.min_inner(outer), self.max_inner(outer));
        if !(lo <= hi && keeps(lo)) {
            return None;
        }
        if keeps(hi) {
            return Some(hi);
        }
        while hi - lo > rounding * outer {
            let mid = 0.5 * (lo + hi);
            if mid <= lo || mid >= hi {
                break;
            }
            if keeps(mid) {
                lo = mid;
            } else {
                hi = mid;
            }
        }
        // To rounding the admitted end, which is feasible; coarser, the end that bounds it.
        Some(if rounding > 1e-12 { hi } else { lo })
    }

    /// The maximum inner diameter that one limit admits at a length and an outer diameter \[m\]; `None` when it admits none, the wall's own
    /// when it never binds.
    #[must_use]
    pub fn max_inner_of_limit(&self, q: PinQuantity, length: f64, outer: f64) -> Option<f64> {
        let keeps = |inner: f64| {
            self.utilisation(&PinSize { length, outer, inner }).is_ok_and(|u| u[q as usize] <= 1.0)
        };
        let (lo, hi) = (self.min_inner(outer), self.max_inner(outer));
        (lo <= hi && keeps(lo)).then(|| bisect(lo, hi, 60, keeps).0)
    }

    /// Which limits leave no pin of this outer diameter, with the lengths that they leave to a pin with the minimum bore; empty when there
    /// is one. Two limits that contradict each other stand one after the other, the one with the minimum length first.
    #[must_use]
    pub fn blocking_limits(&self, outer: f64) -> Vec<BlockingLimit> {
        let pins = Excess { design: self, outer, inner: self.min_inner(outer) };
        let (low, high) = (self.length.low, self.length.high);
        let any_length = [PinQuantity::RodPressure, PinQuantity::ShearStress].into_iter();
        let mut out: Vec<BlockingLimit> = any_length
            .filter(|q| pins.breaks(*q, high))
            .map(|limit| BlockingLimit { limit, length: None })
            .collect();
        let Lengths { never, min, max } = pins.lengths();
        out.extend(never);
        if !out.is_empty() {
            return out;
        }
        let (from, to) = (min.map_or(low, |(_, l)| l), max.map_or(high, |(_, l)| l));
        if from > to {
            let bound = |(limit, length)| BlockingLimit { limit, length: Some(length) };
            out.extend(min.map(|(q, l)| bound((q, LengthBound::AtLeast(l)))));
            out.extend(max.map(|(q, l)| bound((q, LengthBound::AtMost(l)))));
        } else if pins.resultant_never_kept(from, to) {
            out.push(BlockingLimit { limit: PinQuantity::ResultantStress, length: None });
        }
        out
    }

    /// Minimum outer diameter of the range for which there is a pin \[m\], to rounding; `None` when there is none. Every limit is easier to
    /// keep with a larger outer diameter.
    #[must_use]
    pub fn min_feasible_outer(&self) -> Option<f64> {
        let possible = |outer: f64| {
            self.min_inner(outer) <= self.max_inner(outer) && self.blocking_limits(outer).is_empty()
        };
        let (lo, hi) = (self.outer.low, self.outer.high);
        if possible(lo) {
            return Some(lo);
        }
        possible(hi).then(|| bisect(hi, lo, 60, possible).0)
    }
}
