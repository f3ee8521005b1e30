//! Proof that no lighter pin exists anywhere in the ranges, by branch and bound.
//!
//! Every limit is monotone in every dimension ([`PinStrength`](gudgeon_core::kinds::PinStrength)), or, as the resultant, put together from
//! parts that are. Over a box of lengths and outer diameters the maximum bore of all its pins is therefore bounded from two of its corners,
//! and with the minimum length and diameter it bounds their mass from below. A box that this bound keeps above the best pin is
//! done; the others are halved (`matthiesen2020`).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use gudgeon_core::kinds::PinSize;

use crate::design::Design;

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

struct Part {
    bound: f64,
    length: (f64, f64),
    outer: (f64, f64),
}

impl PartialEq for Part {
    fn eq(&self, o: &Self) -> bool {
        self.cmp(o) == Ordering::Equal
    }
}
impl Eq for Part {}
impl PartialOrd for Part {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        Some(self.cmp(o))
    }
}
impl Ord for Part {
    /// The lowest bound first; ties by place, so that the order never depends on the heap.
    fn cmp(&self, o: &Self) -> Ordering {
        o.bound
            .total_cmp(&self.bound)
            .then(o.length.0.total_cmp(&self.length.0))
            .then(o.outer.0.total_cmp(&self.outer.0))
    }
}

/// Lower bound of the mass in a box; `None` when no pin of it keeps the limits.
fn bound(d: &Design<'_>, length: (f64, f64), outer: (f64, f64), rounding: f64) -> Option<f64> {
    let inner = d.max_feasible_inner_over(length.0, length.1, outer.1, rounding)?;
    let inner = inner.min(outer.0);
    Some(d.masses(&PinSize { length: length.0, outer: outer.0, inner }).differential())
}

/// Proves that no pin of the design is lighter than `best` by more than `gap` of the pin's mass, with at most `max_boxes` boxes.
#[must_use]
pub fn certify(d: &Design<'_>, best: &PinSize, gap: f64, max_boxes: u32) -> Certificate {
    let masses = d.masses(best);
    let target = masses.differential() - gap * masses.pin;
    let mut out = Certificate {
        bound: f64::INFINITY,
        best: masses.differential(),
        boxes: 0,
        closed: true,
        lighter: None,
    };
    let mut heap = BinaryHeap::new();
    // Bores to a fraction of the gap; wide boxes need no more than their own width.
    let rounding = |span: f64| (1e-2 * span).clamp(1e-2 * gap, 1e-3);
    let examine =
        |length: (f64, f64), outer: (f64, f64), heap: &mut BinaryHeap<Part>, out: &mut Certificate| {
            out.boxes += 1;
            let span = ((length.1 - length.0) / length.1).max((outer.1 - outer.0) / outer.1);
            if let Some(bound) = bound(d, length, outer, rounding(span)) {
                if bound >= target {
                    out.bound = out.bound.min(bound);
                } else {
                    heap.push(Part { bound, length, outer });
                }
            }
        };
    let (length, outer) = ((d.length.low, d.length.high), (d.outer.low, d.outer.high.max(d.outer.low)));
    examine(length, outer, &mut heap, &mut out);
    while let Some(part) = heap.pop() {
        if out.boxes >= max_boxes {
            out.closed = false;
            out.bound = out.bound.min(part.bound);
            break;
        }
        let (l, o) = (part.length, part.outer);
        let middle = (0.5 * (l.0 + l.1), 0.5 * (o.0 + o.1));
        // A pin in the middle that beats the given one shows that it was no optimum.
        if out.lighter.is_none()
            && let Some(inner) = d.max_feasible_inner_over(middle.0, middle.0, middle.1, 1e-13)
        {
            let size = PinSize { length: middle.0, outer: middle.1, inner };
            if d.masses(&size).differential() < target {
                out.lighter = Some(size);
            }
        }
        // Halve what moves the bound most: lengths weigh with the pin's section, diameters with its surface.
        let by_length = (l.1 - l.0) / l.1 >= 2.0 * (o.1 - o.0) / o.1;
        if by_length && l.1 > l.0 {
            examine((l.0, middle.0), o, &mut heap, &mut out);
            examine((middle.0, l.1), o, &mut heap, &mut out);
        } else if o.1 > o.0 {
            examine(l, (o.0, middle.1), &mut heap, &mut out);
            examine(l, (middle.1, o.1), &mut heap, &mut out);
        } else {
            out.bound = out.bound.min(part.bound);
            out.closed = false;
            break;
        }
    }
    // Where everything is cut off at once, the target itself is what was proved.
    out.bound = out.bound.min(out.best);
    out
}
