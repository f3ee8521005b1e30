//! Cost and error of shaft lines: eigenvalues and the forced sweep of an engine of nine inertias, growth with the number of inertias, and
//! free vibration by closed form against the published Runge-Kutta scheme.
//!
//! Every figure stands beside its error. `--json` prints the figures of the race alone (for `race_torsion.py`), everything else goes to
//! criterion after the table.
#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]
#![allow(clippy::print_stdout, missing_docs)]

use std::hint::black_box;
use std::time::Instant;

use criterion::Criterion;
use gudgeon_core::kinds::{CouplingSpec, Line, LineLink, LineNode, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::quantity::quantity;
use gudgeon_torsion::coupling::Linear;
use gudgeon_torsion::cycle::Cycle;
use gudgeon_torsion::eigen::{natural_frequencies, roots, shapes};
use gudgeon_torsion::sweep::{LANES, Sweep};
use gudgeon_torsion::torsion::{Implicit, Propagator, RungeKutta};
use gudgeon_torsion::tree::Tree;

const J: [f64; 9] = [0.120, 0.030, 0.055, 0.055, 0.055, 0.055, 0.055, 0.055, 1.60];
const K: [f64; 8] = [0.08e6, 0.90e6, 1.35e6, 1.35e6, 1.35e6, 1.35e6, 1.35e6, 1.80e6];
const C: [f64; 8] = [25.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 2.0];
const C_ABS: [f64; 9] = [0.0, 0.0, 1.5, 1.5, 1.5, 1.5, 1.5, 1.5, 0.0];
/// Frequencies \[rad/s\] without the rigid mode, 17 digits of a solution with 25.
const OMEGA: [f64; 8] = [
    691.6327859407956,
    1440.440080366365,
    3440.1628614475494,
    5307.914956291062,
    6799.924756648763,
    8031.322137571369,
    9043.232890181248,
    9691.269760304264,
];
/// Order 3 with 160 N m per throw at 2100 rpm: angle of the first inertia \[rad\]; order 6 with 55 N m: torque of the last shaft \[N m\].
const ORDER_3: f64 = 6.276_024_914_430_47e-3;
const ORDER_6: f64 = 837.528_520_168_25;
const FIRING: [f64; 6] = [0.0, 480.0, 240.0, 600.0, 120.0, 360.0];

fn line(j: &[f64], k: &[f64], c: &[f64], c_abs: &[f64]) -> Line {
    let node = |(j, c): (&f64, &f64)| LineNode {
        name: String::new(),
        inertia: *j,
        damping: *c,
        ground: 0.0,
        ratio: 1.0,
    };
    let link = |(i, (k, c)): (usize, (&f64, &f64))| LineLink {
        name: String::new(),
        nodes: [i, i + 1],
        coupling: Linear { stiffness: quantity(*k), damping: quantity(*c), loss_factor: quantity(0.0) }
            .build()
            .expect("builds"),
    };
    Line {
        nodes: j.iter().zip(c_abs).map(node).collect(),
        links: k.iter().zip(c).enumerate().map(link).collect(),
        ..Line::default()
    }
}

fn torque(tree: &Tree, order: f64, amplitude: f64) -> Vec<[f64; 2]> {
    (0..tree.len())
        .map(|p| {
            let i = tree.node[p];
            if !(2..8).contains(&i) {
                return [0.0; 2];
            }
            let a = -order * FIRING[i - 2].to_radians();
            [amplitude * a.cos(), amplitude * a.sin()]
        })
        .collect()
}

/// 401 speeds from 800 to 4000 rpm, 24 orders from a half to twelve; returns the sum of all angles, so that nothing is left out.
fn sweep(tree: &Tree, orders: &[(f64, Vec<[f64; 2]>)], work: &mut Sweep, out: &mut [[f64; 2]]) {
    let n = tree.len();
    let speed = |s: usize| (800.0 + 8.0 * s as f64) * std::f64::consts::PI / 30.0;
    for (k, (order, torque)) in orders.iter().enumerate() {
        let mut s = 0;
        while s < 401 {
            let omega = std::array::from_fn(|l| order * speed((s + l).min(400)));
            work.solve(tree, &omega, torque).expect("damped");
            for l in 0..LANES.min(401 - s) {
                let row = &mut out[(k * 401 + s + l) * n..][..n];
                for (r, a) in row.iter_mut().zip(&work.angle) {
                    *r = [a[0][l], a[1][l]];
                }
            }
            s += LANES;
        }
    }
}

/// Median seconds of `f`, each of `rounds` timings over `times` calls.
fn median(rounds: usize, times: usize, mut f: impl FnMut()) -> f64 {
    let mut t: Vec<f64> = (0..rounds)
        .map(|_| {
            let begin = Instant::now();
            for _ in 0..times {
                f();
            }
            begin.elapsed().as_secs_f64() / times as f64
        })
        .collect();
    t.sort_by(f64::total_cmp);
    t[rounds / 2]
}

fn compressor() -> Line {
    let i0 = 8.422_684;
    let c = 2.0 * 0.03 * (8e6_f64 * i0).sqrt();
    line(&[130.0, 10.0, 310.0, i0, i0, i0, i0], &[8e6, 40e6, 8e6, 8e6, 8e6, 8e6], &[c; 6], &[0.0; 7])
}

fn free(line: &Line, spec: &dyn TorsionSpec, times: &[f64]) -> TorsionOut {
    let mut speeds = [0.0; 7];
    speeds[0] = 1000.0;
    let ctx = TorsionCtx {
        line,
        speed: 268.0,
        orders: 1.0,
        period: 2.0 * std::f64::consts::PI,
        balance: &[1.0],
        angles: &[0.0; 7],
        speeds: &speeds,
        times,
    };
    let mut out = TorsionOut::default();
    spec.build(&ctx).expect("builds").run(&mut out).expect("runs");
    out
}

fn race() -> serde_json::Value {
    let engine = line(&J, &K, &C, &C_ABS);
    let tree = Tree::new(&engine).expect("builds");
    let n = tree.len();
    // Eigenvalues.
    let eigen = median(9, 20_000, || {
        black_box(natural_frequencies(black_box(&tree), 20).expect("found"));
    });
    let found = natural_frequencies(&tree, 20).expect("found");
    let eigen_error = found[1..].iter().zip(OMEGA).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    let normal = shapes(&tree, &found);
    let damped = median(9, 2000, || {
        black_box(roots(black_box(&tree), &found, &normal).expect("found"));
    });
    let with_shapes = median(9, 2000, || {
        let w = natural_frequencies(black_box(&tree), 20).expect("found");
        black_box(shapes(&tree, &w));
    });
    // Sweep.
    let orders: Vec<(f64, Vec<[f64; 2]>)> = (1..=24)
        .map(|k| {
            let o = 0.5 * f64::from(k);
            (o, torque(&tree, o, if o == 3.0 { 160.0 } else { 55.0 }))
        })
        .collect();
    let mut work = Sweep::new(n);
    let mut out = vec![[0.0; 2]; 24 * 401 * n];
    let forced = median(9, 20, || sweep(black_box(&tree), &orders, &mut work, black_box(&mut out)));
    // 2100 rpm is not among the speeds; the error is measured there.
    let at = |order: f64, amplitude: f64, work: &mut Sweep| {
        let w = order * 2100.0 * std::f64::consts::PI / 30.0;
        work.solve(&tree, &[w; LANES], &torque(&tree, order, amplitude)).expect("damped");
    };
    at(3.0, 160.0, &mut work);
    let p = tree.position[0];
    let a = (work.angle[p][0][0].hypot(work.angle[p][1][0]) / ORDER_3 - 1.0).abs();
    at(6.0, 55.0, &mut work);
    let t = work.transmitted[n - 2];
    let b = (t[0][0].hypot(t[1][0]) / ORDER_6 - 1.0).abs();
    // Free vibration to 0.1 s: closed form against the published scheme, at its own error and at a tenth of it.
    let line = compressor();
    let exact = free(&line, &Propagator {}, &[0.1]);
    let closed = median(9, 200, || {
        black_box(free(&line, &Propagator {}, &[0.1]));
    });
    // Rows of the published run: 5 s every 1 ms.
    let rows: Vec<f64> = (1..=5000).map(|k| 1e-3 * f64::from(k)).collect();
    let closed_rows = median(5, 2, || {
        black_box(free(&line, &Propagator {}, &rows));
    });
    let kutta: Vec<serde_json::Value> = [1e-3, 1e-4, 1e-5, 2e-6]
        .iter()
        .map(|&h| {
            let spec = RungeKutta { step: quantity(h), look_ahead: false };
            let out = free(&line, &spec, &[0.1]);
            let error = (0..7).map(|i| (out.speeds[0][i] - exact.speeds[0][i]).abs()).fold(0.0, f64::max);
            let seconds = median(5, ((1e-3 / h) as usize).clamp(1, 20), || {
                black_box(free(&line, &spec, &[0.1]));
            });
            let whole = if h >= 1e-5 {
                median(3, 1, || {
                    black_box(free(&line, &spec, &rows));
                })
            } else {
                f64::NAN
            };
            serde_json::json!({ "step": h, "error": error, "seconds": seconds, "seconds_5_s": whole })
        })
        .collect();
    serde_json::json!({
        "eigenvalues": { "seconds": eigen, "error": eigen_error },
        "eigenvalues_and_shapes": { "seconds": with_shapes },
        "damped": { "seconds": damped },
        "sweep": { "seconds": forced, "error": a.max(b), "checksum": out.iter().map(|x| x[0] + x[1]).sum::<f64>() },
        "closed_form": { "seconds": closed, "seconds_5_s": closed_rows },
        "runge_kutta": kutta,
    })
}

/// Nanoseconds per inertia of the forced solution, for chains and for trees of 200 branches.
fn growth() {
    println!("{:>28} {:>9} {:>12} {:>14}", "line", "inertias", "us/solve", "ns/inertia");
    let report = |name: &str, line: &Line| {
        let tree = Tree::new(line).expect("builds");
        let n = tree.len();
        let f: Vec<[f64; 2]> = (0..n).map(|i| [(i as f64).sin(), 0.5]).collect();
        let omega: [f64; LANES] = std::array::from_fn(|l| 100.0 * (l + 1) as f64);
        let mut work = Sweep::new(n);
        let t = median(7, (200_000 / n).max(1), || {
            work.solve(black_box(&tree), &omega, &f).expect("damped");
        }) / LANES as f64;
        println!("{name:>28} {n:>9} {:>12.3} {:>14.2}", 1e6 * t, 1e9 * t / n as f64);
    };
    for n in [10_u32, 100, 1000, 10_000] {
        let j: Vec<f64> = (0..n).map(|i| 0.1 + 0.05 * f64::from(i).sin()).collect();
        let k: Vec<f64> = (1..n).map(|i| 1e6 * (1.5 + (0.7 * f64::from(i)).cos())).collect();
        let m = n as usize;
        report("chain", &line(&j, &k, &vec![3.0; m - 1], &vec![0.1; m]));
    }
    for depth in [1_usize, 5, 50] {
        let mut tree = line(&[5.0], &[], &[], &[1.0]);
        for _ in 0..200 {
            let mut at = 0;
            for _ in 0..depth {
                let m = tree.nodes.len();
                let part = line(&[1.0, 0.05], &[1e5], &[2.0], &[0.0, 0.01]);
                tree.nodes.push(part.nodes[1].clone());
                tree.links.push(LineLink { nodes: [at, m], ..part.links[0].clone() });
                at = m;
            }
        }
        report(&format!("200 branches of {depth}"), &tree);
    }
}

/// Microseconds per step and inertia of the implicit method over time: a chain hit at its end.
fn growth_in_time() {
    println!(
        "{:>28} {:>9} {:>7} {:>12} {:>14}",
        "implicit, 0.05 s", "inertias", "steps", "us/step", "ns/inertia"
    );
    for n in [10_usize, 100, 1000, 4000] {
        let j: Vec<f64> = (0..n).map(|i| 0.1 + 0.05 * (i as f64).sin()).collect();
        let k: Vec<f64> = (1..n).map(|i| 1e6 * (1.5 + (0.7 * i as f64).cos())).collect();
        let chain = line(&j, &k, &vec![30.0; n - 1], &vec![0.1; n]);
        let mut speeds = vec![100.0; n];
        speeds[0] = 120.0;
        let ctx = TorsionCtx {
            line: &chain,
            speed: 100.0,
            orders: 1.0,
            period: 2.0 * std::f64::consts::PI,
            balance: &[1.0],
            angles: &vec![0.0; n],
            speeds: &speeds,
            times: &[0.05],
        };
        let spec = Implicit { tolerance: quantity(1e-6) };
        let mut steps = 0;
        let t = median(3, 1, || {
            let mut out = TorsionOut::default();
            spec.build(&ctx).expect("builds").run(&mut out).expect("runs");
            steps = out.counters["time_steps"] + out.counters["rejected"];
        });
        let each = t / steps as f64;
        println!("{:>28} {n:>9} {steps:>7} {:>12.2} {:>14.1}", "", 1e6 * each, 1e9 * each / n as f64);
    }
}

fn main() {
    let json = std::env::args().any(|a| a == "--json");
    let figures = race();
    if json {
        println!("{figures}");
        return;
    }
    println!("{figures:#}");
    growth();
    growth_in_time();
    if std::env::args().any(|a| a == "--table") {
        return;
    }
    let mut c = Criterion::default().configure_from_args();
    let tree = Tree::new(&line(&J, &K, &C, &C_ABS)).expect("builds");
    // Torques that decay as those of gas do, with a resonance at order 8: other phases every time.
    let orders: Vec<f64> = (1..=24).map(f64::from).collect();
    let sizes: Vec<f64> = orders.iter().map(|o| o.powi(-2) / (1.0 - (o / 8.0).powi(2)).hypot(0.05)).collect();
    let mut cycle = Cycle::new(&orders, 2.0 * std::f64::consts::PI);
    let (mut turn, mut re, mut im) = (0.0, [0.0; 24], [0.0; 24]);
    c.bench_function("torsion/extremes_of_24_orders", |b| {
        b.iter(|| {
            turn += 0.1;
            for (k, size) in sizes.iter().enumerate() {
                let (sin, cos) = (turn * sizes[(7 * k) % 24].sqrt() + (k * k) as f64).sin_cos();
                (re[k], im[k]) = (size * cos, size * sin);
            }
            cycle.extremes(0.0, [&re, &im])
        });
    });
    c.bench_function("torsion/eigenvalues_9", |b| b.iter(|| natural_frequencies(black_box(&tree), 20)));
    c.final_summary();
}
