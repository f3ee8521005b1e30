//! Proof that no lighter pin exists anywhere in the ranges, by branch and bound.
//!
//! Every limit is monotone in every dimension ([`PinStrength`](gudgeon_core::kinds::PinStrength)), or, as the resultant, put together from
//! parts that are. Masses are monotone too, so pins lighter than a mass `m` have bores above the one that gives `m` to the shortest and
//! thinnest pin of a box of lengths and outer diameters. Where a limit is exceeded by that bore in the best corner of the box, no
//! pin of the box is lighter than `m`: one look at a box decides. Boxes are as long as that admits, and as wide (`cover.rs`;
//! branch and bound in the manner of `matthiesen2020`).

mod cover;

use gudgeon_core::kinds::PinSize;

use crate::design::{Design, Masses};
use cover::{Cover, Outcome};

/// What was proved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// No pin of the ranges weighs less than this \[kg\] (pin less relief).
    pub bound: f64,
    /// Mass of the pin that was given \[kg\].
    pub best: f64,
    /// Boxes examined.
    pub boxes: u32,
    /// Whether the gap that was asked for is closed.
    pub closed: bool,
    /// A pin lighter than the one given, when one was met.
    pub lighter: Option<PinSize>,
}

/// Part of the boxes that is kept for a wider gap where the one that is asked for takes too many.
const RESERVE: u32 = 4;
/// Ratio of a gap that was proved and one that was not below which nothing between them is tried.
const NEAR: f64 = 1.05;

/// Part of the gap that is proved, so that what is told of it keeps within it to rounding.
const WITHIN: f64 = 0.999;

/// Proves that no pin of the design is lighter than `best` by more than `gap` of the pin's mass, with at most `max_boxes` boxes.
///
/// Where that takes too many boxes, or is not true, the bound is that of the smallest wider gap that was proved.
#[must_use]
pub fn certify(d: &Design<'_>, best: &PinSize, gap: f64, max_boxes: u32) -> Certificate {
    let gap = WITHIN * gap;
    let masses = d.masses(best);
    let mut attempt = Attempt { design: d, best, masses, boxes: 0 };
    let first = attempt.at(gap, max_boxes - max_boxes / RESERVE);
    let (bound, lighter) = match first {
        Outcome::Proved => (masses.differential() - gap * masses.pin, None),
        Outcome::Lighter(size) => (attempt.wider(gap, max_boxes), Some(size)),
        Outcome::Open => (attempt.wider(gap, max_boxes), None),
    };
    Certificate {
        bound,
        best: masses.differential(),
        boxes: attempt.boxes,
        closed: first == Outcome::Proved,
        lighter,
    }
}

/// Proofs of several gaps, one after the other.
struct Attempt<'a, 'b> {
    design: &'a Design<'b>,
    best: &'a PinSize,
    masses: Masses,
    /// Boxes of all of them.
    boxes: u32,
}

impl Attempt<'_, '_> {
    /// Tries to prove one gap while fewer than `max_boxes` boxes were examined in all.
    fn at(&mut self, gap: f64, max_boxes: u32) -> Outcome {
        let target = self.masses.differential() - gap * self.masses.pin;
        let mut cover = Cover { design: self.design, target, gap, boxes: self.boxes, max_boxes };
        let outcome = cover.prove(self.best.outer);
        self.boxes = cover.boxes;
        outcome
    }

    /// The bound of the smallest gap above `open` that the boxes that are left can prove, by halving on a logarithmic scale; without
    /// any, that of the whole ranges as one box.
    fn wider(&mut self, open: f64, max_boxes: u32) -> f64 {
        let Masses { pin, .. } = self.masses;
        let best = self.masses.differential();
        let whole = whole_ranges(self.design).min(best);
        if self.design.length.is_fixed() && self.design.outer.is_fixed() {
            return whole;
        }
        let (mut open, mut proved) = (open, (best - whole) / pin);
        let mut bound = whole;
        while self.boxes < max_boxes && proved > NEAR * open {
            let between = (open * proved).sqrt();
            match self.at(between, max_boxes) {
                Outcome::Proved => (proved, bound) = (between, best - between * pin),
                Outcome::Lighter(_) | Outcome::Open => open = between,
            }
        }
        bound
    }
}

/// Lower bound of the mass over the whole ranges \[kg\]: the shortest and thinnest pin with the largest bore that the limits leave to any;
/// infinite when they leave none.
fn whole_ranges(d: &Design<'_>) -> f64 {
    let (length, outer) = (d.length, d.outer);
    let inner = d.max_feasible_inner_over(length.low, length.high, outer.high.max(outer.low), 1e-16);
    inner.map_or(f64::INFINITY, |inner| {
        let size = PinSize { length: length.low, outer: outer.low, inner: inner.min(outer.low) };
        d.masses(&size).differential()
    })
}
