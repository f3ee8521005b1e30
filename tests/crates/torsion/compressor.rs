//! The four-throw compressor of Gomes (2021): every value that an independent implementation gave for the published equations, and
//! what must hold whatever the numbers (momentum, energy, closed forms). Values without a word on where they come from are of that
//! implementation (NumPy and SciPy, matrix exponentials, compiled Runge-Kutta).

use crate::common::Gas;
use crate::common::compressor::*;
use gudgeon_core::kinds::*;
use gudgeon_core::quantity::quantity;
use gudgeon_numerics::linalg::Complex;
use gudgeon_torsion::forcing::{gas_series, series};
use gudgeon_torsion::throw_inertia::{Exact, FirstHarmonic, Mean};
use gudgeon_torsion::torsion::{HarmonicBalance, Implicit, Modal, Orders, Propagator, RungeKutta};
use gudgeon_torsion::tree::Tree;
use std::f64::consts::PI;

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * b.abs()
}

#[test]
fn inertia_and_damping_of_a_throw() {
    let (i0, c0) = inertia_and_damping();
    // Eight digits of the computed values; the source prints 8.42 and 492.51.
    assert!(close(i0, 8.422684, 1e-9) && close(c0, 492.5173085, 1e-10), "{i0} {c0}");
    let first = FirstHarmonic {}.build(&THROW).expect("builds");
    let eps = (first.inertia(PI / 2.0).0 - first.mean()) / first.mean();
    assert!(close(eps, 0.122480672, 1e-8), "{eps}");
    let exact = Exact {}.build(&THROW).expect("builds");
    assert!(close(exact.inertia(0.0).0, 7.391068, 1e-9) && close(exact.inertia(PI).0, 7.391068, 1e-9));
    assert!(close(exact.mean(), 8.429384, 1e-7), "{}", exact.mean());
    let at = 81.12_f64.to_radians();
    assert!(close(exact.inertia(at).0, 9.507246, 1e-7));
    let c = series(|a| exact.inertia(a).0, 2.0 * PI, &[], 4);
    for (k, v) in [0.16628, -1.03166, -0.16682, -0.00670].into_iter().enumerate() {
        // Five printed decimals.
        assert!((c[k + 1].re - v).abs() < 6e-6 && c[k + 1].im.abs() < 1e-12, "{c:?}");
    }
    // The derivative against differences of fourth order: h⁴/30 times derivatives below 2⁵, rounding over h.
    for model in [&exact, &first] {
        for i in 0..50 {
            let t = 0.13 * f64::from(i);
            let h = 1e-3;
            let f = |x: f64| model.inertia(x).0;
            let d = (8.0 * (f(t + h) - f(t - h)) - (f(t + 2.0 * h) - f(t - 2.0 * h))) / (12.0 * h);
            assert!((model.inertia(t).1 - d).abs() < 1e-10);
        }
    }
}

/// θ \[rad\], pressure of the windows, Q of M1, M2, M3.
const POINTS: [[f64; 5]; 12] = [
    [0.2000, 446711.80, 380.3478, 522.0512, 522.0512],
    [0.5000, 172243.99, 192.0579, 255.0844, 255.0844],
    [0.7000, 94522.13, -25.2689, -32.3662, 0.0],
    [0.7709, 78161.27, -93.8622, -118.3972, 0.0],
    [4.0000, 125795.83, -134.6182, -108.9347, -108.9347],
    [4.5000, 181102.26, -530.3187, -495.2655, -495.2655],
    [5.0000, 337543.30, -1420.9907, -1557.9368, -1557.9368],
    [5.3000, 585819.04, -2413.9383, -2888.9614, -2888.9614],
    [5.3619, 670632.49, -2690.1323, -3272.3775, -2873.9983],
    [5.3621, 601325.00, -2362.2100, -2873.6284, -2873.6284],
    [5.8000, 601325.00, -1310.2908, -1744.7240, -1744.7240],
    [6.2000, 601325.00, -229.5791, -316.7794, -316.7794],
];

#[test]
fn pressure_and_torque_at_points() {
    let [m1, m2, m3] = [Gas::M1, Gas::M2, Gas::M3].map(|g| end(g).remove(0));
    for [t, p, q1, q2, q3] in POINTS {
        // Values are given to 0.01 Pa and 1e-4 N m.
        assert!((m1.pressure.pressure(t) - p).abs() < 6e-3);
        for (e, q) in [(&m1, q1), (&m2, q2), (&m3, q3)] {
            let found = e.torque(t, t);
            assert!((found - q).abs() < 6e-5, "{t}: {found} {q}");
            // A whole turn later the same.
            assert!((e.torque(t + 2.0 * PI, t + 2.0 * PI) - found).abs() < 1e-8);
        }
    }
    // Lever: the rate of the piston's way, by differences of fourth order.
    for i in 0..100 {
        let t = 0.07 + 0.0631 * f64::from(i);
        let h = 1e-3;
        let y = |t: f64| m2.kinematics.motion(t).y;
        let d = (8.0 * (y(t + h) - y(t - h)) - (y(t + 2.0 * h) - y(t - 2.0 * h))) / (12.0 * h);
        assert!((m2.kinematics.motion(t).v / 100.0 - d).abs() < 1e-12);
    }
}

#[test]
fn work_of_the_ideal_cycle_is_the_closed_form() {
    let l = line(Gas::M3, &Mean {}, None, [0.0; 4]);
    let c = gas_series(&l.throws[0], 12);
    // V_c = A S/(ε - 1) with the stroke of the source; W = n/(n-1) p_s (V_max - V_4) ((p_d/p_s)^((n-1)/n) - 1).
    let area = PI * 0.305 * 0.305 / 4.0;
    let (vc, ps, pd, n): (f64, f64, f64, f64) = (area * 0.145 / 16.5, 101_325.0, 601_325.0, 1.4);
    let v4 = vc * (pd / ps).powf(1.0 / n);
    let work = n / (n - 1.0) * ps * (vc + 0.18 * area - v4) * ((pd / ps).powf((n - 1.0) / n) - 1.0);
    assert!(close(work, 2705.679669, 1e-9));
    assert!(close(c[0].re, -work / (2.0 * PI), 1e-12), "{} {}", c[0].re, -work / (2.0 * PI));
    // Harmonics to five digits.
    let table = [
        [-423.67, 701.51],
        [219.62, 635.99],
        [381.84, 243.45],
        [246.35, 13.93],
        [80.04, -39.21],
        [-20.15, -0.38],
        [-39.17, 47.60],
        [-14.65, 60.90],
        [11.71, 39.05],
        [17.13, 6.16],
        [4.58, -13.89],
        [-10.44, -13.15],
    ];
    for (c, t) in c[1..].iter().zip(table) {
        assert!((c.re - t[0]).abs() < 6e-3 && (c.im + t[1]).abs() < 6e-3, "{c:?} {t:?}");
    }
    let m1 = gas_series(&line(Gas::M1, &Mean {}, None, [0.0; 4]).throws[0], 4);
    let m2 = gas_series(&line(Gas::M2, &Mean {}, None, [0.0; 4]).throws[0], 4);
    assert!((m1[0].re + 371.87).abs() < 6e-3 && (m2[0].re + 433.10).abs() < 6e-3);
    assert!((m1[1].re + 333.10).abs() < 6e-3 && (m1[1].im + 611.17).abs() < 6e-3);
}

#[test]
fn eigenvalues_of_the_printed_line() {
    let l = line(Gas::None, &Mean {}, None, [0.0; 4]);
    let modes = gudgeon_torsion::natural_frequencies::Eigenvalues::default()
        .build(&l)
        .expect("builds")
        .modes()
        .expect("found");
    let table = [
        [261.518353, 1.846832, 261.514724, 0.007062],
        [359.581573, 3.950092, 359.560242, 0.010985],
        [979.011801, 29.503740, 978.567135, 0.030136],
        [1494.704739, 68.770209, 1493.122084, 0.046009],
        [1831.967617, 103.305480, 1829.053375, 0.056390],
        [2217.811237, 50.021299, 2217.218983, 0.022555],
    ];
    assert_eq!(modes[0].omega, 0.0);
    for (m, t) in modes[1..].iter().zip(table) {
        let (decay, w) = m.damped.expect("oscillates");
        // Half a unit of the last of six decimals.
        assert!((m.omega - t[0]).abs() < 6e-7 && (decay - t[1]).abs() < 6e-7 && (w - t[2]).abs() < 6e-7);
        assert!((decay / decay.hypot(w) - t[3]).abs() < 6e-7);
        assert!(m.residual < 1e-11);
    }
    let shapes = [
        [1.0, -0.11137, -0.33174, -0.55442, -0.73718, -0.86686, -0.93412],
        [0.06774, -0.07459, -0.10065, 0.27335, 0.61014, 0.86387, 1.0],
    ];
    for (m, s) in modes[1..].iter().zip(shapes) {
        assert!(m.shape.iter().zip(s).all(|(a, b)| (a - b).abs() < 6e-6), "{:?}", m.shape);
    }
    let squares: Vec<f64> = modes.iter().map(|m| m.omega * m.omega).collect();
    assert!(close(squares.iter().sum(), 11_665_089.149, 1e-10));
    assert!(close(squares[1..].iter().product(), 3.125_867_9e35, 2e-8));
    // The published values: neighbours clamped.
    let clamped = gudgeon_torsion::natural_frequencies::ClampedNeighbours {}
        .build(&l)
        .expect("builds")
        .modes()
        .expect("found");
    let printed = [248.0695, 2190.8902, 393.4955, 1378.2714, 1378.2714, 1378.2714, 974.5850];
    for (m, p) in clamped.iter().zip(printed) {
        assert!((m.omega - p).abs() < 6e-5);
    }
    assert!(close(clamped.iter().map(|m| m.omega * m.omega).sum(), squares.iter().sum(), 1e-13));
}

/// t, angles, speeds of the free response, exact to the printed digits.
const FREE: [(f64, [f64; 7], [f64; 7]); 5] = [
    (
        0.001,
        [0.988496, 0.117734, 0.001025, 0.000037, 0.000001, 0.0, 0.0],
        [968.221466, 271.588523, 4.559284, 0.224141, 0.006771, 0.000144, 0.000002],
    ),
    (
        0.01,
        [3.981067, 2.580978, 2.294711, 1.824616, 1.425181, 1.137876, 0.989581],
        [-354.259242, 454.202639, 499.418789, 500.585599, 494.587822, 494.353470, 492.246422],
    ),
    (
        0.1,
        [28.728834, 26.721368, 26.319007, 25.623557, 25.031278, 24.600510, 24.373898],
        [568.290879, 237.766482, 172.979107, 88.184738, 17.600804, -32.678691, -58.741172],
    ),
    (
        1.0,
        [268.475474, 268.797146, 268.861852, 268.934584, 268.994890, 269.037984, 269.060429],
        [189.289976, 277.710236, 295.026527, 313.226487, 328.199577, 338.841614, 344.366781],
    ),
    (
        3.0,
        [806.292384, 806.301231, 806.302965, 806.304738, 806.306193, 806.307225, 806.307761],
        [270.592899, 268.568017, 268.160578, 267.755308, 267.422728, 267.186758, 267.064372],
    ),
];

#[test]
fn free_response_in_closed_form() {
    let l = line(Gas::None, &Mean {}, None, [0.0; 4]);
    let mut times: Vec<f64> = FREE.iter().map(|f| f.0).collect();
    times.push(1000.0);
    let out = run(&Propagator {}, &context(&l, 268.0, 1.0, &START, &times));
    assert_eq!(out.counters["time_steps"], 0);
    let inertia: Vec<f64> = (0..7).map(|i| l.mean_inertia(i)).collect();
    let total: f64 = inertia.iter().sum();
    assert!(close(total, 483.690736, 1e-9));
    for (r, f) in FREE.iter().enumerate() {
        for i in 0..7 {
            // Half a unit of the sixth decimal.
            assert!((out.angles[r][i] - f.1[i]).abs() < 6e-7, "{} {} {}", f.0, out.angles[r][i], f.1[i]);
            assert!((out.speeds[r][i] - f.2[i]).abs() < 6e-7, "{} {} {}", f.0, out.speeds[r][i], f.2[i]);
        }
        let momentum: f64 = inertia.iter().zip(&out.speeds[r]).map(|(j, w)| j * w).sum();
        assert!(close(momentum, 130.0 * 1000.0, 1e-12), "momentum");
    }
    // Much later all turn at the momentum over the inertia.
    for w in &out.speeds[5] {
        assert!(close(*w, 130_000.0 / total, 1e-13));
    }
}

#[test]
fn runge_kutta_of_fourth_order_and_its_limit() {
    let l = line(Gas::None, &Mean {}, None, [0.0; 4]);
    let exact = run(&Propagator {}, &context(&l, 268.0, 1.0, &START, &[0.1]));
    let error = |h: f64| {
        let spec = RungeKutta { step: quantity(h), look_ahead: false };
        let out = run(&spec, &context(&l, 268.0, 1.0, &START, &[0.1]));
        let momentum: f64 = (0..7).map(|i| l.mean_inertia(i) * out.speeds[0][i]).sum();
        assert!(close(momentum, 130_000.0, 1e-10), "a linear invariant holds to rounding");
        (0..7).map(|i| (out.speeds[0][i] - exact.speeds[0][i]).abs()).fold(0.0, f64::max)
    };
    // Errors of the source's scheme, two digits.
    for (h, e) in
        [(1e-3, 1.77), (5e-4, 0.515), (2.5e-4, 0.185), (1.25e-4, 1.16e-2), (1e-4, 4.7e-3), (5e-5, 2.8e-4)]
    {
        let found = error(h);
        assert!(close(found, e, 0.02), "{h}: {found} {e}");
    }
    let order = (error(5e-5) / error(2.5e-5)).log2();
    assert!((order - 4.0).abs() < 0.05, "{order}");
    // Stable below 1.29450 ms only.
    let grows = |h: f64| {
        let spec = RungeKutta { step: quantity(h), look_ahead: false };
        let ctx_times = [4.0];
        let ctx = context(&l, 268.0, 1.0, &START, &ctx_times);
        let mut out = TorsionOut::default();
        spec.build(&ctx).expect("builds").run(&mut out).map(|()| out.speeds[0][1].abs())
    };
    assert!(grows(1.2940e-3).expect("stable") < 400.0);
    assert!(grows(1.2960e-3).is_err() || grows(1.2960e-3).expect("finite") > 1e3);
    let message = grows(2e-3).expect_err("blows up").to_string();
    assert!(message.contains("too large"), "{message}");
}

#[test]
fn one_step_as_published() {
    let l = line(Gas::M1, &Mean {}, Some((2000.0, -0.2)), [0.0; 4]);
    let spec = RungeKutta { step: quantity(5e-5), look_ahead: true };
    let out = run(&spec, &context(&l, 268.0, 1.0, &START, &[5e-5, 1e-4, 0.02]));
    let near = |a: f64, b: f64| assert!(close(a, b, 1e-8), "{a} {b}");
    near(out.angles[0][0], 0.0499940053932);
    near(out.angles[0][1], 7.80428557237e-5);
    near(out.angles[0][2], 3.61400487e-9);
    near(out.speeds[0][0], 999.734739595);
    near(out.speeds[0][1], 3.44860949844);
    near(out.speeds[0][2], 2.83086740e-4);
    near(out.speeds[0][3], 2.30544792e-7);
    assert!((out.drive[0][0] - 1800.0530).abs() < 6e-5, "four decimals");
    near(out.angles[1][0], 0.0999709344247);
    near(out.speeds[1][0], 999.317133347);
    near(out.speeds[1][1], 8.83073294909);
    // 400 steps: ten digits of the values.
    assert!(close(out.speeds[2][6], 172.322049291, 1e-9), "{}", out.speeds[2][6]);
    for (gas, ahead, value) in [(Gas::M2, true, 172.284996037), (Gas::M3, false, 172.280439309)] {
        let l = line(gas, &Mean {}, Some((2000.0, -0.2)), [0.0; 4]);
        let spec = RungeKutta { step: quantity(5e-5), look_ahead: ahead };
        let out = run(&spec, &context(&l, 268.0, 1.0, &START, &[0.02]));
        assert!(close(out.speeds[0][6], value, 1e-9), "{}", out.speeds[0][6]);
    }
}

#[test]
fn start_up_as_published() {
    let l = line(Gas::M1, &Mean {}, Some((2000.0, -0.2)), [0.0; 4]);
    let spec = RungeKutta { step: quantity(1e-6), look_ahead: true };
    let out = run(&spec, &context(&l, 268.0, 1.0, &START, &[0.01, 0.05, 0.1]));
    // First order in the step under gas torque: at 1e-6 the digits given.
    let speeds = [
        [-354.19579, 454.24642, 499.45867, 500.63270, 494.65111, 494.41273, 492.3189],
        [839.7689, 197.5390, 62.9262, 18.0455, -13.5995, -33.6527, -43.1803],
        [568.3755, 238.0855, 173.3407, 87.9283, 16.8237, -33.7895, -60.098],
    ];
    for (row, s) in out.speeds.iter().zip(speeds) {
        assert!(row.iter().zip(s).all(|(a, b)| (a - b).abs() < 3e-4), "{row:?} {s:?}");
    }
    let gas = [[60.49, -1167.78, -1993.03, -2653.72], [190.67, -249.37, -1407.67, -1970.03]];
    for (row, g) in out.gas[1..].iter().zip(gas) {
        assert!(row.iter().zip(g).all(|(a, b)| (a - b).abs() < 0.05), "{row:?} {g:?}");
    }
}

#[test]
fn the_last_cylinder_swings_most() {
    // Peak to peak of the speeds, free and within 0.1 s before 5 s; printed: I7 > I6 > I5 > I4, free and with every motor.
    let swing = |out: &TorsionOut, rows: std::ops::Range<usize>, i: usize| {
        let of = out.speeds[rows].iter().map(|w| w[i]);
        of.clone().fold(f64::NEG_INFINITY, f64::max) - of.fold(f64::INFINITY, f64::min)
    };
    let ordered = |s: &[f64]| s[3] < s[4] && s[4] < s[5] && s[5] < s[6];
    let l = line(Gas::None, &Mean {}, None, [0.0; 4]);
    let times: Vec<f64> = (0..=25_000).map(|i| 4e-6 * f64::from(i)).collect();
    let out = run(&Propagator {}, &context(&l, 268.0, 1.0, &START, &times));
    let free: Vec<f64> = (0..7).map(|i| swing(&out, 0..times.len(), i)).collect();
    assert!(ordered(&free), "{free:?}");
    // The flywheel swings more than the coupling, which the source prints otherwise; it is the smoother one: within the first 20 ms its
    // speed turns round less often.
    assert!(free[2] > free[1], "{free:?}");
    let turns = |i: usize| {
        let w: Vec<f64> = out.speeds[..5000].iter().map(|w| w[i]).collect();
        w.windows(3).filter(|w| (w[1] - w[0]) * (w[2] - w[1]) < 0.0).count()
    };
    assert!(turns(2) < turns(1), "{} {}", turns(2), turns(1));
    for c0 in [500.0, 2000.0, 5000.0] {
        let l = line(Gas::M1, &Mean {}, Some((c0, -1e-4 * c0)), [0.0; 4]);
        let times: Vec<f64> = (0..=1000).map(|i| 4.9 + 1e-4 * f64::from(i)).collect();
        let spec = RungeKutta { step: quantity(5e-5), look_ahead: true };
        let out = run(&spec, &context(&l, 268.0, 1.0, &START, &times));
        let s: Vec<f64> = (0..7).map(|i| swing(&out, 0..times.len(), i)).collect();
        assert!(ordered(&s), "{c0}: {s:?}");
        // Four gas torques of one size.
        let peak = |k: usize| out.gas.iter().map(|g| g[k]).fold(f64::INFINITY, f64::min);
        for k in 1..4 {
            assert!(close(peak(k), peak(0), 0.01), "{c0}: {} {}", peak(k), peak(0));
        }
    }
}

/// Largest and smallest torque of the links and peak-to-peak speed of the nodes over a turn.
fn cycle(out: &TorsionOut, period: f64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let (links, nodes) = (out.mean_torque.len(), out.orders.get(0).angle.len());
    let (mut top, mut bottom) = (vec![f64::NEG_INFINITY; links], vec![f64::INFINITY; links]);
    let mut swing = vec![[f64::INFINITY, f64::NEG_INFINITY]; nodes];
    for s in 0..2880 {
        let at = period * f64::from(s) / 2880.0;
        let mut t = out.mean_torque.clone();
        let mut w = vec![0.0; nodes];
        for o in out.orders.iter() {
            let (sin, cos) = (o.order * at).sin_cos();
            for (t, a) in t.iter_mut().zip(&o.torque) {
                *t += a[0] * cos - a[1] * sin;
            }
            for (w, a) in w.iter_mut().zip(&o.angle) {
                *w -= o.order * out.speed * (a[0] * sin + a[1] * cos);
            }
        }
        for l in 0..links {
            top[l] = f64::max(top[l], t[l]);
            bottom[l] = f64::min(bottom[l], t[l]);
        }
        for (s, w) in swing.iter_mut().zip(w) {
            *s = [s[0].min(w), s[1].max(w)];
        }
    }
    (top, bottom, swing.iter().map(|s| s[1] - s[0]).collect())
}

#[test]
fn steady_vibration_by_orders() {
    let at = |gas: Gas, speed: f64, phases: [f64; 4]| {
        let l = line(gas, &Mean {}, None, phases);
        let out = run(&Orders {}, &context(&l, speed, 200.0, &[], &[]));
        assert_eq!(out.counters["time_steps"], 0);
        out
    };
    // Extremes over a turn, four to five digits.
    let near = |a: &[f64], b: &[f64], tolerance: f64| {
        assert!(a.iter().zip(b).all(|(a, b)| close(*a, *b, tolerance)), "{a:?} {b:?}");
    };
    let out = at(Gas::M1, 285.25, [0.0; 4]);
    let (top, _, swing) = cycle(&out, 2.0 * PI);
    near(&swing, &[0.538, 0.173, 0.311, 0.181, 0.422, 0.660, 0.895], 5e-3);
    near(&top, &[11540.0, 11269.0, 5041.0, 3944.0, 3058.0, 1825.0], 5e-3);
    let (top, ..) = cycle(&at(Gas::M1, 268.77, [0.0; 4]), 2.0 * PI);
    near(&top, &[29291.0, 28903.0, 3633.0, 3667.0, 3219.0, 2017.0], 5e-3);
    let out = at(Gas::M3, 104.720, [0.0; 4]);
    let (top, bottom, _) = cycle(&out, 2.0 * PI);
    near(&top, &[8195.0, 7935.0, 12391.0, 9439.0, 6500.0, 3336.0], 5e-4);
    near(&bottom, &[-5165.0, -5003.0, -6310.0, -5720.0, -4429.0, -2446.0], 5e-4);
    near(&out.mean_torque, &[1722.489, 1722.489, 1722.489, 1291.867, 861.245, 430.622], 2e-6);
    let amplitude: Vec<f64> =
        out.orders.iter().take(4).map(|o| o.torque[2][0].hypot(o.torque[2][1])).collect();
    near(&amplitude, &[3338.0, 4025.0, 5219.0, 1911.0], 5e-4);
    let phases = [0.0, 180.0, 90.0, 270.0].map(f64::to_radians);
    let (top, bottom, _) = cycle(&at(Gas::M3, 104.720, phases), 2.0 * PI);
    near(&top, &[2612.0, 2564.0, 4142.0, 4097.0, 3447.0, 2436.0], 1e-3);
    near(&bottom, &[892.0, 960.0, -1027.0, -3518.0, -2586.0, -1454.0], 1e-3);
}

#[test]
fn orders_are_what_the_time_domain_settles_to() {
    // Gas torques by the mean angle: the periodic motion of `orders` started in itself stays (propagator), and Runge-Kutta with the
    // same torques as a table of harmonics follows it.
    let base = line(Gas::M3, &Mean {}, None, [0.0; 4]);
    let speed = 104.720;
    let steady = run(&Orders {}, &context(&base, speed, 24.0, &[], &[]));
    let mut l = base.clone();
    for t in &mut l.throws {
        t.ends.clear();
    }
    let c = gas_series(&base.throws[0], 24);
    for t in &base.throws {
        let orders = (1..=24)
            .map(|k| gudgeon_torsion::drive::Harmonic {
                order: k as f64,
                amplitude: quantity(c[k].abs()),
                phase: quantity(-c[k].im.atan2(c[k].re)),
                factor: quantity(1.0),
            })
            .collect();
        let drive = gudgeon_torsion::drive::Harmonics { mean: quantity(c[0].re), orders };
        l.drives.push(LineDrive {
            node: t.node,
            phase: 0.0,
            factor: 1.0,
            drive: drive.build().expect("builds"),
        });
    }
    let hold = gudgeon_torsion::drive::Constant { torque: quantity(steady.balance_torque) };
    l.drives.push(LineDrive { node: 0, phase: 0.0, factor: 1.0, drive: hold.build().expect("builds") });
    let motion = |time: f64| {
        let (mut a, mut w) = (steady.mean_angle.clone(), vec![speed; 7]);
        for o in steady.orders.iter() {
            let (sin, cos) = (o.order * speed * time).sin_cos();
            for i in 0..7 {
                let [re, im] = o.angle[i];
                a[i] += re * cos - im * sin;
                w[i] -= o.order * speed * (re * sin + im * cos);
            }
        }
        a.iter_mut().for_each(|a| *a += speed * time);
        (a, w)
    };
    let (angles, speeds) = motion(0.0);
    let times = [0.013, 0.05, 0.2];
    let ctx = TorsionCtx { angles: &angles, ..context(&l, speed, 24.0, &speeds, &times) };
    let exact = run(&Propagator {}, &ctx);
    // The harmonics of the torque are taken at the mean angle; there they differ from the true angle by the twist (1e-3 rad), and
    // the torques by as much of themselves.
    let rk = run(&RungeKutta { step: quantity(2e-5), look_ahead: false }, &ctx);
    for (r, t) in times.iter().enumerate() {
        let (a, w) = motion(*t);
        for i in 0..7 {
            assert!((exact.angles[r][i] - a[i]).abs() < 1e-11, "{} {}", exact.angles[r][i], a[i]);
            assert!((exact.speeds[r][i] - w[i]).abs() < 1e-9, "{} {}", exact.speeds[r][i], w[i]);
            assert!((rk.speeds[r][i] - w[i]).abs() < 5e-2, "{} {}", rk.speeds[r][i], w[i]);
        }
    }
    // Modes, all of them, without the coupling of modes by damping: with light damping the same to some percent; without damping
    // and without order at a resonance the same to rounding.
    let mut bare = base.clone();
    bare.links.iter_mut().zip(crate::common::COMPRESSOR_K).for_each(|(k, stiffness)| {
        *k = crate::common::link(k.nodes[0], k.nodes[1], stiffness, 0.0, 0.0);
    });
    let a = run(&Orders {}, &context(&bare, speed, 24.0, &[], &[]));
    for (modes, tolerance) in [(7, 1e-10), (5, 5e-3)] {
        let spec = Modal { modes, ..Modal::default() };
        let b = run(&spec, &context(&bare, speed, 24.0, &[], &[]));
        for (x, y) in a.orders.iter().zip(b.orders.iter()).take(6) {
            for (p, q) in x.torque.iter().zip(&y.torque) {
                let top = x.torque.iter().map(|t| t[0].hypot(t[1])).fold(0.0, f64::max);
                assert!(
                    (p[0] - q[0]).hypot(p[1] - q[1]) < tolerance * top,
                    "{modes} {} {p:?} {q:?}",
                    x.order
                );
            }
        }
    }
}

#[test]
fn a_free_throw_keeps_its_energy() {
    // One throw alone, 100 rad/s at the dead centre: ω = 100 √(I(0)/I(θ)).
    for (model, quarter) in [(&FirstHarmonic {} as &dyn ThrowInertiaSpec, Some(88.41764)), (&Exact {}, None)]
    {
        let inertia = model.build(&THROW).expect("builds");
        let l = Line {
            nodes: vec![crate::common::node(0.0, 0.0)],
            throws: vec![LineThrow::new(0, 0.0, inertia.clone(), Vec::new())],
            ..Line::default()
        };
        let times: Vec<f64> = (1..40).map(|i| 2e-3 * f64::from(i)).collect();
        let ctx = TorsionCtx {
            line: &l,
            speed: 100.0,
            orders: 1.0,
            period: 2.0 * PI,
            balance: &[1.0],
            angles: &[0.0],
            speeds: &[100.0],
            times: &times,
        };
        let j0 = inertia.inertia(0.0).0;
        for (spec, tolerance) in [
            (&RungeKutta { step: quantity(1e-5), look_ahead: false } as &dyn TorsionSpec, 1e-12),
            // Error control at 1e-9 per step.
            (&Implicit { tolerance: quantity(1e-9) }, 1e-7),
        ] {
            let out = run(spec, &ctx);
            for (a, w) in out.angles.iter().zip(&out.speeds) {
                let exact = 100.0 * (j0 / inertia.inertia(a[0]).0).sqrt();
                assert!(close(w[0], exact, tolerance), "{} {exact}", w[0]);
            }
        }
        if let Some(value) = quarter {
            assert!(close(100.0 * (j0 / inertia.inertia(PI / 2.0).0).sqrt(), value, 1e-7));
        }
    }
}

#[test]
fn harmonic_balance_after_other_speeds_is_that_of_its_own() {
    let l = line(Gas::M3, &Exact {}, None, [0.0, PI, PI / 2.0, 1.5 * PI]);
    let spec = HarmonicBalance { tolerance: quantity(1e-11), rounds: 100 };
    let mut swept = spec.build(&context(&l, 60.0, 24.0, &[], &[])).expect("builds");
    let mut out = TorsionOut::default();
    // From coarse to fine and back over places that are known: guesses between and beyond speeds.
    for speed in [60.0, 62.0, 61.0, 60.5, 61.5, 64.0, 61.5, 62.8] {
        swept.set_speed(speed).expect("a periodic motion has any speed");
        swept.run(&mut out).expect("converges");
        // A good guess leaves few evaluations; none may need as many as a start from nothing took by plain rounds.
        assert!(out.counters["rounds"] <= 8, "{speed}: {}", out.counters["rounds"]);
    }
    let alone = run(&spec, &context(&l, 62.8, 24.0, &[], &[]));
    let largest = alone.orders.iter().map(|o| o.torque[3][0].hypot(o.torque[3][1])).fold(0.0, f64::max);
    for (a, b) in alone.orders.iter().zip(out.orders.iter()) {
        for (a, b) in a.torque.iter().zip(&b.torque) {
            // Both are within the tolerance, which the line magnifies by less than a hundred here.
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9 * largest, "{a:?} {b:?}");
        }
    }
}

#[test]
fn harmonic_balance_is_the_periodic_motion_with_variable_inertia() {
    // 600 rpm, ideal valves, exact inertia: the motion from the orders, started in itself and integrated with all that is
    // nonlinear, comes back after a turn.
    let l = line(Gas::M3, &Exact {}, None, [0.0, PI, PI / 2.0, 1.5 * PI]);
    let speed = 62.8;
    let orders = 40.0;
    let out = run(
        &HarmonicBalance { tolerance: quantity(1e-11), rounds: 200 },
        &context(&l, speed, orders, &[], &[]),
    );
    assert_eq!(out.counters["time_steps"], 0);
    let (mut a, mut w) = (out.mean_angle.clone(), vec![speed; 7]);
    for o in out.orders.iter() {
        for i in 0..7 {
            a[i] += o.angle[i][0];
            w[i] -= o.order * speed * o.angle[i][1];
        }
    }
    let mut driven = l.clone();
    let hold = gudgeon_torsion::drive::Constant { torque: quantity(out.balance_torque) };
    driven.drives.push(LineDrive { node: 0, phase: 0.0, factor: 1.0, drive: hold.build().expect("builds") });
    let turn = [2.0 * PI / speed];
    let ctx = TorsionCtx { angles: &a, ..context(&driven, speed, orders, &w, &turn) };
    let end = run(&Implicit { tolerance: quantity(1e-9) }, &ctx);
    for i in 0..7 {
        // Orders above 40 carry the kinks of the valves: 1e-6 of the torque, seen as 1e-5 rad/s.
        assert!((end.speeds[0][i] - w[i]).abs() < 2e-4, "{} {}", end.speeds[0][i], w[i]);
        assert!((end.angles[0][i] - a[i] - 2.0 * PI).abs() < 2e-5, "{} {}", end.angles[0][i], a[i]);
    }
    // Without variable inertia and with gas by the mean angle it is `orders`; here the gas feels the twist, a thousandth.
    let plain = line(Gas::M3, &Mean {}, None, [0.0; 4]);
    let x = run(&HarmonicBalance::default(), &context(&plain, 104.72, 24.0, &[], &[]));
    let y = run(&Orders {}, &context(&plain, 104.72, 24.0, &[], &[]));
    let (p, ..) = cycle(&x, 2.0 * PI);
    let (q, ..) = cycle(&y, 2.0 * PI);
    for (p, q) in p.iter().zip(&q) {
        assert!(close(*p, *q, 0.02) && (p - q).abs() > 0.0, "{p} {q}");
    }
}

#[test]
fn energy_balances_without_gas() {
    // d/dt(kinetic + elastic) = -ωᵀCω; the loss by Simpson over the closed form.
    let l = line(Gas::None, &Mean {}, None, [0.0; 4]);
    let n = 4000;
    let times: Vec<f64> = (0..=n).map(|i| 0.05 * f64::from(i) / f64::from(n)).collect();
    let out = run(&Propagator {}, &context(&l, 268.0, 1.0, &START, &times));
    let energy = |r: usize| {
        let kinetic: f64 = (0..7).map(|i| 0.5 * l.mean_inertia(i) * out.speeds[r][i].powi(2)).sum();
        let elastic: f64 = (0..6)
            .map(|i| 0.5 * crate::common::COMPRESSOR_K[i] * (out.angles[r][i] - out.angles[r][i + 1]).powi(2))
            .sum();
        kinetic + elastic
    };
    let c0 = inertia_and_damping().1;
    let loss =
        |r: usize| -> f64 { (0..6).map(|i| c0 * (out.speeds[r][i] - out.speeds[r][i + 1]).powi(2)).sum() };
    let h = 0.05 / f64::from(n);
    let lost: f64 = (0..=n as usize)
        .map(|r| {
            loss(r)
                * if r == 0 || r == n as usize {
                    1.0
                } else if r % 2 == 1 {
                    4.0
                } else {
                    2.0
                }
        })
        .sum::<f64>()
        * h
        / 3.0;
    // Simpson: (ωh)⁴/180 with ω h = 2 · 2218 · 1.25e-5.
    assert!(close(energy(0), 6.5e7, 1e-14));
    assert!((energy(0) - energy(n as usize) - lost).abs() < 1e-7 * energy(0));
}

#[test]
fn phasors_are_what_the_lanes_and_the_tree_say() {
    // One order by hand: the first of M3 at 1000 rpm through the tree itself.
    let l = line(Gas::M3, &Mean {}, None, [0.0; 4]);
    let out = run(&Orders {}, &context(&l, 104.72, 3.0, &[], &[]));
    let tree = Tree::new(&l).expect("builds");
    let c = gas_series(&l.throws[0], 3)[1];
    let torque: Vec<Complex> =
        (0..7).map(|p| if tree.node[p] >= 3 { c } else { Complex::default() }).collect();
    let (mut x, mut q) = (torque.clone(), torque.clone());
    let mut work = gudgeon_torsion::tree::Work::new(7);
    let z = Complex::new(0.0, 104.72);
    tree.solve(z, &torque, &mut x, &mut q, gudgeon_torsion::tree::Singular::Refuse, &mut work)
        .expect("damped");
    for p in 0..7 {
        let a = out.orders.get(0).angle[tree.node[p]];
        assert!((x[p].re - a[0]).abs() < 1e-18 && (x[p].im - a[1]).abs() < 1e-18);
    }
}

#[test]
fn a_model_at_another_speed_answers_as_if_it_were_built_there() {
    let l = line(Gas::M3, &Exact {}, Some((2000.0, -20.0)), [0.0, PI, PI / 2.0, 1.5 * PI]);
    let specs: [&dyn TorsionSpec; 3] = [&Orders {}, &Modal::default(), &HarmonicBalance::default()];
    for spec in specs {
        let mut moving = spec.build(&context(&l, 60.0, 12.0, &[], &[])).expect("builds");
        for speed in [60.0, 61.0, 104.72, 40.0] {
            let mut out = TorsionOut::default();
            moving.set_speed(speed).expect("periodic");
            moving.run(&mut out).expect("runs");
            let there = run(spec, &context(&l, speed, 12.0, &[], &[]));
            let scale =
                there.orders.iter().flat_map(|o| o.torque).map(|t| t[0].hypot(t[1])).fold(0.0, f64::max);
            for (a, b) in out.orders.iter().zip(there.orders.iter()) {
                for (a, b) in a.torque.iter().zip(&b.torque) {
                    // Harmonic balance ends at 1e-10 of the exciting torques, which a resonance magnifies some ten times.
                    assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-8 * scale, "{speed}: {a:?} {b:?}");
                }
            }
        }
    }
    let mut time = RungeKutta { step: quantity(1e-4), look_ahead: false }
        .build(&context(&l, 60.0, 12.0, &[60.0; 7], &[0.01]))
        .expect("builds");
    assert!(time.set_speed(61.0).is_err(), "a motion over time has no mean speed");
}

#[test]
fn critical_speeds_are_natural_frequencies_by_orders() {
    let l = line(Gas::M3, &Mean {}, None, [0.0; 4]);
    let mut steady =
        gudgeon_torsion::steady::Steady::new(&context(&l, 100.0, 12.0, &[], &[])).expect("builds");
    let frequencies = steady.frequencies(40).expect("converges");
    let (from, to) = (30.0, 130.0);
    let found = steady.critical_speeds(&[3.0, 8.0], from, to, 10).expect("converges");
    let mut expected: Vec<(f64, usize)> = Vec::new();
    for o in [3.0, 8.0] {
        expected.extend(frequencies.iter().enumerate().map(|(m, w)| (w / o, m + 1)));
    }
    expected.retain(|(w, _)| *w >= from && *w <= to);
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(found.len(), expected.len());
    for (c, (speed, mode)) in found.iter().zip(expected) {
        assert_eq!(c.mode, mode);
        // Counts and QL iteration agree to rounding of the largest eigenvalue.
        assert!(close(c.speed, speed, 1e-12), "{} {speed}", c.speed);
    }
}

#[test]
fn throws_that_are_alike_excite_as_throws_of_their_own() {
    let own = line(Gas::M3, &Exact {}, None, [0.0, 2.0, 1.0, 0.5]);
    let mut shared = own.clone();
    let first = own.throws[0].clone();
    shared.throws = own.throws.iter().map(|t| first.alike(t.node, t.phase)).collect();
    assert!(shared.throws.iter().all(|t| t.is_like(&first)) && !own.throws[1].is_like(&first));
    // The same numbers, also of fewer orders than were asked for first.
    for orders in [24.0, 7.0] {
        let [a, b] = [&own, &shared].map(|l| gudgeon_torsion::forcing::Excitation::new(l, 100.0, orders));
        assert_eq!(a, b);
    }
    // So is the motion with all that is not linear, but for the interpolants that they share: these are right to 1e-13 of their maximum.
    let [a, b] = [&own, &shared].map(|l| {
        let out = run(&HarmonicBalance::default(), &context(l, 100.0, 12.0, &[], &[]));
        out.orders.iter().flat_map(|o| o.torque).collect::<Vec<_>>()
    });
    let largest = a.iter().map(|z| z[0].hypot(z[1])).fold(0.0, f64::max);
    let miss = a.iter().zip(&b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
    // Of four throws, magnified by resonances nearby.
    assert!(a.len() == b.len() && miss < 1e-11 * largest, "{miss:e} of {largest:e}");
}

#[test]
fn orders_side_by_side_are_those_of_one_after_the_other() {
    // Eleven orders: a full row of lanes and one with some left over.
    let l = line(Gas::M3, &Exact {}, None, [0.0, 2.0, 1.0, 0.5]);
    let ctx = context(&l, 100.0, 11.0, &[], &[]);
    let found = run(&Orders {}, &ctx).orders;
    let mut steady = gudgeon_torsion::steady::Steady::new(&ctx).expect("builds");
    let orders = steady.excitation.orders.clone();
    assert!(found.len() == orders.len() && orders.len() == 11);
    for (f, o) in found.iter().zip(&orders) {
        let exact = steady.respond(o).expect("no resonance");
        assert!(f.order == exact.order && f.excitation == exact.excitation);
        let largest = |of: &[[f64; 2]]| of.iter().map(|z| z[0].hypot(z[1])).fold(0.0, f64::max);
        for (a, b) in [(&f.angle, &exact.angle), (&f.torque, &exact.torque)] {
            let miss = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
            // Rounding, times the magnification of resonances nearby.
            assert!(miss <= 1e-12 * largest(b), "order {}: {miss:e}", f.order);
        }
        for (a, b) in f.heat.iter().zip(&exact.heat) {
            assert!(close(*a, *b, 1e-11), "heat of order {}: {a} {b}", f.order);
        }
    }
}
