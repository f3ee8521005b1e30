//! Interpolation: orders, monotonicity, refusals.

use gudgeon_numerics::table::{Pchip, PeriodicCubic, TableError};
use std::f64::consts::TAU;

fn grid(n: usize, stretch: f64) -> Vec<f64> {
    (0..n)
        .map(|i| {
            let u = i as f64 / n as f64;
            TAU * (u + stretch * (TAU * u).sin() / TAU)
        })
        .collect()
}

#[test]
fn periodic_spline_is_fourth_order_and_wraps() {
    for stretch in [0.0, 0.4] {
        let error = |n: usize| {
            let x = grid(n, stretch);
            let y = x.iter().map(|x| x.sin().exp()).collect();
            let s = PeriodicCubic::new(x, y, TAU).unwrap();
            (0..1000)
                .map(|k| -7.0 + 0.02 * f64::from(k))
                .map(|t| (s.value(t) - t.sin().exp()).abs())
                .fold(0.0, f64::max)
        };
        let order = (error(40) / error(80)).log2();
        // Fourth order; a stretched grid samples its largest error at different places.
        assert!((3.6..4.6).contains(&order), "{order}");
    }
    // Two rows: the spline through +1, -1 is symmetric and exact at the nodes.
    let s = PeriodicCubic::new(vec![0.0, 1.0], vec![1.0, -1.0], 2.0).unwrap();
    assert_eq!((s.value(0.0), s.value(1.0), s.value(3.0)), (1.0, -1.0, -1.0));
    // By symmetry zero half way, within rounding.
    assert!(s.value(0.5).abs() < 1e-15 && s.value(-0.5).abs() < 1e-15);
}

#[test]
fn derivative_is_that_of_the_value() {
    let x = grid(17, 0.3);
    let y: Vec<f64> = x.iter().map(|x| x.cos() + 0.3 * (2.0 * x).sin()).collect();
    let s = PeriodicCubic::new(x.clone(), y.clone(), TAU).unwrap();
    let p = Pchip::periodic(x, y, TAU).unwrap();
    for k in 0..100 {
        let t = 0.0601 * f64::from(k);
        let h = 1e-5;
        let near = |f: &dyn Fn(f64) -> f64| (f(t + h) - f(t - h)) / (2.0 * h);
        // Central difference of a cubic: h² times its third derivative (below 100), or the kink of Pchip's second
        // derivative within h of a node (below 100 h).
        assert!((s.eval(t).1 - near(&|t| s.value(t))).abs() < 1e-6);
        assert!((p.eval(t).1 - near(&|t| p.value(t))).abs() < 1e-3);
    }
}

#[test]
fn monotone_data_gives_a_monotone_interpolant() {
    // The RPN 14 data of Fritsch & Carlson 1980 (radiochemical calculations): a spline overshoots here.
    let x = vec![7.99, 8.09, 8.19, 8.7, 9.2, 10.0, 12.0, 15.0, 20.0];
    let y = vec![0.0, 2.76429e-5, 4.37498e-2, 0.169183, 0.469428, 0.943740, 0.998636, 0.999919, 0.999994];
    let p = Pchip::new(x, y).unwrap();
    let mut last = -1.0;
    let mut hint = 0;
    for k in 0..=13_000 {
        let t = 7.5 + 0.001 * f64::from(k);
        let (v, d) = p.eval_near(t, &mut hint);
        assert_eq!((v, d), p.eval(t));
        assert!(v >= last && d >= 0.0 && (0.0..=0.999994).contains(&v), "{t} {v} {d}");
        last = v;
    }
    assert!(p.contains(8.0) && !p.contains(7.5));
}

#[test]
fn straight_lines_are_reproduced_and_uniform_look_up_is_exact_at_nodes() {
    let x: Vec<f64> = (0..1000).map(|i| 0.1 * f64::from(i)).collect();
    let y: Vec<f64> = x.iter().map(|x| 3.0 - 2.0 * x).collect();
    let p = Pchip::new(x.clone(), y.clone()).unwrap();
    for (x, y) in x.iter().zip(&y) {
        assert_eq!(p.value(*x), *y);
        // Rounding of the table's abscissae times the slope.
        assert!((p.value(x + 0.03) - (y - 0.06)).abs() < 1e-12 || *x > 99.8);
    }
}

#[test]
fn bad_tables_are_refused() {
    let nan = f64::NAN;
    assert!(matches!(Pchip::new(vec![], vec![]), Err(TableError::TooShort { .. })));
    assert!(matches!(Pchip::new(vec![0.0], vec![0.0]), Err(TableError::TooShort { .. })));
    assert!(matches!(Pchip::new(vec![0.0, 1.0], vec![0.0]), Err(TableError::Lengths { .. })));
    assert!(matches!(Pchip::new(vec![0.0, nan], vec![0.0, 1.0]), Err(TableError::NotFinite { row: 2 })));
    let repeated = Pchip::new(vec![0.0, 1.0, 1.0], vec![0.0; 3]);
    assert!(matches!(repeated, Err(TableError::NotIncreasing { row: 3, .. })));
    for period in [1.0, 0.5, nan] {
        let p = PeriodicCubic::new(vec![0.0, 1.0], vec![0.0; 2], period);
        assert!(matches!(p, Err(TableError::Period { .. })));
    }
}

#[test]
fn end_values_are_held_with_derivative_zero_beyond() {
    // Unequal intervals; y = (x + 1)², whose derivative the three-point formula at the ends knows exactly.
    let x = vec![0.0, 0.5, 2.0, 3.0];
    let y: Vec<f64> = x.iter().map(|x| (x + 1.0) * (x + 1.0)).collect();
    let p = Pchip::new(x, y).unwrap();
    for (at, value, derivative) in [(-1.0, 1.0, 0.0), (0.0, 1.0, 2.0), (3.0, 16.0, 8.0), (4.0, 16.0, 0.0)] {
        let (v, d) = p.eval(at);
        // Rounding of secants up to 8.
        assert!(v == value && (d - derivative).abs() < 1e-14, "{at}: {v} {d}");
    }
    assert!(p.contains(0.0) && p.contains(3.0) && !p.contains(-1e-9) && !p.contains(3.0 + 1e-9));
    assert!(!p.contains(f64::NAN) && p.value(f64::NAN).is_nan());
    // Inner derivatives: the harmonic mean of 2.5 and 4.5 over intervals of 0.5 and 1.5, weights (2·1.5 + 0.5), (1.5 + 2·0.5).
    let d = p.eval(0.5).1;
    assert!((d - 6.0 / (3.5 / 2.5 + 2.5 / 4.5)).abs() < 1e-14, "{d}");
}

#[test]
fn ends_stay_monotone() {
    // The three-point formula would turn round before the first node, or overshoot beyond it.
    let flat = Pchip::new(vec![0.0, 1.0, 2.0], vec![0.0, 0.1, 1.0]).unwrap();
    assert_eq!(flat.eval(0.0).1, 0.0);
    // Secants 1 and -10: the formula gives 6.5, limited to three times the secant.
    let steep = Pchip::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, -9.0]).unwrap();
    assert_eq!(steep.eval(0.0).1, 3.0);
    // Secants 1 and -2: the formula gives 2.5, within the limit.
    let mild = Pchip::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, -1.0]).unwrap();
    assert_eq!(mild.eval(0.0).1, 2.5);
    // An extremum of the data is one of the curve.
    assert_eq!(
        (mild.eval(1.0), Pchip::new(vec![0.0, 2.0], vec![1.0, 5.0]).unwrap().eval(0.5).1),
        ((1.0, 0.0), 2.0)
    );
}

#[test]
fn hints_change_the_way_and_not_the_result() {
    for stretch in [0.0, 0.5] {
        let x = grid(23, stretch);
        let y: Vec<f64> = x.iter().map(|x| x.sin() + 0.2 * (3.0 * x).cos()).collect();
        let tables = (
            Pchip::new(x.clone(), y.clone()).unwrap(),
            Pchip::periodic(x.clone(), y.clone(), TAU).unwrap(),
            PeriodicCubic::new(x.clone(), y.clone(), TAU).unwrap(),
        );
        for k in 0..400 {
            let t = -1.0 + 0.021 * f64::from(k);
            for hint in [0, 1, 11, 21, 22, 500] {
                let mut h = hint;
                assert_eq!(tables.0.eval_near(t, &mut h), tables.0.eval(t));
                h = hint;
                assert_eq!(tables.1.eval_near(t, &mut h), tables.1.eval(t));
                h = hint;
                assert_eq!(tables.2.eval_near(t, &mut h), tables.2.eval(t));
                // The interval that was found is the one of the argument.
                let wrapped = t.rem_euclid(TAU);
                assert!(h < 23 && x[h] <= wrapped && (h == 22 || wrapped < x[h + 1]), "{t} {h}");
            }
        }
        // At the nodes the value is that of the table.
        for (x, y) in x.iter().zip(&y) {
            assert_eq!((tables.0.value(*x), tables.1.value(*x), tables.2.value(*x)), (*y, *y, *y));
        }
        assert!(tables.1.contains(1e9) && !tables.1.contains(f64::INFINITY));
    }
}
