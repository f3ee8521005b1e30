//! Methods of implicit stages, and what stands between the ends of their steps.

use gudgeon_numerics::ode::StepView;
use gudgeon_scene_piston_secondary::stages::formula::{ESDIRK3, Formula};
use gudgeon_scene_piston_secondary::stages::passed::Passed;

/// Sums of sixteen digits.
const ROUNDING: f64 = 1e-14;

/// Weights of the rates of a stage, its own among them.
fn weights(f: &Formula, stage: usize) -> Vec<f64> {
    f.a[stage].iter().copied().chain([f.diagonal]).collect()
}

/// `Σ b_j c_j^p` less that of an exact method.
fn missed(f: &Formula, weights: &[f64], p: i32) -> f64 {
    weights.iter().zip(f.c).map(|(b, c)| b * c.powi(p)).sum::<f64>() - 1.0 / f64::from(p + 1)
}

#[test]
fn order_conditions_hold() {
    let f = ESDIRK3;
    let end = f.c.len() - 1;
    for stage in 1..=end {
        assert!((weights(&f, stage).iter().sum::<f64>() - f.c[stage]).abs() < ROUNDING);
    }
    let own = weights(&f, end);
    for p in 0..3 {
        assert!(missed(&f, &own, p).abs() < ROUNDING, "moment {p}");
    }
    // What it is compared with is of order two: the difference goes with the cube of the step.
    assert!(missed(&f, f.compared, 1).abs() < ROUNDING);
    assert!(missed(&f, f.compared, 2).abs() > 1e-3);
    let apart = |p: i32| (0..=end).map(|j| f.difference(j) * f.c[j].powi(p)).sum::<f64>();
    assert!(apart(0).abs() < ROUNDING && apart(1).abs() < ROUNDING);
}

#[test]
fn stages_are_foreseen_along_polynomials() {
    // Rates 1 + c - c²: exact where two rates and a curvature, or three rates, are known.
    let rate = |c: f64| 1.0 + c - c * c;
    let before: Vec<Vec<f64>> = ESDIRK3.c[..3].iter().map(|c| vec![rate(*c)]).collect();
    let mut guess = [0.0];
    ESDIRK3.foresee(&before, &[0.0], 2.0, &mut guess);
    assert!((guess[0] - rate(1.0)).abs() < ROUNDING);
    ESDIRK3.foresee(&before[..1], &[0.5], 2.0, &mut guess);
    assert!((guess[0] - (1.0 + ESDIRK3.c[1])).abs() < ROUNDING);
}

#[test]
fn a_cubic_comes_back_between_the_ends_of_a_step() {
    let f = |t: f64| 1.0 + t * (2.0 - t * (3.0 - 0.5 * t));
    let (a, b, middle) = (0.3, 0.9, 0.6);
    let slope = 2.0 - b * (6.0 - 1.5 * b);
    let y = [f(a), f(a + middle * (b - a)), f(b), (b - a) * slope].map(|v| vec![v]);
    let passed = Passed { span: (a, b), middle, y };
    let mut y = [0.0];
    for k in 0..=4 {
        let t = a + (b - a) * f64::from(k) / 4.0;
        passed.interpolate(t, &mut y);
        assert!((y[0] - f(t)).abs() < ROUNDING, "{t}");
    }
}
