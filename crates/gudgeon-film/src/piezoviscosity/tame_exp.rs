//! The exponential function without overflow.

use gudgeon_numerics::elementary;

/// Where the exponential ends: 1e13 times the viscosity is a glass, not an oil.
pub const MAX_EXPONENT: f64 = 30.0;
/// Where it ends for tension, which no oil of a film sees.
pub const MIN_EXPONENT: f64 = -5.0;

/// `exp(x)` and its derivative, with tangents in place of overflow: a straight line above [`MAX_EXPONENT`], a hyperbola below [`MIN_EXPONENT`].
#[inline]
pub fn tame_exp(x: f64) -> (f64, f64) {
    if x > MAX_EXPONENT {
        let top = elementary::exp(MAX_EXPONENT);
        // The bound keeps a product with a viscosity finite.
        (top * (1.0 + (x - MAX_EXPONENT).min(1e250)), top)
    } else if x < MIN_EXPONENT {
        // The bound keeps the inverse a number.
        let (low, inverse) = (elementary::exp(MIN_EXPONENT), 1.0 / (1.0 + MIN_EXPONENT - x.max(-1e250)));
        (low * inverse, low * inverse * inverse)
    } else {
        let e = elementary::exp(x);
        (e, e)
    }
}
