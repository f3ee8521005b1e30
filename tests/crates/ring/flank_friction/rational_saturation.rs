//! Friction that saturates.

use gudgeon_core::kinds::FlankFrictionSpec;
use gudgeon_ring::RationalSaturation;

use super::check_derivative;

#[test]
fn published_values() {
    let m = RationalSaturation::default().build().expect("builds");
    for (v, f) in [(1e-5, 4.9505e-4), (1e-4, 4.5455e-3), (1e-3, 0.025), (0.1, 0.049505)] {
        // Five printed digits: half a unit of the last is at most 1.1e-5 of the value; rounding aside, the published form to the bit.
        assert!((m.force(v, 1.0) / f - 1.0).abs() < 1.1e-5);
        assert!((m.force(v, 1.0) - v / (20.0 * v + 0.020)).abs() < 1e-17);
        assert_eq!(m.force(-v, 3.0), -m.force(v, 3.0));
    }
}

#[test]
fn slope_is_the_derivative_and_never_negative() {
    let m = RationalSaturation::default().build().expect("builds");
    check_derivative(m.as_ref(), 1e-3);
    for v in [-1.0, -1e-3, 0.0, 1e-5, 1.0] {
        assert!(m.derivative(v, 1e3) > 0.0);
    }
}
