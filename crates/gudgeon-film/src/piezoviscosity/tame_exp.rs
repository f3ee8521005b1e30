//! The exponential function without overflow.

/// Where the exponential ends: 1e13 times the viscosity is a glass, not an oil.
pub const MOST: f64 = 30.0;
/// Where it ends for tension, which no oil of a film sees.
pub const LEAST: f64 = -5.0;

/// `exp(x)` and its derivative, with tangents in place of overflow: a straight line above [`MOST`], a hyperbola below [`LEAST`].
#[inline]
pub fn tame_exp(x: f64) -> (f64, f64) {
    if x > MOST {
        let top = MOST.exp();
        // The bound keeps a product with a viscosity finite.
        (top * (1.0 + (x - MOST).min(1e250)), top)
    } else if x < LEAST {
        // The bound keeps the inverse a number.
        let (low, inverse) = (LEAST.exp(), 1.0 / (1.0 + LEAST - x.max(-1e250)));
        (low * inverse, low * inverse * inverse)
    } else {
        let e = x.exp();
        (e, e)
    }
}
