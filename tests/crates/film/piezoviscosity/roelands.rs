//! Viscosity under pressure after Roelands.

use gudgeon_core::quantity::quantity;

use gudgeon_core::kinds::{Piezoviscosity, PiezoviscositySpec};
use gudgeon_film::Roelands;

/// Pressure of the law \[Pa\].
const P_R: f64 = 1.962e8;

fn at(m: &dyn Piezoviscosity, mu0: f64, p: f64) -> (f64, f64) {
    let (mut f, mut s) = ([0.0], [0.0]);
    m.factor(mu0, &[p], &mut f, &mut s).expect("in range");
    (f[0], s[0])
}

#[test]
fn worked_values() {
    let m = Roelands { exponent: Some(quantity(0.6)), pressure_viscosity: None }.build().expect("builds");
    // ln μ0 + 9.67 at 0.04 Pa s = 6.451124175; (2^0.6 - 1) at p = p_r: evaluated with 30 digits.
    assert_eq!(at(&*m, 0.04, 0.0).0, 1.0);
    let (f, _) = at(&*m, 0.04, P_R);
    // Rounding of an exponent of 3.3.
    assert!((f / 27.853_304_413_537_067 - 1.0).abs() < 4e-15, "{f}");
    // Isotherms meet: μ0 f -> 6.31e-5 where the exponent tends to -(ln μ0 + 9.67); all rise from there.
    assert!(at(&*m, 0.01, 1e8).0 < at(&*m, 0.1, 1e8).0);
}

#[test]
fn given_coefficient_is_the_slope_at_ambient() {
    let m = Roelands { exponent: None, pressure_viscosity: Some(quantity(1.8e-8)) }.build().expect("builds");
    for mu0 in [0.003, 0.02, 0.5] {
        // Three roundings.
        assert!((at(&*m, mu0, 0.0).1 / 1.8e-8 - 1.0).abs() < 1e-15);
    }
}

#[test]
fn slope_is_the_derivative() {
    let m = Roelands { exponent: Some(quantity(0.65)), pressure_viscosity: None }.build().expect("builds");
    // The last two on either side of the tangent, ln f = 30 near 1.5 GPa.
    for p in [-5e7, 0.0, 1e7, 3e8, 1e9, 3e9] {
        let d = 1e4;
        let central = (at(&*m, 0.05, p + d).0 - at(&*m, 0.05, p - d).0) / (2.0 * d);
        // Truncation (d f'/f)² ~ (2e-4)²/6, rounding 1e-16/(1e4 · 1e-8).
        assert!((central / at(&*m, 0.05, p).1 - 1.0).abs() < 1e-8, "{p}");
    }
}

#[test]
fn extremes() {
    let m = Roelands { exponent: Some(quantity(0.65)), pressure_viscosity: None }.build().expect("builds");
    for p in [1e12, 1e100, 1e307] {
        let (f, s) = at(&*m, 0.05, p);
        assert!(f.is_finite() && f > 0.0 && s.is_finite() && s >= 0.0, "{p}: {f} {s}");
    }
    let (mut f, mut s) = ([0.0], [0.0]);
    for (mu0, p) in
        [(1e-5, 0.0), (-1.0, 0.0), (f64::NAN, 0.0), (0.05, -2e8), (0.05, f64::NAN), (f64::INFINITY, 0.0)]
    {
        assert!(m.factor(mu0, &[p], &mut f, &mut s).is_err_and(|e| e.is_recoverable()), "{mu0} {p}");
    }
}

#[test]
fn one_description() {
    let neither = Roelands { exponent: None, pressure_viscosity: None };
    assert!(neither.build().is_err());
    let both = Roelands { exponent: Some(quantity(0.6)), pressure_viscosity: Some(quantity(2e-8)) };
    assert_eq!(both.build().err().map(|e| e.field), Some("pressure_viscosity".into()));
}
