//! Viscosity under pressure: what the models share.

pub mod barus;
pub mod off;
pub mod roelands;

/// Where the exponential ends: 1e13 times the viscosity is a glass, not an oil.
const MOST: f64 = 30.0;
/// Where it ends for tension, which no oil of a film sees.
const LEAST: f64 = -5.0;

/// `exp(x)` and its derivative, with tangents in place of overflow: a straight line above [`MOST`], a hyperbola below [`LEAST`].
#[inline]
fn tame_exp(x: f64) -> (f64, f64) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_is_continued_with_its_slope() {
        for joint in [MOST, LEAST] {
            let (l, r) = (tame_exp(joint.next_down()), tame_exp(joint.next_up()));
            // One ulp of the argument 30 is 4e-15.
            assert!((l.0 / r.0 - 1.0).abs() < 1e-14 && (l.1 / r.1 - 1.0).abs() < 1e-14);
        }
        for x in [-1e300, -5.0, 0.0, 40.0, 1e300] {
            let (f, s) = tame_exp(x);
            assert!(f > 0.0 && f.is_finite() && s >= 0.0 && s.is_finite(), "{x}");
        }
    }
}
