use std::f64::consts::PI;

use gudgeon_study::sampling::{LatinHypercube, Morris, OneAtATime, Points, Saltelli};
use gudgeon_study::sensitivity::{
    Bootstrap, NoFigure, band, elementary_effects, main_effects, sobol_indices, tornado,
};

fn results(design: &dyn Points, f: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    (0..design.len()).map(|k| f(&design.point(k))).collect()
}

/// Ishigami and Homma 1990 with a = 7, b = 0.1, inputs uniform on -π to π.
fn ishigami(u: &[f64]) -> f64 {
    let x: Vec<f64> = u.iter().map(|u| PI * (2.0 * u - 1.0)).collect();
    x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
}

/// Its variance and the first and total indices, in closed form.
fn ishigami_indices() -> (f64, [[f64; 2]; 3]) {
    let (a, b) = (7.0_f64, 0.1);
    let v1 = 0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2);
    let v2 = a * a / 8.0;
    let v13 = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let v = v1 + v2 + v13;
    (v, [[v1 / v, (v1 + v13) / v], [v2 / v, v2 / v], [0.0, v13 / v]])
}

/// Sobol's g-function.
fn g(u: &[f64], a: &[f64]) -> f64 {
    u.iter().zip(a).map(|(u, a)| ((4.0 * u - 2.0).abs() + a) / (1.0 + a)).product()
}

const A: [f64; 4] = [0.0, 1.0, 4.5, 9.0];

fn g_indices() -> Vec<[f64; 2]> {
    let own = A.map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
    let all: f64 = own.iter().map(|v| 1.0 + v).product();
    own.iter().map(|v| [v / (all - 1.0), v * all / (1.0 + v) / (all - 1.0)]).collect()
}

/// Estimates lie at most `tolerance` away from what is exact, which lies within their intervals.
fn near(design: &Saltelli, y: &[f64], exact: &[[f64; 2]], tolerance: f64) {
    let found = sobol_indices(design, y, Bootstrap { resamples: 100, seed: 1 }).unwrap();
    for (own, exact) in found.inputs.iter().zip(exact) {
        for (estimate, exact) in [own.first, own.total].into_iter().zip(exact) {
            assert!((estimate.value - exact).abs() < tolerance, "{estimate:?}, exact {exact}");
            // Intervals of random rows are wider than the error of even ones.
            assert!(
                estimate.low - 1e-12 <= *exact && *exact <= estimate.high + 1e-12,
                "{estimate:?} {exact}"
            );
        }
    }
}

#[test]
fn indices_of_ishigami() {
    let design = Saltelli::new(4096, 3, 0).unwrap();
    let y = results(&design, ishigami);
    let (variance, exact) = ishigami_indices();
    // Random rows would have deviations up to 0.03 with 4096 of them; those of a Sobol sequence are three times as accurate here.
    near(&design, &y, &exact, 0.01);
    let found = sobol_indices(&design, &y, Bootstrap { resamples: 0, seed: 0 }).unwrap();
    assert!((found.variance / variance - 1.0).abs() < 0.01, "{}", found.variance);
    assert!((found.mean - 3.5).abs() < 0.02, "{}", found.mean);
}

#[test]
fn indices_of_the_g_function() {
    let design = Saltelli::new(4096, 4, 3).unwrap();
    // As above.
    near(&design, &results(&design, |u| g(u, &A)), &g_indices(), 0.01);
}

#[test]
fn indices_of_a_sum_do_not_see_its_offset() {
    let design = Saltelli::new(1024, 3, 0).unwrap();
    let sum = |u: &[f64]| 1e9 + u[0] + 2.0 * u[1] + 3.0 * u[2];
    // Shares of squares 1 : 4 : 9. Random rows would scatter by 0.03.
    near(&design, &results(&design, sum), &[[1.0 / 14.0; 2], [4.0 / 14.0; 2], [9.0 / 14.0; 2]], 0.01);
}

#[test]
fn failed_points_are_left_out_and_counted() {
    let design = Saltelli::new(2048, 3, 0).unwrap();
    let mut y = results(&design, ishigami);
    y[0] = f64::NAN; // A of the first row: no input has it
    y[5 + 2] = f64::INFINITY; // mixture of the first input in the second row
    let found = sobol_indices(&design, &y, Bootstrap { resamples: 100, seed: 1 }).unwrap();
    assert_eq!(found.failed, 2);
    assert_eq!(
        found.inputs.iter().map(|i| (i.rows.used, i.rows.left_out)).collect::<Vec<_>>(),
        [(2046, 2), (2047, 1), (2047, 1)]
    );
    assert!(found.inputs.iter().all(|i| i.first.value.is_finite() && i.total.high.is_finite()));
    // Two rows of 2048 weigh less than 1e-2.
    let (_, exact) = ishigami_indices();
    assert!((found.inputs[1].total.value - exact[1][1]).abs() < 0.02);

    y.fill(f64::NAN);
    let none = sobol_indices(&design, &y, Bootstrap::default());
    assert_eq!(none, Err(NoFigure::TooFew { left: 0, of: 2048, needed: 4 }));
    y.fill(3.0);
    assert_eq!(sobol_indices(&design, &y, Bootstrap::default()), Err(NoFigure::Constant));
    assert!(sobol_indices(&design, &y[1..], Bootstrap::default()).is_err());
}

#[test]
fn intervals_repeat() {
    let design = Saltelli::new(64, 3, 0).unwrap();
    let y = results(&design, ishigami);
    let found = |seed| sobol_indices(&design, &y, Bootstrap { resamples: 50, seed }).unwrap();
    assert_eq!(found(1), found(1));
    assert_ne!(found(1), found(2));
}

#[test]
fn elementary_effects_of_a_linear_function_are_its_coefficients() {
    let design = Morris::new(10, 4, 4, 0).unwrap();
    let y = results(&design, |u| 5.0 + 2.0 * u[0] - 3.0 * u[1] + u[3]);
    let found = elementary_effects(&design, &y).unwrap();
    for (e, coefficient) in found.iter().zip([2.0, -3.0, 0.0, 1.0]) {
        // Differences of numbers of size 10, divided by a half.
        assert!((e.mu - coefficient).abs() < 1e-14 && (e.mu_star - f64::abs(coefficient)).abs() < 1e-14);
        assert!(e.sigma < 1e-14);
        assert_eq!((e.steps.used, e.steps.left_out), (10, 0));
    }
}

#[test]
fn elementary_effects_of_a_product_are_the_other_factor() {
    // The effect of u_0 in u_0 (u_1 - 1/2) is u_1 - 1/2: its mean magnitude over four levels is 1/4, its mean 0.
    let design = Morris::new(4000, 2, 4, 0).unwrap();
    let found = elementary_effects(&design, &results(&design, |u| u[0] * (u[1] - 0.5))).unwrap();
    // Before or after the other one's step the levels are balanced, but not within the trajectories that go first: 5/√(16 · 4000).
    assert!(found[0].mu.abs() < 0.02, "{found:?}");
    // The magnitudes are 1/8 and 3/8, at equal numbers within the same scatter.
    assert!((found[0].mu_star - 0.25).abs() < 0.02, "{found:?}");
    assert!((found[0].sigma - (5.0_f64 / 64.0).sqrt()).abs() < 0.02, "{found:?}");
}

#[test]
fn a_failed_point_costs_its_two_steps() {
    let design = Morris::new(5, 3, 4, 0).unwrap();
    let mut y = results(&design, |u| u[0] + u[1] + u[2]);
    y[1] = f64::NAN;
    let found = elementary_effects(&design, &y).unwrap();
    let left_out: Vec<usize> = found.iter().map(|e| e.steps.left_out).collect();
    let mut expected = [0; 3];
    design.order(0)[..2].iter().for_each(|i| expected[*i] = 1);
    assert_eq!(left_out, expected);
    y.fill(f64::NAN);
    assert!(elementary_effects(&design, &y).is_err());
}

#[test]
fn the_widest_swing_comes_first() {
    let design = OneAtATime::new(3, 0.1, 0.9).unwrap();
    let mut y = results(&design, |u| u[0] - 4.0 * u[1] + 3.0 * u[2]);
    let found = tornado(&design, &y).unwrap();
    assert_eq!(found.swings.iter().map(|s| s.input).collect::<Vec<_>>(), [1, 2, 0]);
    // 4 times 0.8, within rounding.
    assert!((found.swings[0].range - 3.2).abs() < 1e-15);
    assert_eq!(found.swings[0].low, Some(y[3]));
    y[3] = f64::NAN;
    let found = tornado(&design, &y).unwrap();
    assert_eq!((found.failed, found.swings[0].input, found.swings[1].low), (1, 2, None));
    assert!(tornado(&design, &[f64::NAN; 7]).is_err());
}

#[test]
fn main_effects_find_the_first_order_indices() {
    let design = LatinHypercube::new(8000, 3, 0).unwrap();
    let points: Vec<Vec<f64>> = (0..design.len()).map(|k| design.point(k)).collect();
    let mut y: Vec<f64> = points.iter().map(|u| ishigami(u)).collect();
    let (_, exact) = ishigami_indices();
    // The mean over a bin of width w takes the factor sin(f w/2)/(f w/2) off a harmonic of frequency f: 1 for the first input, 2 for the second.
    let w = 2.0 * PI / 20.0;
    let seen = |f: f64| ((0.5 * f * w).sin() / (0.5 * f * w)).powi(2);
    let expected = [exact[0][0] * seen(1.0), exact[1][0] * seen(2.0), 0.0];
    for (found, expected) in main_effects(&points, &y).unwrap().iter().zip(expected) {
        // Three standard deviations of a correlation ratio η² of n random points, 2 η (1 - η²)/√n = 0.0086.
        assert!((found.share - expected).abs() < 0.026, "{} {expected}", found.share);
        assert!(found.bins.len() == 20 && found.bins.iter().all(|b| b.points == 400));
    }
    y[7] = f64::NAN;
    let found = main_effects(&points, &y).unwrap();
    assert!(found.iter().all(|e| e.left_out == 1 && e.share.is_finite()));
    assert_eq!(main_effects(&points, &vec![1.0; 8000]), Err(NoFigure::Constant));
}

#[test]
fn bands_are_those_of_order_statistics() {
    let mut y: Vec<f64> = (0..=100).rev().map(f64::from).collect();
    y.push(f64::NAN);
    let found = band(&y).unwrap();
    assert_eq!((found.mean, found.quantiles, found.min, found.max), (50.0, [5.0, 50.0, 95.0], 0.0, 100.0));
    // Σ (k - 50)² = 50 · 51 · 101 / 3, over 100.
    assert!((found.deviation - 858.5_f64.sqrt()).abs() < 1e-12);
    assert_eq!((found.points.used, found.points.left_out), (101, 1));
    let one = band(&[3.0]).unwrap();
    assert_eq!((one.deviation, one.quantiles), (0.0, [3.0; 3]));
    assert!(band(&[f64::NAN]).is_err());
}
