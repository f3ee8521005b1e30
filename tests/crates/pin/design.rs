//! What the limits leave: bores, lengths and outer diameters against a look at many pins.

use std::f64::consts::PI;

use gudgeon_core::kinds::{PinQuantity, PinSize};
use gudgeon_pin::design::{BlockingLimit, Design, LengthBound, Range, Relief};

use crate::common::*;

#[test]
fn the_mass_is_that_of_a_tube_less_the_flats() {
    let m = model("thin_ring", PI);
    let mut d = published_design(&*m, PI);
    let size = mm(60.0, 22.0, 14.0);
    let tube = 7850.0 * 0.25 * PI * (22e-3f64.powi(2) - 14e-3f64.powi(2)) * 60e-3;
    let masses = d.masses(&size);
    assert!((masses.pin / tube - 1.0).abs() < 1e-14);
    assert_eq!(masses.differential(), masses.pin - masses.relieved);
    // Nothing is cut beyond a pin as long as the piston is wide, and a longer one gains nothing.
    for length in [BORE, 2.0 * BORE] {
        assert!(d.masses(&PinSize { length, ..size }).relieved.abs() < 1e-18);
    }
    // A vanishing pin: the whole half discs.
    let all = Relief { bore: BORE, height: 26e-3, density: 2690.0 }.mass(0.0);
    assert!((all / (0.25 * PI * BORE * BORE * 26e-3 * 2690.0) - 1.0).abs() < 1e-14);
    d.relief = None;
    assert_eq!(d.masses(&size).relieved, 0.0);
}

#[test]
fn bores_leave_a_wall_and_the_theory() {
    let m = model("curved_ring", PI);
    let mut d = published_design(&*m, PI);
    d.inner = Range { low: 2e-3, high: 30e-3 };
    // The curved bar holds from a quarter of the outer diameter on.
    assert_eq!((d.min_inner(20e-3), d.min_inner(4e-3)), (5e-3, 2e-3));
    assert!((d.max_inner(20e-3) - 20e-3 * (1.0 - 1e-9)).abs() < 1e-17);
    assert_eq!(d.max_inner(40e-3), 30e-3);
    d.min_wall = 3e-3;
    assert_eq!(d.max_inner(20e-3), 20e-3 - 6e-3);
    d.min_wall = 0.0;
    d.tolerance = mm(0.0, 0.2, 0.3);
    assert!((d.max_inner(20e-3) - (20e-3 - 0.5e-3)).abs() < 1e-9 * 20e-3 + 1e-17);
    assert!(Range::at(1.0).is_fixed() && !d.inner.is_fixed() && Range { low: 2.0, high: 1.0 }.is_fixed());
}

/// The bore that all limits leave is the smallest of the bores that each of them leaves, and one of them is used up there.
#[test]
fn the_tightest_limit_is_the_bore() {
    let m = model("elastic_ring", PI);
    let mut d = published_design(&*m, PI);
    d.limits[PinQuantity::Deflection as usize] = 0.1e-3;
    d.limits[PinQuantity::OvalisationStress as usize] = 55.0 * KGF;
    let mut solved = 0;
    for outer in [20.7e-3, 21.5e-3, 22.5e-3, 23.5e-3] {
        for length in [58e-3, 62e-3, 66e-3, 72e-3] {
            let of_limits: Vec<Option<f64>> =
                PinQuantity::ALL.into_iter().map(|q| d.max_inner_of_limit(q, length, outer)).collect();
            let smallest = of_limits.iter().copied().collect::<Option<Vec<f64>>>();
            let smallest = smallest.map(|b| b.into_iter().fold(f64::INFINITY, f64::min));
            let all = d.max_feasible_inner(length, outer);
            assert_eq!(all.is_some(), smallest.is_some(), "{outer} {length}");
            let (Some(all), Some(smallest)) = (all, smallest) else { continue };
            solved += 1;
            // Both bisections end at neighbouring numbers; 60 halvings leave 2e-20 of the diameter.
            assert!((all / smallest - 1.0).abs() < 1e-14, "{all} {smallest}");
            let u = d.utilisation(&PinSize { length, outer, inner: all }).expect("inside");
            let max = u.iter().copied().fold(0.0, f64::max);
            assert!(max <= 1.0 && max > 1.0 - 1e-12, "{max}");
        }
    }
    assert!(solved >= 6, "{solved}");
    // A limit that never binds leaves the wall alone.
    d.limits[PinQuantity::ShearStress as usize] = f64::INFINITY;
    let wall = d.max_inner(22e-3);
    let bore = d.max_inner_of_limit(PinQuantity::ShearStress, 60e-3, 22e-3).expect("never binds");
    assert!((bore / wall - 1.0).abs() < 1e-15);
    d.limits = [f64::INFINITY; 8];
    assert_eq!(d.max_feasible_inner(60e-3, 22e-3), Some(wall));
    d.inner = Range { low: 23e-3, high: 30e-3 };
    assert_eq!(d.max_feasible_inner(60e-3, 22e-3), None);
    assert_eq!(d.max_inner_of_limit(PinQuantity::ShearStress, 60e-3, 22e-3), None);
}

/// Whether a pin of an outer diameter keeps the limits, by a look at many lengths of the thickest wall.
fn some_length_keeps(d: &Design<'_>, outer: f64) -> bool {
    let inner = d.min_inner(outer);
    (0..=4000).any(|k| {
        let length = d.length.low + (d.length.high - d.length.low) * f64::from(k) / 4000.0;
        d.utilisation(&PinSize { length, outer, inner }).is_ok_and(|u| u.iter().all(|u| *u <= 1.0))
    })
}

fn excess(d: &Design<'_>, outer: f64, b: &BlockingLimit, length: f64) -> f64 {
    let size = PinSize { length, outer, inner: d.min_inner(outer) };
    d.utilisation(&size).map_or(f64::INFINITY, |u| u[b.limit as usize]) - 1.0
}

/// Random engines: limits block a diameter exactly when no length keeps them, and the lengths that they leave are those at which they are
/// used up.
#[test]
fn blocking_limits_block() {
    let mut r = Random(5);
    let (mut blocked, mut pairs, mut resultant) = (0, 0, 0);
    for k in 0..400 {
        let mut e = Engine::new(&mut r);
        e.limits[PinQuantity::RodPressure as usize] *= if k % 3 == 0 { 1.0 } else { 5.0 };
        e.limits[PinQuantity::ResultantStress as usize] *= if k % 5 == 0 { 0.7 } else { 1.0 };
        let s = gudgeon_core::kinds::PinStrengthSpec::build(&gudgeon_pin::ThinRing {}, &e.ctx);
        let s = s.expect("builds");
        let d = e.design(&*s);
        let outer = e.bore * r.between(0.2, 0.35);
        let blocking = d.blocking_limits(outer);
        if blocking.is_empty() {
            // The resultant's interval may be narrower than the look's: the optimum of a wider pin shows the other side.
            assert!(some_length_keeps(&d, outer * (1.0 + 1e-3)), "{k}");
            continue;
        }
        assert!(!some_length_keeps(&d, outer), "{k}: {blocking:?}");
        blocked += 1;
        match blocking.as_slice() {
            [
                a @ BlockingLimit { length: Some(LengthBound::AtLeast(min)), .. },
                b @ BlockingLimit { length: Some(LengthBound::AtMost(max)), .. },
            ] => {
                pairs += 1;
                assert!(min > max);
                // 80 halvings of centimetres end at rounding; slopes over the length are of order one.
                assert!(excess(&d, outer, a, *min).abs() < 1e-12 && excess(&d, outer, b, *max).abs() < 1e-12);
            }
            all => {
                for b in all {
                    assert_eq!(b.length, None, "{all:?}");
                    resultant += usize::from(b.limit == PinQuantity::ResultantStress);
                    for part in [0.0, 0.25, 0.5, 0.75, 1.0] {
                        let length = d.length.low + (d.length.high - d.length.low) * part;
                        let alone = b.limit != PinQuantity::ResultantStress;
                        assert!(!alone || excess(&d, outer, b, length) > 0.0, "{b:?}");
                    }
                }
            }
        }
    }
    assert!(blocked > 50 && pairs > 5 && resultant > 0, "{blocked} {pairs} {resultant}");
}

#[test]
fn the_minimum_outer_diameter_parts_the_range() {
    let m = model("thin_ring", PUBLISHED_PI);
    let mut d = published_design(&*m, PUBLISHED_PI);
    // Without the rod pressure the limits of stress and length decide.
    d.limits[PinQuantity::RodPressure as usize] = f64::INFINITY;
    let min = d.min_feasible_outer().expect("there are pins");
    assert!(min > d.outer.low && min < d.outer.high);
    assert!(d.blocking_limits(min).is_empty() && !d.blocking_limits(min * (1.0 - 1e-12)).is_empty());
    d.outer.low = 22e-3;
    assert_eq!(d.min_feasible_outer(), Some(22e-3));
    d.outer = Range { low: 15e-3, high: 19e-3 };
    assert_eq!(d.min_feasible_outer(), None);
    // A wall that does not fit forbids what strength admits.
    d.outer = Range { low: 22e-3, high: 30e-3 };
    d.inner.low = 10e-3;
    d.min_wall = 7e-3;
    assert!((d.min_feasible_outer().expect("wide ones") - 24e-3).abs() < 1e-16);
}

/// The hoop stress falls with the length, the bending stress rises: their resultant has a minimum between the ends of the range, which alone
/// decides whether its limit blocks a diameter.
#[test]
fn the_resultant_blocks_a_diameter_below_its_minimum_over_the_length() {
    let m = model("thin_ring", PI);
    let mut d = published_design(&*m, PI);
    let (outer, resultant) = (22e-3, PinQuantity::ResultantStress);
    d.inner = Range { low: 15e-3, high: 22e-3 };
    d.limits = [f64::INFINITY; 8];
    d.limits[resultant as usize] = 1.0;
    let n = 4000;
    let stress: Vec<f64> = (0..=n)
        .map(|k| d.length.low + (d.length.high - d.length.low) * f64::from(k) / f64::from(n))
        .map(|length| {
            let size = PinSize { length, outer, inner: d.min_inner(outer) };
            d.utilisation(&size).expect("inside")[resultant as usize]
        })
        .collect();
    let min = stress.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(stress[0] > 1.1 * min && stress[n as usize] > 1.1 * min);
    // The square of half a step over the length, below 1e-6, is what the grid may miss.
    d.limits[resultant as usize] = min * (1.0 + 1e-9);
    assert!(d.blocking_limits(outer).is_empty());
    d.limits[resultant as usize] = min * (1.0 - 1e-6);
    assert_eq!(d.blocking_limits(outer), [BlockingLimit { limit: resultant, length: None }]);
}
