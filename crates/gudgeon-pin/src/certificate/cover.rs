//! Covers lengths and outer diameters by boxes in which no pin is lighter than a target.
//!
//! A strip of outer diameters is walked along from short to long pins. At a length, the bore that gives the target to the thinnest
//! pin of the strip is held against the limits of its thickest one. A limit that grows with the length ends the strip there:
//! longer pins exceed it all the more, and need wider bores. A limit that falls with the length carries a box up to the length at which it
//! is kept. Where neither is exceeded, or the box would be short beside its width, the strip is split, and its parts go on from
//! there.
//!
//! Near an optimum that three limits hold, the mass that is left over grows with the distance from it, and so may the boxes: their number
//! goes with the logarithm of the gap. Along a flat optimum, which two limits hold, it goes with the reciprocal of the root of the gap; a
//! proof that knows of limits only that they are monotone can do no better, for between two looks they may be stairs.
//!
//! At bores below the smallest of a model (`min_bore_ratio`) of the thickest pin, that one is looked at with the smallest bore, as if no
//! limit rose where both diameters grow in proportion.

use gudgeon_core::kinds::{PIN_QUANTITIES, PinQuantity, PinSize, resultant_stress};

use crate::design::{Design, Range};
use crate::optimum::lightest;

/// Length of a box by its width, both relative, below which the strip is split. Boxes of a random engine at a gap of 1e-3: 319 with 0.25, 336
/// with 0.5, 380 with 1, 476 with 2.
const ASPECT: f64 = 0.25;
/// Part of the gap below which the width of a strip says that it may hold a lighter pin.
const NARROW: f64 = 1e-3;
/// Lengths behind the end of a strip, by its relative width, at which such a pin is looked for.
const BEHIND: [f64; 3] = [0.0, 4.0, 64.0];
/// Part by which a box stays short of the length at which the limits are kept, beyond rounding.
const SHORT: f64 = 1e-12;
/// Part of a length by which a look is taken beside it.
const BESIDE: f64 = 1e-9;

/// How a proof ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// No pin is lighter than the target.
    Proved,
    /// This one is.
    Lighter(PinSize),
    /// The boxes do not suffice, or strips are as narrow as numbers can be.
    Open,
}

/// A proof that no pin of a design is lighter than a target.
pub struct Cover<'a, 'b> {
    pub design: &'a Design<'b>,
    /// Mass \[kg\] (pin less relief).
    pub target: f64,
    /// Distance of the target from the optimum by the mass of the pin: what narrow strips are measured by.
    pub gap: f64,
    /// Boxes examined.
    pub boxes: u32,
    /// Boxes at which it ends.
    pub max_boxes: u32,
}

/// Outer diameters of which all shorter pins are done \[m\].
#[derive(Clone, Copy)]
struct Strip {
    outer: Range,
    from: f64,
}

/// How far a walk along a strip came.
enum Walk {
    /// To its end.
    Done,
    /// To a length at which it must be split.
    Stopped(f64),
}

impl Cover<'_, '_> {
    /// Covers the ranges of the design; strips are split at the diameter of the optimum first, which none of them then holds inside.
    pub fn prove(&mut self, optimum: f64) -> Outcome {
        let d = self.design;
        let outer = Range { low: d.outer.low, high: d.outer.high.max(d.outer.low) };
        // A pin whose tolerance leaves it no longer than the gap between the bosses is none.
        let from = d.length.low.max(d.boss_gap + d.tolerance.length);
        let mut open = vec![Strip { outer, from }];
        while let Some(strip) = open.pop() {
            let Walk::Stopped(from) = self.walk(strip) else { continue };
            let Range { low, high } = strip.outer;
            if self.boxes >= self.max_boxes {
                return Outcome::Open;
            }
            if high - low <= NARROW * self.gap * high
                && let Some(size) = self.lighter(from, strip.outer)
            {
                return Outcome::Lighter(size);
            }
            let middle = if low < optimum && optimum < high { optimum } else { 0.5 * (low + high) };
            if middle <= low || middle >= high {
                return Outcome::Open;
            }
            open.push(Strip { outer: Range { low: middle, high }, from });
            open.push(Strip { outer: Range { low, high: middle }, from });
        }
        Outcome::Proved
    }

    /// Walks along a strip as far as boxes go.
    fn walk(&mut self, Strip { outer, from }: Strip) -> Walk {
        let d = self.design;
        let widest = d.max_inner(outer.high);
        // Thicker pins have no bore that the model holds for.
        let thickest = outer.high.min(widest / d.strength.min_bore_ratio());
        if thickest < outer.low || d.inner.low > widest {
            return Walk::Done;
        }
        let narrowest = d.min_inner(thickest);
        let least = ASPECT * (outer.high - outer.low) / outer.high;
        let mut length = from;
        loop {
            self.boxes += 1;
            let bore = self.bore(length, outer.low);
            if bore >= widest {
                // No wall is left, nor to longer pins.
                return Walk::Done;
            }
            let at = BestCorner { design: d, outer: thickest, inner: bore.max(narrowest) };
            match at.longest(length, least * length) {
                Some(end) if end >= d.length.high => return Walk::Done,
                Some(end) if self.boxes < self.max_boxes => length = end,
                _ => return Walk::Stopped(length),
            }
        }
    }

    /// Bore that gives a pin the target mass \[m\]; zero where a solid one is lighter. It grows with length and outer diameter.
    fn bore(&self, length: f64, outer: f64) -> f64 {
        let d = self.design;
        let relieved = d.relief.map_or(0.0, |r| r.mass(length.min(r.bore)));
        let square = outer * outer - (self.target + relieved) / (0.25 * d.pi * d.density * length);
        square.max(0.0).sqrt()
    }

    /// A pin lighter than the target near a narrow strip: at the length at which it could not be excluded or behind it, or the optimum that
    /// is reached from there.
    fn lighter(&self, length: f64, outer: Range) -> Option<PinSize> {
        let d = self.design;
        let is_lighter = |size: &PinSize| d.masses(size).differential() < self.target;
        let width = (outer.high - outer.low) / outer.high;
        let beside = BEHIND.into_iter().find_map(|part| {
            let length = (length * (1.0 + part * width)).min(d.length.high);
            let inner = d.max_feasible_inner(length, outer.high)?;
            Some(PinSize { length, outer: outer.high, inner }).filter(is_lighter)
        });
        beside.or_else(|| {
            let from = PinSize { length, outer: outer.high, inner: self.bore(length, outer.high) };
            lightest(d, Some(from)).ok().map(|o| o.size).filter(is_lighter)
        })
    }
}

/// The diameters of a box that are best for its strength.
struct BestCorner<'a, 'b> {
    design: &'a Design<'b>,
    outer: f64,
    inner: f64,
}

impl BestCorner<'_, '_> {
    /// Quantities at a length, with the diameters in the worst corner of the tolerances; `None` where the model refuses, which proves
    /// nothing.
    fn quantities(&self, length: f64) -> Option<[f64; PIN_QUANTITIES]> {
        let d = self.design;
        let size =
            PinSize { length, outer: self.outer - d.tolerance.outer, inner: self.inner + d.tolerance.inner };
        d.strength.quantities(&size, &d.load).ok()
    }

    fn exceeds(&self, q: PinQuantity, v: f64) -> bool {
        v > self.design.limits[q as usize]
    }

    /// End of the longest box from a length in which a limit is exceeded everywhere; `None` where it would be no longer than `least` and
    /// leave a rest.
    fn longest(&self, from: f64, least: f64) -> Option<f64> {
        use PinQuantity::{BendingStress, Deflection, ResultantStress, RodPressure};
        let (tolerance, high) = (self.design.tolerance.length, self.design.length.high);
        let grown = self.quantities(from + tolerance)?;
        let bending = grown[BendingStress as usize];
        let grows = [Deflection, BendingStress, RodPressure];
        // The resultant is at least the bending stress.
        if grows.into_iter().any(|q| self.exceeds(q, grown[q as usize]))
            || self.exceeds(ResultantStress, bending)
        {
            return Some(high);
        }
        // What falls may have no number where the theory begins; it is asked for to guess from alone.
        let mut at = from - tolerance;
        let mut fallen = if tolerance == 0.0 { Some(grown) } else { self.quantities(at) };
        if fallen.is_none() {
            at = from * (1.0 + BESIDE) - tolerance;
            fallen = self.quantities(at);
        }
        let fallen = fallen?;
        if !self.falling_exceed(&fallen, bending) {
            return None;
        }
        let guess = self.guess(at, &fallen, bending) + tolerance;
        let mut to = (guess * (1.0 - SHORT)).min(high);
        // What the guess takes for granted holds for the formulas of practice; others take shorter boxes.
        while to >= high || to - from > least {
            if to <= from || self.quantities(to - tolerance).is_some_and(|v| self.falling_exceed(&v, bending))
            {
                return Some(to);
            }
            to = from + 0.5 * (to - from);
        }
        None
    }

    /// Whether a limit that falls with the length is exceeded, or the resultant with the bending stress of the shortest pin.
    fn falling_exceed(&self, v: &[f64; PIN_QUANTITIES], bending: f64) -> bool {
        use PinQuantity::{BossPressure, Ovalisation, OvalisationStress, ResultantStress, ShearStress};
        [BossPressure, Ovalisation, OvalisationStress, ShearStress]
            .into_iter()
            .any(|q| self.exceeds(q, v[q as usize]))
            || self.exceeds(ResultantStress, resultant_stress(bending, v[OvalisationStress as usize]))
    }

    /// The length at which the last of the falling limits is kept, if the boss pressure goes with the reciprocal of the loaded length,
    /// ovalisation and its stress with that of the length, and the shear stress not with it at all.
    fn guess(&self, length: f64, v: &[f64; PIN_QUANTITIES], bending: f64) -> f64 {
        use PinQuantity::{BossPressure, Ovalisation, OvalisationStress, ResultantStress, ShearStress};
        if self.exceeds(ShearStress, v[ShearStress as usize]) {
            return f64::INFINITY;
        }
        let limits = &self.design.limits;
        let part = |q: PinQuantity| v[q as usize] / limits[q as usize];
        let gap = self.design.boss_gap;
        let hoop = limits[ResultantStress as usize].powi(2) - bending * bending;
        (gap + (length - gap) * part(BossPressure))
            .max(length * part(Ovalisation).max(part(OvalisationStress)))
            .max(length * v[OvalisationStress as usize] / hoop.sqrt())
    }
}
