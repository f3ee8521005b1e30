//! Grids of films.

use gudgeon_core::kinds::{Edge, Film2dGrid};

/// Weights along `x` of a grid with these nodes.
fn weights(line: &[f64], low: Edge, high: Edge, period: f64) -> Vec<f64> {
    let edges = [low, high, Edge::Pressure, Edge::Pressure];
    Film2dGrid { x: line.to_vec(), y: vec![0.0, 1.0, 2.0], edges, period }.weights().0
}

#[test]
fn weights_are_exact_for_parabolas_and_better_than_that() {
    let graded = |n: usize| {
        (0..=n)
            .map(|i| {
                let s = i as f64 / n as f64;
                s * (0.5 + 0.5 * s)
            })
            .collect::<Vec<_>>()
    };
    for n in [2, 3, 8, 40] {
        let line = graded(n);
        let w = weights(&line, Edge::Pressure, Edge::Pressure, 0.0);
        let sum: f64 = w.iter().zip(&line).map(|(w, x)| w * (3.0 * x * x - x + 2.0)).sum();
        // Exact but for rounding.
        assert!((sum - 2.5).abs() < 1e-14, "{n}: {sum}");
    }
    let uniform = weights(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0], Edge::Pressure, Edge::Pressure, 0.0);
    let known = [3.0 / 8.0, 7.0 / 6.0, 23.0 / 24.0, 1.0];
    assert!(uniform.iter().zip(known).all(|(a, b)| (a - b).abs() < 1e-15), "{uniform:?}");
    let half = weights(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0], Edge::Pressure, Edge::Wall, 0.0);
    assert!((half[6] - 0.5).abs() < 1e-15 && (half[5] - 1.0).abs() < 1e-15, "{half:?}");
    let turn: Vec<f64> = (0..10).map(f64::from).collect();
    let ring = weights(&turn, Edge::Periodic, Edge::Periodic, 10.0);
    assert!(ring.iter().all(|w| (w - 1.0).abs() < 1e-15), "{ring:?}");
}
