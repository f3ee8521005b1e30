//! Harmonic balance: Newton's method with the partial derivatives of all that is not linear.

use gudgeon_core::kinds::*;
use gudgeon_core::quantity::quantity;
use gudgeon_torsion::coupling::{Piecewise, Progressive};
use gudgeon_torsion::drive::{Constant, Harmonic, Harmonics, PowerLaw};
use gudgeon_torsion::throw_inertia::{Exact, Mean};
use gudgeon_torsion::torsion::{HarmonicBalance, Modal, Orders};
use std::f64::consts::PI;

use crate::common::compressor::{THROW, end, run};
use crate::common::{Gas, chain};

fn context(line: &Line, speed: f64) -> TorsionCtx<'_> {
    TorsionCtx {
        line,
        speed,
        orders: 24.0,
        period: 4.0 * PI,
        balance: &[1.0],
        angles: &[],
        speeds: &[],
        times: &[],
    }
}

/// Evaluations of the motion until its torques are those that made it, to 1e-11.
fn rounds(line: &Line, speed: f64) -> u64 {
    let spec = HarmonicBalance { tolerance: quantity(1e-11), rounds: 60 };
    run(&spec, &context(line, speed)).counters["rounds"]
}

fn throw(node: usize, phase: f64, inertia: &dyn ThrowInertiaSpec, gas: Gas) -> LineThrow {
    LineThrow::new(node, phase, inertia.build(&THROW).expect("builds"), end(gas))
}

fn drive(node: usize, factor: f64, spec: &dyn DriveSpec) -> LineDrive {
    LineDrive { node, phase: 0.0, factor, drive: spec.build().expect("builds") }
}

fn harmonics(orders: &[(f64, f64)]) -> Harmonics {
    let one = |&(order, a): &(f64, f64)| Harmonic {
        order,
        amplitude: quantity(a),
        phase: quantity(0.3 * order),
        factor: quantity(1.0),
    };
    Harmonics { mean: quantity(0.0), orders: orders.iter().map(one).collect() }
}

/// A flywheel on a soft shaft, behind it a shaft of another speed with what a test puts there.
fn soft(ratio: f64) -> Line {
    let mut line = chain(&[40.0, 1.0, 2.0], &[6e4, 2e4], &[20.0, 15.0], &[0.0, 0.0, 2.0]);
    line.nodes[1].ratio = ratio;
    line.nodes[2].ratio = ratio;
    line
}

fn progressive(stiffness: f64) -> Progressive {
    Progressive {
        stiffness: quantity(stiffness),
        nominal_torque: quantity(500.0),
        gain: quantity(3.0),
        damping: quantity(15.0),
    }
}

fn stages(stiffness: f64) -> Piecewise {
    Piecewise {
        twist: vec![-0.1, -0.02, 0.02, 0.1],
        torque: [-0.18, -0.02, 0.02, 0.18].map(|x| stiffness * x).to_vec(),
        damping: quantity(5.0),
        loss_time: quantity(1e-3),
    }
}

/// Newton's method squares the error: from a tenth to 1e-11 it takes four steps, one or two more where the first leave the square behind, and
/// the evaluation that sees the end. With a wrong derivative a step only takes off a constant part.
#[test]
fn a_few_rounds_are_enough_with_the_right_derivatives() {
    for ratio in [1.0, -2.0] {
        for speed in [30.0, 60.0] {
            let with = |change: &dyn Fn(&mut Line)| {
                let mut line = soft(ratio);
                change(&mut line);
                rounds(&line, speed)
            };
            let gas = with(&|l| l.throws.push(throw(2, 0.4, &Mean {}, Gas::M2)));
            let masses = with(&|l| l.throws.push(throw(2, 0.4, &Exact {}, Gas::None)));
            assert!(gas <= 6 && masses <= 5, "{ratio} {speed}: gas {gas}, masses {masses}");
            let pulsating = harmonics(&[(1.0, 90.0), (2.0, 50.0)]);
            let fan = PowerLaw { torque: quantity(800.0), speed: quantity(60.0), exponent: quantity(3.0) };
            let fan = with(&|l| l.drives = vec![drive(2, 1.0, &pulsating), drive(2, -1.0, &fan)]);
            let [cubic, straight] = [&progressive(2e4) as &dyn CouplingSpec, &stages(2e4)].map(|law| {
                with(&|l| {
                    l.drives.push(drive(2, 1.0, &pulsating));
                    l.links[1].coupling = law.build().expect("builds");
                })
            });
            assert!(fan <= 6 && cubic <= 7 && straight <= 7, "{ratio} {speed}: {fan} {cubic} {straight}");
        }
    }
}

/// The same line twice: its last two inertias behind a gear, and reduced to the speed of the first. Torques of the same motion, in as many
/// rounds.
#[test]
fn a_geared_coupling_is_its_reduced_line() {
    let ratio = -2.0;
    let order = |order: f64, amplitude: f64, phase: f64| Harmonic {
        order,
        amplitude: quantity(amplitude),
        phase: quantity(phase),
        factor: quantity(1.0),
    };
    for law in [&progressive(2e4) as &dyn CouplingSpec, &stages(2e4)] {
        let mut geared = chain(&[3.0, 0.5, 0.25], &[2e4, 3e4], &[0.0, 6.0], &[0.0, 0.1, 0.2]);
        geared.nodes[1].ratio = ratio;
        geared.nodes[2].ratio = ratio;
        let mut plain = chain(&[3.0, 2.0, 1.0], &[2e4, 1.2e5], &[0.0, 24.0], &[0.0, 0.4, 0.8]);
        for line in [&mut geared, &mut plain] {
            line.links[0].coupling = law.build().expect("builds");
            line.drives.push(drive(0, 1.0, &Constant { torque: quantity(300.0) }));
        }
        // The angle of the geared shaft is -2 times that of the reference: cos(n θ - φ) is cos(2n ψ + φ), its torque counts -2 times.
        let own =
            Harmonics { mean: quantity(-40.0), orders: vec![order(1.0, 50.0, 0.3), order(0.5, 70.0, -0.4)] };
        let reduced = Harmonics {
            mean: quantity(80.0),
            orders: vec![order(2.0, -100.0, -0.3), order(1.0, -140.0, 0.4)],
        };
        geared.drives.push(drive(2, 1.0, &own));
        plain.drives.push(drive(2, 1.0, &reduced));
        let spec = HarmonicBalance { tolerance: quantity(1e-12), rounds: 60 };
        let [a, b] = [&geared, &plain].map(|line| run(&spec, &context(line, 55.0)));
        // The end at 1e-12 is close enough to rounding for it to decide the last round.
        assert!(
            a.counters["rounds"].abs_diff(b.counters["rounds"]) <= 1,
            "{:?} {:?}",
            a.counters,
            b.counters
        );
        let top = b.orders.iter().map(|o| o.torque[0][0].hypot(o.torque[0][1])).fold(0.0, f64::max);
        // A motion that stays in the linear part would be no test.
        assert!(top > 100.0, "{top}");
        assert!((a.mean_torque[0] - b.mean_torque[0]).abs() < 1e-9 * top);
        for (x, y) in a.orders.iter().zip(b.orders.iter()) {
            // The torque of the second shaft is that of its own first inertia.
            for (l, gear) in [(0, 1.0), (1, ratio)] {
                let ([p, q], [r, s]) = (x.torque[l], y.torque[l]);
                // The tolerance, magnified by resonances nearby.
                assert!((gear * p - r).hypot(gear * q - s) < 1e-9 * top, "{} {l}: {p} {r}", x.order);
                assert!((x.heat[l] - y.heat[l]).abs() < 1e-9 * top, "{} {l}", x.order);
            }
            for (i, own) in [1.0, ratio, ratio].into_iter().enumerate() {
                let ([p, q], [r, s]) = (x.angle[i], y.angle[i]);
                assert!((p / own - r).hypot(q / own - s) < 1e-9 * top / 2e4, "{} {i}: {p} {r}", x.order);
            }
        }
    }
}

/// Every system is solved for all orders at once.
#[test]
fn linear_solutions_are_counted_by_orders() {
    let mut line = soft(1.0);
    line.throws.push(throw(2, 0.4, &Exact {}, Gas::M2));
    let out = run(&HarmonicBalance::default(), &context(&line, 40.0));
    let orders = out.orders.len() as u64;
    let solutions = out.counters["linear_solutions"];
    // One for each evaluation, and further ones for each step of Newton's method.
    assert!(orders == 48 && solutions.is_multiple_of(orders) && solutions > orders * out.counters["rounds"]);
}

/// Speeds in equal steps above the resonances: the polynomial through those before foretells the next motion, and little is left to do.
#[test]
fn a_sweep_foretells_the_next_motion() {
    let mut line = soft(1.0);
    line.throws.push(throw(2, 0.4, &Exact {}, Gas::M2));
    let spec = HarmonicBalance::default();
    for (from, step) in [(60.0, 0.1), (300.0, 4.0)] {
        let mut swept = spec.build(&context(&line, from)).expect("builds");
        let mut rounds = Vec::new();
        for i in 0..12 {
            let mut out = TorsionOut::default();
            swept.set_speed(from + step * f64::from(i)).expect("periodic");
            swept.run(&mut out).expect("converges");
            rounds.push(out.counters["rounds"]);
        }
        // Eight speeds: the error of the polynomial goes with the eighth power of the step by the distance of the next resonance of an
        // order, so that one step of Newton's method is left; the nearest speed alone would leave three.
        assert!(rounds[8..].iter().all(|c| *c <= 2) && rounds[0] >= 4, "{from} {step}: {rounds:?}");
    }
}

/// Models by independent orders name the one that has more, where there is more.
#[test]
fn a_fuller_model_is_named_where_something_is_not_linear() {
    let plain = soft(1.0);
    let mut bent = plain.clone();
    bent.links[1].coupling = progressive(2e4).build().expect("builds");
    let mut crank = plain.clone();
    crank.throws.push(throw(2, 0.0, &Exact {}, Gas::None));
    for spec in [&Orders {} as &dyn TorsionSpec, &Modal::default()] {
        assert!(spec.fuller(&plain).is_none(), "{spec:?}");
        for line in [&bent, &crank] {
            let fuller = spec.fuller(line).expect("has more");
            assert_eq!(fuller.typetag_name(), "harmonic_balance");
        }
    }
}
