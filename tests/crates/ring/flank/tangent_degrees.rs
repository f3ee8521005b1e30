//! The tangent law with degrees.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{FlankCtx, FlankSpec};
use gudgeon_ring::TangentDegrees;

fn ctx(ring: usize, oil_fill: f64) -> FlankCtx {
    FlankCtx::new(ring, 3, oil_fill, 5e-3, 0.01)
}

fn d(oil_fill: f64, e: f64) -> f64 {
    let m = TangentDegrees::default().build(&ctx(0, oil_fill)).expect("builds").law();
    -m.force(&FlankOil::default(), e * 1e-4, 1.0, 1e-4, 1.0) / 1e7
}

#[test]
fn shape_at_tabulated_positions() {
    // Values of D(e) evaluated independently to six decimals.
    let e = [0.0, 0.05, 0.1, 0.2, 0.25, 0.3, 0.4, 0.5];
    let d6 = [1.065527, 0.563747, 0.293888, 0.070638, 0.030783, 0.011635, 0.000656, 0.0];
    let d9 = [1.015994, 0.866505, 0.736284, 0.515536, 0.418868, 0.328432, 0.160011, 0.0];
    for i in 0..e.len() {
        // Half a unit in the sixth decimal; s/c can be off by a unit in the last place.
        assert!((d(0.6, e[i]) - d6[i]).abs() < 5.1e-7, "{} {}", e[i], d(0.6, e[i]));
        assert!((d(0.9, e[i]) - d9[i]).abs() < 5.1e-7, "{} {}", e[i], d(0.9, e[i]));
    }
}

#[test]
fn symmetric_and_limited() {
    for k in 0..=200 {
        let e = k as f64 / 200.0;
        for f in [0.0, 0.3, 0.6, 0.9, 1.0] {
            // tan of an angle rounded to 1e-16 at exponent 10.
            assert!((d(f, e) - d(f, 1.0 - e)).abs() <= 1e-13 * d(f, e) + 1e-16);
            assert!(d(f, e).is_finite());
        }
    }
    // Beyond the flanks nothing grows; a groove filled with oil is uniform up to the tangent at the exponent zero.
    assert_eq!(d(0.6, -0.49), d(0.6, 0.0));
    assert_eq!(d(0.6, 7.0), d(0.6, 1.0));
    assert_eq!(d(1.0, 0.5), 1.0);
    let m = TangentDegrees::default().build(&ctx(2, 0.9)).expect("builds").law();
    assert!(
        (m.force(&FlankOil::default(), 0.0, 1.0, 1e-4, 1.0) + 2e7 * 1.015994).abs() < 2e7 * 5.1e-7,
        "last ring"
    );
    assert!(m.force(&FlankOil::default(), 0.0, 1.0, 0.0, 1.0).is_finite(), "no clearance");
}

#[test]
fn mean_over_the_groove() {
    // ∫D de = 0.159986 (f_o 0.6) and 0.446938 (0.9), evaluated independently; Simpson with 2000 panels per half is exact to 1e-9
    // for these smooth halves.
    for (f, expected) in [(0.6, 0.159986), (0.9, 0.446938)] {
        let n = 2000;
        let h = 0.5 / n as f64;
        let sum: f64 = (0..=n)
            .map(|k| {
                let w = if k == 0 || k == n {
                    1.0
                } else if k % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                w * d(f, k as f64 * h)
            })
            .sum();
        assert!((2.0 * sum * h / 3.0 - expected).abs() < 5.1e-7);
    }
}

/// Time for a ring to cross the groove under a constant force, `m s'' = F - A F_s D(s/c) s'`, from rest at the lower flank.
///
/// Integrated by the trapezoidal rule with Newton's method in `v`, time steps refined from the start where the acceleration is large.
fn traverse(ring: usize, fill: f64, force: f64, steps_per_estimate: f64) -> f64 {
    let m = TangentDegrees::default().build(&ctx(ring, fill)).expect("builds").law();
    let (mass, area, c) = (0.043, 1.8e-3, 1e-4);
    let a = |s: f64, v: f64| (force + m.force(&FlankOil::default(), s, v, c, area)) / mass;
    // Overdamped estimate of the time.
    let (mean, coefficient) = if fill == 0.6 { (0.159986, 1e7) } else { (0.446938, 2e7) };
    let estimate = area * coefficient * c / force * mean;
    let dt_max = estimate / steps_per_estimate;
    let (mut t, mut s, mut v) = (0.0, 0.0, 0.0);
    let mut dt: f64 = 1e-9;
    loop {
        let a0 = a(s, v);
        let mut w = v;
        for _ in 0..60 {
            let s1 = s + 0.5 * dt * (v + w);
            let g = |w: f64| w - v - 0.5 * dt * (a0 + a(s + 0.5 * dt * (v + w), w));
            let r = g(w);
            // The force is linear in v up to the small change of s with it.
            let slope = 1.0 - 0.5 * dt * (a(s1, 1.0) - a(s1, 0.0));
            let step = r / slope;
            w -= step;
            if step.abs() <= 1e-15 * (1.0 + w.abs()) {
                break;
            }
        }
        let s1 = s + 0.5 * dt * (v + w);
        if s1 >= c {
            return t + dt * (c - s) / (s1 - s);
        }
        (t, s, v) = (t + dt, s1, w);
        dt = (1.02 * dt).min(dt_max);
    }
}

#[test]
fn groove_traverse() {
    // A stiff solver gives these times for m = 43 g, A = 18 cm², c = 0.1 mm, five significant digits.
    let cases = [
        (0, 0.6, 90.0, 3.2020e-3),
        (0, 0.6, 500.0, 5.7821e-4),
        (0, 0.6, 2000.0, 1.4642e-4),
        (2, 0.9, 90.0, 1.78787e-2),
        (2, 0.9, 500.0, 3.21913e-3),
        (2, 0.9, 2000.0, 8.0567e-4),
    ];
    for (ring, fill, force, expected) in cases {
        let t = traverse(ring, fill, force, 20_000.0);
        // Half a unit of the last printed digit (up to 3.5e-5 relative).
        assert!((t / expected - 1.0).abs() < 3.5e-5, "{fill} {force}: {t:e} {expected:e}");
    }
}
