//! The periodic monotone cubic.

use std::f64::consts::TAU;

use gudgeon_kinematics::{PeriodicCubic, TooClose};

fn sampled(n: usize, f: impl Fn(f64) -> f64) -> PeriodicCubic {
    let x: Vec<f64> = (0..n).map(|i| TAU * i as f64 / n as f64).collect();
    let y: Vec<f64> = x.iter().map(|&x| f(x)).collect();
    PeriodicCubic::new(&x, &y, TAU).expect("distinct")
}

#[test]
fn passes_through_the_points_in_every_period() {
    let x = [-1.0, 0.5, 0.6, 2.0, 4.9];
    let y = [3.0, 1.0, 1.5, 1.5, -2.0];
    let c = PeriodicCubic::new(&x, &y, TAU).expect("distinct");
    for (x, y) in x.iter().zip(y) {
        for turn in [-3.0, 0.0, 1.0, 1000.0] {
            // Reducing 1000 turns costs 1000 ulp of 2π, 1e-12; the steepest chord is 5 per radian.
            assert!((c.value(x + turn * TAU) - y).abs() < 2e-11, "{x} {turn}");
        }
    }
}

#[test]
fn never_overshoots() {
    // A step, a plateau and a spike on uneven abscissae.
    let x = [0.0, 0.1, 1.0, 1.01, 2.0, 4.0, 4.5, 6.0];
    let y = [1.0, 1.0, 1.0, 9.0, 9.0, 2.0, 30.0, 2.0];
    let c = PeriodicCubic::new(&x, &y, TAU).expect("distinct");
    for i in 0..x.len() {
        let (a, b) = (x[i], if i + 1 < x.len() { x[i + 1] } else { TAU });
        let (ya, yb) = (y[i], y[(i + 1) % y.len()]);
        for k in 0..=200 {
            let v = c.value(a + (b - a) * f64::from(k) / 200.0);
            // Rounding of the cubic in units of the largest value.
            assert!(v >= ya.min(yb) - 1e-13 && v <= ya.max(yb) + 1e-13, "segment {i}: {v}");
        }
    }
}

#[test]
fn is_continuously_differentiable() {
    let x = [0.0, 0.3, 1.0, 2.2, 2.5, 5.0];
    let y = [1.0, 2.0, 2.5, 7.0, 1.0, 0.5];
    let c = PeriodicCubic::new(&x, &y, TAU).expect("distinct");
    for x in x.iter().map(|x| x + TAU) {
        let h = 1e-6;
        let (l, r) = ((c.value(x) - c.value(x - h)) / h, (c.value(x + h) - c.value(x)) / h);
        // Second derivatives up to 300 times h, and rounding 1e-15/h.
        assert!((l - r).abs() < 1e-3, "{x}: {l} {r}");
    }
}

#[test]
fn converges_with_the_stated_order() {
    // sin on a monotone stretch and everywhere: orders 3 and 2.
    let error = |n: usize, from: f64, to: f64| {
        let c = sampled(n, f64::sin);
        (0..5000)
            .map(|i| from + (to - from) * f64::from(i) / 5000.0)
            .fold(0.0_f64, |w, x| w.max((c.value(x) - x.sin()).abs()))
    };
    let inner = (error(128, -1.0, 1.0) / error(256, -1.0, 1.0)).log2();
    let all = (error(128, 0.0, TAU) / error(256, 0.0, TAU)).log2();
    assert!((inner - 3.0).abs() < 0.5, "{inner}");
    assert!((all - 2.0).abs() < 0.3, "{all}");
}

#[test]
fn a_constant_and_a_pair_of_points() {
    assert_eq!(sampled(4, |_| 7.0).value(1.234), 7.0);
    let c = PeriodicCubic::new(&[1.0, 2.0], &[0.0, 1.0], 2.0).expect("distinct");
    assert_eq!((c.value(1.0), c.value(2.0), c.value(1.5)), (0.0, 1.0, 0.5));
}

#[test]
fn finds_the_segment_in_clustered_data() {
    // 1000 points within 1e-3 of each other and a few far away: the guide alone would be useless.
    let mut x: Vec<f64> = (0..1000).map(|i| 3.0 + 1e-6 * f64::from(i)).collect();
    x.insert(0, 0.0);
    x.push(6.0);
    let y: Vec<f64> = x.iter().map(|x| 10.0 + x).collect();
    let c = PeriodicCubic::new(&x, &y, TAU).expect("distinct");
    for x in &x {
        assert!((c.value(*x) - (10.0 + x)).abs() < 1e-13);
    }
}

#[test]
fn refuses_points_that_coincide() {
    assert_eq!(PeriodicCubic::new(&[0.0, 1.0, 1.0], &[1.0, 2.0, 3.0], TAU).err(), Some(TooClose(2)));
    // Distinct as numbers, but not after the shift to the origin.
    let tiny = PeriodicCubic::new(&[1e9, 1e9 + 1e-7], &[1.0, 2.0], 1e-7).err();
    assert!(tiny.is_some());
}
