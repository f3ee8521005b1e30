//! A ring with three seats.

use gudgeon_core::kinds::{AxialForces, RingMotion, RingMotionCtx, RingMotionSpec};
use gudgeon_core::kinds::{FlankCtx, FlankSpec};
use gudgeon_core::states::Signals;
use gudgeon_ring::{Dry, ThreeSeat};

fn built(spec: &ThreeSeat) -> Box<dyn RingMotion> {
    let oil = FlankCtx::new(0, 1, 0.6, 5e-3, 0.01);
    let damping = Dry::default().build(&oil).expect("builds").law();
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

#[test]
fn weight_and_film_count_with_their_signs() {
    let mut m = built(&ThreeSeat { gravity: true, ..ThreeSeat::default() });
    assert!(m.uses_gravity() && m.uses_film_force() && m.moves());
    let mut at = |gravity, film| {
        let f = AxialForces { gas: 100.0, inertia: -120.0, gravity, film, ..AxialForces::default() };
        seat(&mut *m, &f)
    };
    // The resultant of -20 N, beyond the band of 10 N, and what moves it to the other side.
    assert_eq!((at(0.0, 0.0), at(40.0, 0.0), at(0.0, 40.0), at(25.0, -25.0)), (0.0, 1.0, 1.0, 0.0));
    assert_eq!((at(60.0, -25.0), at(-25.0, 60.0), at(15.0, 0.0)), (1.0, 1.0, 0.5));
}

#[test]
fn a_case_that_names_the_model_alone_has_its_defaults() {
    use serde::Deserialize as _;
    use serde::de::value::{Error, MapDeserializer};
    let empty = MapDeserializer::<_, Error>::new(std::iter::empty::<(&str, bool)>());
    let read = ThreeSeat::deserialize(empty).expect("no key is needed");
    assert!(read.film_force && !read.gravity);
    let (a, b) = (built(&read), built(&ThreeSeat::default()));
    assert_eq!(a.decision_interval(), b.decision_interval());
}

#[test]
fn the_seat_is_remembered() {
    let mut m = built(&ThreeSeat::default());
    assert_eq!(seat(&mut *m, &AxialForces { gas: 5.0, ..AxialForces::default() }), 1.0);
    let mut saved = Vec::new();
    m.save(&mut saved);
    m.initial(&mut []);
    assert_eq!(m.decided(), [0.0]);
    assert_eq!((m.restore(&saved), m.decided()), (1, &[1.0][..]));
    assert_eq!(m.reads(), Signals::PRESSURE | Signals::FILM_FORCE);
    let alone = built(&ThreeSeat { film_force: false, ..ThreeSeat::default() });
    assert_eq!(alone.reads(), Signals::PRESSURE);
}
