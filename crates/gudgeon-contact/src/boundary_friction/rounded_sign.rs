//! The sign of a speed, rounded at rest.

use gudgeon_numerics::elementary;

/// `v/√(v² + v_0²)` and its derivative `(v_0/√)²/√`; the sign of `v`, and zero, for `v_0 = 0`.
#[inline]
pub(super) fn rounded_sign(speed: f64, rounding: f64) -> (f64, f64) {
    let root = elementary::hypot(speed, rounding).min(f64::MAX);
    if root > 0.0 {
        let r = rounding / root;
        // Bounded for a rounding speed so small that the slope has no number.
        (speed / root, (r * r / root).min(f64::MAX))
    } else {
        (0.0, 0.0)
    }
}
