//! Crests of machining grooves.

use gudgeon_contact::{CrestWedge, composite_modulus};
use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::quantity;

/// Deflection of a crest over its line load over E', as printed.
const PUBLISHED: f64 = 1.077;

fn skirt() -> Box<dyn Contact> {
    let spec = CrestWedge {
        amplitude: quantity(4e-6),
        pitch: quantity(0.25e-3),
        composite_modulus: quantity(44.52e9),
        deflection: quantity(PUBLISHED),
        friction_coefficient: quantity(0.15),
    };
    spec.build().expect("builds")
}

fn pressure(m: &dyn Contact, h: f64) -> f64 {
    let mut p = [f64::NAN];
    m.pressure(&[h], &mut p);
    p[0]
}

#[test]
fn line_load_of_a_crest() {
    let m = skirt();
    // 1 µm of 44.52 GPa over 1.077; three roundings, and that of Ω - h.
    assert!((pressure(&*m, 3e-6) * 0.25e-3 / (44.52e3 / 1.077) - 1.0).abs() < 1e-14);
    assert_eq!((pressure(&*m, 4e-6), pressure(&*m, 1.0), m.range(), m.floor()), (0.0, 0.0, 4e-6, None));
    // Linear on, through overlapping mean planes.
    assert!((pressure(&*m, -4e-6) / pressure(&*m, 0.0) - 2.0).abs() < 1e-15);
}

#[test]
fn mean_gap_of_triangular_waves() {
    let m = skirt();
    // Half the waves are above their mean: (Ω/2)/2 is left where the mean planes touch; nothing where crests fill the troughs.
    for (h, gap) in [(0.0, 1e-6), (-2e-6, 0.25e-6), (-4e-6, 0.0), (-5e-6, 0.0), (4e-6, 4e-6), (7e-6, 7e-6)] {
        assert!((m.mean_gap(h) - gap).abs() < 1e-20, "{h}: {}", m.mean_gap(h));
    }
}

#[test]
fn published_modulus_and_constant() {
    // Aluminium skirt 68.6 GPa, 0.34 on a cast iron block 98.0 GPa, 0.25: printed 44.52 GPa, cut after the fourth digit.
    assert!((composite_modulus([68.6e9, 98.0e9], [0.34, 0.25]) / 1e9 - 44.527).abs() < 0.0005);
    // -(2/π²) ∫_0^1 ln s ln{[1+√(1-s²)]/[1-√(1-s²)]} ds = 1.0779, the integral 5.3192: with s = 1/cosh t it is (4/π²) ∫ t ln cosh t sinh t/cosh² t dt,
    // by the trapezoidal rule on a function that is even in t and falls as t² exp(-t).
    let f = |t: f64| t * t.cosh().ln() * t.sinh() / (t.cosh() * t.cosh());
    let step = 1.0 / 64.0;
    let sum: f64 = (1..64 * 60).map(|i| step * f(step * f64::from(i))).sum();
    let exact = 4.0 / (std::f64::consts::PI * std::f64::consts::PI) * sum;
    assert!((0.5 * std::f64::consts::PI.powi(2) * exact - 5.3192).abs() < 5e-5, "{exact}");
    // The published 1.077 is that, cut.
    assert!((PUBLISHED / exact - 1.0).abs() < 1e-3);
}

#[test]
fn skirt_touching_at_its_lower_end() {
    // Loureiro's skirt: radius 38.24 mm, half angle 0.6213, height 30.3 mm, clearance 10 µm, eccentricities -1 µm on top and -6.2 µm
    // below; grooves down to 30.25 mm. A static point of another implementation, twenty steps in angle by the trapezoidal rule:
    // 230.65 N and, at 0.15, a friction of 34.763 N from five crests.
    let m = skirt();
    let (radius, half_angle, height, pitch) = (0.03824, 0.6213, 0.0303, 0.25e-3);
    let (mut force, mut friction, mut crests) = (0.0, 0.0, 0);
    for k in 0..=121 {
        let e = -1.0 - 5.2 * pitch * f64::from(k) / height;
        let mut touched = false;
        for i in 0..=20 {
            let angle = half_angle * (f64::from(i) / 10.0 - 1.0);
            let weight = if i == 0 || i == 20 { 0.05 } else { 0.1 } * half_angle;
            let line = pitch * pressure(&*m, (10.0 + e * angle.cos()) * 1e-6);
            touched |= line > 0.0;
            force += radius * weight * line * angle.cos();
            friction += radius * weight * line * m.friction_coefficient();
        }
        crests += i32::from(touched);
    }
    // Half a unit of the last digit printed.
    assert!((force - 230.65).abs() < 0.005 && (friction - 34.763).abs() < 0.0005, "{force} {friction}");
    assert_eq!(crests, 5);
}

/// A stiffness, or a pressure at full approach, that no normal number holds is refused.
#[test]
fn crests_without_a_pressure_are_refused() {
    let of = |amplitude: f64, modulus: f64| {
        let spec = CrestWedge {
            amplitude: quantity(amplitude),
            pitch: quantity(0.25e-3),
            composite_modulus: quantity(modulus),
            deflection: quantity(PUBLISHED),
            friction_coefficient: quantity(0.15),
        };
        spec.build().is_ok()
    };
    assert!(of(4e-6, 44.52e9) && of(4e-6, 1e-280));
    assert!(!of(4e-6, 1e-320) && !of(1e-323, 44.52e9) && !of(4e-300, 1e-20));
}
