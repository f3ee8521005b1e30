//! Roots: accuracy, evaluations, refusals.

use gudgeon_numerics::roots::{Known, RootError, first_root, itp, newton_bracketed};
use std::convert::Infallible;

fn ok(f: impl Fn(f64) -> f64) -> impl Fn(f64) -> Result<f64, Infallible> {
    move |x| Ok(f(x))
}

#[test]
fn itp_finds_roots_within_its_bound() {
    // Functions with their roots: smooth, flat, steep, discontinuous.
    type Case = (fn(f64) -> f64, f64, f64, f64);
    let cases: [Case; 5] = [
        (|x| x * x - 2.0, 0.0, 2.0, 2f64.sqrt()),
        (|x| (x - 1.0).powi(9), 0.0, 3.0, 1.0),
        (|x| (1.0 - x).atan() * 1e8, -1e3, 4.0, 1.0),
        (|x| if x < 0.3 { -1.0 } else { 1.0 }, 0.0, 1.0, 0.3),
        (|x| x.exp() - 1e-8, -100.0, 100.0, -18.420_680_743_952_367),
    ];
    for (f, lo, hi, root) in cases {
        let r = itp(ok(f), lo, hi, 1e-12).unwrap();
        // The 9th power is below the smallest resolvable sign change only within rounding of x - 1, so all are met.
        assert!((r.x - root).abs() <= 1.1e-12 + 4.0 * f64::EPSILON * root.abs(), "{r:?}");
        // Never more than one evaluation beyond bisection, the two ends, and one for rounding at the last halving.
        let bisection = ((hi - lo) / 1e-12).log2().ceil();
        assert!(f64::from(r.evaluations) <= bisection + 4.0, "{r:?}");
        assert!(f(r.x) == 0.0 || (f(r.x) > 0.0) == (f(hi) > 0.0), "the end beyond the crossing");
    }
    // Superlinear on a smooth function: far fewer than the 41 halvings.
    assert!(itp(ok(|x| x * x - 2.0), 0.0, 2.0, 1e-12).unwrap().evaluations <= 12);
    assert!(matches!(itp(ok(|x| x * x + 1.0), 0.0, 2.0, 1e-12), Err(RootError::NoBracket { .. })));
    assert!(matches!(itp(ok(|_| f64::NAN), 0.0, 2.0, 1e-12), Err(RootError::NotANumber { .. })));
    assert!(matches!(itp(|_| Err::<f64, _>("no"), 0.0, 2.0, 1e-12), Err(RootError::Function("no"))));
}

#[test]
fn newton_is_fast_from_a_good_start_and_safe_from_a_bad_one() {
    let f = |x: f64| Ok::<_, Infallible>((x * x * x - 2.0, 3.0 * x * x));
    let root = 2f64.cbrt();
    let r = newton_bracketed(f, 0.0, 10.0, 1.26, 1e-9).unwrap();
    // One quadratic step from 1e-4, then the step that confirms it.
    assert!((r.x - root).abs() < 1e-15 && r.evaluations <= 3, "{r:?}");
    for x0 in [0.0, 1e-9, 10.0, 5.0, -3.0] {
        let r = newton_bracketed(f, 0.0, 10.0, x0, 1e-12).unwrap();
        assert!((r.x - root).abs() < 1e-12, "{x0} {r:?}");
    }
    // arctan: Newton alone diverges from |x| > 1.39.
    let r =
        newton_bracketed(|x| Ok::<_, Infallible>((x.atan(), 1.0 / (1.0 + x * x))), -50.0, 40.0, 30.0, 1e-12);
    assert!(r.unwrap().x.abs() < 1e-12);
    let none = newton_bracketed(|x| Ok::<_, Infallible>((x * x + 1.0, 2.0 * x)), -1.0, 2.0, 0.5, 1e-12);
    assert!(matches!(none, Err(RootError::NoBracket { .. })), "{none:?}");
}

/// A function that tells nothing of its derivative.
fn silent(f: impl Fn(f64) -> f64) -> impl Fn(f64) -> Result<(f64, f64), Infallible> {
    move |x| Ok((f(x), 0.0))
}

#[test]
fn the_first_root_is_found_whatever_the_guess() {
    // Rises through 1, falls through 2, rises through 3.
    let f = |x: f64| (x - 1.0) * (x - 2.0) * (x - 3.0);
    let known = Known { from: 0.0, guess: 0.0, rest: None, reach: 0.3, tol: 1e-10 };
    for (from, root) in [(0.0, 1.0), (1.9, 1.0), (2.1, 3.0), (5.0, 3.0)] {
        let found = first_root(silent(f), Known { from, guess: 17.0, ..known }).unwrap();
        // The last step of the search is below the tolerance.
        assert!((found.x - root).abs() < 1e-9, "{from}: {found:?}");
    }
    // A corner, a step and a function without a root.
    let corner = first_root(silent(|x: f64| if x < 1.0 { x - 1.0 } else { 1e9 * (x - 1.0) }), known).unwrap();
    assert!((corner.x - 1.0).abs() < 1e-9, "{corner:?}");
    let step = first_root(silent(|x: f64| if x < 1.0 { -1.0 } else { 1.0 }), known).unwrap();
    assert!((step.x - 1.0).abs() < 1e-9, "{step:?}");
    assert!(matches!(first_root(silent(|_| -1.0), known), Err(RootError::NoConvergence { .. })));
    assert!(matches!(first_root(|_| Err::<_, _>("no"), known), Err(RootError::Function("no"))));
}

#[test]
fn a_guess_and_what_is_known_of_the_derivative_save_evaluations() {
    // Most of the derivative belongs to a term that it is told of.
    let (fast, slow) = (|x: f64| 8.0 * x.exp(), |x: f64| x * x);
    let asked = |known: Known, told: f64| {
        let (mut evaluations, mut last) = (0, f64::NAN);
        let f = |x: f64| {
            (evaluations, last) = (evaluations + 1, x);
            Ok::<_, Infallible>((fast(x) + slow(x) - 9.0, told * fast(x)))
        };
        let found = first_root(f, known).unwrap();
        // What the function left behind belongs to the root, and the root is one step nearer.
        assert!((found.x - last).abs() <= known.tol && (fast(found.x) + slow(found.x) - 9.0).abs() < 1e-8);
        (found, evaluations)
    };
    let known = Known { from: 0.0, guess: 0.3, rest: None, reach: 1.0, tol: 1e-6 };
    let (cold, of_cold) = asked(known, 1.0);
    // The rest is 2 x. Secants over a hundredth tell it to the square of that.
    let (found, _) = asked(Known { guess: cold.x + 1e-2, rest: Some(0.0), ..known }, 1.0);
    let rest = found.rest.unwrap();
    assert!((rest - 2.0 * found.x).abs() < 1e-2, "{found:?}");
    let near = Known { guess: found.x + 1e-3, rest: Some(rest), ..known };
    // A step by the derivative leaves 1e-6 of 1e-3, which the second one goes without a look.
    let (_, told) = asked(near, 1.0);
    assert_eq!(told, 2);
    // At the root, one look is enough.
    assert_eq!(asked(Known { guess: found.x, ..near }, 1.0).1, 1);
    // Untold, what was left of the derivative is a third off a tenth away: secants find it, but look once more.
    let away = Known { guess: found.x + 0.2, ..near };
    let (_, of_told) = asked(away, 1.0);
    let (_, of_silent) = asked(Known { rest: Some(rest + fast(found.x)), ..away }, 0.0);
    assert!(of_told < of_silent && of_silent <= of_cold, "{of_told} {of_silent} {of_cold}");
}
