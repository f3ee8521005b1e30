//! Friction with a Stribeck branch.

use gudgeon_core::kinds::FlankFrictionSpec;
use gudgeon_core::quantity::quantity;
use gudgeon_ring::TanhStribeck;
use gudgeon_ring::parts::tanh_stribeck::{SERIES, stribeck};

use super::check_derivative;

#[test]
fn tabulated_values() {
    let m = TanhStribeck { coefficient: quantity(1.0), ..TanhStribeck::default() }.build().expect("builds");
    assert_eq!(m.force(0.0, 1.0), 0.0);
    // Known with two decimals.
    for (v, f) in [(0.01, 1.57), (0.02, 1.65), (0.05, 1.18), (0.2, 1.00)] {
        assert!((m.force(v, 1.0) - f).abs() < 0.0051, "{v} {}", m.force(v, 1.0));
        assert_eq!(m.force(-v, 2.0), -m.force(v, 2.0));
    }
    let peak = (0..1000).map(|i| m.force(1e-4 * f64::from(i), 1.0)).fold(0.0, f64::max);
    // tanh(1.5) (1 + 0.75 (coth 0.5 - 1)) = 1.6954 bounds the maximum from below; it lies close by and is flat.
    assert!((1.6953..1.6970).contains(&peak), "{peak}");
}

#[test]
fn slope_is_the_derivative() {
    let m = TanhStribeck::default().build().expect("builds");
    check_derivative(m.as_ref(), 0.01);
    assert!(m.derivative(0.05, 1.0) < 0.0, "the falling branch");
}

#[test]
fn series_meets_the_closed_form() {
    let below = stribeck(SERIES * (1.0 - 1e-12));
    let above = stribeck(SERIES);
    // Cancellation in coth z - z/sinh² z at z = 0.01: 100 times the rounding of 100.
    assert!((below.0 - above.0).abs() < 1e-12 && (below.1 - above.1).abs() < 1e-11);
}
