//! The film of a ring at the end of a step of a published scheme.

use gudgeon_core::EvalError;
use gudgeon_numerics::roots::{RootError, itp};

/// First stride of the walk to a bracket, over the film before; how far it goes beyond where a secant points, and how much longer it becomes at least and at most: where a
/// load fades out secants point next to where they are, for ever.
const FIRST: f64 = 1e-3;
const BEYOND: f64 = 1.1;
const LONGER: (f64, f64) = (2.0, 8.0);

/// Film thickness \[m\] between `floor` and `most` at which `excess`, what film and contact carry more than the ring asks for, falls through zero: `floor` where it is
/// not above zero there, `most` where it is still above zero there; known to `within`.
///
/// The sources halve the whole interval, thirty times and more. This walks from the film `old` at the start of the step until the sign changes, and looks
/// between: some ten evaluations for the same film.
///
/// # Errors
/// Those of `excess`; fatal where it is no number.
pub fn closing_film(
    excess: impl FnMut(f64) -> Result<f64, EvalError>,
    (floor, most): (f64, f64),
    old: f64,
    within: f64,
) -> Result<f64, EvalError> {
    let mut excess = numbers(excess);
    let (mut last, mut stride) = (old.max(floor).min(most), FIRST * old.max(within / FIRST));
    let mut before = excess(last)?;
    let end = if before > 0.0 { most } else { floor };
    loop {
        if last == end {
            return Ok(end);
        }
        let next = if end > last { (last + stride).min(end) } else { (last - stride).max(end) };
        let now = excess(next)?;
        if (now > 0.0) != (before > 0.0) {
            break between(excess, (last.min(next), last.max(next)), within);
        }
        let newton = BEYOND * (now * (next - last) / (now - before)).abs();
        let (least, longest) = (LONGER.0 * stride, LONGER.1 * stride);
        stride = if newton.is_finite() { newton.clamp(least, longest) } else { longest };
        (last, before) = (next, now);
    }
}

/// A function that refuses to be no number.
fn numbers(mut f: impl FnMut(f64) -> Result<f64, EvalError>) -> impl FnMut(f64) -> Result<f64, EvalError> {
    move |h| match f(h)? {
        x if x.is_nan() => Err(EvalError::fatal("film", format!("no load is known of a film of {h:e} m"))),
        x => Ok(x),
    }
}

/// The root in a bracket.
fn between(
    excess: impl FnMut(f64) -> Result<f64, EvalError>,
    (low, high): (f64, f64),
    within: f64,
) -> Result<f64, EvalError> {
    let root = itp(excess, low, high, within).map_err(|e| match e {
        RootError::Function(e) => e,
        e => EvalError::fatal("film", format!("no film carries the load of the ring: {e}")),
    })?;
    Ok(root.x)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The film of a load that falls with the square of the thickness, and the evaluations that it took.
    fn film(root: f64, (floor, most): (f64, f64), old: f64) -> (f64, u32) {
        let mut count = 0;
        let excess = |h: f64| {
            count += 1;
            Ok(1e-12 / (h * h) - 1e-12 / (root * root))
        };
        (closing_film(excess, (floor, most), old, 1e-13).unwrap(), count)
    }

    #[test]
    fn a_film_is_found_from_near_and_from_far() {
        for (old, most_evaluations) in [(1e-6, 8), (0.97e-6, 14), (1.1e-6, 14), (2e-8, 40), (5e-5, 40)] {
            let (h, count) = film(1e-6, (1e-8, 6e-5), old);
            // The interval in which it is known to lie.
            assert!((h - 1e-6).abs() <= 1e-13, "{h:e} from {old:e}");
            // Bisection takes 31 from anywhere.
            assert!(count <= most_evaluations, "{count} evaluations from {old:e}");
        }
    }

    /// Doubled strides are through sixty micrometres after sixteen.
    #[test]
    fn a_load_that_fades_out_ends_the_walk_soon() {
        let mut count = 0;
        let excess = |h: f64| {
            count += 1;
            Ok((-h / 1e-7).exp())
        };
        let h = closing_film(excess, (1e-8, 6e-5), 1e-6, 1e-13).unwrap();
        assert!(h == 6e-5 && count <= 18, "{h:e} after {count}");
    }

    #[test]
    fn a_film_beyond_an_end_is_that_end() {
        assert_eq!(film(1e-9, (1e-8, 6e-5), 1e-6).0, 1e-8);
        assert_eq!(film(1e-3, (1e-8, 6e-5), 1e-6).0, 6e-5);
    }
}
