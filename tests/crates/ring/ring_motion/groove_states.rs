//! The states of a ring between its flanks: free motion, and while the oil on a flank holds it.

use gudgeon_core::geometry::{FlankOil, RingPlace};
use gudgeon_core::kinds::{
    AxialForces, FlankCtx, FlankLaw, FlankSpec, RingForces, RingMotion, RingMotionCtx, RingMotionSpec,
    RingResponse,
};
use gudgeon_core::quantity::quantity;
use gudgeon_core::states::Signals;
use gudgeon_ring::{Dry, NewtonGroove, SqueezeFilm};

const MASS: f64 = 0.043;
const C: f64 = 1e-4;
const OMEGA: f64 = 200.0;
const TOLERANCE: f64 = 1e-4;

fn oil(spec: &dyn FlankSpec) -> Box<dyn FlankLaw> {
    spec.build(&FlankCtx::new(0, 1, 0.6, 5e-3, 0.01)).expect("builds").law()
}

/// A groove in which nothing resists.
fn nothing() -> Dry {
    Dry { gas_viscosity: quantity(0.0), ..Dry::default() }
}

fn built(spec: &NewtonGroove, damping: Box<dyn FlankLaw>) -> Box<dyn RingMotion> {
    spec.build(RingMotionCtx::new(0, MASS, C, OMEGA, damping)).expect("builds")
}

/// A ring at a height with a velocity, flanks of some 18 cm² and an axial load of gas.
fn forces(s: f64, v: f64, gas: f64) -> RingForces {
    let place = RingPlace {
        h: 1e-6,
        s,
        v,
        clearance: C,
        lift_fraction: (s / C).clamp(0.0, 1.0),
        r_inner: 0.055,
        r_outer: 0.06,
        ..RingPlace::default()
    };
    RingForces::new(place, AxialForces { gas, ..AxialForces::default() })
}

fn rates(m: &mut dyn RingMotion, f: &RingForces) -> ([f64; 2], RingResponse) {
    let y = [f.place.s / C, f.place.v / (C * OMEGA)];
    let mut dy = [f64::NAN; 2];
    let r = m.rates(&y, f, &mut dy).expect("a motion");
    (dy, r)
}

fn near(got: f64, want: f64, tolerance: f64) {
    assert!((got - want).abs() <= tolerance * want.abs(), "{got:e}, expected {want:e}");
}

#[test]
fn a_free_ring_is_a_mass() {
    let mut m = built(&NewtonGroove::default(), oil(&nothing()));
    let mut f = forces(0.5 * C, 3e-3, 10.0);
    f.axial = AxialForces { gas: 10.0, inertia: -3.0, gravity: 0.4, film: 1.0, expander: 0.0, damping: 0.0 };
    let (dy, r) = rates(&mut *m, &f);
    // s/c0 and its derivative by crank angle: m c0 ω² y'' = ΣF. A few roundings.
    near(dy[0], 3e-3 / (C * OMEGA), 1e-15);
    near(dy[1], 8.4 / (MASS * C * OMEGA * OMEGA), 1e-14);
    assert_eq!((r.v, r.damping, r.reaction), (3e-3, 0.0, 0.0));
    // Sunk 10 nm into a flank of 10 kN/µm, at rest: 100 N away from it.
    for (s, away) in [(-1e-8, 1.0), (C + 1e-8, -1.0)] {
        let (dy, r) = rates(&mut *m, &forces(s, 0.0, 25.0));
        // The depth at the upper flank carries the rounding of the clearance.
        near(r.reaction, away * 100.0, 1e-11);
        near(dy[1], (25.0 + away * 100.0) / (MASS * C * OMEGA * OMEGA), 1e-11);
    }
    let pose = m.pose(&[0.25, 0.7], C);
    near(pose.s, 0.25 * C, 1e-15);
    near(pose.v, 0.7 * C * OMEGA, 1e-15);
    near(pose.lift_fraction, 0.25, 1e-15);
}

#[test]
fn the_oil_is_part_of_the_motion() {
    let squeeze = SqueezeFilm::default();
    let mut m = built(&NewtonGroove::default(), oil(&squeeze));
    let f = forces(0.2 * C, -2e-3, 10.0);
    let want = oil(&squeeze).force(&FlankOil::default(), 0.2 * C, -2e-3, C, f.place.flank_area());
    let (dy, r) = rates(&mut *m, &f);
    assert!(want > 0.0 && r.damping == want, "{} {want}", r.damping);
    near(dy[1], (10.0 + want) / (MASS * C * OMEGA * OMEGA), 1e-14);
    let second = m.second_order().expect("a law of second order");
    assert_eq!(second.damping(&f.place.flank, 0.2 * C, -2e-3, C, f.place.flank_area()), want);
}

#[test]
fn what_a_model_says_about_itself() {
    for (film_force, gravity) in [(true, false), (false, true)] {
        let m = built(&NewtonGroove { film_force, gravity, ..NewtonGroove::default() }, oil(&nothing()));
        assert!(m.moves() && m.uses_damping());
        assert_eq!((m.uses_film_force(), m.uses_gravity()), (film_force, gravity));
        let own = Signals::LIFT
            | Signals::AXIAL_VELOCITY
            | Signals::FILM_THICKNESS
            | Signals::PRESSURE
            | Signals::FLANK_OIL;
        assert_eq!(m.reads(), if film_force { own | Signals::FILM_FORCE } else { own });
    }
    let m = built(&NewtonGroove::default(), oil(&nothing()));
    let [lift, velocity] = m.states() else { panic!("two states") };
    assert_eq!((lift.name.as_str(), lift.changes), ("lift of ring1", Signals::LIFT));
    assert_eq!(
        (velocity.name.as_str(), velocity.changes),
        ("axial velocity of ring1", Signals::AXIAL_VELOCITY)
    );
}

#[test]
fn heights_are_judged_by_the_distance_from_the_flank() {
    let mut m = built(&NewtonGroove::default(), oil(&nothing()));
    for (lift, factor) in [(0.3, 30.0), (0.9, 10.0), (0.001, 1.0), (1.0, 1.0)] {
        rates(&mut *m, &forces(lift * C, 0.0, 1.0));
        let mut atol = [2.0, 3.0];
        m.ease(&mut atol);
        // The height that counts as one is a hundredth of the clearance.
        near(atol[0], 2.0 * factor, 1e-12);
        assert_eq!(atol[1], 3.0);
    }
}

/// A ring that the oil on a flank holds under a load towards that flank.
fn held(upper: bool, load: f64) -> (Box<dyn RingMotion>, RingForces) {
    let mut m = built(&NewtonGroove::default(), oil(&SqueezeFilm::default()));
    m.set_accuracy(TOLERANCE);
    let away = if upper { -1.0 } else { 1.0 };
    let s = if upper { C - 1e-7 } else { 1e-7 };
    let f = forces(s, 0.0, -away * load);
    m.free();
    rates(&mut *m, &f);
    let mut y = [s / C, 0.3];
    m.start(&mut y);
    assert_eq!(y[1], 0.0, "held from the start");
    (m, f)
}

#[test]
fn a_held_ring_moves_as_the_forces_balance() {
    for upper in [false, true] {
        let (mut m, f) = held(upper, 300.0);
        assert!(m.is_integrated(0) && !m.is_integrated(1) && m.event_is_located(0));
        let (dy, r) = rates(&mut *m, &f);
        // The velocity is found to 1e-13, the force of the film is proportional to it.
        assert!((f.axial.gas + r.damping + r.reaction).abs() < 1e-9 * 300.0, "{r:?}");
        near(dy[0], r.v / (C * OMEGA), 1e-15);
        assert_eq!(dy[1], 0.0);
        assert!(if upper { r.v > 0.0 } else { r.v < 0.0 }, "towards the flank");
        // Only a load that draws it away from the flank lets it go.
        assert!(m.event(0) < 0.0);
        let away = if upper { -1.0 } else { 1.0 };
        rates(&mut *m, &forces(f.place.s, 0.0, away * 1e4));
        assert!(m.event(0) > 0.0);
        let mut y = [0.0, 0.0];
        m.switch(0, &mut y);
        // Ten times the tolerance, in clearances per radian.
        near(y[1], away * 10.0 * TOLERANCE, 1e-14);
        assert!(m.is_integrated(1) && !m.event_is_located(0));
    }
}

#[test]
fn the_event_of_a_held_ring_is_the_balance_at_the_release_speed() {
    let (mut m, f) = held(false, 300.0);
    for load in [-1e3, -20.0, 50.0, 400.0] {
        rates(&mut *m, &forces(f.place.s, 0.0, load));
        let release = 10.0 * TOLERANCE * C * OMEGA;
        let film = oil(&SqueezeFilm::default()).force(
            &FlankOil::default(),
            f.place.s,
            release,
            C,
            f.place.flank_area(),
        );
        near(m.event(0), (load + film) / (MASS * C * OMEGA * OMEGA), 1e-12);
    }
}

#[test]
fn a_free_ring_is_held_when_it_moves_as_the_forces_balance() {
    let (mut m, f) = held(false, 300.0);
    let (_, balanced) = rates(&mut *m, &f);
    m.free();
    assert!(m.is_integrated(1));
    // As fast as the balance has it; the tolerance is that of the velocity, in clearances per radian.
    let unit = C * OMEGA;
    for (off, ready) in [(0.0, true), (0.5, true), (-0.5, true), (1.5, false), (-1.5, false)] {
        rates(&mut *m, &forces(f.place.s, balanced.v + off * TOLERANCE * unit, -300.0));
        assert_eq!(m.event(0) > 0.0, ready, "{off}: {}", m.event(0));
    }
    rates(&mut *m, &forces(f.place.s, balanced.v + 0.25 * TOLERANCE * unit, -300.0));
    // Settled to a quarter of what is admitted; nothing else is nearer.
    near(m.event(0), 0.75, 1e-6);
    let mut y = [1e-3, 0.4];
    m.switch(0, &mut y);
    assert_eq!((y, m.is_integrated(1)), ([1e-3, 0.0], false));
    // Halfway between the flanks the oil is too soft to hold anything.
    m.free();
    rates(&mut *m, &forces(0.5 * C, 0.0, -300.0));
    assert!(m.event(0) < 0.0);
}

#[test]
fn without_a_tolerance_nothing_is_held() {
    let (mut m, f) = held(false, 300.0);
    assert_eq!(m.n_events(), 1);
    m.set_accuracy(0.0);
    m.free();
    rates(&mut *m, &f);
    let mut y = [1e-3, 0.3];
    m.start(&mut y);
    assert_eq!((m.n_events(), y[1], m.is_integrated(1)), (0, 0.3, true));
}

#[test]
fn the_memory_is_what_holds_the_ring() {
    for upper in [false, true] {
        let (mut m, f) = held(upper, 300.0);
        let (want, _) = rates(&mut *m, &f);
        let mut saved = vec![7.0];
        m.save(&mut saved);
        assert_eq!(saved.len(), 2);
        m.free();
        assert!(m.is_integrated(1));
        assert_eq!(m.restore(&saved[1..]), 1);
        assert!(!m.is_integrated(1));
        assert_eq!(rates(&mut *m, &f).0, want);
    }
    let m = built(&NewtonGroove::default(), oil(&nothing()));
    let mut saved = Vec::new();
    m.save(&mut saved);
    let (mut other, _) = held(true, 300.0);
    other.restore(&saved);
    assert!(other.is_integrated(1), "a free ring");
}

#[test]
fn small_changes_follow_the_tangent_of_the_balance() {
    for upper in [false, true] {
        let (mut m, f) = held(upper, 300.0);
        let (_, base) = rates(&mut *m, &f);
        m.begin_differences();
        let moved = |d: f64| forces(f.place.s, 0.0, f.axial.gas + d);
        // A film is linear in the approach: the derivative over a millionth of the velocity keeps nine digits.
        let (_, near_by) = rates(&mut *m, &moved(1e-3));
        m.end_differences();
        let (_, searched) = rates(&mut *m, &moved(1e-3));
        let change = searched.v - base.v;
        assert!(change > 0.0);
        near(near_by.v - base.v, change, 1e-5);
    }
}

#[test]
fn a_ring_near_its_release_is_not_held_at_once() {
    // Pulled off the flank by less than the oil holds; the velocity of the balance is a part of the release speed.
    let release = 10.0 * TOLERANCE * C * OMEGA;
    let (mut m, f) = held(false, 300.0);
    let mut parts = 0;
    for pull in [20.0, 60.0, 90.0, 100.0] {
        let (mut other, _) = held(false, 300.0);
        let (_, balanced) = rates(&mut *other, &forces(f.place.s, 0.0, pull));
        let part = balanced.v / release;
        if part >= 1.0 {
            continue;
        }
        parts += 1;
        m.free();
        rates(&mut *m, &forces(f.place.s, balanced.v, pull));
        // Half the release speed and more is too fast to be held again; a cycle may start up to the release speed itself.
        near(m.event(0), (1.0 - 2.0 * part).max(-1.0), 1e-6);
        let mut y = [1e-3, 0.3];
        m.start(&mut y);
        assert!(!m.is_integrated(1), "{pull}: {part}");
        m.free();
    }
    assert!(parts >= 2, "{parts}");
}

#[test]
fn a_film_holds_where_it_is_stiff() {
    // Between the flanks the films soften; a rate of 100 per radian is the least that holds.
    let spec = SqueezeFilm { separation: quantity(0.0), ..SqueezeFilm::default() };
    let squeeze = oil(&spec);
    let mut m = built(&NewtonGroove::default(), oil(&spec));
    m.set_accuracy(TOLERANCE);
    let (mut stiff, mut soft) = (0, 0);
    for k in 0..100 {
        let s = C * (0.3 + 0.00195 * f64::from(k));
        let area = forces(s, 0.0, 0.0).place.flank_area();
        // The film is linear in the approach to the lower flank.
        let v = 1e-6;
        let stiffness = (squeeze.force(&FlankOil::default(), s, -2.0 * v, C, area)
            - squeeze.force(&FlankOil::default(), s, -v, C, area))
            / v;
        let rate = stiffness / (MASS * OMEGA * 100.0) - 1.0;
        let balanced = -1.0 / stiffness;
        m.free();
        rates(&mut *m, &forces(s, balanced, -1.0));
        if rate < 0.0 {
            soft += 1;
            assert_eq!(m.event(0), -1.0, "{s}");
        } else if rate < 0.9 {
            stiff += 1;
            // A derivative over a millionth of the velocity.
            assert!((m.event(0) - rate).abs() < 1e-6, "{s}: {} {rate}", m.event(0));
        }
    }
    assert!(stiff >= 2 && soft >= 3, "{stiff} {soft}");
}
