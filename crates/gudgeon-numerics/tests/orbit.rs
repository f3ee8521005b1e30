//! The periodic-orbit search on maps whose fixed points and multipliers are known: cost, period and, above all, honesty of the
//! reported error.

use gudgeon_core::EvalError;
use gudgeon_numerics::orbit::{CycleMap, OrbitOptions, OrbitReport, periodic_orbit};

/// A map from a closure, with unit scales and a deterministic noise of relative size `noise`.
struct Map<F> {
    dim: usize,
    f: F,
    noise: f64,
    calls: usize,
}

impl<F: FnMut(&[f64], &mut [f64])> CycleMap for Map<F> {
    fn dim(&self) -> usize {
        self.dim
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], _: f64) -> Result<f64, EvalError> {
        self.calls += 1;
        (self.f)(y0, y1);
        for (i, y) in y1.iter_mut().enumerate() {
            // A hash of the call: looks random, repeats exactly.
            let u = ((self.calls * 31 + i * 17) as f64 * 0.618_033_988_749_894_9).fract() * 2.0 - 1.0;
            *y += self.noise * u;
        }
        Ok(1.0)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
}

fn options(tolerance: f64) -> OrbitOptions {
    OrbitOptions { tolerance, accuracy: 0.1 * tolerance, max_cycles: 60, accelerate: true }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// A linear map with these multipliers in a skew (non-normal) basis, around a fixed point; returns report and true error.
fn linear(multipliers: &[f64], o: &OrbitOptions, noise: f64) -> (OrbitReport, f64) {
    let n = multipliers.len();
    let target: Vec<f64> = (0..n).map(|i| 1.0 + 0.3 * i as f64).collect();
    // v_i = e_i + 0.5 e_{i+1}: coordinates in this basis by forward substitution.
    let t = target.clone();
    let f = |y: &[f64], out: &mut [f64]| {
        let mut c = vec![0.0; n];
        for i in 0..n {
            c[i] = y[i] - t[i] - if i > 0 { 0.5 * c[i - 1] } else { 0.0 };
        }
        for i in 0..n {
            c[i] *= multipliers[i];
        }
        for i in 0..n {
            out[i] = t[i] + c[i] + if i > 0 { 0.5 * c[i - 1] } else { 0.0 };
        }
    };
    let mut y = vec![0.0; n];
    let r = periodic_orbit(&mut Map { dim: n, f, noise, calls: 0 }, &mut y, o).unwrap();
    let e = distance(&y, &target);
    (r, e)
}

#[test]
fn the_reported_error_covers_the_true_one() {
    let slow: [&[f64]; 10] = [
        &[0.3, 0.0],
        &[0.95, 1e-3, 1e-7],
        &[-0.9, 0.2],
        &[0.999, 0.1],
        &[0.9, 0.8, 0.7, 0.3],
        &[0.99, -0.95, 0.5],
        &[0.95; 3],
        &[-0.5, 0.5, 0.1, -0.1, 0.01, 0.0],
        &[1e-7; 5],
        &[0.0; 3],
    ];
    let mut failures = Vec::new();
    for m in slow {
        for tolerance in [1e-2, 1e-4, 1e-8] {
            for noise in [0.0, 0.01] {
                let (r, e) = linear(m, &options(tolerance), noise * tolerance);
                // Rounding of numbers of order 1; the map's own noise over 1 - λ, from up to four secants and the state.
                let floor = 1e-13 + 5.0 * noise * tolerance / (1.0 - m[0].max(0.0));
                // A mode that changes the state by about a tenth of the tolerance per cycle is invisible beside faster ones.
                if 1.0 - m[0] < 0.11 * tolerance {
                    continue;
                }
                let covered = e <= 3.0 * r.error_estimate + floor;
                if !covered || !r.converged || r.period != 1 {
                    failures.push(format!("{m:?} {tolerance:e} {noise}: {e:e} {r:?}"));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn cheap_maps_are_cheap() {
    // A gas network forgets its start within one cycle: one cycle to get there, one to confirm.
    let (r, _) = linear(&[1e-7, 1e-8, 0.0], &options(1e-4), 0.0);
    assert!(r.cycles <= 2, "{r:?}");
    // One slow mode: two cycles give its secant, one the extrapolation, the rest confirms.
    let (r, e) = linear(&[0.95, 1e-3, 1e-4, 0.0], &options(1e-4), 0.0);
    assert!(r.cycles <= 6 && e < 1e-4, "{e:e} {r:?}");
}

#[test]
fn nonlinear_fixed_points() {
    // x' = cos x, and a coupled pair with multipliers 0.9 and -0.3.
    let mut y = [0.0];
    let mut m = Map { dim: 1, f: |y: &[f64], o: &mut [f64]| o[0] = y[0].cos(), noise: 0.0, calls: 0 };
    let r = periodic_orbit(&mut m, &mut y, &options(1e-9)).unwrap();
    let e = (y[0] - 0.739_085_133_215_160_6).abs();
    assert!(r.converged && e <= 3.0 * r.error_estimate + 1e-13 && r.cycles < 12, "{e:e} {r:?}");
    let f = |y: &[f64], o: &mut [f64]| {
        o[0] = 0.9 * y[0] + 0.1 * y[1] * y[1];
        o[1] = 1.0 - 0.3 * y[1] + 0.3 + 0.01 * (y[0] - 1.0).powi(2);
    };
    let mut y = [0.2, 0.4];
    let r = periodic_orbit(&mut Map { dim: 2, f, noise: 0.0, calls: 0 }, &mut y, &options(1e-8)).unwrap();
    let e = distance(&y, &[1.0, 1.0]);
    assert!(r.converged && r.period == 1 && e <= 3.0 * r.error_estimate + 1e-13 && e < 1e-8, "{e:e} {r:?}");
}

#[test]
fn period_two_is_reported_not_an_unstable_fixed_point() {
    // Logistic map at 3.2: fixed point 0.6875 (multiplier -1.2), two-cycle 0.5130, 0.7995 (multiplier 0.16).
    let logistic = |y: &[f64], o: &mut [f64]| o[0] = 3.2 * y[0] * (1.0 - y[0]);
    for start in [0.1, 0.3, 0.68, 0.9] {
        let mut y = [start];
        let r =
            periodic_orbit(&mut Map { dim: 1, f: logistic, noise: 0.0, calls: 0 }, &mut y, &options(1e-6))
                .unwrap();
        // x± = (r + 1 ± sqrt((r - 3)(r + 1)))/(2 r).
        let root = (0.2f64 * 4.2).sqrt();
        let e = [(4.2 + root) / 6.4, (4.2 - root) / 6.4].iter().map(|x| (y[0] - x).abs()).fold(1.0, f64::min);
        assert!(r.converged && r.period == 2 && e <= 3.0 * r.error_estimate + 1e-13, "{start} {y:?} {r:?}");
    }
    // Hénon's map with a = 0.5, b = 0.3: two-cycle; the fixed point has a multiplier of -1.2.
    let henon = |y: &[f64], o: &mut [f64]| (o[0], o[1]) = (1.0 - 0.5 * y[0] * y[0] + y[1], 0.3 * y[0]);
    let mut y = [0.5, 0.1];
    let r =
        periodic_orbit(&mut Map { dim: 2, f: henon, noise: 0.0, calls: 0 }, &mut y, &options(1e-6)).unwrap();
    // x± = ((1-b) ± sqrt(4 a - 3 (1-b)²))/(2 a).
    let root = (2.0f64 - 3.0 * 0.49).sqrt();
    let e = [0.7 + root, 0.7 - root].iter().map(|x| (y[0] - x).abs()).fold(1.0, f64::min);
    assert!(r.converged && r.period == 2 && e <= 3.0 * r.error_estimate + 1e-13, "{e:e} {y:?} {r:?}");
}

#[test]
fn no_fixed_point_is_not_converged() {
    // A drift: y grows by 0.01 each cycle (multiplier 1, no orbit).
    let mut y = [0.0];
    let mut m = Map { dim: 1, f: |y: &[f64], o: &mut [f64]| o[0] = y[0] + 0.01, noise: 0.0, calls: 0 };
    let r = periodic_orbit(&mut m, &mut y, &options(1e-3)).unwrap();
    assert!(!r.converged, "{r:?}");
    // Chaos.
    let mut y = [0.3];
    let mut m =
        Map { dim: 1, f: |y: &[f64], o: &mut [f64]| o[0] = 3.99 * y[0] * (1.0 - y[0]), noise: 0.0, calls: 0 };
    let r = periodic_orbit(&mut m, &mut y, &options(1e-6)).unwrap();
    assert!(!r.converged, "{r:?}");
}
