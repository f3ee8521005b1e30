//! Noise of a trace, and the filter.

use std::f64::consts::TAU;

use gudgeon_kinematics::smoothing::{noise, smooth};

/// Uniform noise of standard deviation `s`.
fn noisy(rows: &[f64], s: f64) -> Vec<f64> {
    let mut seed = 1_u64;
    rows.iter()
        .map(|p| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let unit = (seed >> 11) as f64 / (1_u64 << 53) as f64;
            p + s * 12f64.sqrt() * (unit - 0.5)
        })
        .collect()
}

/// A pulse of 60 on a base of 1 with ripple.
fn clean(n: usize) -> Vec<f64> {
    let bump = |x: f64| 60.0 * (-((x - 0.52) / 0.03).powi(2)).exp();
    (0..n).map(|j| j as f64 / n as f64).map(|x| 1.0 + 0.2 * (3.0 * TAU * x).sin() + bump(x)).collect()
}

#[test]
fn noise_is_told_from_a_smooth_trace_and_from_its_last_digit() {
    for n in [720, 1440, 7200] {
        let rows = clean(n);
        assert_eq!(noise(&rows), None);
        // Printed to 0.001 of 60.
        let printed: Vec<f64> = rows.iter().map(|p| (p * 1e3).round() / 1e3).collect();
        assert_eq!(noise(&printed), None, "{n}");
        let found = noise(&noisy(&rows, 0.03)).expect("noisy");
        // Fourth differences that share rows tell as much as n/5 of their own: 10 % at 720 rows; uniform noise is not normal: 7 %.
        assert!((found / 0.03 - 1.0).abs() < 0.25, "{n}: {found}");
    }
}

#[test]
fn the_filter_takes_off_the_noise_and_leaves_the_trace() {
    let truth = clean(1440);
    let mut rows = noisy(&truth, 0.03);
    let before = rows.clone();
    let done = smooth(&mut rows, None);
    let rms =
        |a: &[f64]| (a.iter().zip(&truth).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt();
    // A pulse of 30 degrees needs some 60 of 720 harmonics: a quarter of the noise and as much bend at most.
    assert!(rms(&rows) < 0.5 * rms(&before), "{} {}", rms(&rows), rms(&before));
    assert!(noise(&rows).is_none());
    let mean = |a: &[f64]| a.iter().sum::<f64>() / a.len() as f64;
    // Rounding of sums of 1440 numbers up to 60.
    assert!((mean(&rows) - mean(&before)).abs() < 1e-12);
    // The peak within three standard deviations of the noise.
    assert!(done.peak.abs() < 3.0 * 0.03, "{}", done.peak);
    // The upper 360 of 720 harmonics know the noise to 4 %; six standard deviations of 1440 changes.
    assert!((done.noise / 0.03 - 1.0).abs() < 0.1 && done.change.0 <= 1.1 * done.noise, "{done:?}");
    assert!(done.change.1 < 6.0 * 0.03, "{done:?}");
}

#[test]
fn no_phase_is_shifted_and_the_cut_off_is_halved() {
    let n = 360;
    for k in [2, 20, 60] {
        let wave: Vec<f64> = (0..n).map(|j| (TAU * (k * j) as f64 / n as f64 + 0.7).cos()).collect();
        let mut rows = wave.clone();
        smooth(&mut rows, Some(20.0));
        let share = 1.0 / (1.0 + (k as f64 / 20.0).powi(6));
        for (a, b) in rows.iter().zip(&wave) {
            // Rounding of sums of 180 terms; harmonics from 60 on are left out, where 1.4e-3 would be left.
            let within = if k == 60 { 1.5e-3 } else { 1e-12 };
            assert!((a - share * b).abs() < within, "{k}");
        }
    }
}

/// A wave that the rows resolve has large fourth differences and yet is no noise: its second differences grow with their width, by
/// `4 cos²(π h/n)`. The level of the trace changes nothing.
#[test]
fn a_wave_that_the_rows_resolve_is_no_noise() {
    for level in [0.0, 1.0, 100.0] {
        let rows: Vec<f64> = (0..64).map(|k| level + (TAU * 6.0 * f64::from(k) / 64.0).cos()).collect();
        assert_eq!(noise(&rows), None, "{level}");
    }
}
