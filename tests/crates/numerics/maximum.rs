//! Maxima of sampled functions against closed forms.

use gudgeon_numerics::maximum::maximise;

/// Amplitude of one inertia on a spring, `1/√((1 - r²)² + (2 ζ r)²)`: maximum `1/(2 ζ √(1 - ζ²))` at `r = √(1 - 2 ζ²)`.
fn resonance(zeta: f64) -> impl Fn(f64) -> f64 {
    move |r| 1.0 / (1.0 - r * r).hypot(2.0 * zeta * r)
}

#[test]
fn the_top_of_a_resonance_is_found_to_its_closed_form() {
    for zeta in [0.3, 0.05, 1e-3, 1e-5] {
        let f = resonance(zeta);
        // Samples far from the top, and the natural frequency with places beside it.
        let mut at: Vec<f64> = (0..=20).map(|i| 0.2 + 0.08 * f64::from(i)).collect();
        at.extend([-2.0, -0.5, 0.0, 0.5, 2.0].map(|k| 1.0 + k * zeta));
        at.sort_by(f64::total_cmp);
        let samples: Vec<(f64, f64)> = at.iter().map(|r| (*r, f(*r))).collect();
        let mut calls = 0;
        let (r, top) = maximise(&samples, |x| {
            calls += 1;
            f(x)
        });
        let exact = 0.5 / (zeta * (1.0 - zeta * zeta).sqrt());
        // The value is flat at the top: 1e-7 of the distance of the samples, squared, and the rounding of the formula.
        assert!((top / exact - 1.0).abs() < 1e-10, "{zeta}: {top} {exact}");
        // Of the width ζ of the resonance: the cubic part of the curve over the thousandth that the parabola spans.
        assert!((r - (1.0 - 2.0 * zeta * zeta).sqrt()).abs() < 1e-4 * zeta, "{zeta}: {r}");
        assert!(calls < 60, "{calls}");
    }
}

#[test]
fn ends_and_flat_functions_are_their_own_tops() {
    let ramp: Vec<(f64, f64)> = (0..5).map(|i| (f64::from(i), f64::from(i))).collect();
    assert_eq!(maximise(&ramp, |x| x), (4.0, 4.0));
    let flat: Vec<(f64, f64)> = (0..5).map(|i| (f64::from(i), 1.0)).collect();
    assert_eq!(maximise(&flat, |_| 1.0).1, 1.0);
    assert_eq!(maximise(&[(2.0, 3.0)], |_| 9.0), (2.0, 3.0));
    assert_eq!(maximise(&[], |x| x).1, f64::NEG_INFINITY);
    // A top between the end and the sample beside it.
    let f = |x: f64| 1.0 - (x - 0.2) * (x - 0.2);
    let samples: Vec<(f64, f64)> = (0..3).map(|i| (f64::from(i), f(f64::from(i)))).collect();
    let (x, top) = maximise(&samples, f);
    assert!((x - 0.2).abs() < 1e-9 && top > 1.0 - 1e-15, "{x} {top}");
}

#[test]
fn places_are_better_than_values_show_them() {
    // Values of 1 - (x - c)² are the same within 1e-8 of the top; the parabola through points 1e-3 of the range away knows the place to the
    // rounding of the values over that distance, 1e-13.
    for c in [0.2, 0.37, 0.5, 0.81] {
        let f = |x: f64| 1.0 - (x - c) * (x - c);
        let samples: Vec<(f64, f64)> = [0.0, 0.5, 1.0].iter().map(|x| (*x, f(*x))).collect();
        let (x, top) = maximise(&samples, f);
        assert!((x - c).abs() < 1e-11 && (top - 1.0).abs() < 1e-15, "{c}: {x} {top}");
    }
}

#[test]
fn the_highest_of_several_tops_is_found() {
    // Tops 1 and 1.2 that the samples show as 0.98 and 0.95: both are looked at. One below 0.7 of the highest sample is not.
    let bump = |x: f64, c: f64, height: f64| height / (1.0 + 400.0 * (x - c) * (x - c));
    let f = |x: f64| bump(x, 0.3, 1.0) + bump(x, 0.7, 1.2) + bump(x, 1.5, 0.3);
    let samples: Vec<(f64, f64)> =
        [0.0, 0.1, 0.307, 0.5, 0.726, 0.9, 1.2, 1.5, 2.0].iter().map(|x| (*x, f(*x))).collect();
    let mut looked = Vec::new();
    let (x, top) = maximise(&samples, |x| {
        looked.push(x);
        f(x)
    });
    // The other bumps move the top by less than a thousandth.
    assert!((x - 0.7).abs() < 1e-3 && top > 1.2, "{x} {top}");
    assert!(looked.iter().any(|x| (0.25..0.35).contains(x)) && looked.iter().all(|x| *x < 1.0), "{looked:?}");
    // Samples that are one place, but for rounding, are taken as one.
    let twice: Vec<(f64, f64)> = samples.iter().flat_map(|s| [(s.0, s.1 - 1e-12), *s]).collect();
    let again = maximise(&twice, f);
    assert!((again.0 - x).abs() < 1e-9 && (again.1 - top).abs() < 1e-12, "{again:?} {x} {top}");
}
