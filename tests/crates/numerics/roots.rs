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

#[test]
fn the_first_root_is_found_whatever_the_guess() {
    // Rises through 1, falls through 2, rises through 3.
    let f = |x: f64| (x - 1.0) * (x - 2.0) * (x - 3.0);
    let known = Known { from: 0.0, guess: 0.0, slope: 0.0, reach: 0.3, tol: 1e-10 };
    for (from, root) in [(0.0, 1.0), (1.9, 1.0), (2.1, 3.0), (5.0, 3.0)] {
        let found = first_root(ok(f), Known { from, guess: 17.0, ..known }).unwrap();
        // The last step of the search is below the tolerance.
        assert!((found.x - root).abs() < 1e-9, "{from}: {found:?}");
    }
    // A guess with a slope leads to the root beside it, in few evaluations, the last of them at the answer.
    let (mut evaluations, mut last) = (0, f64::NAN);
    let counted = |x: f64| {
        (evaluations, last) = (evaluations + 1, x);
        Ok::<_, Infallible>(f(x))
    };
    let found = first_root(counted, Known { guess: 3.01, slope: 2.0, ..known }).unwrap();
    assert!((found.x - 3.0).abs() < 1e-9 && found.x == last && evaluations <= 5, "{found:?} {evaluations}");
    // A corner, a step and a function without a root.
    let corner = first_root(ok(|x: f64| if x < 1.0 { x - 1.0 } else { 1e9 * (x - 1.0) }), known).unwrap();
    assert!((corner.x - 1.0).abs() < 1e-9, "{corner:?}");
    let step = first_root(ok(|x: f64| if x < 1.0 { -1.0 } else { 1.0 }), known).unwrap();
    assert!((step.x - 1.0).abs() < 1e-9, "{step:?}");
    assert!(matches!(first_root(ok(|_| -1.0), known), Err(RootError::NoConvergence { .. })));
    assert!(matches!(first_root(|_| Err::<f64, _>("no"), known), Err(RootError::Function("no"))));
}
