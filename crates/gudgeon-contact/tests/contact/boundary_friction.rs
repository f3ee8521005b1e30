//! Friction of solid contact against sliding speed.

use gudgeon_contact::{Coulomb, Frictionless, Stribeck};
use gudgeon_core::kinds::{BoundaryFriction, BoundaryFrictionSpec};
use gudgeon_core::quantity::quantity;

/// Coefficient and slope at one speed.
fn friction(m: &dyn BoundaryFriction, speed: f64) -> (f64, f64) {
    let (mut c, mut s) = ([f64::NAN], [f64::NAN]);
    m.coefficient(&[speed], &mut c, &mut s).expect("finite");
    (c[0], s[0])
}

/// Odd, of the sign of the speed, with the slope it says, finite at extremes, and errors for bad input.
fn odd_with_its_slope(m: &dyn BoundaryFriction, scale: f64) {
    for v in [1e-3, 0.03, 0.1, 0.4, 1.0, 3.0, 20.0].map(|v| v * scale) {
        let ((f, s), (g, t)) = (friction(m, v), friction(m, -v));
        assert!(f > 0.0 && f == -g && s == t, "{v}");
        let d = 1e-4 * v;
        let central = (friction(m, v + d).0 - friction(m, v - d).0) / (2.0 * d);
        // Truncation 1e-8 of the terms f/v and of the slope at rest, which cancel in part; rounding 1e-17/d.
        assert!((central - s).abs() < 1e-7 * (s.abs() + f / v) + 1e-16 / d, "{v}: {central} {s}");
    }
    for v in [f64::MAX, -1e200, 1e-300] {
        let (f, s) = friction(m, v);
        assert!(f.is_finite() && s.is_finite(), "{v}");
    }
    let (mut c, mut s) = ([0.0], [0.0]);
    assert!(m.coefficient(&[f64::NAN], &mut c, &mut s).is_err_and(|e| e.is_recoverable()));
    assert!(m.coefficient(&[0.0, 0.0], &mut c, &mut s).is_err_and(|e| !e.is_recoverable()));
}

fn coulomb(rounding: f64) -> Box<dyn BoundaryFriction> {
    Coulomb { friction_coefficient: quantity(0.10), rounding_speed: quantity(rounding) }
        .build()
        .expect("builds")
}

#[test]
fn constant_away_from_rest() {
    let m = coulomb(0.01);
    assert_eq!(friction(&*m, 0.0), (0.0, 10.0));
    // 1 - v_0²/(2 v²) at 10 m/s.
    assert!((friction(&*m, 10.0).0 - 0.1 * (1.0 - 0.5e-6)).abs() < 1e-12);
    // 1/√2 at v_0.
    assert!((friction(&*m, 0.01).0 - 0.1 * std::f64::consts::FRAC_1_SQRT_2).abs() < 1e-16);
    odd_with_its_slope(&*m, 0.01);
}

#[test]
fn a_bare_jump() {
    let m = coulomb(0.0);
    assert_eq!([-2.0, 0.0, 1e-300].map(|v| friction(&*m, v)), [(-0.1, 0.0), (0.0, 0.0), (0.1, 0.0)]);
}

fn stribeck(exponent: f64, rounding: f64) -> Stribeck {
    Stribeck {
        static_coefficient: quantity(0.15),
        kinetic_coefficient: quantity(0.10),
        stribeck_speed: quantity(0.1),
        exponent: quantity(exponent),
        rounding_speed: quantity(rounding),
    }
}

#[test]
fn from_static_to_kinetic() {
    for n in [1.0, 2.0, 3.5] {
        let bare = stribeck(n, 0.0).build().expect("builds");
        // 1/e of the way at the Stribeck speed, whatever the exponent.
        assert!((friction(&*bare, 0.1).0 - 0.1 - 0.05 / std::f64::consts::E).abs() < 1e-16);
        // exp(-1e-6) of the surplus at most is lost at 1e-7 m/s.
        assert!((friction(&*bare, 1e-7).0 - 0.15).abs() < 1e-7);
        assert_eq!(friction(&*bare, 1e300), (0.1, 0.0));
        assert_eq!(friction(&*bare, 0.0).0, 0.0);
        odd_with_its_slope(&*stribeck(n, 0.01).build().expect("builds"), 0.1);
    }
}

#[test]
fn refuses_a_corner() {
    assert_eq!(stribeck(0.5, 0.01).build().err().map(|e| e.field), Some("exponent".into()));
}

#[test]
fn no_friction_at_any_speed() {
    let m = Frictionless {}.build().expect("builds");
    assert!(m.is_off());
    assert_eq!([-1.0, 0.0, f64::MAX].map(|v| friction(&*m, v)), [(0.0, 0.0); 3]);
    let (mut c, mut s) = ([0.0], [0.0]);
    assert!(m.coefficient(&[f64::NAN], &mut c, &mut s).is_err_and(|e| e.is_recoverable()));
    assert!(m.coefficient(&[0.0], &mut [], &mut s).is_err_and(|e| !e.is_recoverable()));
    // A coefficient of zero is no friction either, any other is.
    let of = |mu: f64| Coulomb { friction_coefficient: quantity(mu), rounding_speed: quantity(0.01) };
    assert!(of(0.0).build().expect("builds").is_off() && !of(0.1).build().expect("builds").is_off());
    let falling = |statics: f64, kinetic: f64| {
        let (static_coefficient, kinetic_coefficient) = (quantity(statics), quantity(kinetic));
        Stribeck { static_coefficient, kinetic_coefficient, ..stribeck(1.0, 0.01) }
            .build()
            .expect("builds")
            .is_off()
    };
    assert!(falling(0.0, 0.0) && !falling(0.1, 0.0) && !falling(0.1, 0.1));
}
