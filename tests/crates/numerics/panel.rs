//! The polynomial through the samples of a step.

use gudgeon_numerics::panel::{LOBATTO, SIMPSON, TRAPEZIUM};

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
    for rule in [LOBATTO, SIMPSON, TRAPEZIUM] {
        let n = rule.nodes.len();
        let mut highest = 0.0_f64;
        for bits in 0..1_u32 << n {
            let v: Vec<f64> = (0..n).map(|k| f64::from((bits >> k) & 1)).collect();
            let top = (0..=2000).map(|k| rule.value(&v, f64::from(k) / 2000.0)).fold(f64::MIN, f64::max);
            assert!(top <= 1.0 + rule.overshoot, "{n} {bits}: {top}");
            highest = highest.max(top - 1.0);
        }
        // No wider than it need be: what was rounded up, to two digits.
        assert!(rule.overshoot - highest < 5e-3, "{n}: {highest}");
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

#[test]
fn rules_are_consistent() {
    for rule in [LOBATTO, TRAPEZIUM] {
        // Rounding of five weights.
        assert!((rule.weights.iter().sum::<f64>() - 1.0).abs() < 4e-16);
        assert!(rule.nodes.windows(2).all(|w| w[0] < w[1]) && rule.nodes[0] == 0.0);
        assert_eq!(rule.nodes[rule.nodes.len() - 1], 1.0);
        // At a node the value is that of the node, not of a quotient by zero.
        let v: Vec<f64> = (0..rule.nodes.len()).map(|k| (k * k) as f64 - 1.0).collect();
        for (x, v_k) in rule.nodes.iter().zip(&v) {
            assert_eq!(rule.value(&v, *x), *v_k);
        }
    }
}

#[test]
fn extremes_and_crossings_of_straight_lines() {
    let down = [3.0, 1.0];
    let mut seen = Vec::new();
    TRAPEZIUM.crossings(&down, 1.5, |x, up| seen.push((x, up)));
    // Halved to the rounding of a sixteenth.
    assert!(seen.len() == 1 && (seen[0].0 - 0.75).abs() < 1e-15 && !seen[0].1, "{seen:?}");
    for level in [0.9, 1.0, 3.0, 3.1] {
        let mut count = 0;
        TRAPEZIUM.crossings(&down, level, |_, _| count += 1);
        // A level that is reached and not passed is crossed where the line comes from above it.
        assert_eq!(count, usize::from(level == 1.0), "{level}");
    }
    let mut count = 0;
    TRAPEZIUM.crossings(&[1.0, 3.0], 3.0, |_, _| count += 1);
    assert_eq!(count, 0);
    // An extreme must lie beyond the bound, not on it.
    assert_eq!(TRAPEZIUM.maximum(&down, 3.0), None);
    assert_eq!(TRAPEZIUM.maximum(&down, 2.9), Some((0.0, 3.0)));
    assert_eq!(TRAPEZIUM.minimum(&down, 1.0), None);
    assert_eq!(TRAPEZIUM.minimum(&down, 1.1), Some((1.0, 1.0)));
    assert_eq!(
        (TRAPEZIUM.fall(&down), TRAPEZIUM.fall(&[1.0, 1.0]), TRAPEZIUM.fall(&[1.0, 3.0])),
        (2.0, 0.0, 0.0)
    );
}

#[test]
fn rises_and_falls_differ_by_the_change() {
    // Polynomials of degree 4 with turning points at a, b and c: what falls less what rises is the fall from end to end.
    for (a, b, c) in
        [(0.1, 0.4, 0.85), (0.3, 0.5, 0.7), (-0.2, 0.6, 0.9), (0.25, 1.4, 1.7), (0.15, 0.45, 1.2)]
    {
        let p = |x: f64| {
            let (s, d, q) = (a + b + c, a * b + b * c + c * a, a * b * c);
            x.powi(4) / 4.0 - s * x.powi(3) / 3.0 + d * x * x / 2.0 - q * x
        };
        let v = sampled(p);
        let turned: Vec<f64> = v.iter().map(|v| -v).collect();
        let (fall, rise) = (LOBATTO.fall(&v), LOBATTO.fall(&turned));
        assert!((fall - rise - (p(0.0) - p(1.0))).abs() < 1e-14, "{a} {b} {c}");
        let mut points = vec![0.0, 1.0];
        points.extend([a, b, c].iter().filter(|x| (0.0..1.0).contains(*x)));
        points.sort_by(f64::total_cmp);
        let exact: f64 = points.windows(2).map(|w| (p(w[0]) - p(w[1])).max(0.0)).sum();
        // Turning values to rounding.
        assert!((fall - exact).abs() < 1e-14, "{a} {b} {c}: {fall} {exact}");
        let top = points.iter().fold(f64::MIN, |m, x| m.max(p(*x)));
        let (at, found) = LOBATTO.maximum(&v, f64::NEG_INFINITY).unwrap();
        assert!(
            (found - top).abs() < 1e-15 && (p(at) - top).abs() < 1e-14,
            "{a} {b} {c}: {at} {found} {top}"
        );
        let bottom = points.iter().fold(f64::MAX, |m, x| m.min(p(*x)));
        let (at, found) = LOBATTO.minimum(&v, f64::INFINITY).unwrap();
        assert!((found - bottom).abs() < 1e-15 && (p(at) - bottom).abs() < 1e-14, "{a} {b} {c}");
    }
}

#[test]
fn monotone_samples_are_taken_by_their_ends() {
    // The polynomials through these turn between the samples.
    assert_eq!(LOBATTO.fall(&[0.0, 0.0, 0.0, 0.0, 1.0]), 0.0);
    assert_eq!(LOBATTO.fall(&[1.0, 0.0, 0.0, 0.0, 0.0]), 1.0);
    assert!(LOBATTO.fall(&[0.0, 0.0, 1.0, 0.0, 0.0]) > 1.0);
}

#[test]
fn three_samples_are_exact_for_the_integral_of_a_cubic_and_through_a_parabola() {
    let at = |f: &dyn Fn(f64) -> f64| SIMPSON.nodes.iter().map(|x| f(*x)).collect::<Vec<_>>();
    for degree in 0..=3 {
        let v = at(&|x| x.powi(degree));
        // Three products of numbers up to one.
        assert!((SIMPSON.mean(&v) - 1.0 / f64::from(degree + 1)).abs() < 1e-15, "{degree}");
    }
    let parabola = |x: f64| 1.0 + x * (3.0 - 4.0 * x);
    let v = at(&parabola);
    for x in [0.0, 0.1, 0.5, 0.77, 1.0] {
        // As above, over differences of a tenth.
        assert!((SIMPSON.value(&v, x) - parabola(x)).abs() < 1e-14, "{x}");
    }
    let (x, top) = SIMPSON.maximum(&v, 0.0).expect("above");
    // A quotient of differences of a tenth; the top is flat there.
    assert!((x - 0.375).abs() < 1e-14 && (top - 1.5625).abs() < 1e-14, "{x} {top}");
    assert_eq!(SIMPSON.maximum(&v, 1.6), None);
    // Up to the top and down from there; upside down the way up is what falls. Rounding as above.
    assert!((SIMPSON.fall(&v) - 1.5625).abs() < 1e-14);
    let down: Vec<f64> = v.iter().map(|v| -v).collect();
    assert!((SIMPSON.fall(&down) - 0.5625).abs() < 1e-14);
    assert!(SIMPSON.minimum(&down, 0.0).is_some_and(|(at, low)| at == x && low == -top));
    // One that turns before the step, a straight line, and what stands still.
    assert_eq!(SIMPSON.maximum(&[3.0, 2.0, 0.0], 0.0), Some((0.0, 3.0)));
    assert_eq!(SIMPSON.maximum(&[1.0, 2.0, 3.0], 0.0), Some((1.0, 3.0)));
    assert_eq!(SIMPSON.minimum(&[1.0, 2.0, 3.0], 2.0), Some((0.0, 1.0)));
    assert_eq!((SIMPSON.fall(&[2.0; 3]), SIMPSON.fall(&[1.0, 2.0, 3.0])), (0.0, 0.0));
    assert!(SIMPSON.maximum(&[2.0; 3], 1.0).is_some_and(|(_, top)| top == 2.0));
}
