//! The certificate: bounds that hold, pins that are lighter.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{
    PIN_QUANTITIES, PinExpansion, PinForces, PinQuantity, PinSize, PinStrength, PinStrengthSpec,
};
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

/// What was proved holds for pins thrown at random into the ranges, each with the largest bore that the limits leave it, for every model
/// and with tolerances; and a pin heavier than the optimum is no proof of anything.
#[test]
fn no_random_pin_is_lighter_than_the_bound() {
    let mut r = Random(20_261_125);
    let mut closed = 0;
    for case in 0..24 {
        let e = Engine::new(&mut r);
        let s: Box<dyn PinStrengthSpec> = spec(serde_json::json!({ "model": MODELS[case % 4] }));
        let strength = s.build(&e.ctx).expect("builds");
        let mut d = e.design(&*strength);
        // The limits of the deformations belong to the thin ring.
        d.limits[PinQuantity::Deflection as usize] *= 2.0;
        if case % 3 == 0 {
            d.tolerance = mm(0.1, 0.005, 0.05);
        }
        let Ok(o) = lightest(&d, None) else { continue };
        let gap = [1e-2, 1e-3, 1e-4][case % 3];
        let c = certify(&d, &o.size, gap, 200_000);
        let mass = o.masses.differential();
        // Rounding of the difference of two masses.
        assert!(c.closed && c.lighter.is_none() && mass - c.bound <= gap * o.masses.pin + 1e-15, "{c:?}");
        closed += 1;
        for _ in 0..500 {
            let length = r.between(d.length.low, d.length.high);
            let outer = r.between(d.outer.low, d.outer.high);
            let Some(inner) = d.max_feasible_inner(length, outer) else { continue };
            let thrown = d.masses(&PinSize { length, outer, inner }).differential();
            assert!(thrown >= c.bound, "{case}: {length} {outer} {inner} weighs {thrown}, {c:?}");
        }
        let heavy = PinSize { inner: 0.9 * o.size.inner, ..o.size };
        let c = certify(&d, &heavy, 1e-4, 200_000);
        let lighter = c.lighter.expect("the optimum is lighter");
        assert!(!c.closed && c.bound <= mass + 1e-15, "{c:?}");
        assert!(d.masses(&lighter).differential() < d.masses(&heavy).differential());
        assert!(d.utilisation(&lighter).expect("inside").iter().all(|u| *u <= 1.0 + 1e-12));
    }
    assert!(closed >= 12, "too few engines have a pin: {closed}");
}

/// Limits that fall with the length otherwise than those of practice, within the contract of the kind.
#[derive(Debug)]
struct Steeper(Box<dyn PinStrength>);

impl PinStrength for Steeper {
    fn quantities(&self, s: &PinSize, f: &PinForces) -> Result<[f64; PIN_QUANTITIES], EvalError> {
        let mut q = self.0.quantities(s, f)?;
        let steep = (2.0 * GAP / s.length).powi(3);
        q[PinQuantity::Ovalisation as usize] *= steep;
        q[PinQuantity::ShearStress as usize] *= 1.0 + 0.5 * steep;
        Ok(q)
    }
    fn expansion(&self, s: &PinSize, f: &PinForces) -> Result<PinExpansion, EvalError> {
        self.0.expansion(s, f)
    }
}

/// The proof takes the lengths at which limits are kept from the formulas of practice, and believes none of them.
#[test]
fn the_proof_asks_nothing_of_a_limit_but_that_it_is_monotone() {
    let strength = Steeper(model("thin_ring", PUBLISHED_PI));
    let d = published_design(&strength, PUBLISHED_PI);
    // No gradients, so no optimum is searched for: the lightest of a grid.
    let (steps, mut best) = (400, None::<(f64, PinSize)>);
    let at = |r: Range, k: i32| r.low + (r.high - r.low) * f64::from(k) / f64::from(steps);
    for k in 0..=steps {
        for l in 0..=steps {
            let (length, outer) = (at(d.length, l), at(d.outer, k));
            let Some(inner) = d.max_feasible_inner(length, outer) else { continue };
            let size = PinSize { length, outer, inner };
            let mass = d.masses(&size).differential();
            if best.is_none_or(|b| mass < b.0) {
                best = Some((mass, size));
            }
        }
    }
    let (mass, size) = best.expect("there is one");
    // The grid is 0.15 mm in length and 0.011 mm in diameter; 10 g/mm and 44 g/mm of one, less than a gram of a pin of 150 g.
    let c = certify(&d, &size, 2e-2, 200_000);
    assert!(c.closed && c.lighter.is_none() && c.bound <= mass, "{c:?}");
}

/// Where the bore is given, lengths and outer diameters alone are held against the limits.
#[test]
fn a_given_bore_is_no_room_without_pins() {
    for name in ["thin_ring", "curved_ring"] {
        let m = model(name, PUBLISHED_PI);
        let mut d = published_design(&*m, PUBLISHED_PI);
        d.limits[PinQuantity::Deflection as usize] = 0.1e-3;
        d.inner = Range::at(12e-3);
        let o = lightest(&d, None).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        let c = certify(&d, &o.size, 1e-4, 200_000);
        assert!(c.closed && c.lighter.is_none() && c.boxes > 1, "{name}: {c:?}");
        // A longer pin is no optimum.
        let c = certify(&d, &PinSize { length: 1.05 * o.size.length, ..o.size }, 1e-4, 200_000);
        assert!(!c.closed && c.lighter.is_some() && c.bound <= o.masses.differential(), "{name}: {c:?}");
    }
}
