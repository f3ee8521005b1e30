//! Rings that the oil on a flank holds.

use gudgeon_core::geometry::{FlankOil, RingPlace};
use gudgeon_core::kinds::{FlankCtx, FlankLaw, FlankResistance, FlankSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_ring::parts::{Balance, Groove, GrooveFlank as Flank};
use gudgeon_ring::{Dry, SqueezeFilm, WettedStrip};

const C: f64 = 1e-4;

/// A ring with a flank of 1.8e-3 m².
fn at(s: f64) -> RingPlace {
    let (r_inner, r_outer) = (0.055, (0.055_f64 * 0.055 + 1.8e-3 / std::f64::consts::PI).sqrt());
    RingPlace { s, clearance: C, r_inner, r_outer, ..RingPlace::default() }
}

fn groove<'a>(damping: &'a dyn FlankLaw, flank: &'a Flank) -> Groove<'a> {
    Groove { damping, flank, fall: 0.02 }
}

fn models() -> (Box<dyn FlankLaw>, Flank) {
    let ctx = FlankCtx::new(0, 1, 0.6, 5e-3, 0.01);
    let damping = SqueezeFilm::default().build(&ctx).expect("builds").law();
    (damping, Flank { stiffness: 1e10, per_rebound: 100.0 })
}

#[test]
fn velocity_balances_the_forces_on_both_flanks() {
    let (damping, flank) = models();
    let mut held = 0;
    for (away, s) in [(1.0, 0.0), (1.0, 1e-7), (1.0, -2e-8), (1.0, 3e-6), (-1.0, C), (-1.0, C - 2e-7)] {
        for load in [-1e4, -300.0, -1.0, -1e-6, 1e-6, 1.0, 50.0] {
            // A load on the flank is towards it; up to 50 N are less than the 108 N that the film can hold.
            let place = at(s);
            let b = Balance::new(away, away * load, &place, groove(&*damping, &flank));
            // A film that the load tears apart, and a flank that pushes harder than the load, let go.
            if b.force(1e-3) >= 0.0 {
                continue;
            }
            held += 1;
            let w = b.velocity(1e-3);
            assert!(w < 1e-3, "kept");
            // Resolution of the velocity times the stiffness, against the largest force in the balance.
            let left = b.force(w).abs();
            assert!(
                left <= 1e-9 * (load.abs() + b.stiffness(w) * w.abs()) + 1e-12,
                "{s} {load}: {w:e} {left:e}"
            );
        }
    }
    assert!(held >= 30, "{held} of 42");
}

#[test]
fn beyond_the_release_speed_the_velocity_goes_on_along_the_tangent() {
    let (damping, flank) = models();
    let release = 1e-5;
    let place = at(0.0);
    let at = |load: f64| Balance::new(1.0, load, &place, groove(&*damping, &flank)).velocity(release);
    // The load that leads to the release speed, by bisection on the velocity.
    let (mut lo, mut hi) = (0.0, 1e4);
    for _ in 0..100 {
        let mid = 0.5 * (lo + hi);
        if at(mid) < release { lo = mid } else { hi = mid }
    }
    let step = 1e-6 * hi;
    let (below, above) = ((at(hi) - at(hi - step)) / step, (at(hi + step) - at(hi)) / step);
    // One tangent on both sides; the curvature of the law over a millionth of the load.
    assert!((below / above - 1.0).abs() < 1e-3, "{below:e} {above:e}");
    // Straight from there: twice the excess, twice the speed.
    let (one, two) = (at(1.5 * hi) - release, at(2.0 * hi) - release);
    assert!((two / one - 2.0).abs() < 1e-6, "{one:e} {two:e}");
}

#[test]
fn a_ring_that_nothing_resists_falls_at_a_finite_speed() {
    let (_, flank) = models();
    let none: Box<dyn FlankLaw> = Dry { gas_viscosity: quantity(0.0), ..Dry::default() }
        .build(&FlankCtx::new(0, 1, 0.6, 5e-3, 0.01))
        .expect("builds")
        .law();
    for (away, s) in [(1.0, 1e-9), (1.0, 0.0), (-1.0, C - 1e-9)] {
        let place = at(s);
        let b = Balance::new(away, -away * 300.0, &place, groove(&*none, &flank));
        assert_eq!(b.velocity(1e-5), -0.02);
    }
}

/// Random numbers between 0 and 1, the same in every run.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

/// A law of which only the force is known.
struct Silent(Box<dyn FlankLaw>);

impl FlankLaw for Silent {
    fn force(&self, oil: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> f64 {
        self.0.force(oil, s, v, clearance, area)
    }
}

/// The velocity at which the force changes its sign, by bisection down to neighbouring numbers.
fn bisected(b: &Balance<'_>, release: f64) -> f64 {
    let (mut lo, mut hi) = if b.force(0.0) > 0.0 { (0.0, release) } else { (-1e9, -0.0) };
    for _ in 0..1200 {
        let mid = 0.5 * (lo + hi);
        if mid <= lo || mid >= hi {
            break;
        }
        if b.force(mid) > 0.0 { lo = mid } else { hi = mid }
    }
    0.5 * (lo + hi)
}

#[test]
fn velocity_is_that_of_bisection_for_films_and_for_laws_that_tell_only_their_force() {
    let ctx = FlankCtx::new(0, 1, 0.6, 5e-3, 0.01).at_speed(200.0);
    // Walls that let go far above the release speed and below it.
    let walls = [100.0, 1e5].map(|per_rebound| Flank { stiffness: 1e10, per_rebound });
    let strip = WettedStrip::default().build(&ctx).expect("builds");
    let laws = [SqueezeFilm::default().build(&ctx).expect("builds").law(), strip.law()];
    let silent = [SqueezeFilm::default().build(&ctx).expect("builds").law(), strip.law()].map(Silent);
    let (mut seed, release) = (3, 1e-3);
    let (mut rising, mut sinking) = (0, 0);
    for _ in 0..20_000 {
        let away = if random(&mut seed) < 0.5 { 1.0 } else { -1.0 };
        // From a little in the flank to mid-groove.
        let depth = -1e-7 * random(&mut seed);
        let from =
            if random(&mut seed) < 0.3 { depth } else { 0.5 * C * 10.0_f64.powf(-4.0 * random(&mut seed)) };
        let mut place = at(if away > 0.0 { from } else { C - from });
        let y = [3.0 * random(&mut seed), 3.0 * random(&mut seed)];
        place.flank = strip.oil(&y, &place);
        let sign = if random(&mut seed) < 0.5 { 1.0 } else { -1.0 };
        let load = sign * 10.0_f64.powf(6.0 * random(&mut seed) - 2.0);
        let flank = &walls[usize::from(random(&mut seed) < 0.5)];
        let k = usize::from(random(&mut seed) < 0.5);
        let known = Balance::new(away, away * load, &place, groove(&*laws[k], flank));
        if known.force(release) >= 0.0 {
            continue;
        }
        if known.force(0.0) > 0.0 {
            rising += 1
        } else {
            sinking += 1
        }
        let want = bisected(&known, release);
        // A rounding of the greatest force that is balanced, some ten times, and the resolution of the search.
        let noise = 1e-15 * (load.abs() + known.reaction(0.0).abs()) / known.stiffness(want);
        for (b, resolution) in
            [(&known, 1e-15), (&Balance::new(away, away * load, &place, groove(&silent[k], flank)), 1e-13)]
        {
            let w = b.velocity(release);
            let allowed = 4.0 * resolution * want.abs() + 10.0 * noise;
            assert!((w - want).abs() <= allowed, "{k} {place:?} {load:e}: {w:e} {want:e} {allowed:e}");
        }
    }
    assert!(rising > 1000 && sinking > 1000, "{rising} {sinking}");
}

#[test]
fn the_stiffness_is_the_slope_of_the_force_on_the_side_away_from_zero() {
    let (damping, flank) = models();
    for s in [-2e-8, 0.0, 1e-6] {
        let place = at(s);
        let b = Balance::new(1.0, -20.0, &place, groove(&*damping, &flank));
        for w in [-1e-4, -0.0, 0.0, 1e-5] {
            let d = 1e-9_f64.copysign(w);
            let slope = (b.force(w + d) - b.force(w)) / d;
            // Tension bends the law by 2 d/t of its slope, and rounding of the force is as much of a difference of 1e-9.
            assert!((b.stiffness(w) / -slope - 1.0).abs() < 1e-2, "{s:e} {w:e}");
        }
    }
}

#[test]
fn a_resistance_that_is_linear_opposes_both_ways() {
    let r = FlankResistance::linear(3.0);
    assert_eq!((r.force(2.0), r.force(-2.0), r.at(-0.5)), (-6.0, 6.0, [1.5, 3.0, 0.0]));
}
