//! Pulses of a trace that no step of an integrator may pass over.

use std::f64::consts::PI;

/// Widest pulse at half of its height \[rad\] that could lie between the ends of two steps: 10 degrees.
const NARROW: f64 = 10.0 / 180.0 * PI;
/// Smallest height of a pulse, over the range of the rows, for which steps stop.
const MIN_PULSE: f64 = 0.01;

/// Angles of the tops and bottoms of pulses that no step may pass over: rows that the pressure leaves by more than [`MIN_PULSE`] of
/// the range on both sides within [`NARROW`], and that have less than this between the places where half of that is lost.
pub(crate) fn narrow_pulses(angles: &[f64], p: &[f64], period: f64) -> Vec<f64> {
    let n = p.len();
    let (low, high) = p.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
    let least = MIN_PULSE * (high - low);
    // The largest fall (`sign` 1) or rise from row `k` on one side, before the trace goes beyond it, within the width of a pulse.
    let side = |k: usize, step: usize, sign: f64| {
        let (mut fall, mut j) = (0.0_f64, (k + step) % n);
        loop {
            let away = if step == 1 { angles[j] - angles[k] } else { angles[k] - angles[j] };
            let down = sign * (p[k] - p[j]);
            if j == k || away.rem_euclid(period) > NARROW || down < 0.0 {
                return fall;
            }
            fall = fall.max(down);
            j = (j + step) % n;
        }
    };
    let narrow = |k: usize, sign: f64| {
        let height = side(k, 1, sign).min(side(k, n - 1, sign));
        let half = |step: usize| {
            let mut j = (k + step) % n;
            while j != k && sign * (p[k] - p[j]) < 0.5 * height {
                j = (j + step) % n;
            }
            let away = if step == 1 { angles[j] - angles[k] } else { angles[k] - angles[j] };
            away.rem_euclid(period)
        };
        height > least && half(1) + half(n - 1) < NARROW
    };
    (0..n)
        .filter(|&k| {
            let (before, after) = (p[(k + n - 1) % n], p[(k + 1) % n]);
            let top = p[k] > before && p[k] >= after;
            let bottom = p[k] < before && p[k] <= after;
            top && narrow(k, 1.0) || bottom && narrow(k, -1.0)
        })
        .map(|k| angles[k])
        .collect()
}
