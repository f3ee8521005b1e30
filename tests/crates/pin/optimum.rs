//! The exact optimum: the published engine, the closed-form problem, random engines, its proofs.

#![allow(clippy::excessive_precision, reason = "reference values stand as they were computed")]

use crate::common::*;
use gudgeon_core::kinds::{BossBore, PinForces, PinQuantity, PinSize, PinStrengthCtx, PinStrengthSpec};
use gudgeon_pin::certificate::certify;
use gudgeon_pin::design::{Design, Range};
use gudgeon_pin::optimum::{Bound, KKT_TOLERANCE, NoOptimum, lightest};

#[test]
fn the_published_engine_has_a_pin_0_69_g_lighter() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let d = published_design(&*strength, PUBLISHED_PI);
    let o = lightest(&d, None).expect("solved");
    // An independent brute force on a fine grid, to the digits it gives.
    assert!((1e3 * o.size.outer - 21.2497).abs() < 5e-5, "{}", o.size.outer);
    assert!((1e3 * o.size.length - 62.8684).abs() < 5e-5, "{}", o.size.length);
    assert!((1e3 * o.size.inner - 13.5896).abs() < 5e-5, "{}", o.size.inner);
    assert!((1e3 * o.masses.differential() - 42.678).abs() < 5e-4, "{}", o.masses.differential());
    let mut active = o.active();
    active.sort();
    assert_eq!(active, [PinQuantity::BossPressure, PinQuantity::Ovalisation, PinQuantity::BendingStress]);
    assert!(o.kkt.hold_to_rounding() && o.kkt.curvature.is_none(), "{:?}", o.kkt);
    let published = d.masses(&mm(61.9, 21.85, 13.94));
    assert!((1e3 * (published.differential() - o.masses.differential()) - 0.69).abs() < 5e-3);
}

/// No point of a grid finer than any manufacture is lighter, and the grid comes close.
#[test]
fn brute_force_finds_nothing_lighter() {
    for name in MODELS {
        let strength = model(name, PUBLISHED_PI);
        let mut d = published_design(&*strength, PUBLISHED_PI);
        if name != "thin_ring" {
            // The published limits of the deformations belong to the published formulas.
            d.limits[PinQuantity::Deflection as usize] = 0.1e-3;
            d.limits[PinQuantity::OvalisationStress as usize] = 55.0 * KGF;
        }
        let o = lightest(&d, None).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        let mut best = f64::INFINITY;
        let (step_o, step_l) = (0.01e-3, 0.05e-3);
        let mut outer = 20.5e-3;
        while outer <= d.outer.high {
            let mut length = 55e-3;
            while length < 75e-3 {
                if let Some(inner) = d.max_feasible_inner(length, outer) {
                    best = best.min(d.masses(&PinSize { length, outer, inner }).differential());
                }
                length += step_l;
            }
            outer += step_o;
        }
        let m = o.masses.differential();
        // Sensitivities of at most 44 g/mm of diameter and 10 g/mm of length times half a step, doubled.
        assert!(best >= m - 1e-12 && best - m < 1.5e-3, "{name}: {best} {m}");
        let c = certify(&d, &o.size, 1e-6, 200_000);
        assert!(c.closed && c.lighter.is_none() && m - c.bound <= 1.001e-6 * o.masses.pin, "{name}: {c:?}");
    }
}

/// Two limits, two diameters, a given length: the closed-form optimum of minimal mass under bending `32 M D/(π (D⁴ - d⁴)) <= 450 MPa` and
/// ovalisation `0.0833 F ((D + d)/(D - d))³/(E L) <= 0.03 mm`, solved in 25 digits (mpmath).
#[test]
fn the_closed_form_problem_to_1e_12() {
    let pi = std::f64::consts::PI;
    let s: Box<dyn PinStrengthSpec> = spec(serde_json::json!({ "model": "thin_ring" }));
    // A small end as wide as the gap: moment F a/4 - F B/8 = F L/8 = 337.5 Nm.
    let gap = 27e-3;
    let ctx = PinStrengthCtx {
        boss_gap: gap,
        rod_width: gap,
        boss_bore: BossBore::Profiled,
        modulus: 2.06e11,
        poisson: 0.3,
        pi,
    };
    let strength = s.build(&ctx).expect("builds");
    let mut limits = [f64::INFINITY; 8];
    limits[PinQuantity::BendingStress as usize] = 450e6;
    // The thin ring has 1/8 for 0.0833.
    limits[PinQuantity::Ovalisation as usize] = 30e-6 * 0.125 / 0.0833;
    let mut d = Design {
        strength: &*strength,
        load: PinForces { gas: 45e3, inertia: 0.0 },
        limits,
        density: 7800.0,
        pi,
        relief: None,
        boss_gap: gap,
        length: Range::at(60e-3),
        outer: Range { low: 10e-3, high: 40e-3 },
        inner: Range { low: 0.0, high: 40e-3 },
        min_wall: 0.0,
        tolerance: PinSize::default(),
    };
    let o = lightest(&d, None).expect("solved");
    for (name, got, exact) in [
        ("D", o.size.outer, 0.020_977_752_215_594_051_344),
        ("d", o.size.inner, 0.013_518_746_390_231_569_712),
        ("d/D", o.size.inner / o.size.outer, 0.644_432_551_747_953_978_187),
        ("mass", o.masses.pin, 0.094_578_342_179_125_535_865),
        // Mass per relative change of a limit.
        ("bending", o.multipliers[PinQuantity::BendingStress as usize], 0.063_052_228_119_417_023_910),
        ("ovalisation", o.multipliers[PinQuantity::Ovalisation as usize], 0.012_367_771_947_788_547_033),
    ] {
        assert!((got / exact - 1.0).abs() < 1e-12, "{name}: {got} {exact}");
    }
    assert!(o.kkt.hold_to_rounding(), "{:?}", o.kkt);
    // A third variable: a free length is held by nothing but its range, and shorter is lighter until ovalisation holds.
    d.length = Range { low: 50e-3, high: 60e-3 };
    let free = lightest(&d, None).expect("solved");
    assert!(free.masses.pin <= o.masses.pin && free.kkt.hold(KKT_TOLERANCE));
}

#[test]
fn random_engines_satisfy_the_conditions_and_hold_no_lighter_pin() {
    let mut r = Random(11);
    let (mut solved, mut infeasible, mut corners, mut by_rounding) = (0, 0, 0, 0);
    let mut wrong = Vec::new();
    for k in 0..600 {
        let e = Engine::new(&mut r);
        let name = MODELS[k % MODELS.len()];
        let s: Box<dyn PinStrengthSpec> = spec(serde_json::json!({ "model": name }));
        let strength = s.build(&e.ctx).expect("builds");
        let mut d = e.design(&*strength);
        if name != "thin_ring" {
            d.limits[PinQuantity::Deflection as usize] *= 2.2;
        }
        match lightest(&d, None) {
            Ok(o) => {
                solved += 1;
                assert!(o.kkt.hold(KKT_TOLERANCE), "{k}: {:?}", o.kkt);
                // What exceeds a limit, if only by rounding, is not passed over.
                let excess = o.utilisation.iter().fold(f64::NEG_INFINITY, |a: f64, u| a.max(u - 1.0));
                assert!(o.kkt.infeasibility >= excess, "{k}: {excess:e} {:?}", o.kkt);
                by_rounding += usize::from(excess > 0.0);
                corners += usize::from(o.kkt.curvature.is_none());
                if k % 6 < 4 {
                    let c = certify(&d, &o.size, 1e-3, 50_000);
                    if !c.closed || c.lighter.is_some() {
                        wrong.push(format!("{k} {name}: {c:?} {o:?}"));
                    }
                }
            }
            Err(NoOptimum::Infeasible(f)) => {
                infeasible += 1;
                assert!(!f.is_empty(), "{k}");
            }
            Err(e) => wrong.push(format!("{k} {name}: {e:?} {:?} {:?}", d.limits, d.length)),
        }
    }
    assert!(wrong.is_empty(), "{} of {solved}\n{}", wrong.len(), wrong.join("\n"));
    assert!(solved > 400 && corners > 100 && infeasible > 0, "{solved} {corners} {infeasible}");
    assert!(by_rounding > 50, "{by_rounding}");
}

#[test]
fn multipliers_are_the_change_of_the_mass() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*strength, PUBLISHED_PI);
    let o = lightest(&d, None).expect("solved");
    for q in PinQuantity::ALL {
        let k = q as usize;
        let mut at = |factor: f64| {
            let was = d.limits[k];
            d.limits[k] = was * factor;
            let m = lightest(&d, None).expect("solved").masses.differential();
            d.limits[k] = was;
            m
        };
        let h: f64 = 1e-5;
        let slope = (at(h.exp()) - at((-h).exp())) / (2.0 * h);
        // Truncation h² of the third derivative, rounding 1e-16/h of the mass.
        assert!(
            (slope + o.multipliers[k]).abs() < 1e-8 * o.masses.pin,
            "{q:?}: {slope} {}",
            o.multipliers[k]
        );
    }
}

#[test]
fn tolerances_are_kept_in_every_corner() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*strength, PUBLISHED_PI);
    let nominal = lightest(&d, None).expect("solved");
    d.tolerance = mm(0.2, 0.005, 0.1);
    let o = lightest(&d, None).expect("solved");
    assert!(o.masses.differential() > nominal.masses.differential());
    assert!(o.kkt.hold(KKT_TOLERANCE));
    let mut worst: f64 = 0.0;
    for c in 0..8 {
        let side = |bit: i32, t: f64| if c & bit == 0 { t } else { -t };
        let s = PinSize {
            length: o.size.length + side(1, 0.2e-3),
            outer: o.size.outer + side(2, 0.005e-3),
            inner: o.size.inner + side(4, 0.1e-3),
        };
        let q = strength.quantities(&s, &d.load).expect("inside");
        for (v, l) in q.iter().zip(d.limits) {
            worst = worst.max(v / l);
        }
    }
    // The worst corner is the one the optimum was sized for; rounding.
    assert!((worst - 1.0).abs() < 1e-12, "{worst}");
    let c = certify(&d, &o.size, 1e-5, 200_000);
    assert!(c.closed && c.lighter.is_none(), "{c:?}");
}

#[test]
fn bounds_hold_and_are_named() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*strength, PUBLISHED_PI);
    d.min_wall = 4.5e-3;
    let o = lightest(&d, None).expect("solved");
    assert!(o.bounds[Bound::MinWall as usize] > 0.0);
    assert!((o.size.outer - o.size.inner - 9e-3).abs() < 1e-15);
    d.min_wall = 0.0;
    d.outer = Range { low: 22e-3, high: 23e-3 };
    let o = lightest(&d, None).expect("solved");
    assert!((o.size.outer - 22e-3).abs() < 1e-17 && o.bounds[Bound::MinOuter as usize] > 0.0);
    d.inner = Range { low: 0.0, high: 10e-3 };
    let o = lightest(&d, None).expect("solved");
    assert!(o.bounds[Bound::MaxInner as usize] > 0.0 && (o.size.inner - 10e-3).abs() < 1e-17);
    // Every wrong range ends in words, not in a loop.
    d.outer = Range { low: 18e-3, high: 19.5e-3 };
    let Err(NoOptimum::Infeasible(f)) = lightest(&d, None) else { panic!("there is no such pin") };
    assert_eq!(f[0].limit, PinQuantity::RodPressure);
}

/// A bound that gives way by a length changes the mass by its multiplier times that length; so do two bounds that hold together.
#[test]
fn multipliers_of_bounds_are_the_change_of_the_mass() {
    let strength = model("thin_ring", PUBLISHED_PI);
    let base = published_design(&*strength, PUBLISHED_PI);
    let moved = |bound: Bound, by: f64| {
        let mut d = base;
        match bound {
            Bound::MinWall => d.min_wall = 4.5e-3 - 0.5 * by,
            Bound::MinOuter => d.outer = Range { low: 22e-3 - by, high: 23e-3 },
            Bound::MaxInner => d.inner = Range { low: 0.0, high: 10e-3 + by },
            Bound::MinLength => d.length = Range { low: 68e-3 - by, high: 80e-3 },
            _ => d.outer = Range { low: 19.55e-3, high: 21e-3 + by },
        }
        lightest(&d, None).expect("solved")
    };
    for bound in [Bound::MinWall, Bound::MinOuter, Bound::MaxInner, Bound::MinLength, Bound::MaxOuter] {
        let h = 1e-7;
        let slope =
            (moved(bound, h).masses.differential() - moved(bound, -h).masses.differential()) / (2.0 * h);
        let multiplier = moved(bound, 0.0).bounds[bound as usize];
        // Truncation (h/diameter)², rounding 1e-17 kg over h; a wall counts on both sides.
        assert!(
            multiplier > 0.0 && (slope / multiplier + 1.0).abs() < 1e-7,
            "{bound:?}: {slope} {multiplier}"
        );
    }
}

/// Newton's method squares the error, so few steps are needed: from any start about ten, two of them at rounding.
#[test]
fn a_few_quadratic_programs_are_enough() {
    for name in MODELS {
        let strength = model(name, PUBLISHED_PI);
        let mut d = published_design(&*strength, PUBLISHED_PI);
        if name != "thin_ring" {
            d.limits[PinQuantity::Deflection as usize] = 0.1e-3;
            d.limits[PinQuantity::OvalisationStress as usize] = 55.0 * KGF;
        }
        for from in [None, Some(mm(54.0, 21.85, 17.0)), Some(mm(65.0, 23.0, 13.0)), Some(mm(80.0, 20.7, 6.0))]
        {
            let o = lightest(&d, from).expect("solved");
            assert!(o.iterations <= 20, "{name} {from:?}: {}", o.iterations);
        }
    }
}
