//! Rings that the oil on a flank holds.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::FlankLaw;
use gudgeon_core::kinds::{FlankCtx, FlankSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_ring::parts::{Balance, GrooveFlank as Flank};
use gudgeon_ring::{Dry, SqueezeFilm};

const C: f64 = 1e-4;
const A: f64 = 1.8e-3;

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
            let b = Balance {
                away,
                external: away * load,
                s,
                oil: FlankOil::default(),
                clearance: C,
                area: A,
                damping: &*damping,
                flank: &flank,
                fall: 0.02,
            };
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
                left <= 1e-9 * (load.abs() + b.stiffness(w, b.force(w)) * w.abs()) + 1e-12,
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
    let at = |load: f64| {
        Balance {
            away: 1.0,
            external: load,
            s: 0.0,
            oil: FlankOil::default(),
            clearance: C,
            area: A,
            damping: &*damping,
            flank: &flank,
            fall: 0.02,
        }
        .velocity(release)
    };
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
        let b = Balance {
            away,
            external: -away * 300.0,
            s,
            oil: FlankOil::default(),
            clearance: C,
            area: A,
            damping: &*none,
            flank: &flank,
            fall: 0.02,
        };
        assert_eq!(b.velocity(1e-5), -0.02);
    }
}
