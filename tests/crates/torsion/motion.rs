//! Motion over time: recorded torques against the laws, closed form against steps, starts that cannot be.

use crate::common::compressor::run;
use crate::common::{chain, link, node};
use gudgeon_core::kinds::*;
use gudgeon_core::quantity::quantity;
use gudgeon_torsion::coupling::Progressive;
use gudgeon_torsion::drive::{Harmonic, Harmonics, Linear, PowerLaw};
use gudgeon_torsion::torsion::{Implicit, Propagator, RungeKutta};
use std::f64::consts::PI;

fn context<'a>(line: &'a Line, start: [&'a [f64]; 2], times: &'a [f64]) -> TorsionCtx<'a> {
    TorsionCtx {
        line,
        speed: 50.0,
        orders: 10.0,
        period: 4.0 * PI,
        balance: &[1.0],
        angles: start[0],
        speeds: start[1],
        times,
    }
}

fn drive(node: usize, factor: f64, phase: f64, spec: &dyn DriveSpec) -> LineDrive {
    LineDrive { node, phase, factor, drive: spec.build().expect("builds") }
}

/// A motor with a straight torque-speed line, a gear to a shaft that turns backwards, a branch, drag, and a pulsating load.
fn geared() -> Line {
    let mut line = chain(&[2.0, 0.5, 0.2, 1.0], &[3e3, 5e4, 2e3], &[4.0, 6.0, 3.0], &[0.2, 0.0, 0.1, 0.3]);
    line.nodes[2].ratio = -2.5;
    line.nodes[3].ratio = -2.5;
    line.nodes.push(node(0.7, 0.4));
    line.links.push(link(4, 1, 1e3, 2.0, 0.0));
    let motor = Linear { intercept: Some(quantity(900.0)), slope: Some(quantity(-12.0)), rated: None };
    let order =
        Harmonic { order: 1.5, amplitude: quantity(60.0), phase: quantity(0.4), factor: quantity(1.0) };
    let load = Harmonics { mean: quantity(100.0), orders: vec![order] };
    line.drives = vec![drive(0, 1.0, 0.0, &motor), drive(4, -1.0, 0.2, &load)];
    line
}

const SPEEDS: [f64; 5] = [55.0, 50.0, -125.0, -120.0, 48.0];
const ANGLES: [f64; 5] = [0.1, 0.0, 0.02, 0.0, -0.05];

/// Every recorded torque is that of its law at the recorded motion, and momentum changes by what acts.
fn torques_are_those_of_the_laws(line: &Line, out: &TorsionOut) {
    for r in 0..out.times.len() {
        for (l, torque) in line.links.iter().zip(&out.torque[r]) {
            let [a, b] = l.nodes;
            let gear = line.nodes[a].ratio / line.nodes[b].ratio;
            let twist = out.angles[r][a] - gear * out.angles[r][b];
            let rate = out.speeds[r][a] - gear * out.speeds[r][b];
            let law = l.coupling.torque(twist, rate).torque;
            assert!((torque - law).abs() < 1e-9 * (1.0 + law.abs()), "{r} {}: {torque} {law}", l.name);
        }
    }
}

#[test]
fn recorded_torques_are_those_of_the_laws() {
    let mut line = geared();
    let law = Progressive {
        stiffness: quantity(2e3),
        nominal_torque: quantity(300.0),
        gain: quantity(4.0),
        damping: quantity(3.0),
    };
    line.links[2].coupling = law.build().expect("builds");
    let fan = PowerLaw { torque: quantity(50.0), speed: quantity(100.0), exponent: quantity(2.0) };
    line.drives.push(drive(3, -1.0, 0.0, &fan));
    let times: Vec<f64> = (0..30).map(|i| 0.01 * f64::from(i)).collect();
    let ctx = context(&line, [&ANGLES, &SPEEDS], &times);
    let a = run(&Implicit { tolerance: quantity(1e-9) }, &ctx);
    let b = run(&RungeKutta { step: quantity(2e-5), look_ahead: false }, &ctx);
    torques_are_those_of_the_laws(&line, &a);
    torques_are_those_of_the_laws(&line, &b);
    for r in 0..times.len() {
        for i in 0..5 {
            // Tolerance over some hundred steps; the fourth power of 2e-5 times 500 rad/s is 1e-8.
            assert!(
                (a.speeds[r][i] - b.speeds[r][i]).abs() < 2e-5,
                "{r} {i}: {} {}",
                a.speeds[r][i],
                b.speeds[r][i]
            );
            assert!((a.angles[r][i] - b.angles[r][i]).abs() < 2e-6, "{r} {i}");
        }
        for (d, (x, t)) in line.drives.iter().zip(a.drive[r].iter().zip(&b.drive[r])) {
            let i = d.node;
            let torque = d.factor * d.drive.torque(a.angles[r][i] + d.phase, a.speeds[r][i]).torque;
            assert!((x - torque).abs() < 1e-9 * (1.0 + torque.abs()), "{r} {i}: {x} {torque}");
            // As the method used it, in its last stage: at the end of the step.
            assert!(r == 0 || (t - torque).abs() < 1e-2, "{r} {i}: {t} {torque}");
        }
    }
}

#[test]
fn the_closed_form_is_what_small_steps_come_to() {
    // A harmonic torque by the angle of the mean speed and by that of the shaft differ to second order in the vibration: nearly none here.
    let mut line = geared();
    let order =
        Harmonic { order: 1.5, amplitude: quantity(1e-4), phase: quantity(0.4), factor: quantity(1.0) };
    line.drives[1] = drive(4, -1.0, 0.2, &Harmonics { mean: quantity(100.0), orders: vec![order] });
    let times: Vec<f64> = (0..25).map(|i| 0.02 * f64::from(i)).collect();
    for braked in [true, false] {
        if !braked {
            // Without drag and motor the line runs away under constant torque.
            line.nodes.iter_mut().for_each(|n| n.damping = 0.0);
            line.drives.remove(0);
        }
        let ctx = context(&line, [&ANGLES, &SPEEDS], &times);
        let a = run(&Propagator {}, &ctx);
        let b = run(&Implicit { tolerance: quantity(1e-11) }, &ctx);
        assert_eq!(a.times, times);
        for r in 0..times.len() {
            for i in 0..5 {
                // Tolerance over some hundred steps, and 1e-4 N m by an angle that is a radian off at the end.
                assert!(
                    (a.speeds[r][i] - b.speeds[r][i]).abs() < 2e-4,
                    "{r} {i}: {} {}",
                    a.speeds[r][i],
                    b.speeds[r][i]
                );
                assert!(
                    (a.angles[r][i] - b.angles[r][i]).abs() < 2e-5,
                    "{r} {i}: {} {}",
                    a.angles[r][i],
                    b.angles[r][i]
                );
            }
            for (x, y) in a.torque[r].iter().zip(&b.torque[r]) {
                assert!((x - y).abs() < 1e-2, "{r}: {x} {y}");
            }
        }
        torques_are_those_of_the_laws(&line, &a);
    }
}

#[test]
fn a_critically_damped_pair_is_no_sum_of_exponentials() {
    // c = 2 √(k J) of the relative motion, to the last digit: a double eigenvalue.
    let line = chain(&[1.0, 1.0], &[200.0], &[20.0], &[]);
    let mut model = Propagator {}.build(&context(&line, [&[0.1, -0.1], &[50.0; 2]], &[0.1])).expect("builds");
    assert!(model.run(&mut TorsionOut::default()).is_err());
}

#[test]
fn starts_that_cannot_be_are_refused() {
    let mut line = chain(&[1.0, 2.0, 1.0], &[1e3, f64::INFINITY], &[1.0], &[]);
    line.nodes[2].ratio = 2.0;
    let implicit = Implicit::default();
    let field = |angles: &[f64], speeds: &[f64], times: &[f64]| {
        implicit.build(&context(&line, [angles, speeds], times)).err().map(|e| e.field)
    };
    let ok = [[0.1, 0.2, 0.4], [50.0, 50.0, 100.0]];
    assert_eq!(field(&ok[0], &ok[1], &[1.0]), None);
    assert_eq!(field(&ok[0][..2], &ok[1], &[1.0]).as_deref(), Some("start"));
    assert_eq!(field(&ok[0], &ok[1][..2], &[1.0]).as_deref(), Some("start"));
    assert_eq!(field(&ok[0], &ok[1], &[]).as_deref(), Some("time"));
    assert_eq!(field(&[0.1, 0.2, 0.401], &ok[1], &[1.0]).as_deref(), Some("start"));
    assert_eq!(field(&ok[0], &[50.0, 50.0, 50.0], &[1.0]).as_deref(), Some("start"));
    for tolerance in [1e-14, 0.1] {
        let spec = Implicit { tolerance: quantity(tolerance) };
        let e = spec.build(&context(&line, [&ok[0], &ok[1]], &[1.0])).expect_err("refused");
        assert_eq!(e.field, "tolerance");
    }
    let steps = RungeKutta { step: quantity(1e-8), look_ahead: false };
    assert_eq!(steps.build(&context(&line, [&ok[0], &ok[1]], &[1.0])).expect_err("refused").field, "step");
}

#[test]
fn rigid_links_carry_what_moves_the_parts_behind_them() {
    // A geared shaft on rigid links with a throw at its end, whose inertia varies: the mesh carries the rates of momentum behind it.
    use crate::common::Gas;
    use crate::common::compressor::{THROW, end};
    let mut line =
        chain(&[3.0, 0.5, 0.2, 0.4], &[4e3, f64::INFINITY, f64::INFINITY], &[8.0], &[0.3, 0.2, 0.1, 0.6]);
    line.nodes[2].ratio = 1.5;
    line.nodes[3].ratio = 1.5;
    let inertia = gudgeon_torsion::throw_inertia::Exact {}.build(&THROW).expect("builds");
    line.throws.push(LineThrow::new(3, 0.4, inertia, end(Gas::M3)));
    let fan = PowerLaw { torque: quantity(70.0), speed: quantity(100.0), exponent: quantity(2.0) };
    line.drives.push(drive(2, -1.0, 0.0, &fan));
    let (h, first) = (1e-5, 2000);
    let times: Vec<f64> = (first..first + 5).map(|i| h * f64::from(i)).collect();
    let start: [&[f64]; 2] = [&[0.0; 4], &[40.0, 40.0, 60.0, 60.0]];
    let ctx = context(&line, start, &times);
    let out = run(&RungeKutta { step: quantity(h), look_ahead: false }, &ctx);
    let (r, t) = (2, &line.throws[0]);
    let (w, a) = (&out.speeds[r], &out.angles[r]);
    // Accelerations by differences of fourth order over steps of 1e-5: forces change within 1e-3.
    let alpha = |i: usize| {
        let v = |k: usize| out.speeds[k][i];
        (8.0 * (v(3) - v(1)) - (v(4) - v(0))) / (12.0 * h)
    };
    let (j, dj) = t.inertia.inertia(a[3] + t.phase);
    let last = t.gas_torque(a[3], a[3]) - 0.6 * w[3] - (0.4 + j) * alpha(3) - 0.5 * dj * w[3] * w[3];
    let load = -70.0 * (w[2] / 100.0).powi(2);
    let before = load - 0.1 * w[2] - 0.2 * alpha(2);
    // The torque in a link is that on its first inertia, against the motion.
    let found = &out.torque[r];
    assert!((found[2] + last).abs() < 1e-4 * last.abs(), "{} {last}", found[2]);
    assert!((found[1] + 1.5 * (last + before)).abs() < 1e-4 * last.abs(), "{} {}", found[1], last + before);
    let shaft = 4e3 * (a[0] - a[1]) + 8.0 * (w[0] - w[1]);
    assert!((found[0] - shaft).abs() < 1e-9 * shaft.abs(), "{} {shaft}", found[0]);
    assert!((w[2] / w[1] - 1.5).abs() < 1e-13 && (a[3] / a[1] - 1.5).abs() < 1e-13);
}

/// The same line with its inertias in the opposite order: the torque of a rigid link is then found from the parts on its other side.
#[test]
fn the_order_of_the_inertias_changes_no_torque() {
    use crate::common::Gas;
    use crate::common::compressor::{THROW, end};
    let line = |turned: bool| {
        let n = 5;
        let at = |i: usize| if turned { n - 1 - i } else { i };
        let mut line = Line { nodes: vec![node(0.0, 0.0); n], ..Line::default() };
        for (i, (inertia, damping, ratio)) in
            [(3.0, 0.3, 2.0), (0.5, 0.2, 2.0), (0.2, 0.1, -1.5), (0.4, 0.6, -1.5), (0.3, 0.4, 1.0)]
                .into_iter()
                .enumerate()
        {
            line.nodes[at(i)] = LineNode { ratio, ..node(inertia, damping) };
        }
        let rigid = f64::INFINITY;
        for (a, b, k, c) in [(0, 1, 4e3, 8.0), (1, 2, rigid, 0.0), (3, 2, rigid, 0.0), (4, 3, 2e3, 3.0)] {
            line.links.push(link(at(a), at(b), k, c, 0.0));
        }
        for (i, phase) in [(3, 0.4), (2, 1.1)] {
            let inertia = gudgeon_torsion::throw_inertia::Exact {}.build(&THROW).expect("builds");
            line.throws.push(LineThrow::new(at(i), phase, inertia, end(Gas::M3)));
        }
        let fan = PowerLaw { torque: quantity(70.0), speed: quantity(100.0), exponent: quantity(2.0) };
        line.drives.push(drive(at(2), -1.0, 0.0, &fan));
        line
    };
    let speeds = [40.0, 40.0, -30.0, -30.0, 20.0];
    let turned: Vec<f64> = speeds.iter().rev().copied().collect();
    let times: Vec<f64> = (1..20).map(|i| 0.002 * f64::from(i)).collect();
    let (first, second) = (line(false), line(true));
    // Fixed steps are the same but for rounding; controlled ones judge an error by the speed of the first inertia of rigidly joined ones.
    for (spec, tolerance) in [
        (&RungeKutta { step: quantity(1e-4), look_ahead: false } as &dyn TorsionSpec, 1e-10),
        (&Implicit { tolerance: quantity(1e-9) }, 1e-6),
    ] {
        let a = run(spec, &context(&first, [&[0.0; 5], &speeds], &times));
        let b = run(spec, &context(&second, [&[0.0; 5], &turned], &times));
        for (x, y) in a.torque.iter().zip(&b.torque) {
            let top = x.iter().map(|t| t.abs()).fold(0.0, f64::max);
            for (p, q) in x.iter().zip(y) {
                assert!((p - q).abs() < tolerance * top, "{p} {q}");
            }
        }
    }
}

/// A crank of no inertia of its own stands still with its piston at the dead centres, whatever it is geared to.
#[test]
fn a_crank_without_inertia_is_refused_also_behind_a_gear() {
    use crate::common::compressor::THROW;
    let bare = ThrowCtx { crank_inertia: 0.0, rod_mass: 0.0, ..THROW };
    let with = |crank: ThrowCtx, wheel: f64| {
        let mut line = chain(&[1.0, wheel, 0.0], &[1e4, f64::INFINITY], &[], &[]);
        line.nodes[2].ratio = 1.5;
        let inertia = gudgeon_torsion::throw_inertia::Exact {}.build(&crank).expect("builds");
        line.throws.push(LineThrow::new(2, 0.3, inertia, Vec::new()));
        Implicit::default().build(&context(&line, [&[0.0; 3], &[50.0, 50.0, 75.0]], &[1.0])).err()
    };
    let refused = with(bare, 0.0).expect("vanishes");
    assert!(refused.field == "inertias.1" && refused.to_string().contains("vanishes"), "{refused}");
    // The crank's own inertia or that of the wheel is enough.
    assert!(with(ThrowCtx { crank_inertia: 0.1, ..bare }, 0.0).is_none());
    assert!(with(bare, 0.1).is_none());
}

/// Fixed steps: a row stands at the end of the step nearest to the time that was asked for.
#[test]
fn rows_of_fixed_steps_stand_at_the_nearest_step() {
    let line = geared();
    let times = [0.0, 1.4e-3, 2.6e-3, 5e-3];
    let spec = RungeKutta { step: quantity(1e-3), look_ahead: false };
    let out = run(&spec, &context(&line, [&ANGLES, &SPEEDS], &times));
    for (t, exact) in out.times.iter().zip([0.0, 1e-3, 3e-3, 5e-3]) {
        // Rounding of a product.
        assert!((t - exact).abs() < 1e-17, "{t} {exact}");
    }
    assert_eq!((out.counters["time_steps"], out.counters["right_hand_sides"]), (5, 20));
    assert_eq!(out.angles[0], ANGLES);
}

/// Two geared inertias on springs and a damper against the ground, rigidly joined: one damped oscillator, whose motion is known.
#[test]
fn a_held_line_swings_out_on_its_springs() {
    let mut line = chain(&[2.0, 0.5], &[f64::INFINITY], &[], &[0.0, 3.0]);
    line.nodes[1].ratio = -2.0;
    line.nodes[0].ground = 2e3;
    line.nodes[1].ground = 1.5e3;
    // Counted at the first inertia everything of the second counts four times.
    let (j, c, k): (f64, f64, f64) = (2.0 + 4.0 * 0.5, 4.0 * 3.0, 2e3 + 4.0 * 1.5e3);
    let (delta, square) = (0.5 * c / j, k / j);
    let w = (square - delta * delta).sqrt();
    let times: Vec<f64> = (0..40).map(|i| 0.01 * f64::from(i)).collect();
    let ctx = context(&line, [&[0.1, -0.2], &[0.0, 0.0]], &times);
    for (spec, tolerance) in [
        // (ω h)⁴/120 of a radian each radian, 20 of them.
        (&RungeKutta { step: quantity(1e-4), look_ahead: false } as &dyn TorsionSpec, 1e-9),
        // The tolerance, step by step, some hundred of them.
        (&Implicit { tolerance: quantity(1e-9) }, 1e-6),
    ] {
        let out = run(spec, &ctx);
        for (r, t) in times.iter().enumerate() {
            let (sin, cos) = (w * t).sin_cos();
            let decay = (-delta * t).exp();
            let angle = 0.1 * decay * (cos + delta / w * sin);
            let speed = -0.1 * decay * square / w * sin;
            let acceleration = -square * angle - 2.0 * delta * speed;
            let (x, v) = (&out.angles[r], &out.speeds[r]);
            assert!((x[0] - angle).abs() < tolerance && (x[1] + 2.0 * angle).abs() < 2.0 * tolerance, "{t}");
            assert!((v[0] - speed).abs() < w * tolerance && (v[1] + 2.0 * speed).abs() < 2.0 * w * tolerance);
            // The mesh carries what moves the first inertia against its spring: 2 ω² + 2e3 N m, less than k, by radian of error.
            let mesh = -(2.0 * acceleration + 2e3 * angle);
            assert!((out.torque[r][0] - mesh).abs() < k * tolerance, "{t}: {} {mesh}", out.torque[r][0]);
        }
    }
}
