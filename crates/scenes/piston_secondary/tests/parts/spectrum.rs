//! Courses over a cycle taken apart into harmonics.

use std::f64::consts::PI;

use gudgeon_scene_piston_secondary::spectrum::{HARMONICS, POINTS, Piece, amplitudes};

/// A four-stroke cycle in steps that end at `ends`, parts of it; `f` of its part, the step given by its middle where it jumps at an end.
fn pieces(ends: &[f64], f: impl Fn(f64, f64) -> f64) -> Vec<Piece> {
    ends.windows(2)
        .map(|w| {
            let middle = 0.5 * (w[0] + w[1]);
            Piece {
                ends: [w[0] * 4.0 * PI, w[1] * 4.0 * PI],
                values: [w[0], middle, w[1]].map(|x| f(x, middle)),
            }
        })
        .collect()
}

#[test]
fn harmonics_of_waves_in_uneven_steps() {
    // Steps grow threefold over the cycle; the mean is no harmonic.
    let ends: Vec<f64> = (0..=1500).map(|k| f64::from(k) / 1500.0).map(|x| 0.5 * x * (1.0 + x)).collect();
    let wave = |n: f64, x: f64| (2.0 * PI * n * x).cos();
    let one = pieces(&ends, |x, _| 7.0 + 3.0 * wave(1.0, x) + 0.25 * wave(40.0, x + 0.1));
    let other = pieces(&ends, |x, _| -2.0 + wave(3.0, x));
    let [a, b] = amplitudes(&one, &other, 60);
    for (k, (a, b)) in a.iter().zip(&b).enumerate() {
        let n = k + 1;
        let exact = match n {
            1 => (3.0, 0.0),
            3 => (0.0, 1.0),
            40 => (0.25, 0.0),
            _ => (0.0, 0.0),
        };
        // A parabola through three points of a wave misses (n h)³/(72 √3) of it at most, h = 2π/1000 the longest step: 1.3e-4 of harmonic 40.
        assert!((a - exact.0).abs() < 4e-5 && (b - exact.1).abs() < 1e-6, "harmonic {n}: {a} {b}");
    }
}

#[test]
fn kinks_and_jumps_are_folded_back_as_little_as_is_said() {
    // A triangle from 1 to -1 and back: 8/(π n)² in odd harmonics. A pulse of 1 over a sixteenth of the cycle: 2 |sin(π n/16)|/(π n).
    let ends: Vec<f64> = (0..=64).map(|k| f64::from(k) / 64.0).collect();
    let triangle = pieces(&ends, |x, _| 1.0 - 4.0 * x.min(1.0 - x));
    let pulse = pieces(&ends, |_, middle| if middle < 1.0 / 16.0 { 1.0 } else { 0.0 });
    let [a, b] = amplitudes(&triangle, &pulse, HARMONICS);
    for (k, (a, b)) in a.iter().zip(&b).enumerate() {
        let (n, points) = ((k + 1) as f64, POINTS as f64);
        // Of equal steps, the sine stands in place of its angle. Rounding of a transform.
        let sine = points * (PI * n / points).sin();
        let sampled = if k % 2 == 0 { 8.0 / sine.powi(2) } else { 0.0 };
        assert!((a - sampled).abs() < 1e-13, "harmonic {n}: {a} {sampled}");
        let sampled = 2.0 * (PI * n / 16.0).sin().abs() / sine;
        assert!((b - sampled).abs() < 1e-13, "harmonic {n}: {b} {sampled}");
        // What is folded back of the triangle: from both sides of every multiple of the points, 1 + 1/4 + 1/9 + ... of them.
        let exact = if k % 2 == 0 { 8.0 / (PI * n).powi(2) } else { 0.0 };
        let folded = 2.0 * PI * PI / 6.0 * (n / (points - n)).powi(2);
        assert!((a - exact).abs() <= folded * exact + 1e-13, "harmonic {n}: {a} {exact}");
    }
}
