//! Quadrature rules: degrees of exactness, adaptive integrals.

use gudgeon_numerics::quadrature::{GaussLegendre, QuadratureError, integrate_adaptive};

#[test]
fn gauss_is_exact_to_its_degree() {
    for n in 1..=64 {
        let rule = GaussLegendre::new(n);
        // ∫_0^1 x^d dx = 1/(d+1). Up to 16 nodes rounding of the terms; beyond, the weights near the ends lose
        // 1/(1-x²), about n²/6.
        let bound = if n <= 16 { 1e-14 } else { (n * n) as f64 * f64::EPSILON };
        for d in [0, 1, n, 2 * n - 1] {
            let v = rule.integrate(0.0, 1.0, |x| x.powi(d as i32));
            assert!((v * (d + 1) as f64 - 1.0).abs() < bound, "{n} {d} {v}");
        }
        assert!(rule.nodes().windows(2).all(|w| w[0] < w[1]));
    }
    // Not exact one degree beyond: the error of the 2-point rule for x^4 on [-1, 1] is 2/5 - 2/9.
    let v = GaussLegendre::new(2).integrate(-1.0, 1.0, |x| x.powi(4));
    assert!((v - 2.0 / 9.0).abs() < 1e-15);
}

#[test]
fn kronrod_nodes_are_exact_to_degree_22() {
    for d in 0..=22 {
        // Any error is small enough: the rule of 15 points on the whole interval.
        let v = integrate_adaptive(|x| x.powi(d), 0.0, 1.0, f64::INFINITY, 0.0).unwrap();
        // 15 terms, rounded constants.
        assert!((v * f64::from(d + 1) - 1.0).abs() < 1e-14, "{d} {v}");
    }
}

#[test]
fn adaptive_handles_peaks_and_end_singularities() {
    let v = integrate_adaptive(|x| 1.0 / (1e-4 + x * x), -1.0, 1.0, 0.0, 1e-12).unwrap();
    assert!((v / (200.0 * 100f64.atan()) - 1.0).abs() < 1e-11);
    // The square root at 0 costs bisections only.
    let v = integrate_adaptive(f64::sqrt, 0.0, 1.0, 0.0, 1e-11).unwrap();
    assert!((v - 2.0 / 3.0).abs() < 1e-10);
    assert!(integrate_adaptive(|_| f64::NAN, 0.0, 1.0, 0.0, 1e-9).is_err());
    assert!(integrate_adaptive(|x| 1.0 / x, -1.0, 1.0, 0.0, 1e-9).is_err());
}

#[test]
fn integrands_without_a_value_are_named_by_their_place() {
    let nan = integrate_adaptive(|_| f64::NAN, 0.5, 2.0, 0.0, 1e-9);
    assert_eq!(nan, Err(QuadratureError::NotFinite { x: 1.25 }));
    let late = integrate_adaptive(|x| if x > 1.9 { f64::INFINITY } else { x.sqrt() }, 0.0, 2.0, 0.0, 1e-9);
    assert_eq!(late, Err(QuadratureError::NotFinite { x: 1.0 }));
    // A function that no polynomial fits: the best value, and how far it is off.
    let rough = integrate_adaptive(|x| (1e9 * x * x).sin().signum(), 0.0, 1.0, 0.0, 1e-14);
    assert!(matches!(rough, Err(QuadratureError::NoConvergence { error, .. }) if error > 0.0), "{rough:?}");
    // Tolerances may be absolute, and need not be both.
    let loose = integrate_adaptive(|x| (50.0 * x).sin().abs(), 0.0, 1.0, 0.5, 0.0).unwrap();
    let tight = integrate_adaptive(|x| (50.0 * x).sin().abs(), 0.0, 1.0, 1e-8, 0.0).unwrap();
    // 15 full half waves of area 2/50, and what is left of the next.
    let exact = (15.0 * 2.0 + 1.0 - (50.0 - 15.0 * std::f64::consts::PI).cos()) / 50.0;
    assert!(
        (tight - exact).abs() < 1e-8 && (loose - exact).abs() < 0.5 && loose != tight,
        "{loose} {tight} {exact}"
    );
}
