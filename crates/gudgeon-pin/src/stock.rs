//! The lightest pin of sizes that can be had.

use gudgeon_core::kinds::PinSize;

use crate::design::{Design, Range};
use crate::optimum::lightest;

/// Sizes that can be had; a dimension without sizes stays free.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sizes {
    /// Outer diameters \[m\].
    pub outer: Vec<f64>,
    /// Inner diameters \[m\].
    pub inner: Vec<f64>,
    /// The length is a multiple of this \[m\].
    pub length_step: Option<f64>,
}

/// A pin of these sizes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// Dimensions \[m\].
    pub size: PinSize,
    /// Pin less relief \[kg\].
    pub differential: f64,
    /// Combinations looked at.
    pub tried: u32,
}

/// Combinations beyond which a search is refused by its caller: [`Sizes::combinations`].
pub const MAX_COMBINATIONS: f64 = 200_000.0;

impl Sizes {
    /// How many combinations a search of the design looks at.
    #[must_use]
    pub fn combinations(&self, d: &Design<'_>) -> f64 {
        let lengths = self.length_step.map_or(1.0, |s| ((d.length.high - d.length.low) / s).max(1.0));
        // The bore is cut to size where length and outer diameter are known.
        let bores = if self.outer.is_empty() || self.length_step.is_none() {
            self.inner.len().max(1) as f64
        } else {
            1.0
        };
        lengths * bores * self.outer.len().max(1) as f64
    }

    fn lengths(&self, d: &Design<'_>) -> Vec<f64> {
        let Some(step) = self.length_step else { return Vec::new() };
        let first = (d.length.low / step - 1e-9).ceil();
        let last = (d.length.high / step + 1e-9).floor();
        (0..).map(|k| first + f64::from(k)).take_while(|k| *k <= last).map(|k| k * step).collect()
    }

    /// The lightest pin of these sizes within the ranges of the design; `None` when no combination keeps the limits.
    #[must_use]
    pub fn lightest(&self, d: &Design<'_>) -> Option<Choice> {
        let inside = |v: f64, r: Range| v >= r.low && v <= r.high;
        let lengths = self.lengths(d);
        let mut inner: Vec<f64> = self.inner.iter().copied().filter(|v| inside(*v, d.inner)).collect();
        inner.sort_by(f64::total_cmp);
        let mut best: Option<Choice> = None;
        let mut tried = 0;
        let mut consider = |size: PinSize| {
            let differential = d.masses(&size).differential();
            if best.is_none_or(|b| differential < b.differential) {
                best = Some(Choice { size, differential, tried: 0 });
            }
        };
        let free = |length: Range, outer: Range, bore: Range| {
            lightest(&Design { length, outer, inner: bore, limits: d.limits, ..*d }, None)
                .ok()
                .map(|o| o.size)
        };
        let outers: Vec<Range> = if self.outer.is_empty() {
            vec![d.outer]
        } else {
            self.outer.iter().copied().filter(|v| inside(*v, d.outer)).map(Range::at).collect()
        };
        for outer in outers {
            if outer.is_fixed() && !lengths.is_empty() {
                for &length in &lengths {
                    tried += 1;
                    let Some(bore) = d.max_feasible_inner(length, outer.low) else { continue };
                    // The largest bore of the list that is not above.
                    let bore = if self.inner.is_empty() {
                        Some(bore)
                    } else {
                        inner.iter().rev().copied().find(|v| *v <= bore && *v >= d.min_inner(outer.low))
                    };
                    if let Some(inner) = bore {
                        consider(PinSize { length, outer: outer.low, inner });
                    }
                }
                continue;
            }
            let lengths = if lengths.is_empty() {
                vec![d.length]
            } else {
                lengths.iter().copied().map(Range::at).collect()
            };
            let bores = if self.inner.is_empty() {
                vec![d.inner]
            } else {
                inner.iter().copied().map(Range::at).collect()
            };
            for length in &lengths {
                for bore in &bores {
                    tried += 1;
                    if let Some(size) = free(*length, outer, *bore) {
                        consider(size);
                    }
                }
            }
        }
        best.map(|b| Choice { tried, ..b })
    }
}
