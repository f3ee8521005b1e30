//! Curves through the ordinates of a skirt.

use gudgeon_core::kinds::{ProfileCurve, ProfileCurveSpec};

use gudgeon_pin::{Lagrange, Linear, MonotoneCubic};

/// The nodes of the published run \[mm, um\] (Reimer 1984).
const X: [f64; 5] = [0.0, 9.0, 18.0, 29.52, 33.84];
const Y: [f64; 5] = [-20.0, 0.0, 0.0, -60.44, -120.88];

fn curves() -> [Box<dyn ProfileCurve>; 3] {
    let specs: [&dyn ProfileCurveSpec; 3] = [&Lagrange {}, &MonotoneCubic {}, &Linear {}];
    specs.map(|s| s.build(&X, &Y).expect("builds"))
}

/// The printed table (Reimer 1984), digits that the reproduction garbled repaired; 6 digits, the last row 5.
#[test]
fn the_polynomial_is_the_published_table() {
    let printed = [
        -20.0, -13.4731, -8.32267, -4.29325, -1.2138, 1.00212, 2.3564, 2.76638, 2.06484, 0.0, -3.76447,
        -9.64947, -18.1604, -29.8874, -45.5048, -65.7719, -91.5323, -123.714, -163.33,
    ];
    let [lagrange, ..] = curves();
    for (k, p) in printed.into_iter().enumerate() {
        let y = lagrange.value(2.0 * k as f64);
        let half_digit =
            if k == 18 { 5e-3 } else { 0.5 * 10f64.powi(f64::log10(f64::abs(p).max(1.0)) as i32 - 5) };
        assert!((y - p).abs() <= half_digit * 1.0001, "{k}: {y} {p}");
    }
}

#[test]
fn every_curve_meets_its_nodes_and_two_keep_the_shape() {
    for c in &curves() {
        for (x, y) in X.iter().zip(Y) {
            assert!((c.value(*x) - y).abs() < 1e-13 * 120.0, "rounding of products of node distances");
        }
    }
    let [lagrange, monotone, linear] = curves();
    // Between the two nodes at zero the polynomial stands proud of the piston, the others do not.
    assert!(lagrange.value(14.0) > 2.7);
    for k in 0..=360 {
        let x = 0.1 * f64::from(k);
        assert!(monotone.value(x) <= 0.0 && linear.value(x) <= 0.0, "{x}");
    }
    // Beyond the last node both go on straight, with the slope of the end.
    let slope = |c: &dyn ProfileCurve| (c.value(40.0) - c.value(36.0)) / 4.0;
    assert!((slope(&*linear) + 60.44 / 4.32).abs() < 1e-12);
    assert!(slope(&*monotone) < 0.0);
}

#[test]
fn points_without_a_curve_are_refused() {
    for (x, y) in [
        (vec![0.0], vec![1.0]),
        (vec![0.0, 1.0], vec![1.0]),
        (vec![0.0, 0.0], vec![1.0, 2.0]),
        (vec![0.0, f64::NAN], vec![1.0, 2.0]),
    ] {
        assert!(Lagrange {}.build(&x, &y).is_err() && Linear {}.build(&x, &y).is_err());
        assert!(MonotoneCubic {}.build(&x, &y).is_err());
    }
}

/// Straight between neighbours and beyond the ends; the polynomial is that of its degree; the cubic goes on with its own slope.
#[test]
fn curves_between_and_beyond_their_nodes() {
    let [lagrange, monotone, linear] = curves();
    for (at, want) in [(4.5, -10.0), (-9.0, -40.0), (23.76, -30.22), (33.84 + 4.32, -181.32), (13.0, 0.0)] {
        // Rounding of numbers of order a hundred.
        assert!((linear.value(at) - want).abs() < 1e-12, "{at}: {}", linear.value(at));
    }
    // Four points of a parabola: the polynomial through them is the parabola, wherever it is asked.
    let x = [0.0, 1.0, 2.5, 4.0];
    let parabola = |x: f64| 3.0 - 2.0 * x + 0.5 * x * x;
    let c = Lagrange {}.build(&x, &x.map(parabola)).expect("builds");
    for at in [-1.0, 0.3, 3.0, 6.0] {
        assert!((c.value(at) - parabola(at)).abs() < 1e-13);
    }
    assert!(lagrange.value(9.0).abs() < 1e-13);
    // Continuous with its slope at both ends, straight beyond.
    for (end, out) in [(0.0, -1.0), (33.84, 1.0)] {
        let h = 1e-6;
        let inside = (monotone.value(end) - monotone.value(end - out * h)) / (out * h);
        let outside = (monotone.value(end + 3.0 * out) - monotone.value(end)) / (3.0 * out);
        // One-sided differences: half the curvature, of order one, times h.
        assert!((inside - outside).abs() < 1e-5, "{end}: {inside} {outside}");
        let further = (monotone.value(end + 9.0 * out) - monotone.value(end)) / (9.0 * out);
        assert!((further - outside).abs() < 1e-12);
    }
}

#[test]
fn a_polynomial_has_at_most_twelve_points() {
    let of = |n: u32| {
        let x: Vec<f64> = (0..n).map(f64::from).collect();
        Lagrange {}.build(&x, &x).is_ok()
    };
    assert!(of(12) && !of(13));
}
