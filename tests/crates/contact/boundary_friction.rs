//! Friction of solid contact against sliding speed, load and real area.

use gudgeon_contact::{
    AsperityIntegralFormula, Coulomb, Frictionless, GreenwoodTripp, ShearStrength, Stribeck,
};
use gudgeon_core::kinds::{BoundaryFriction, BoundaryFrictionSpec, ContactSpec, Rubbing};
use gudgeon_core::quantity::quantity;

/// Nominal pressure of the contact \[Pa\], and its real over nominal area: 200 MPa on the summits.
const PRESSED: (f64, f64) = (1e6, 0.005);

fn at<'a>(speed: &'a [f64], pressure: &'a [f64], real_area: &'a [f64]) -> Rubbing<'a> {
    Rubbing { speed, pressure, real_area }
}

/// Coefficient and slope at one speed.
fn friction(m: &dyn BoundaryFriction, speed: f64) -> (f64, f64) {
    let (mut c, mut s) = ([f64::NAN], [f64::NAN]);
    m.coefficient(&at(&[speed], &[PRESSED.0], &[PRESSED.1]), &mut c, &mut s).expect("finite");
    assert_eq!(m.of_body(speed, PRESSED.0, PRESSED.1), Ok(c[0]));
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
    for (v, p, a) in [(f64::NAN, 1.0, 0.0), (1.0, f64::INFINITY, 0.0), (1.0, 1.0, f64::NAN)] {
        assert!(m.coefficient(&at(&[v], &[p], &[a]), &mut c, &mut s).is_err_and(|e| e.is_recoverable()));
    }
    let two = at(&[0.0, 0.0], &[0.0, 0.0], &[0.0, 0.0]);
    assert!(m.coefficient(&two, &mut c, &mut s).is_err_and(|e| !e.is_recoverable()));
    let unequal = at(&[0.0], &[0.0], &[0.0, 0.0]);
    assert!(m.coefficient(&unequal, &mut c, &mut s).is_err_and(|e| !e.is_recoverable()));
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
    assert!(
        m.coefficient(&at(&[f64::NAN], &[0.0], &[0.0]), &mut c, &mut s).is_err_and(|e| e.is_recoverable())
    );
    assert!(m.coefficient(&at(&[0.0], &[0.0], &[0.0]), &mut [], &mut s).is_err_and(|e| !e.is_recoverable()));
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

fn layer(strength: f64, pressure_coefficient: f64) -> Box<dyn BoundaryFriction> {
    ShearStrength {
        strength: quantity(strength),
        pressure_coefficient: quantity(pressure_coefficient),
        rounding_speed: quantity(0.01),
    }
    .build()
    .expect("builds")
}

#[test]
fn strength_over_the_real_area_and_a_part_of_the_load() {
    let m = layer(2e6, 0.08);
    odd_with_its_slope(&*m, 0.01);
    // tau = 2 MPa * 0.005 + 0.08 * 1 MPa = 90 kPa under 1 MPa; 1 - v_0²/(2 v²) at 100 m/s is 5e-9 less.
    assert!((friction(&*m, 100.0).0 - 0.09).abs() < 1e-9);
    // Nothing pressed together rubs with nothing, whatever the coefficient.
    assert!(m.of_body(1.0, 0.0, 0.0).is_ok_and(f64::is_finite));
    assert!(m.of_body(1.0, f64::MIN_POSITIVE, 1.0).is_ok_and(f64::is_finite));
    assert!(m.uses_real_area() && !m.is_off());
}

/// Without a strength of its own the layer is dry friction, and needs no area; without both it is none.
#[test]
fn the_limits_are_dry_friction_and_none() {
    let m = layer(0.0, 0.10);
    assert!(!m.uses_real_area());
    for v in [-3.0, -0.01, 0.0, 0.02, 15.0] {
        assert_eq!(friction(&*m, v), friction(&*coulomb(0.01), v));
    }
    assert!(layer(0.0, 0.0).is_off());
}

/// Of Greenwood and Tripp's surfaces, whose mean pressure on the summits is `p A/A_c = (16 √2/(15 π)) √(σ/β) E' F_5/2/F_2`: the strength adds
/// `τ_0 A_c/(A p)`, which falls as the surfaces approach.
#[test]
fn adds_the_strength_over_the_pressure_on_the_summits() {
    let contact = GreenwoodTripp {
        roughness: quantity(0.3e-6),
        composite_modulus: quantity(115e9),
        eta_beta_sigma: Some(quantity(0.05)),
        sigma_over_beta: Some(quantity(1e-3)),
        asperity_density: None,
        asperity_radius: None,
        integral: AsperityIntegralFormula::Exact,
        friction_coefficient: quantity(0.1),
    }
    .build()
    .expect("builds");
    let m = layer(2e6, 0.08);
    let mut last = f64::INFINITY;
    for lambda in [3.0, 2.0, 1.0, 0.5] {
        let (mut p, mut a) = ([0.0], [0.0]);
        contact.pressure(&[lambda * 0.3e-6], &mut p);
        assert!(contact.real_area(&[lambda * 0.3e-6], &mut a));
        let summit = 16.0 * std::f64::consts::SQRT_2 / (15.0 * std::f64::consts::PI)
            * 1e-3_f64.sqrt()
            * 115e9
            * gudgeon_contact::f_5_2(lambda)
            / gudgeon_contact::f_2(lambda);
        let added = m.of_body(1e6, p[0], a[0]).expect("finite") - 0.08;
        // Two evaluations of the same integrals; the difference of coefficients loses two digits.
        assert!((added / (2e6 / summit) - 1.0).abs() < 1e-9, "{lambda}: {added}");
        assert!(added < last);
        last = added;
    }
}
