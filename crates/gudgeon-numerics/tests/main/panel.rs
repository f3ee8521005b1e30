//! The polynomial through the samples of a step.

use gudgeon_numerics::panel::{LOBATTO, OVERSHOOT, TRAPEZIUM};

fn sampled(f: impl Fn(f64) -> f64) -> Vec<f64> {
    LOBATTO.nodes.iter().map(|x| f(*x)).collect()
}

#[test]
fn integrates_degree_seven_and_interpolates_degree_four() {
    for degree in 0..=7 {
        let v = sampled(|x| x.powi(degree));
        // Rounding of five products of numbers below 1.
        assert!((LOBATTO.mean(&v) - 1.0 / f64::from(degree + 1)).abs() < 2e-15, "{degree}");
    }
    let p = |x: f64| 1.0 - 3.0 * x + x * x - 7.0 * x.powi(3) + 5.0 * x.powi(4);
    for k in 0..=100 {
        let x = f64::from(k) / 100.0;
        // Barycentric weights of the order of one: a few units of rounding of coefficients up to 7.
        assert!((LOBATTO.value(&sampled(p), x) - p(x)).abs() < 2e-14, "{x}");
    }
    assert_eq!(TRAPEZIUM.value(&[1.0, 3.0], 0.25), 1.5);
}

#[test]
fn extremes_lie_between_the_samples() {
    // Turns at 0.3 and 0.83, between nodes.
    let p = |x: f64| x * (3.0 * 0.3 * 0.83 - 1.5 * (0.3 + 0.83) * x + x * x);
    let v = sampled(p);
    let (x, top) = LOBATTO.maximum(&v, -1.0).expect("above");
    // A turning point is known to the root of the rounding of the value, the value to its rounding.
    assert!((x - 0.3).abs() < 1e-7 && (top - p(0.3)).abs() < 1e-15, "{x} {top}");
    let down: Vec<f64> = v.iter().map(|v| -v).collect();
    assert_eq!(LOBATTO.minimum(&down, 1.0), Some((x, -top)));
    // The end is lower than where it turns back up.
    assert_eq!(LOBATTO.minimum(&v, 1.0), Some((0.0, 0.0)));
    assert_eq!(LOBATTO.maximum(&v, top + 1e-9), None);
    assert_eq!(TRAPEZIUM.maximum(&[1.0, 4.0], 0.0), Some((1.0, 4.0)));
    assert_eq!(TRAPEZIUM.minimum(&[1.0, 4.0], 2.0), Some((0.0, 1.0)));
}

#[test]
fn the_bound_that_spares_the_search_holds() {
    // The worst samples for the overshoot: both signs of the Lebesgue function.
    for bits in 0..32_u32 {
        let v: Vec<f64> = (0..5).map(|k| f64::from((bits >> k) & 1)).collect();
        let top = (0..=2000).map(|k| LOBATTO.value(&v, f64::from(k) / 2000.0)).fold(f64::MIN, f64::max);
        assert!(top <= 1.0 + OVERSHOOT, "{bits}: {top}");
    }
}

#[test]
fn crossings_are_located_and_directed() {
    let p = |x: f64| (x - 0.2) * (x - 0.55) * (x - 0.9);
    let mut seen = Vec::new();
    LOBATTO.crossings(&sampled(p), 0.0, |x, up| seen.push((x, up)));
    assert_eq!(seen.iter().map(|s| s.1).collect::<Vec<_>>(), [true, false, true]);
    for ((x, _), root) in seen.iter().zip([0.2, 0.55, 0.9]) {
        // Rounding of the value, 1e-17, over its slope there, 0.1 or more.
        assert!((x - root).abs() < 1e-14, "{x}");
    }
    LOBATTO.crossings(&sampled(p), 1.0, |x, _| panic!("{x}"));
}

#[test]
fn falls_add_up() {
    let p = |x: f64| x * (3.0 * 0.3 * 0.83 - 1.5 * (0.3 + 0.83) * x + x * x);
    // Rounding of values below 1.
    assert!((LOBATTO.fall(&sampled(p)) - (p(0.3) - p(0.83))).abs() < 1e-15);
    assert_eq!(LOBATTO.fall(&sampled(|x| x)), 0.0);
    assert_eq!(TRAPEZIUM.fall(&[3.0, 1.0]), 2.0);
}
