//! Maxima and minima over the cycle of sums of harmonics.

use std::f64::consts::PI;

use gudgeon_torsion::cycle::Cycle;

#[test]
fn extremes_are_those_of_a_dense_grid() {
    // Five orders without a pattern: a grid of 2e5 points is right to (5 π/1e5)²/2 ≈ 1e-8 of the amplitude, and never above.
    let orders = [0.5, 1.0, 2.5, 3.0, 5.0];
    let a = [[1.0, 0.3], [-0.4, 2.0], [0.7, -0.9], [1.5, 0.2], [-0.3, 0.8]];
    let found = Cycle::new(&orders, 4.0 * PI).extremes(0.25, |k| a[k]);
    let value = |t: f64| {
        0.25 + orders.iter().zip(a).map(|(o, [re, im])| re * (o * t).cos() - im * (o * t).sin()).sum::<f64>()
    };
    let grid = (0..200_000).map(|i| value(4.0 * PI * f64::from(i) / 2e5));
    let [high, low] = grid.fold([f64::NEG_INFINITY, f64::INFINITY], |[a, b], v| [a.max(v), b.min(v)]);
    assert!(found[0] >= high && found[0] - high < 1e-7, "{} {high}", found[0]);
    assert!(found[1] <= low && low - found[1] < 1e-7, "{} {low}", found[1]);
}

#[test]
fn one_wave_is_its_amplitude_wherever_its_crest_stands() {
    for i in 0..50 {
        let (sin, cos) = (0.13 * f64::from(i)).sin_cos();
        let [high, low] = Cycle::new(&[3.0], 2.0 * PI).extremes(-1.0, |_| [2.0 * cos, 2.0 * sin]);
        // Rounding of a sine.
        assert!((high - 1.0).abs() < 1e-14 && (low + 3.0).abs() < 1e-14, "{high} {low}");
    }
}
