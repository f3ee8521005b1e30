//! Motion over time of lines with rigid links, gears, many inertias and dampers of fluid alone.

use gudgeon_core::kinds::*;
use gudgeon_core::quantity::quantity;
use gudgeon_torsion::coupling::{LoadDependent, Progressive};
use gudgeon_torsion::drive::{Constant, Harmonic, Harmonics};
use gudgeon_torsion::torsion::{Implicit, Modal, Orders, Propagator, RungeKutta};
use std::f64::consts::PI;

use crate::common::compressor::{THROW, run};
use crate::common::{chain, link, node};

fn context<'a>(line: &'a Line, start: [&'a [f64]; 2], times: &'a [f64]) -> TorsionCtx<'a> {
    TorsionCtx {
        line,
        speed: 50.0,
        orders: 6.0,
        period: 2.0 * PI,
        balance: &[1.0],
        angles: start[0],
        speeds: start[1],
        times,
    }
}

fn drive(node: usize, spec: &dyn DriveSpec) -> LineDrive {
    LineDrive { node, phase: 0.0, factor: 1.0, drive: spec.build().expect("builds") }
}

/// Motor, rigid flange of no inertia, shaft, pinion, rigid mesh with a wheel of speed -0.4, shaft, load with a throw; and the
/// same with the rigid parts made one by hand.
fn geared() -> (Line, Line) {
    let throw = |node: usize| {
        LineThrow::new(
            node,
            0.3,
            gudgeon_torsion::throw_inertia::Exact {}.build(&THROW).expect("builds"),
            Vec::new(),
        )
    };
    let rigid = f64::INFINITY;
    let mut full = chain(
        &[3.0, 0.0, 0.5, 2.0, 4.0],
        &[rigid, 2e4, rigid, 9e4],
        &[0.0, 6.0, 0.0, 9.0],
        &[0.1, 0.0, 0.2, 0.0, 0.3],
    );
    for i in [3, 4] {
        full.nodes[i].ratio = -0.4;
    }
    full.throws.push(throw(4));
    let order = |order: f64| Harmonic {
        order,
        amplitude: quantity(300.0),
        phase: quantity(0.5),
        factor: quantity(1.0),
    };
    let wheel = Harmonics { mean: quantity(-40.0), orders: vec![order(2.5)] };
    full.drives.push(drive(0, &Constant { torque: quantity(100.0) }));
    full.drives.push(drive(3, &wheel));
    // One inertia for motor and flange; pinion with the wheel's inertia, drag and torque at its own speed.
    let mut own =
        chain(&[3.0, 0.5 + 0.16 * 2.0, 4.0], &[2e4, 9e4 * 0.16], &[6.0, 9.0 * 0.16], &[0.1, 0.2, 0.3]);
    own.nodes[2].ratio = -0.4;
    own.links[1] = link(2, 1, 9e4, 9.0, 0.0);
    own.throws.push(throw(2));
    own.drives.push(drive(0, &Constant { torque: quantity(100.0) }));
    let turned = Harmonic {
        order: 1.0,
        amplitude: quantity(-0.4 * 300.0),
        phase: quantity(-0.5),
        factor: quantity(1.0),
    };
    own.drives.push(drive(1, &Harmonics { mean: quantity(0.4 * 40.0), orders: vec![turned] }));
    (full, own)
}

#[test]
fn rigid_links_and_gears_move_as_one() {
    let (full, own) = geared();
    let start = [50.0, 50.0, 55.0, -22.0, -21.0];
    let times: Vec<f64> = (0..60).map(|i| 0.004 * f64::from(i)).collect();
    for (spec, tolerance) in [
        (&Implicit { tolerance: quantity(1e-9) } as &dyn TorsionSpec, 1e-6),
        (&RungeKutta { step: quantity(1e-4), look_ahead: false }, 1e-12),
    ] {
        let a = run(spec, &context(&full, [&[0.0; 5], &start], &times));
        let b = run(spec, &context(&own, [&[0.0; 3], &[50.0, 55.0, -21.0]], &times));
        for r in 0..times.len() {
            let (x, y) = (&a.speeds[r], &b.speeds[r]);
            for (i, exact) in [(0, y[0]), (1, y[0]), (2, y[1]), (3, -0.4 * y[1]), (4, y[2])] {
                assert!((x[i] - exact).abs() < 60.0 * tolerance, "{r} {i}: {} {exact}", x[i]);
            }
            // The flange without inertia carries what the shaft behind it does.
            let (p, q) = (&a.torque[r], &b.torque[r]);
            let top = 2e3;
            assert!((p[0] - p[1]).abs() < 1e-9 * top && (p[1] - q[0]).abs() < 50.0 * tolerance * top);
        }
    }
    // The mesh: what is left of the pinion's torques, by differences of its speed over 20 us.
    let h = 2e-5;
    let times: Vec<f64> = (0..5).map(|i| 0.1 + h * f64::from(i)).collect();
    let spec = RungeKutta { step: quantity(h), look_ahead: false };
    let a = run(&spec, &context(&full, [&[0.0; 5], &start], &times));
    let w = |r: usize| a.speeds[r][2];
    let rate = (8.0 * (w(3) - w(1)) - (w(4) - w(0))) / (12.0 * h);
    let mesh = a.torque[2][1] - 0.2 * w(2) - 0.5 * rate;
    assert!((a.torque[2][2] / mesh - 1.0).abs() < 1e-7, "{} {mesh}", a.torque[2][2]);
    // A start that the rigid flange cannot have.
    let error =
        Implicit::default().build(&context(&full, [&[0.0; 5], &[50.0, 49.0, 55.0, -22.0, -21.0]], &[1.0]));
    assert!(error.expect_err("refused").to_string().contains("rigid"));
}

#[test]
fn closed_form_with_rigid_links_is_the_merged_line() {
    let rigid = f64::INFINITY;
    let mut full = chain(&[1.0, 0.0, 0.7, 2.0], &[3e4, rigid, 5e4], &[4.0, 0.0, 7.0], &[]);
    let mut own = chain(&[1.0, 0.7, 2.0], &[3e4, 5e4], &[4.0, 7.0], &[]);
    for (l, at) in [(&mut full, 3), (&mut own, 2)] {
        let order =
            Harmonic { order: 3.0, amplitude: quantity(50.0), phase: quantity(0.1), factor: quantity(1.0) };
        l.drives.push(drive(at, &Harmonics { mean: quantity(10.0), orders: vec![order] }));
    }
    let times: Vec<f64> = (0..40).map(|i| 0.003 * f64::from(i)).collect();
    let a = run(&Propagator {}, &context(&full, [&[0.0; 4], &[60.0, 50.0, 50.0, 45.0]], &times));
    let b = run(&Propagator {}, &context(&own, [&[0.0; 3], &[60.0, 50.0, 45.0]], &times));
    for r in 0..times.len() {
        for (i, j) in [(0, 0), (1, 1), (2, 1), (3, 2)] {
            // Rounding of sums of modes with a spread of a hundred.
            assert!((a.speeds[r][i] - b.speeds[r][j]).abs() < 1e-10, "{r} {i}");
            assert!((a.angles[r][i] - b.angles[r][j]).abs() < 1e-11, "{r} {i}");
        }
        assert!(
            (a.torque[r][0] - a.torque[r][1]).abs() < 1e-8,
            "the flange has no inertia: {:?}",
            a.torque[r]
        );
        assert!((a.torque[r][2] - b.torque[r][1]).abs() < 1e-7);
    }
    // Modes: all of them and no damping, a rigid link among them, are the orders.
    let bare = |mut l: Line| {
        l.links = l
            .links
            .iter()
            .map(|k| link(k.nodes[0], k.nodes[1], k.coupling.linear(0.0, 0.0).stiffness, 0.0, 0.0))
            .collect();
        l
    };
    let line = bare(full);
    let x = run(&Modal::default(), &context(&line, [&[], &[]], &[]));
    let y = run(&Orders {}, &context(&line, [&[], &[]], &[]));
    for (p, q) in x.orders.get(0).torque.iter().zip(&y.orders.get(0).torque) {
        assert!((p[0] - q[0]).abs() < 1e-11 * 50.0 && (p[1] - q[1]).abs() < 1e-11 * 50.0, "{p:?} {q:?}");
    }
}

#[test]
fn what_has_no_meaning_in_time_is_refused_with_a_way_out() {
    let refused = |line: &Line, spec: &dyn TorsionSpec| {
        let n = line.nodes.len();
        let speeds = vec![50.0; n];
        let angles = vec![0.0; n];
        let e = spec.build(&context(line, [&angles, &speeds], &[1.0])).expect_err("refused");
        (e.field.clone(), format!("{e:?}"))
    };
    let implicit = Implicit::default();
    let mut line = chain(&[1.0, 2.0, 1.0], &[1e4, 2e4], &[], &[]);
    line.links[1] = link(1, 2, 2e4, 0.0, 0.1);
    let step = RungeKutta { step: quantity(1e-5), look_ahead: false };
    for spec in [&implicit as &dyn TorsionSpec, &step, &Propagator {}] {
        let (field, text) = refused(&line, spec);
        assert!(field == "links.1" && text.contains("harmonic") && text.contains("eta k/omega"), "{text}");
    }
    // A dynamic stiffness, also where the loss at rest is zero.
    let rubber = LoadDependent {
        mean_torque: vec![0.0, 1e3],
        stiffness: vec![1e4, 2e4],
        relative_damping: vec![0.0, 1.0],
        heat_factor: quantity(1.0),
    };
    line.links[1].coupling = rubber.build().expect("builds");
    assert_eq!(refused(&line, &implicit).0, "links.1");
    // An inertia of zero between two springs.
    let line = chain(&[1.0, 0.0, 1.0], &[1e4, 2e4], &[], &[]);
    let (field, text) = refused(&line, &implicit);
    assert!(field == "inertias.1" && text.contains("1/k1 + 1/k2"), "{text}");
    // A damper of fluid alone: no closed form; over time and by modes it is as good as any other.
    let mut line = chain(&[1.0, 2.0, 0.4], &[1e4, 0.0], &[5.0, 30.0], &[]);
    assert_eq!(refused(&line, &Propagator {}).0, "links.1");
    let out = run(&implicit, &context(&line, [&[0.0; 3], &[60.0, 50.0, 40.0]], &[3.0]));
    let common = (60.0 + 2.0 * 50.0 + 0.4 * 40.0) / 3.4;
    // The slip dies with c (1/J₁ + 1/J₂), within 3 s to rounding; the error of the method is left.
    assert!(out.speeds[0].iter().all(|w| (w - common).abs() < 1e-4), "{:?} {common}", out.speeds[0]);
    line.links[1] = link(1, 2, 0.0, 0.0, 0.0);
    let order =
        Harmonic { order: 2.0, amplitude: quantity(9.0), phase: quantity(0.0), factor: quantity(1.0) };
    for at in [0, 2] {
        line.drives.push(drive(at, &Harmonics { mean: quantity(0.0), orders: vec![order.clone()] }));
    }
    line.links[0] = link(0, 1, 1e4, 0.0, 0.0);
    let x = run(&Modal { modes: 3, ..Modal::default() }, &context(&line, [&[], &[]], &[]));
    let y = run(&Orders {}, &context(&line, [&[], &[]], &[]));
    for (p, q) in x.orders.get(0).angle.iter().zip(&y.orders.get(0).angle) {
        assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-12 * q[0].hypot(q[1]), "{p:?} {q:?}");
    }
}

#[test]
fn a_thousand_inertias_over_time() {
    // A stiff chain with a branch of ten at every hundredth and a progressive coupling in its middle.
    let n = 1000;
    let j: Vec<f64> = (0..n).map(|i| 0.5 + 0.2 * (i as f64).sin()).collect();
    let k: Vec<f64> = (0..n - 1).map(|i| 1e6 * (1.5 + (0.7 * i as f64).cos())).collect();
    let mut line = chain(&j, &k, &vec![30.0; n - 1], &[]);
    for b in 0..10 {
        let m = line.nodes.len();
        line.nodes.push(node(2.0, 0.0));
        line.links.push(link(100 * b + 50, m, 2e5, 20.0, 0.0));
    }
    let law = Progressive {
        stiffness: quantity(1e6),
        nominal_torque: quantity(1e4),
        gain: quantity(2.0),
        damping: quantity(30.0),
    };
    line.links[500].coupling = law.build().expect("builds");
    let size = line.nodes.len();
    let (angles, speeds): (Vec<f64>, Vec<f64>) =
        (vec![0.0; size], (0..size).map(|i| if i < 20 { 60.0 } else { 50.0 }).collect());
    let times = [0.005, 0.01];
    let a = run(&Implicit { tolerance: quantity(1e-7) }, &context(&line, [&angles, &speeds], &times));
    // Highest mode about √(4 · 2.5e6/0.3) = 5.8e3 rad/s: 10 us is a tenth of a radian.
    let b = run(
        &RungeKutta { step: quantity(1e-5), look_ahead: false },
        &context(&line, [&angles, &speeds], &times),
    );
    let momentum = |w: &[f64]| w.iter().zip(&line.nodes).map(|(w, n)| w * n.inertia).sum::<f64>();
    for r in 0..2 {
        // The torques of the links are internal: elimination keeps that to rounding, step by step.
        assert!((momentum(&a.speeds[r]) / momentum(&speeds) - 1.0).abs() < 1e-12);
        for (x, y) in a.speeds[r].iter().zip(&b.speeds[r]) {
            // Tolerance times the steps, against swings of ten.
            assert!((x - y).abs() < 2e-4, "{x} {y}");
        }
    }
    assert!(a.counters["time_steps"] < 400, "{:?}", a.counters);
}
