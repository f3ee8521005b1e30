//! A ring with three seats.

use gudgeon_core::kinds::{AxialForces, RingMotion, RingMotionCtx, RingMotionSpec};
use gudgeon_core::kinds::{FlankDampingCtx, FlankDampingSpec};
use gudgeon_ring::{DampingOff, ThreeSeat};

fn built(spec: &ThreeSeat) -> Box<dyn RingMotion> {
    let oil = FlankDampingCtx { ring: 0, rings: 1, oil_fill: 0.6, width: 5e-3, mu: 0.01 };
    let damping = DampingOff {}.build(&oil).expect("builds");
    spec.build(RingMotionCtx::new(0, 7e-3, 3e-5, 200.0, damping)).expect("builds")
}

/// Where the ring sits after a decision with these forces.
fn seat(m: &mut dyn RingMotion, forces: &AxialForces) -> f64 {
    let before = m.decided()[0];
    assert_eq!(m.decide(forces), m.decided()[0] != before);
    let pose = m.pose(&[], 3e-5);
    assert_eq!((pose.lift_fraction, pose.s), (m.decided()[0], m.decided()[0] * 3e-5));
    pose.lift_fraction
}

#[test]
fn the_three_seats() {
    let mut m = built(&ThreeSeat::default());
    let mut at =
        |gas, inertia, film| seat(&mut *m, &AxialForces { gas, inertia, film, ..AxialForces::default() });
    assert_eq!(at(-100.0, 50.0, 0.0), 0.0);
    assert_eq!(at(-100.0, 150.0, 0.0), 1.0);
    assert_eq!(at(-100.0, 95.0, 0.0), 0.5);
    assert_eq!(at(-100.0, 105.0, 0.0), 0.5);
    assert_eq!(at(-100.0, 95.0, -20.0), 0.0);
    assert_eq!(at(-100.0, 90.0, 0.0), 0.5, "the edge of the band belongs to it");
    assert_eq!(at(0.0, 0.0, 0.0), 0.5, "no force at all");
    assert_eq!(m.decision_interval(), Some(std::f64::consts::PI / 180.0));
}

#[test]
fn counts_only_what_it_is_told_to() {
    let spec = ThreeSeat { gravity: false, film_force: false, ..ThreeSeat::default() };
    let mut m = built(&spec);
    let f = AxialForces { gas: -10.0, film: 1e3, gravity: 1e3, damping: 1e3, ..AxialForces::default() };
    assert_eq!(seat(&mut *m, &f), 0.0);
    assert!(!m.uses_film_force() && !m.uses_gravity());
}
