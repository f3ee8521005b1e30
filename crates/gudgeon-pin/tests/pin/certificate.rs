//! The certificate: bounds that hold, pins that are lighter.

use gudgeon_core::kinds::PinSize;
use gudgeon_pin::certificate::certify;
use gudgeon_pin::design::Range;
use gudgeon_pin::optimum::lightest;

use crate::common::*;

#[test]
fn the_bound_lies_below_the_optimum_however_early_the_search_ends() {
    let m = model("thin_ring", PUBLISHED_PI);
    let d = published_design(&*m, PUBLISHED_PI);
    let o = lightest(&d, None).expect("solved");
    let mass = o.masses.differential();
    let mut last = f64::NEG_INFINITY;
    for boxes in [1, 10, 100, 1000] {
        let c = certify(&d, &o.size, 1e-6, boxes);
        assert!(!c.closed && c.boxes >= boxes && c.boxes <= boxes + 1, "{c:?}");
        // More boxes never bound worse.
        assert!(c.bound <= mass && c.bound >= last, "{c:?}");
        assert_eq!(c.best, mass);
        last = c.bound;
    }
    let c = certify(&d, &o.size, 1e-3, 100_000);
    assert!(c.closed && c.bound >= mass - 1e-3 * o.masses.pin && c.bound <= mass, "{c:?}");
    // A tighter proof takes more boxes.
    let tight = certify(&d, &o.size, 1e-5, 100_000);
    assert!(tight.closed && tight.boxes > c.boxes && tight.bound >= c.bound, "{tight:?}");
}

#[test]
fn a_heavier_pin_is_found_out() {
    let m = model("thin_ring", PUBLISHED_PI);
    let d = published_design(&*m, PUBLISHED_PI);
    let heavy = mm(63.0, 23.0, 14.0);
    let c = certify(&d, &heavy, 1e-3, 100_000);
    let lighter = c.lighter.expect("there is one");
    assert!(d.masses(&lighter).differential() < d.masses(&heavy).differential());
    assert!(d.utilisation(&lighter).expect("inside").iter().all(|u| *u <= 1.0));
    let o = lightest(&d, None).expect("solved");
    assert!(c.bound <= o.masses.differential());
}

/// Where nothing is left to halve, the bore alone decides and one box is the proof.
#[test]
fn one_box_is_enough_where_length_and_diameter_are_given() {
    let m = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*m, PUBLISHED_PI);
    d.length = Range::at(62e-3);
    d.outer = Range::at(21.85e-3);
    let o = lightest(&d, None).expect("solved");
    let c = certify(&d, &o.size, 1e-6, 1000);
    assert!(c.closed && c.boxes == 1 && c.lighter.is_none(), "{c:?}");
    // A bore that is too small: the box is below the target and cannot be halved.
    let c = certify(&d, &PinSize { inner: 0.9 * o.size.inner, ..o.size }, 1e-6, 1000);
    assert!(!c.closed && c.boxes == 1 && c.lighter.is_some(), "{c:?}");
    assert!((c.bound / o.masses.differential() - 1.0).abs() < 1e-6);
    // A length alone is halved, and a diameter alone.
    for (length, outer) in
        [(Range { low: 60e-3, high: 66e-3 }, d.outer), (d.length, Range { low: 21e-3, high: 23e-3 })]
    {
        let mut d = d;
        (d.length, d.outer) = (length, outer);
        let o = lightest(&d, None).expect("solved");
        let c = certify(&d, &o.size, 1e-6, 100_000);
        assert!(c.closed && c.lighter.is_none() && c.boxes > 1, "{c:?}");
    }
}
