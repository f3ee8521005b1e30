//! The lightest pin of sizes that can be had, against all combinations one by one.

use gudgeon_core::kinds::PinSize;
use gudgeon_pin::design::{Design, Range};
use gudgeon_pin::optimum::lightest;
use gudgeon_pin::stock::{Choice, Sizes};

use crate::common::*;

const STEP: f64 = 0.5e-3;

fn outers() -> Vec<f64> {
    vec![21e-3, 22.5e-3, 21.5e-3, 22e-3, 30e-3]
}
fn inners() -> Vec<f64> {
    vec![14e-3, 12e-3, 13e-3, 13.5e-3]
}

/// Every admitted pin of lists of dimensions; the lightest one.
fn one_by_one(d: &Design<'_>, lengths: &[f64], outers: &[f64], inners: &[f64]) -> Option<(PinSize, f64)> {
    let mut best: Option<(PinSize, f64)> = None;
    for &length in lengths {
        for &outer in outers {
            for &inner in inners {
                let size = PinSize { length, outer, inner };
                let m = d.masses(&size).differential();
                if d.utilisation(&size).is_ok_and(|u| u.iter().all(|u| *u <= 1.0))
                    && best.is_none_or(|(_, b)| m < b)
                {
                    best = Some((size, m));
                }
            }
        }
    }
    best
}

fn lengths(d: &Design<'_>) -> Vec<f64> {
    (0..400).map(|k| STEP * f64::from(k)).filter(|l| *l >= d.length.low && *l <= d.length.high).collect()
}

fn same(c: Choice, best: (PinSize, f64)) {
    assert_eq!(c.size, best.0);
    assert_eq!(c.differential, best.1);
}

#[test]
fn three_lists_are_searched_as_if_one_by_one() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*strength, PUBLISHED_PI);
    let sizes = Sizes { outer: outers(), inner: inners(), length_step: Some(STEP) };
    let found = sizes.lightest(&d).expect("there is one");
    let all = outers().into_iter().filter(|o| *o <= d.outer.high).collect::<Vec<_>>();
    same(found, one_by_one(&d, &lengths(&d), &all, &inners()).expect("there is one"));
    assert_eq!(found.tried as usize, all.len() * lengths(&d).len());
    // A range of bores leaves out what lies beside it.
    d.inner = Range { low: 0.0, high: 13.2e-3 };
    let found = sizes.lightest(&d).expect("there is one");
    same(found, one_by_one(&d, &lengths(&d), &all, &[12e-3, 13e-3]).expect("there is one"));
    // None of these keeps the limits.
    assert!(Sizes { inner: vec![17e-3], ..sizes.clone() }.lightest(&d).is_none());
    assert!(Sizes { outer: vec![30e-3], ..sizes }.lightest(&d).is_none());
}

#[test]
fn a_dimension_without_sizes_stays_free() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let d = published_design(&*strength, PUBLISHED_PI);
    let free = lightest(&d, None).expect("solved").masses.differential();
    let none = Sizes::default();
    let of = |s: Sizes| s.lightest(&d).expect("there is one");
    // Nothing in stock: the optimum itself.
    assert_eq!(of(none.clone()).differential, free);
    // Lengths and outer diameters given: the maximum bore.
    let found = of(Sizes { outer: outers(), length_step: Some(STEP), ..none.clone() });
    assert_eq!(Some(found.size.inner), d.max_feasible_inner(found.size.length, found.size.outer));
    // One list alone: the best of the optima with that dimension fixed.
    let found = of(Sizes { outer: outers(), ..none.clone() });
    let by_hand = outers()
        .into_iter()
        .filter(|o| *o <= d.outer.high)
        .map(|o| lightest(&Design { outer: Range::at(o), limits: d.limits, ..d }, None).expect("solved"))
        .map(|o| o.masses.differential())
        .fold(f64::INFINITY, f64::min);
    assert_eq!((found.differential, found.tried), (by_hand, 4));
    let found = of(Sizes { inner: inners(), ..none.clone() });
    // A given dimension carries the rounding of its scale.
    let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-15;
    assert!(inners().iter().any(|i| same(*i, found.size.inner)) && found.differential > free);
    assert_eq!(found.tried, 4);
    let found = of(Sizes { length_step: Some(STEP), ..none.clone() });
    assert!(same((found.size.length / STEP).round() * STEP, found.size.length));
    assert_eq!(found.tried as usize, lengths(&d).len());
    // More freedom is never heavier.
    assert!(found.differential >= free);
    let both = of(Sizes { inner: inners(), length_step: Some(STEP), ..none });
    assert!(both.differential >= found.differential);
    assert_eq!(both.tried as usize, lengths(&d).len() * inners().len());
}

#[test]
fn combinations_are_counted_before_a_search() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*strength, PUBLISHED_PI);
    d.length = Range { low: 30e-3, high: 80e-3 };
    let count = |outer: &[f64], inner: &[f64], length_step| {
        Sizes { outer: outer.to_vec(), inner: inner.to_vec(), length_step }.combinations(&d)
    };
    let (o, i) = (outers(), inners());
    assert_eq!(count(&[], &[], None), 1.0);
    assert_eq!(count(&o, &[], None), 5.0);
    assert_eq!(count(&o, &i, None), 20.0);
    // 100 steps; rounding of the quotient.
    assert!((count(&[], &i, Some(STEP)) - 400.0).abs() < 1e-9);
    // The bore is cut to size where length and outer diameter are known.
    assert!((count(&o, &i, Some(STEP)) - 500.0).abs() < 1e-9);
    assert_eq!(count(&[], &[], Some(1.0)), 1.0);
}
