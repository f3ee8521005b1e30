//! Laws of couplings against closed forms: periods of nonlinear oscillators, energy per cycle, response by hand.

use gudgeon_core::kinds::*;
use gudgeon_core::quantity::quantity;
use gudgeon_numerics::linalg::Complex;
use gudgeon_torsion::coupling::{FrequencyDependent, LoadDependent, Piecewise, Progressive};
use gudgeon_torsion::drive::{Constant, Harmonic, Harmonics, PowerLaw};
use gudgeon_torsion::steady::about_mean_torque;
use gudgeon_torsion::torsion::{HarmonicBalance, Implicit, Orders, RungeKutta};
use std::f64::consts::PI;

use crate::common::compressor::run;
use crate::common::node;

fn c(re: f64, im: f64) -> Complex {
    Complex::new(re, im)
}

fn pair(j: [f64; 2], coupling: &dyn CouplingSpec) -> Line {
    let coupling = coupling.build().expect("builds");
    Line {
        nodes: j.map(|j| node(j, 0.0)).to_vec(),
        links: vec![LineLink { name: "coupling".into(), nodes: [0, 1], coupling }],
        ..Line::default()
    }
}

fn context<'a>(
    line: &'a Line,
    speed: f64,
    orders: f64,
    start: [&'a [f64]; 2],
    times: &'a [f64],
) -> TorsionCtx<'a> {
    TorsionCtx {
        line,
        speed,
        orders,
        period: 2.0 * PI,
        balance: &[1.0],
        angles: start[0],
        speeds: start[1],
        times,
    }
}

fn drive(node: usize, factor: f64, spec: &dyn DriveSpec) -> LineDrive {
    LineDrive { node, phase: 0.0, factor, drive: spec.build().expect("builds") }
}

/// Complete elliptic integral of the first kind, parameter m = k², by the arithmetic-geometric mean.
fn elliptic(m: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    while (a - b).abs() > 1e-16 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * PI / a
}

/// Inertias of 2 and 1 kg m²: relative motion is that of 2/3 kg m², and half the twist of the second is the first's.
const J: [f64; 2] = [2.0, 1.0];
const REDUCED: f64 = 2.0 / 3.0;

/// Twist and rate of twist at `t`, released at twist `x`, with the number of steps.
fn released(line: &Line, spec: &dyn TorsionSpec, x: f64, t: f64) -> (f64, f64, u64) {
    let (angles, times) = ([x / 3.0, -2.0 * x / 3.0], [t]);
    let out = run(spec, &context(line, 1.0, 1.0, [&angles, &[0.0; 2]], &times));
    // Nothing turns: twice the first and once the second is zero, to the rounding of some thousand steps.
    assert!((2.0 * out.angles[0][0] + out.angles[0][1]).abs() < 1e-10 * x);
    (out.angles[0][0] - out.angles[0][1], out.speeds[0][0] - out.speeds[0][1], out.counters["time_steps"])
}

#[test]
fn progressive_has_the_period_of_the_cubic_oscillator() {
    let spec = Progressive {
        stiffness: quantity(2e4),
        nominal_torque: quantity(2e3),
        gain: quantity(3.0),
        damping: quantity(0.0),
    };
    let law = spec.build().expect("builds");
    // The definition: tangent three times the first at the nominal torque.
    assert!((law.linear(0.0, 2e3).stiffness / 6e4 - 1.0).abs() < 1e-14);
    assert!((law.torque(law.static_twist(2e3), 0.0).torque / 2e3 - 1.0).abs() < 1e-14);
    let cubic = law.torque(1.0, 0.0).torque - 2e4;
    let line = pair(J, &spec);
    // x'' + αx + βx³ = 0 from rest at A: T = 4 K(m)/√(α + βA²), m = βA²/(2 (α + βA²)). Twice the nominal twist.
    let a = 2.0 * law.static_twist(2e3);
    let (alpha, beta) = (2e4 / REDUCED, cubic / REDUCED);
    let top = alpha + beta * a * a;
    let period = 4.0 * elliptic(beta * a * a / (2.0 * top)) / top.sqrt();
    // Far from the period of the tangent at rest.
    assert!(period < 0.8 * 2.0 * PI / alpha.sqrt());
    let fastest = a * top.sqrt();
    let mut last: Option<(f64, u64)> = None;
    for tolerance in [1e-5, 1e-7, 1e-9] {
        // Ten periods; half a period is the other end, a quarter the middle at the speed that the energy gives.
        let (x, v, steps) = released(&line, &Implicit { tolerance: quantity(tolerance) }, a, 10.0 * period);
        let error = ((x - a) / a).abs().max(v.abs() / fastest);
        assert!(error < 2e3 * tolerance, "{tolerance:e}: {error:e}");
        if let Some((before, fewer)) = last {
            let order = (before / error).ln() / (steps as f64 / fewer as f64).ln();
            // Order 5 of the method; step control moves it a little.
            assert!((4.3..6.3).contains(&order), "{tolerance:e}: {order}");
        }
        last = Some((error, steps));
    }
    // The fixed steps of order 4 see the same period.
    let error = |h: f64| {
        let (x, v, _) = released(&line, &RungeKutta { step: quantity(h), look_ahead: false }, a, period);
        ((x - a) / a).hypot(v / fastest)
    };
    let order = (error(period / 400.0) / error(period / 800.0)).log2();
    assert!((order - 4.0).abs() < 0.15, "{order}");
    let spec = Implicit { tolerance: quantity(1e-10) };
    let (x, v, _) = released(&line, &spec, a, 0.25 * period);
    // The energy of the twist, αA²/2 + βA⁴/4, is in the motion.
    let exact = -(alpha * a * a + 0.5 * beta * a.powi(4)).sqrt();
    assert!((x / a).abs() < 1e-7 && (v / exact - 1.0).abs() < 1e-7, "{x} {v} {exact}");
}

#[test]
fn play_and_stages_have_their_periods() {
    // Play of ±0.01 rad between springs: a quarter is the way through the play and a quarter of a harmonic motion.
    let play = Piecewise {
        twist: vec![-0.05, -0.01, 0.01, 0.05],
        torque: vec![-400.0, 0.0, 0.0, 400.0],
        damping: quantity(0.0),
        loss_time: quantity(0.0),
    };
    let line = pair(J, &play);
    let w = (1e4_f64 / REDUCED).sqrt();
    let v0 = (0.03 - 0.01) * w;
    let period = 4.0 * (0.01 / v0 + 0.5 * PI / w);
    let check = |line: &Line, a: f64, period: f64, v0: f64| {
        // Corners of the law cost the order, not the answer: errors follow the tolerance.
        let mut last = f64::INFINITY;
        for tolerance in [1e-6, 1e-8, 1e-10] {
            let (x, v, _) = released(line, &Implicit { tolerance: quantity(tolerance) }, a, period);
            let error = ((x - a) / a).abs().max(v.abs() / v0);
            assert!(error < 0.3 * last && error < 1e4 * tolerance, "{tolerance:e}: {error:e}");
            last = error;
        }
        let (_, v, _) = released(line, &Implicit { tolerance: quantity(1e-10) }, a, 0.25 * period);
        assert!((v / v0 + 1.0).abs() < 1e-6, "{v} {v0}");
    };
    check(&line, 0.03, period, v0);
    // Two stages: k₁ to x₁, then k₂ about the twist x_c where its line meets zero.
    let (k1, k2, x1, a) = (1e4, 4e4, 0.01, 0.025);
    let stages = Piecewise {
        twist: vec![-0.05, -x1, x1, 0.05],
        torque: vec![-k1 * x1 - k2 * 0.04, -k1 * x1, k1 * x1, k1 * x1 + k2 * 0.04],
        damping: quantity(0.0),
        loss_time: quantity(0.0),
    };
    let (w1, w2) = ((k1 / REDUCED).sqrt(), (k2 / REDUCED).sqrt());
    let centre = x1 - k1 * x1 / k2;
    let v1 = w2 * ((a - centre).powi(2) - (x1 - centre).powi(2)).sqrt();
    let v0 = v1.hypot(w1 * x1);
    let outer = ((x1 - centre) / (a - centre)).acos() / w2;
    let inner = (x1 * w1 / v0).asin() / w1;
    check(&pair(J, &stages), a, 4.0 * (inner + outer), v0);
}

#[test]
fn energy_lost_per_cycle_is_that_of_the_law() {
    // Prescribed twist A sin ωt; loss per cycle by the midpoint rule, whose error at the corners of the damping goes with the step.
    let lost = |law: &dyn Coupling, a: f64, w: f64| {
        let n = 200_000;
        let dt = 2.0 * PI / w / f64::from(n);
        (0..n)
            .map(|i| {
                let (sin, cos) = (w * dt * (f64::from(i) + 0.5)).sin_cos();
                law.torque(a * sin, a * w * cos).torque * a * w * cos * dt
            })
            .sum::<f64>()
    };
    let progressive = Progressive {
        stiffness: quantity(2e4),
        nominal_torque: quantity(2e3),
        gain: quantity(3.0),
        damping: quantity(25.0),
    };
    // A spring of any law loses nothing: πcωA².
    let (a, w) = (0.08, 90.0);
    let found = lost(&*progressive.build().expect("builds"), a, w);
    assert!((found / (PI * 25.0 * w * a * a) - 1.0).abs() < 1e-9, "{found}");
    // Damping by pieces, c + τk: ∮ c ẋ dx = 4 A²ω Σ c [φ/2 + sin 2φ/4], φ the phase at the corners.
    let stages = Piecewise {
        twist: vec![-0.1, -0.03, 0.03, 0.1],
        torque: vec![-3100.0, -300.0, 300.0, 3100.0],
        damping: quantity(2.0),
        loss_time: quantity(1e-3),
    };
    let phi = (0.03_f64 / a).asin();
    let part = |phi: f64| 0.5 * phi + 0.25 * (2.0 * phi).sin();
    let exact = 4.0 * a * a * w * (12.0 * part(phi) + 42.0 * (part(0.5 * PI) - part(phi)));
    let found = lost(&*stages.build().expect("builds"), a, w);
    assert!((found / exact - 1.0).abs() < 1e-4, "{found} {exact}");
    // Relative damping: loss over the elastic energy at the end of the swing, K A²/2; πηKA² of the loss factor.
    let rubber = rubber().build().expect("builds");
    for (mean, psi) in [(0.0, 1.1), (1500.0, 0.95), (-1500.0, 0.95), (9e3, 0.9)] {
        let v = rubber.linear(w, mean);
        let lost = PI * v.loss_factor * v.stiffness * a * a;
        assert!((lost / (0.5 * v.stiffness * a * a) / psi - 1.0).abs() < 1e-14);
    }
}

fn rubber() -> LoadDependent {
    LoadDependent {
        mean_torque: vec![0.0, 1000.0, 2000.0],
        stiffness: vec![1e4, 2e4, 4e4],
        relative_damping: vec![1.1, 1.0, 0.9],
        heat_factor: quantity(0.8),
    }
}

#[test]
fn stiffness_under_load_is_the_slope_of_the_twist() {
    let law = rubber().build().expect("builds");
    // dT = K(T) dx: over a piece where K goes straight from a to b over D, x = D ln(b/a)/(b - a).
    let first = 1000.0 * 2.0_f64.ln() / 8e3;
    let second = 1000.0 * 2.0_f64.ln() / 16e3;
    assert!((law.static_twist(1000.0) / first - 1.0).abs() < 1e-14);
    assert!((law.static_twist(2000.0) / (first + second) - 1.0).abs() < 1e-14);
    assert!((law.static_twist(-2500.0) / -(first + second + 500.0 / 32e3) - 1.0).abs() < 1e-14);
    for mean in [50.0, 900.0, 1700.0, 3000.0, -700.0] {
        // Differences of second order; the third derivative of the twist is of the order x/T².
        let h = 1.0;
        let slope = (law.static_twist(mean + h) - law.static_twist(mean - h)) / (2.0 * h);
        assert!((slope * law.linear(0.0, mean).stiffness - 1.0).abs() < 1e-5, "{mean}");
    }
    // Modes and orders see the coupling at its mean torque: 1500 N m against 24 kN m/rad.
    let mut line = pair(J, &rubber());
    line.drives.push(drive(1, -1.0, &Constant { torque: quantity(1500.0) }));
    let ctx = context(&line, 100.0, 4.0, [&[], &[]], &[]);
    let bare = about_mean_torque(&ctx).expect("builds");
    let w = (24e3_f64 / REDUCED).sqrt();
    let modes = gudgeon_torsion::natural_frequencies::Eigenvalues::default()
        .build(&bare)
        .expect("builds")
        .modes()
        .expect("found");
    assert!((modes[1].omega / w - 1.0).abs() < 1e-14);
    // Both inertias by hand: [K' - ω²J₁, -K'; -K', K' - ω²J₂] a = [0, T].
    let order =
        Harmonic { order: 2.0, amplitude: quantity(70.0), phase: quantity(0.4), factor: quantity(1.0) };
    line.drives.push(drive(1, 1.0, &Harmonics { mean: quantity(0.0), orders: vec![order] }));
    let out = run(&Orders {}, &context(&line, 100.0, 4.0, [&[], &[]], &[]));
    let kappa = c(24e3, 24e3 * 0.95 / (2.0 * PI));
    by_hand(&out.orders.get(0), kappa, 200.0, c(70.0 * 0.4_f64.cos(), -70.0 * 0.4_f64.sin()));
    // Loss per cycle by the definition of ψ.
    let twist = out.orders.torque(0)[0][0].hypot(out.orders.torque(0)[1][0]) / kappa.abs();
    let lost = out.orders.heat(0)[0] * 2.0 * PI / 200.0;
    assert!((lost / (0.95 * 0.5 * 24e3 * twist * twist) - 1.0).abs() < 1e-13);
    // A fan whose torque goes with the square of the speed: over the range every speed has its own stiffness, also where a table
    // begins far above the torque at rest.
    let mut fan = pair(
        J,
        &LoadDependent { mean_torque: vec![20e3, 40e3], stiffness: vec![2e5, 8e5], ..rubber_of_two() },
    );
    fan.drives.push(drive(
        1,
        -1.0,
        &PowerLaw { torque: quantity(30e3), speed: quantity(100.0), exponent: quantity(2.0) },
    ));
    let order =
        Harmonic { order: 2.0, amplitude: quantity(70.0), phase: quantity(0.4), factor: quantity(1.0) };
    fan.drives.push(drive(1, 1.0, &Harmonics { mean: quantity(0.0), orders: vec![order] }));
    let mut moving = Orders {}.build(&context(&fan, 100.0, 4.0, [&[], &[]], &[])).expect("builds");
    for w in [60.0, 95.0, 110.0] {
        let mut there = TorsionOut::default();
        moving.set_speed(w).expect("periodic");
        moving.run(&mut there).expect("runs");
        assert_eq!(there, run(&Orders {}, &context(&fan, w, 4.0, [&[], &[]], &[])));
    }
}

fn rubber_of_two() -> LoadDependent {
    LoadDependent { relative_damping: vec![1.1, 1.0], ..rubber() }
}

/// Answer of two inertias to a torque on the second, by Cramer's rule.
fn by_hand(found: &OrderResponse, kappa: Complex, omega: f64, torque: Complex) {
    let l = omega * omega;
    let (d1, d2) = (kappa - c(l * J[0], 0.0), kappa - c(l * J[1], 0.0));
    let det = d1 * d2 - kappa * kappa;
    let exact = [kappa * torque / det, d1 * torque / det];
    for (a, e) in found.angle.iter().zip(exact) {
        // A determinant of two terms keeps all but a few digits this far from its zero.
        assert!((c(a[0], a[1]) - e).abs() < 1e-12 * e.abs(), "{a:?} {e:?}");
    }
    let t = kappa * (exact[0] - exact[1]);
    assert!((c(found.torque[0][0], found.torque[0][1]) - t).abs() < 1e-12 * t.abs());
    // Loss: half of ω Im κ |twist|².
    let heat = 0.5 * omega * kappa.im * (exact[0] - exact[1]).abs().powi(2);
    assert!((found.heat[0] / heat - 1.0).abs() < 1e-11);
}

#[test]
fn frequency_dependent_coupling_by_hand() {
    let spec = FrequencyDependent {
        frequency: vec![10.0, 50.0, 200.0],
        stiffness: vec![2e4, 3e4, 6e4],
        loss_factor: vec![0.1, 0.5, 0.8],
    };
    let law = spec.build().expect("builds");
    assert_eq!(law.static_twist(500.0), 0.025);
    let mut line = pair(J, &spec);
    let harmonic = |order: f64| Harmonic {
        order,
        amplitude: quantity(40.0 / order),
        phase: quantity(0.3 * order),
        factor: quantity(1.0),
    };
    let orders: Vec<f64> = vec![0.5, 1.0, 3.0, 6.0, 14.0];
    let all = orders.iter().map(|o| harmonic(*o)).collect();
    line.drives.push(drive(1, 1.0, &Harmonics { mean: quantity(0.0), orders: all }));
    // 16 turns a second: 8, 16, 48, 96 and 224 Hz, below, within and above the table.
    let speed = 32.0 * PI;
    let ctx = TorsionCtx { period: 4.0 * PI, ..context(&line, speed, 20.0, [&[], &[]], &[]) };
    let out = run(&Orders {}, &ctx);
    let table = [
        (2e4, 0.1),
        (2.15e4, 0.16),
        (2.95e4, 0.48),
        (3e4 + 3e4 * 46.0 / 150.0, 0.5 + 0.3 * 46.0 / 150.0),
        (6e4, 0.8),
    ];
    for ((o, n), (k, eta)) in out.orders.iter().zip(&orders).zip(table) {
        assert_eq!(o.order, *n);
        let torque = c(0.3 * n, 0.0);
        let torque = c(40.0 / n * torque.re.cos(), -40.0 / n * torque.re.sin());
        by_hand(&o, c(k, k * eta), n * speed, torque);
    }
    // Come from another speed: every speed its own stiffness.
    let ctx = TorsionCtx { period: 4.0 * PI, ..context(&line, 1.0, 20.0, [&[], &[]], &[]) };
    let mut moving = Orders {}.build(&ctx).expect("builds");
    let mut there = TorsionOut::default();
    moving.set_speed(speed).expect("periodic");
    moving.run(&mut there).expect("runs");
    assert_eq!(there, out);
}

#[test]
fn harmonic_balance_of_nonlinear_couplings_is_their_motion_over_time() {
    // A pulsating torque beside a mean one, through a coupling that leaves its tangent: started in the motion by orders and integrated
    // over three turns, the line comes back.
    let progressive = Progressive {
        stiffness: quantity(1e4),
        nominal_torque: quantity(1e3),
        gain: quantity(4.0),
        damping: quantity(25.0),
    };
    let stages = Piecewise {
        twist: vec![-0.2, 0.05, 0.1, 0.3],
        torque: vec![-2000.0, 500.0, 1500.0, 7500.0],
        damping: quantity(20.0),
        loss_time: quantity(1e-4),
    };
    let order = |order: f64, amplitude: f64| Harmonic {
        order,
        amplitude: quantity(amplitude),
        phase: quantity(0.2),
        factor: quantity(1.0),
    };
    // Corners of the torque: what is beyond 120 orders is 1e-6 of it; the smooth law has its orders to 1e-9 within 40.
    for (spec, orders, tolerance) in
        [(&progressive as &dyn CouplingSpec, 40.0, 1e-7), (&stages as &dyn CouplingSpec, 120.0, 2e-4)]
    {
        let mut line = pair(J, spec);
        let torque = Harmonics { mean: quantity(600.0), orders: vec![order(1.0, 700.0), order(2.0, 250.0)] };
        line.drives.push(drive(0, 1.0, &torque));
        line.drives.push(drive(1, -1.0, &Constant { torque: quantity(600.0) }));
        let speed = 70.0;
        let hb = HarmonicBalance { tolerance: quantity(1e-12), rounds: 400 };
        let out = run(&hb, &context(&line, speed, orders, [&[], &[]], &[]));
        // The vibration shifts the mean twist: the tangent at the mean torque alone would not do.
        let plain = run(&Orders {}, &context(&line, speed, orders, [&[], &[]], &[]));
        let twist = |m: &[f64]| m[0] - m[1];
        assert!((twist(&out.mean_angle) / twist(&plain.mean_angle) - 1.0).abs() > 0.01);
        // The load takes 600 N m, whatever the law: that is the mean torque of the coupling.
        assert!((out.mean_torque[0] / 600.0 - 1.0).abs() < 1e-10);
        let state = |t: f64| {
            let (mut a, mut w, mut q) = (out.mean_angle.clone(), vec![speed; 2], out.mean_torque[0]);
            for o in out.orders.iter() {
                let (sin, cos) = (o.order * speed * t).sin_cos();
                q += o.torque[0][0] * cos - o.torque[0][1] * sin;
                for i in 0..2 {
                    let [re, im] = o.angle[i];
                    a[i] += re * cos - im * sin;
                    w[i] -= o.order * speed * (re * sin + im * cos);
                }
            }
            a.iter_mut().for_each(|a| *a += speed * t);
            (a, w, q)
        };
        let mut driven = line.clone();
        driven.drives.push(drive(0, 1.0, &Constant { torque: quantity(out.balance_torque) }));
        let (a, w, _) = state(0.0);
        let turn = 2.0 * PI / speed;
        let n = 96;
        let times: Vec<f64> = (0..=n).map(|i| 3.0 * turn * f64::from(i) / f64::from(n)).collect();
        let time =
            run(&Implicit { tolerance: quantity(1e-10) }, &context(&driven, speed, orders, [&a, &w], &times));
        let top = out.orders.torque(0)[0][0].hypot(out.orders.torque(0)[1][0]);
        for (r, t) in times.iter().enumerate() {
            let (a, w, q) = state(*t);
            for i in 0..2 {
                let error = (time.angles[r][i] - a[i]).abs() / 0.1;
                assert!(error < tolerance, "{t}: angle {error:e}");
                let error = (time.speeds[r][i] - w[i]).abs() / 10.0;
                assert!(error < tolerance, "{t}: speed {error:e}");
            }
            // The whole torque of the coupling, not that of its tangent; corners ring in a finite number of orders.
            let error = (time.torque[r][0] - q).abs() / top;
            assert!(error < 30.0 * tolerance, "{t}: torque {error:e}");
        }
        // What the torques do is lost in the coupling: mean power of the torques at the true angle.
        let m = 2000;
        let power: f64 = (0..m)
            .map(|i| {
                let (a, w, _) = state(turn * f64::from(i) / f64::from(m));
                driven
                    .drives
                    .iter()
                    .map(|d| d.factor * d.drive.torque(a[d.node], w[d.node]).torque * w[d.node])
                    .sum::<f64>()
            })
            .sum::<f64>()
            / f64::from(m);
        let heat: f64 = out.orders.heat(0).iter().sum();
        assert!((power / heat - 1.0).abs() < 30.0 * tolerance && heat > 10.0, "{power} {heat}");
    }
}
