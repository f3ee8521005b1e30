//! The oil that one side keeps: nothing is lost, halves are halves, and full gaps carry as ever.

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{Film2dSpec, SkirtOilSpec, SkirtProfileCtx, SkirtProfileSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_film::film_2d::{Cavitation, Direct};
use gudgeon_film::{SmoothSurfaces, WavinessTransport};
use gudgeon_skirt::{
    Barrel, ContactGrid, FillHistory, NoSkirtOil, OilWay, Panel, Side, SideLoads, SideSetup, Slopes,
};

use crate::common::*;

const PANEL: Panel = Panel { radius: RADIUS, length: LENGTH, half_angle: HALF[0] };

/// A barrelled side on `across` intervals over its arc: an odd number has no half.
fn barrelled(film: &dyn Film2dSpec, across: usize, rough: bool, p_cav: f64) -> Side {
    let files = &Files::default();
    let barrel = Barrel {
        top: quantity(20e-6),
        bottom: quantity(8e-6),
        widest: quantity(0.6),
        ovality: quantity(30e-6),
    };
    let profile = barrel.build(&SkirtProfileCtx { length: LENGTH, radius: RADIUS, files }).expect("a shape");
    let grid = PANEL.grid(10, across, 0.0);
    let waves = waves(WavinessTransport::Homogenised);
    Side::new(SideSetup {
        boundary_friction: None,
        panel: PANEL,
        sign: 1.0,
        clearance: 2e-5,
        grid: &grid,
        film,
        roughness: if rough { &waves } else { &SmoothSurfaces {} },
        contact: &gudgeon_contact::Off {},
        contact_grid: ContactGrid { pitch: 1e-3, intervals: 4 },
        profile: &*profile,
        compliance: rigid(&grid),
        shear_thinning: None,
        p_cav,
        floor: 1e-7,
    })
    .expect("builds")
}

fn kept(across: usize, rough: bool) -> Side {
    let mut side = barrelled(&Direct::default(), across, rough, 0.0);
    side.keep_oil().expect("a film that keeps its filling");
    side
}

/// Step `k` of a motion up and down, towards the liner and away from it.
fn way(k: u32) -> OilWay<'static> {
    let t = f64::from(k) * 0.1;
    let e = [-8e-6 * t.sin(), -12e-6 * (1.3 * t).cos()];
    OilWay { e, q: &[], speed: 9.0 * (0.7 * t).sin(), mu: 0.01, dt: 1e-4, arriving: [3e-6, 40e-6] }
}

#[test]
fn no_oil_is_lost_or_made() {
    for rough in [false, true] {
        let mut side = kept(8, rough);
        side.begin_oil(way(0).e, &[], way(0).speed, Some(15e-6)).expect("a gap");
        let start = side.held();
        assert!(start > 0.0);
        let (mut left, mut least, mut most) = ([0.0; 3], 1.0_f64, 0.0_f64);
        for k in 1..400 {
            let before = side.held();
            side.foresee(&way(k)).expect("a film");
            let moved = side.move_oil(&way(k)).expect("a film");
            left.iter_mut().zip(moved.left).for_each(|(l, m)| *l += m);
            assert!(moved.left[2] > -1e-12 * start, "oil comes in over a flank: {moved:?}");
            // Rounding of the volumes that pass in a step.
            let lost = before - moved.held - moved.left.iter().sum::<f64>();
            assert!(lost.abs() < 1e-13 * before.max(start), "{k}: {lost:e} of {before:e}");
            (least, most) = (least.min(moved.held / moved.room), most.max(moved.held / moved.room));
        }
        // Four hundred steps.
        let lost = start - side.held() - left.iter().sum::<f64>();
        assert!(lost.abs() < 1e-12 * start, "{lost:e} of {start:e}");
        // The gap was neither full nor empty all the while.
        assert!(least < 0.6 && most > 0.6 && most <= 1.0, "{least} {most}");
    }
}

#[test]
fn one_half_stands_for_both() {
    // The same nodes with a shape that is its own mirror image: the half of one is that of a whole with an odd number of intervals in the limit of fine grids alone,
    // so the volumes of coarse ones are compared.
    let follow = |across: usize| {
        let mut side = kept(across, false);
        side.begin_oil(way(0).e, &[], way(0).speed, Some(15e-6)).expect("a gap");
        let moved = (1..60).map(|k| side.move_oil(&way(k)).expect("a film"));
        moved.last().expect("steps")
    };
    let (half, whole) = (follow(16), follow(17));
    // First order in the spacing: a sixteenth of the difference of one interval.
    assert!((half.held / whole.held - 1.0).abs() < 0.01, "{half:?} {whole:?}");
    assert!((half.room / whole.room - 1.0).abs() < 0.005, "{half:?} {whole:?}");
}

#[test]
fn a_gap_that_is_full_carries_like_one_without_history() {
    let (rates, speed, mu) = ([-4e-3, -6e-3], 9.0, 0.01);
    let e = [-8e-6, -12e-6];
    let mut plain =
        barrelled(&Direct { cavitation: Cavitation::HalfSommerfeld, ..Direct::default() }, 8, true, 0.0);
    let mut full = kept(8, true);
    let ask = |side: &mut Side| {
        let mut l = SideLoads::default();
        side.place(e, &[], speed).expect("a gap");
        side.loads(speed, mu, &rates, Slopes::Film, &mut l).expect("a film");
        l
    };
    let (wanted, found) = (ask(&mut plain), ask(&mut full));
    assert_eq!(wanted, found, "every node is full before the oil is followed");
    // An empty gap carries nothing and drags nothing.
    full.begin_oil(e, &[], speed, Some(0.0)).expect("a gap");
    full.foresee(&OilWay { e, speed, arriving: [0.0; 2], ..way(1) }).expect("a film");
    let empty = ask(&mut full);
    // A tenth of a digit of what the full film drags with.
    let none = |f: &f64| f.abs() < 1e-15 * wanted.film[2].abs();
    assert!(empty.film.iter().chain(&empty.contact).all(none), "{empty:?}");
    assert!(empty.slope.iter().all(|s| *s == 0.0));
}

#[test]
fn a_gap_that_closes_on_its_oil_comes_to_carry_without_a_jump() {
    // A film of 10 um: nothing down to where it is nine tenths of the gap, then more with every step, and in the end a full film.
    let mut side = kept(8, false);
    let rates = [-5e-3, -5e-3];
    side.begin_oil([0.0; 2], &[], 0.0, Some(10e-6)).expect("a gap");
    let still = OilWay { e: [0.0; 2], speed: 0.0, arriving: [0.0; 2], dt: 1e-9, ..way(1) };
    side.foresee(&still).expect("a film");
    let mut before = 0.0;
    let mut largest = 0.0_f64;
    for k in 0..400 {
        let e = -1.2e-5 * f64::from(k) / 400.0;
        side.place([e, e], &[], 0.0).expect("a gap");
        let mut l = SideLoads::default();
        side.loads(0.0, 0.01, &rates, Slopes::None, &mut l).expect("a film");
        let force = l.film[0] + l.film[1];
        assert!(force >= before * (1.0 - 1e-9), "{k}: {force} after {before}");
        if side.smallest_gap() > 10e-6 / 0.9 {
            assert_eq!(force, 0.0);
        }
        largest = largest.max(force - before);
        before = force;
    }
    // The last steps, in which a full film grows with the cube of its gap, are among the largest: nothing strikes.
    assert!(before > 0.0 && largest < 0.1 * before, "{largest} of {before}");
}

#[test]
fn a_film_above_that_is_given_is_not_the_rings() {
    let arriving = |spec: &FillHistory| spec.build().expect("a supply").expect("of oil").arriving(0.0);
    let mut open = FillHistory { splash: quantity(80e-6), ..FillHistory::default() };
    let before = arriving(&open);
    assert!(open.take_from_rings(3e-6));
    assert_eq!(arriving(&open), [3e-6, 80e-6]);
    assert!(before[0] > 3e-6 && before[1] == 80e-6, "{before:?}");
    let mut given = FillHistory { above: Some(quantity(7e-6)), ..FillHistory::default() };
    assert!(!given.take_from_rings(3e-6));
    assert_eq!(arriving(&given)[0], 7e-6);
    assert!(!NoSkirtOil {}.keeps_oil() && !NoSkirtOil {}.take_from_rings(3e-6));
    for degrees in [0.01_f64, 20.0] {
        let e = FillHistory { step: quantity(degrees.to_radians()), ..FillHistory::default() }.build();
        assert!(e.expect_err("refused").to_string().contains("between 0.05 and 10"));
    }
}

#[test]
fn films_without_a_filling_are_refused() {
    let cut = Direct { cavitation: Cavitation::HalfSommerfeld, ..Direct::default() };
    let e = barrelled(&cut, 8, false, 0.0).keep_oil().expect_err("refused");
    assert!(e.to_string().contains("does not know how full"), "{e}");
    let e = barrelled(&Direct::default(), 8, false, -5e4).keep_oil().expect_err("refused");
    assert!(e.to_string().contains("open to the crankcase"), "{e}");
}
