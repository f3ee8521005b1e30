//! What a gudgeon pin must keep, what it weighs, and which lengths each limit leaves.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{PIN_QUANTITIES, PinForces, PinQuantity, PinSize, PinStrength, resultant_stress};
use gudgeon_numerics::jet::Real;

/// The flats ("espelhos") cut from the sides of a piston beyond the ends of the pin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relief {
    /// Piston diameter D \[m\].
    pub bore: f64,
    /// Height of the flats \[m\].
    pub height: f64,
    /// Density of the piston \[kg/m³\].
    pub density: f64,
}

impl Relief {
    /// Mass removed \[kg\]: two circular segments beyond `±L/2`,
    /// `A = D²/2 acos(L/D) - L/2 √(D² - L²)`.
    pub fn mass<T: Real>(&self, length: T) -> T {
        let d = self.bore;
        let segments =
            (length / d).acos() * (0.5 * d * d) - length * (-length.squared() + d * d).sqrt() * 0.5;
        segments * (self.height * self.density)
    }
}

/// Masses that the design weighs \[kg\].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Masses {
    /// The pin.
    pub pin: f64,
    /// What is relieved on the piston.
    pub relieved: f64,
}

impl Masses {
    /// What is to be small: the pin less the relief.
    #[must_use]
    pub fn differential(&self) -> f64 {
        self.pin - self.relieved
    }
}

/// Smallest and greatest value \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest.
    pub low: f64,
    /// Greatest.
    pub high: f64,
}

impl Range {
    /// One value.
    #[must_use]
    pub const fn at(v: f64) -> Self {
        Self { low: v, high: v }
    }
    /// Whether it holds one value only.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        self.high <= self.low
    }
}

/// A pin to be sized: model, load, limits, weights, ranges.
#[derive(Debug, Clone, Copy)]
pub struct Design<'a> {
    /// Model of strength.
    pub strength: &'a dyn PinStrength,
    /// Force.
    pub load: PinForces,
    /// Greatest admitted value of each quantity, SI, in the order of [`PinQuantity::ALL`]; infinite where nothing is limited.
    pub limits: [f64; PIN_QUANTITIES],
    /// Density of the pin \[kg/m³\].
    pub density: f64,
    /// Ratio of circumference to diameter.
    pub pi: f64,
    /// Flats on the piston; without them the pin's own mass counts.
    pub relief: Option<Relief>,
    /// Free distance between the bosses \[m\].
    pub boss_gap: f64,
    /// Admitted lengths, above `boss_gap` and below the piston diameter.
    pub length: Range,
    /// Admitted outer diameters.
    pub outer: Range,
    /// Admitted inner diameters.
    pub inner: Range,
    /// Thinnest wall \[m\].
    pub least_wall: f64,
    /// Half widths of the tolerances: limits hold in every corner.
    pub tolerance: PinSize,
}

/// How the corners of the tolerances stand: shortest and longest pin with the smallest outer and greatest inner diameter.
pub(crate) fn corners(size: &PinSize, tol: &PinSize) -> (PinSize, PinSize) {
    let worn = PinSize { length: size.length, outer: size.outer - tol.outer, inner: size.inner + tol.inner };
    (
        PinSize { length: size.length - tol.length, ..worn },
        PinSize { length: size.length + tol.length, ..worn },
    )
}

/// Whether a quantity is greatest in the longest pin; the others are in the shortest, the resultant follows its parts.
pub(crate) const fn grows_with_length(q: PinQuantity) -> bool {
    matches!(q, PinQuantity::Deflection | PinQuantity::BendingStress)
}

/// A limit and the lengths that it leaves at one outer diameter, for the thickest wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forbids {
    /// The limit.
    pub limit: PinQuantity,
    /// What it asks of the length \[m\]: at least (`true`) or at most so much; no value when no length helps.
    pub needs: Option<(bool, f64)>,
}

impl Design<'_> {
    /// Quantities over their limits, each in the worst corner of the tolerances, in the order of [`PinQuantity::ALL`].
    ///
    /// # Errors
    /// Dimensions outside the model.
    pub fn utilisation(&self, size: &PinSize) -> Result<[f64; PIN_QUANTITIES], EvalError> {
        let (short, long) = corners(size, &self.tolerance);
        self.utilisation_between(&short, &long)
    }

    /// Quantities that fall with the length from `short`, those that grow with it from `long`, over their limits: bounds of the
    /// utilisation over a range of lengths, and the worst corner of tolerances.
    pub(crate) fn utilisation_between(
        &self,
        short: &PinSize,
        long: &PinSize,
    ) -> Result<[f64; PIN_QUANTITIES], EvalError> {
        let mut v = self.strength.quantities(short, &self.load)?;
        if short != long {
            let w = self.strength.quantities(long, &self.load)?;
            for q in PinQuantity::ALL.into_iter().filter(|q| grows_with_length(*q)) {
                v[q as usize] = w[q as usize];
            }
            v[PinQuantity::ResultantStress as usize] = resultant_stress(
                v[PinQuantity::BendingStress as usize],
                v[PinQuantity::OvalisationStress as usize],
            );
        }
        for (v, limit) in v.iter_mut().zip(self.limits) {
            *v /= limit;
        }
        Ok(v)
    }

    /// Mass of the pin and of the relief at the nominal dimensions.
    #[must_use]
    pub fn masses(&self, size: &PinSize) -> Masses {
        let PinSize { length, outer, inner } = *size;
        Masses {
            pin: self.pin_mass(length, outer, inner),
            relieved: self.relief.map_or(0.0, |r| r.mass(length.min(r.bore))),
        }
    }

    /// `ρ π/4 (d_o² - d_i²) L`.
    pub(crate) fn pin_mass<T: Real>(&self, length: T, outer: T, inner: T) -> T {
        (outer - inner) * (outer + inner) * length * (0.25 * self.pi * self.density)
    }

    /// Smallest inner diameter at an outer one.
    #[must_use]
    pub fn least_inner(&self, outer: f64) -> f64 {
        // The model must hold in the corner of the tolerances too.
        self.inner.low.max(self.strength.least_bore_ratio() * outer)
    }

    /// Greatest inner diameter at an outer one that leaves a wall, in every corner of the tolerances.
    #[must_use]
    pub fn greatest_inner(&self, outer: f64) -> f64 {
        let play = self.tolerance.outer + self.tolerance.inner;
        self.inner.high.min(outer - 2.0 * self.least_wall).min((outer - play) * (1.0 - 1e-9))
    }

    /// The greatest admitted inner diameter at a length and an outer diameter, to rounding; `None` when even the smallest is too
    /// large.
    #[must_use]
    pub fn greatest_bore(&self, length: f64, outer: f64) -> Option<f64> {
        self.bore_within(length, length, outer, 1e-16)
    }

    /// As [`Design::greatest_bore`] for the best length of a range, to `rounding` of the outer diameter, from above.
    pub(crate) fn bore_within(&self, shortest: f64, longest: f64, outer: f64, rounding: f64) -> Option<f64> {
        let keeps = |inner: f64| {
            // Limits that fall with the length are kept best by the longest pin, the others by the shortest.
            let t = &self.tolerance;
            let worn = |length: f64| PinSize { length, outer: outer - t.outer, inner: inner + t.inner };
            self.utilisation_between(&worn(longest - t.length), &worn(shortest + t.length))
                .is_ok_and(|u| u.iter().all(|u| *u <= 1.0))
        };
        let (mut lo, mut hi) = (self.least_inner(outer), self.greatest_inner(outer));
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

    /// The greatest inner diameter that one limit admits at a length and an outer diameter; `None` when it admits none, the wall's own when
    /// it never binds.
    #[must_use]
    pub fn bore_of_limit(&self, q: PinQuantity, length: f64, outer: f64) -> Option<f64> {
        let keeps = |inner: f64| {
            self.utilisation(&PinSize { length, outer, inner }).is_ok_and(|u| u[q as usize] <= 1.0)
        };
        let (mut lo, mut hi) = (self.least_inner(outer), self.greatest_inner(outer));
        if !(lo <= hi && keeps(lo)) {
            return None;
        }
        for _ in 0..60 {
            let mid = 0.5 * (lo + hi);
            if keeps(mid) {
                lo = mid;
            } else {
                hi = mid;
            }
        }
        Some(lo)
    }

    /// Which limits leave no pin of this outer diameter, with what they ask of the length of a pin with the smallest bore; empty when
    /// there is one. Two entries that contradict each other stand behind each other.
    #[must_use]
    pub fn forbids(&self, outer: f64) -> Vec<Forbids> {
        let inner = self.least_inner(outer);
        let (low, high) = (self.length.low, self.length.high);
        let over = |q: PinQuantity, length: f64| {
            let size = PinSize { length, outer, inner };
            self.utilisation(&size).map_or(f64::INFINITY, |u| u[q as usize]) - 1.0
        };
        let mut out = Vec::new();
        // What no length changes.
        for limit in [PinQuantity::RodPressure, PinQuantity::ShearStress] {
            if over(limit, high) > 0.0 {
                out.push(Forbids { limit, needs: None });
            }
        }
        let cut = |q: PinQuantity, mut bad: f64, mut good: f64| {
            for _ in 0..80 {
                let mid = 0.5 * (bad + good);
                if over(q, mid) > 0.0 {
                    bad = mid;
                } else {
                    good = mid;
                }
            }
            good
        };
        let mut least: Option<Forbids> = None;
        let mut most: Option<Forbids> = None;
        for limit in PinQuantity::ALL {
            let side = match limit {
                PinQuantity::RodPressure | PinQuantity::ShearStress | PinQuantity::ResultantStress => {
                    continue;
                }
                q => !grows_with_length(q),
            };
            let (worst, best) = if side { (low, high) } else { (high, low) };
            if over(limit, best) > 0.0 {
                out.push(Forbids { limit, needs: None });
            } else if over(limit, worst) > 0.0 {
                let at = cut(limit, worst, best);
                let entry = Forbids { limit, needs: Some((side, at)) };
                let tightest = if side { &mut least } else { &mut most };
                let tighter =
                    tightest.and_then(|t| t.needs).is_none_or(|(_, v)| if side { at > v } else { at < v });
                if tighter {
                    *tightest = Some(entry);
                }
            }
        }
        if !out.is_empty() {
            return out;
        }
        let at = |f: &Option<Forbids>, otherwise: f64| f.and_then(|f| f.needs).map_or(otherwise, |(_, v)| v);
        let (from, to) = (at(&least, low), at(&most, high));
        if from > to {
            out.extend(least);
            out.extend(most);
            return out;
        }
        // The resultant falls and rises again: its least value between both ends.
        let (mut a, mut b) = (from, to);
        for _ in 0..100 {
            let (x, y) = (a + 0.382 * (b - a), a + 0.618 * (b - a));
            if over(PinQuantity::ResultantStress, x) < over(PinQuantity::ResultantStress, y) {
                b = y;
            } else {
                a = x;
            }
        }
        let best = [from, a, b, to].map(|l| over(PinQuantity::ResultantStress, l));
        if best.iter().all(|u| *u > 0.0) {
            out.push(Forbids { limit: PinQuantity::ResultantStress, needs: None });
        }
        out
    }

    /// Smallest outer diameter of the range for which there is a pin, to rounding; `None` when there is none. Every limit is easier to
    /// keep with a larger outer diameter.
    #[must_use]
    pub fn least_outer(&self) -> Option<f64> {
        let possible = |outer: f64| {
            self.least_inner(outer) <= self.greatest_inner(outer) && self.forbids(outer).is_empty()
        };
        let (mut lo, mut hi) = (self.outer.low, self.outer.high);
        if possible(lo) {
            return Some(lo);
        }
        if !possible(hi) {
            return None;
        }
        for _ in 0..60 {
            let mid = 0.5 * (lo + hi);
            if possible(mid) {
                hi = mid;
            } else {
                lo = mid;
            }
        }
        Some(hi)
    }
}
