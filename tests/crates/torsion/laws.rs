//! Laws of single parts against their definitions and their own differences.

use crate::common::{chain, link, node};
use gudgeon_core::kinds::*;
use gudgeon_core::quantity::quantity;
use gudgeon_kinematics::ExactSliderCrank;
use gudgeon_numerics::linalg::Complex;
use gudgeon_torsion::CrankEnd;
use gudgeon_torsion::coupling::{FrequencyDependent, LoadDependent, Piecewise, Progressive};
use gudgeon_torsion::drive::*;
use gudgeon_torsion::forcing::{Excitation, series};
use gudgeon_torsion::natural_frequencies::ClampedNeighbours;
use gudgeon_torsion::shaft::{Piece, stiffness, weakest};
use gudgeon_torsion::throw_inertia::{Exact, FirstHarmonic, Lumped, Mean};
use gudgeon_torsion::{damper, forcing};
use std::f64::consts::PI;

/// Derivative by central differences of fourth order.
fn derivative(f: impl Fn(f64) -> f64, x: f64, h: f64) -> f64 {
    (8.0 * (f(x + h) - f(x - h)) - (f(x + 2.0 * h) - f(x - 2.0 * h))) / (12.0 * h)
}

#[test]
fn drives_have_the_derivatives_of_their_torques() {
    let motor = InductionMotor {
        synchronous: quantity(120.0),
        breakdown_torque: quantity(5e3),
        breakdown_slip: quantity(0.08),
        losses: quantity(40.0),
    };
    let power = |n: f64| PowerLaw { torque: quantity(900.0), speed: quantity(80.0), exponent: quantity(n) };
    let curve = Table { speed_rpm: vec![0.0, 400.0, 900.0, 1200.0], torque: vec![800.0, 900.0, 700.0, 0.0] };
    let rated = Linear {
        intercept: None,
        slope: None,
        rated: Some(Rated { torque: quantity(500.0), speed: quantity(110.0), synchronous: quantity(125.0) }),
    };
    let constant = Constant { torque: quantity(5.0) };
    let cases: [(&dyn DriveSpec, bool); 9] = [
        (&motor, false),
        (&power(2.0), false),
        (&power(1.0), true),
        (&power(0.0), true),
        (&power(0.5), false),
        (&curve, false),
        (&rated, true),
        (&constant, true),
        (&gudgeon_torsion::drive::Off {}, true),
    ];
    for (spec, linear) in cases {
        let d = spec.build().expect("builds");
        assert_eq!(d.is_linear(), linear, "{spec:?}");
        for w in [-90.0, -3.0, 5.0, 60.0, 79.0, 112.0, 119.5, 121.0, 150.0] {
            let exact = derivative(|w| d.torque(0.7, w).torque, w, 1e-3);
            let t = d.torque(0.7, w);
            // Fourth order of a step of 1e-3 by the curvature of a motor over its slip of ten; rounding of 5e3 over the step.
            assert!(
                (t.slope - exact).abs() < 1e-6 * (1.0 + exact.abs() + 1e-3 * t.torque.abs()),
                "{spec:?} {w}"
            );
        }
        // Turned about: torque and angle change their sign.
        let back = Reversed::new(spec.build().expect("builds"));
        let (a, b) = (d.torque(0.7, 60.0), back.torque(-0.7, -60.0));
        assert_eq!((a.torque, a.slope, d.is_linear()), (-b.torque, b.slope, back.is_linear()));
    }
    let m = motor.build().expect("builds");
    assert_eq!(m.torque(0.0, 120.0).torque, -40.0);
    for s in [0.08, -0.08_f64] {
        let t = m.torque(0.0, 120.0 * (1.0 - s));
        // The pull-out torque, where the curve is level.
        assert!((t.torque - (5e3 * s.signum() - 40.0)).abs() < 1e-9 && t.slope.abs() < 1e-9, "{t:?}");
    }
    assert!((m.torque(0.0, 0.0).torque - (1e4 / (1.0 / 0.08 + 0.08) - 40.0)).abs() < 1e-9);
    let p = power(2.0).build().expect("builds");
    assert_eq!((p.torque(0.0, -80.0).torque, p.torque(0.0, 160.0).torque), (-900.0, 3600.0));
    assert_eq!(p.torque(0.0, 0.0), DriveTorque::default());
    let t = curve.build().expect("builds");
    for (rpm, torque) in curve.speed_rpm.iter().zip(&curve.torque) {
        // Through the rows; at the ends of the table straight on.
        assert!((t.torque(0.0, rpm * PI / 30.0).torque - torque).abs() < 1e-9);
    }
    let end = 1200.0 * PI / 30.0;
    let slope = t.torque(0.0, end).slope;
    assert!(slope < 0.0 && (t.torque(0.0, end + 10.0).torque - 10.0 * slope).abs() < 1e-9);
    assert_eq!(constant.build().expect("builds").torque(1.0, 2.0).torque, 5.0);
    let r = rated.build().expect("builds");
    assert!((r.torque(0.0, 110.0).torque - 500.0).abs() < 1e-9 && r.torque(0.0, 125.0).torque.abs() < 1e-9);
}

#[test]
fn harmonics_are_the_sum_they_are_given_by() {
    let order = |order: f64, a: f64, phase: f64, factor: f64| Harmonic {
        order,
        amplitude: quantity(a),
        phase: quantity(phase),
        factor: quantity(factor),
    };
    let spec = Harmonics {
        mean: quantity(7.0),
        orders: vec![order(0.5, 3.0, 0.4, 2.0), order(3.0, 5.0, -1.1, 1.0)],
    };
    let d = spec.build().expect("builds");
    assert!(!d.is_linear());
    let back = Reversed::new(spec.build().expect("builds"));
    for i in 0..20 {
        let at = 0.7 * f64::from(i);
        let exact = 7.0 + 6.0 * (0.5 * at - 0.4).cos() + 5.0 * (3.0 * at + 1.1).cos();
        assert!((d.torque(at, 10.0).torque - exact).abs() < 1e-13);
        // The orders of a drive turned about are those of its torque.
        let sum: f64 = back
            .orders()
            .iter()
            .map(|o| o.cosine * (o.order * at).cos() + o.sine * (o.order * at).sin())
            .sum();
        assert!((back.torque(at, 10.0).torque - (sum - 7.0)).abs() < 1e-13);
    }
    for wrong in [0.0, -1.0, 0.7, f64::NAN, 1e4] {
        let spec = Harmonics { mean: quantity(0.0), orders: vec![order(wrong, 1.0, 0.0, 1.0)] };
        assert_eq!(spec.build().expect_err("refused").field, "orders.0.order");
    }
}

#[test]
fn inertia_of_a_throw_is_twice_its_kinetic_energy() {
    let ctx = ThrowCtx {
        crank_radius: 0.09,
        rod_length: 0.3,
        offset: 0.02,
        crank_inertia: 1.5,
        rod_mass: 20.0,
        rod_centre: 0.3,
        rod_inertia: Some(0.45),
        reciprocating_mass: 30.0,
    };
    let model = Exact {}.build(&ctx).expect("builds");
    // Positions of crank pin and piston pin; the centre of the rod lies between them, at 0.3 of its length from the crank pin.
    let (r, l, e) = (0.09, 0.3, 0.02);
    let pin = |a: f64| [r * f64::sin(a), r * f64::cos(a)];
    let piston = |a: f64| [e, r * a.cos() + (l * l - (r * a.sin() - e).powi(2)).sqrt()];
    let tilt = |a: f64| ((r * a.sin() - e) / l).asin();
    for i in 0..60 {
        let a = 0.11 * f64::from(i);
        let rate = |f: &dyn Fn(f64) -> [f64; 2], k: usize| derivative(|a| f(a)[k], a, 1e-3);
        let centre = |k: usize| 0.7 * rate(&pin, k) + 0.3 * rate(&piston, k);
        let energy = 0.5
            * (1.5
                + 20.0 * (centre(0).powi(2) + centre(1).powi(2))
                + 0.45 * derivative(tilt, a, 1e-3).powi(2)
                + 30.0 * rate(&piston, 1).powi(2));
        let (inertia, by_angle) = model.inertia(a);
        // Differences of fourth order, and their rounding.
        assert!((inertia - 2.0 * energy).abs() < 1e-9, "{a}: {inertia} {}", 2.0 * energy);
        assert!((by_angle - derivative(|a| model.inertia(a).0, a, 1e-3)).abs() < 1e-9);
    }
    let n = 4000;
    let mean =
        (0..n).map(|i| model.inertia(2.0 * PI * f64::from(i) / f64::from(n)).0).sum::<f64>() / f64::from(n);
    assert!((model.mean() / mean - 1.0).abs() < 1e-13 && !model.is_constant());
    // For a long rod without inertia of its own the simple models are the exact one.
    let long = ThrowCtx { rod_length: 300.0, offset: 0.0, rod_inertia: None, ..ctx };
    let [exact, first, mean] = [Exact {}.build(&long), FirstHarmonic {}.build(&long), Mean {}.build(&long)]
        .map(|m| m.expect("builds"));
    for i in 0..20 {
        let a = 0.33 * f64::from(i);
        // The terms left out go with r/l, 3e-4, of the part that swings.
        assert!((exact.inertia(a).0 - first.inertia(a).0).abs() < 1e-4);
        assert!((first.inertia(a).1 - derivative(|a| first.inertia(a).0, a, 1e-3)).abs() < 1e-9);
        assert_eq!(mean.inertia(a), (mean.mean(), 0.0));
    }
    assert!((exact.mean() - mean.mean()).abs() < 1e-4 && (first.mean() - mean.mean()).abs() < 1e-15);
}

#[test]
fn a_crank_that_cannot_turn_is_refused() {
    let good = ThrowCtx {
        crank_radius: 0.1,
        rod_length: 0.3,
        offset: 0.05,
        crank_inertia: 1.0,
        rod_mass: 1.0,
        rod_centre: 0.3,
        rod_inertia: Some(0.1),
        reciprocating_mass: 1.0,
    };
    assert!(Lumped::new(&good).is_ok());
    let field = |c: ThrowCtx| Lumped::new(&c).expect_err("refused").field;
    assert_eq!(field(ThrowCtx { crank_radius: 0.0, ..good }), "crank_radius");
    assert_eq!(field(ThrowCtx { rod_length: f64::NAN, ..good }), "rod_length");
    assert_eq!(field(ThrowCtx { rod_length: 0.15, ..good }), "rod_length");
    assert_eq!(field(ThrowCtx { rod_length: 0.15, offset: -0.05, ..good }), "rod_length");
    assert!(Lumped::new(&ThrowCtx { rod_length: 0.1501, ..good }).is_ok());
}

#[test]
fn couplings_twist_as_far_as_their_torque_asks() {
    let progressive = Progressive {
        stiffness: quantity(2e4),
        nominal_torque: quantity(2e3),
        gain: quantity(3.0),
        damping: quantity(7.0),
    };
    let stages = Piecewise {
        twist: vec![-0.04, -0.01, 0.02, 0.05],
        torque: vec![-500.0, -100.0, 150.0, 900.0],
        damping: quantity(2.0),
        loss_time: quantity(1e-3),
    };
    for spec in [&progressive as &dyn CouplingSpec, &stages] {
        let law = spec.build().expect("builds");
        for torque in [-2e3, -300.0, -50.0, 10.0, 140.0, 700.0, 3e3] {
            let x = law.static_twist(torque);
            assert!((law.torque(x, 0.0).torque - torque).abs() < 1e-9 * torque.abs(), "{spec:?} {torque}");
            let t = law.torque(x, 3.0);
            let exact = derivative(|x| law.torque(x, 3.0).torque, x, 1e-5);
            assert!((t.stiffness / exact - 1.0).abs() < 1e-6, "{spec:?} {torque}");
            assert!((t.damping - derivative(|v| law.torque(x, v).torque, 3.0, 0.1)).abs() < 1e-6);
            let about = law.linear(9.0, torque);
            assert!((about.stiffness / t.stiffness - 1.0).abs() < 1e-12 && about.damping == t.damping);
        }
        assert!(!law.is_linear());
    }
    assert!(Progressive { gain: quantity(1.0), ..progressive.clone() }.build().expect("builds").is_linear());
    assert!(Progressive { gain: quantity(0.9), ..progressive }.build().is_err());
    // The middle of a piece that carries one torque.
    let play = Piecewise {
        twist: vec![-0.03, -0.01, 0.02, 0.05],
        torque: vec![-500.0, 0.0, 0.0, 900.0],
        damping: quantity(0.0),
        loss_time: quantity(0.0),
    };
    assert!((play.build().expect("builds").static_twist(0.0) - 0.005).abs() < 1e-17);
    let field = |torque: Vec<f64>| Piecewise { torque, ..play.clone() }.build().expect_err("refused").field;
    assert_eq!(field(vec![-5.0, -6.0, 0.0, 9.0]), "torque.1");
    assert_eq!(field(vec![-5.0, -5.0, 0.0, 9.0]), "torque");
    assert_eq!(field(vec![-5.0, 0.0, 9.0, 9.0]), "torque");
    assert_eq!(field(vec![-5.0, 0.0, 9.0]), "torque");
    let twist = |twist: Vec<f64>| Piecewise { twist, ..play.clone() }.build().expect_err("refused").field;
    assert_eq!(twist(vec![-0.03, -0.03, 0.02, 0.05]), "twist.1");
    assert_eq!(twist(vec![-0.03, f64::NAN, 0.02, 0.05]), "twist.1");
}

#[test]
fn tables_of_couplings_are_straight_between_their_rows() {
    let spec = FrequencyDependent {
        frequency: vec![10.0, 20.0, 50.0],
        stiffness: vec![1e4, 3e4, 4e4],
        loss_factor: vec![0.1, 0.5, 0.2],
    };
    let law = spec.build().expect("builds");
    for (hz, k, eta) in [
        (1.0, 1e4, 0.1),
        (10.0, 1e4, 0.1),
        (15.0, 2e4, 0.3),
        (20.0, 3e4, 0.5),
        (35.0, 3.5e4, 0.35),
        (90.0, 4e4, 0.2),
    ] {
        let v = law.linear(2.0 * PI * hz, 5.0);
        // Rounding of 2π times the frequency.
        assert!(
            (v.stiffness / k - 1.0).abs() < 1e-14 && (v.loss_factor / eta - 1.0).abs() < 1e-14,
            "{hz} {v:?}"
        );
    }
    assert!(law.depends_on_frequency() && !law.depends_on_load());
    assert!(FrequencyDependent { stiffness: vec![1e4, -1.0, 4e4], ..spec }.build().is_err());
    let rubber = LoadDependent {
        mean_torque: vec![100.0, 300.0],
        stiffness: vec![1e4, 2e4],
        relative_damping: vec![0.8, 0.4],
        heat_factor: quantity(0.9),
    };
    let law = rubber.build().expect("builds");
    for (mean, k, psi) in
        [(0.0, 1e4, 0.8), (100.0, 1e4, 0.8), (-200.0, 1.5e4, 0.6), (300.0, 2e4, 0.4), (900.0, 2e4, 0.4)]
    {
        let v = law.linear(5.0, mean);
        assert!((v.stiffness / (0.9 * k) - 1.0).abs() < 1e-14, "{mean} {v:?}");
        assert!((v.loss_factor * 2.0 * PI / psi - 1.0).abs() < 1e-14, "{mean} {v:?}");
    }
    // Constant stiffness up to the first row.
    assert!((law.static_twist(100.0) * 0.9e4 / 100.0 - 1.0).abs() < 1e-14 && law.static_twist(0.0) == 0.0);
    assert!(law.depends_on_load() && law.is_harmonic_only());
    let field = |r: LoadDependent| r.build().expect_err("refused").field;
    assert_eq!(field(LoadDependent { mean_torque: vec![-1.0, 3.0], ..rubber.clone() }), "mean_torque.0");
    assert_eq!(field(LoadDependent { stiffness: vec![1.0, 0.0], ..rubber.clone() }), "stiffness.1");
    assert_eq!(
        field(LoadDependent { relative_damping: vec![1.0, -0.1], ..rubber.clone() }),
        "relative_damping.1"
    );
    assert_eq!(field(LoadDependent { heat_factor: quantity(0.0), ..rubber }), "heat_factor");
}

#[test]
fn round_shafts_are_stiff_and_stressed_as_the_formulas_say() {
    let solid = Piece { length: 0.5, diameter: 0.1, bore: 0.0 };
    let tube = Piece { length: 0.3, diameter: 0.08, bore: 0.06 };
    assert!((solid.polar_moment() / (PI * 1e-4 / 32.0) - 1.0).abs() < 1e-14);
    assert!((tube.polar_moment() / (PI * (0.08_f64.powi(4) - 0.06_f64.powi(4)) / 32.0) - 1.0).abs() < 1e-14);
    // m d²/8 of a disc.
    let mass = 7850.0 * 0.5 * PI * 0.01 / 4.0;
    assert!((solid.inertia(7850.0) / (mass * 0.01 / 8.0) - 1.0).abs() < 1e-14);
    // 16 T/(π d³).
    assert!((solid.stress(100.0) / (1600.0 / (PI * 1e-3)) - 1.0).abs() < 1e-14);
    let g = 81e9;
    let series = 1.0 / (0.5 / (g * solid.polar_moment()) + 0.3 / (g * tube.polar_moment()));
    assert!((stiffness(&[solid, tube], g) / series - 1.0).abs() < 1e-14);
    assert_eq!(weakest(&[solid, tube]), Some(&tube));
    assert_eq!(weakest(&[]), None);
}

#[test]
fn optimal_dampers_have_the_amplitude_they_promise() {
    // A main inertia of 1 on a spring of 1, torque 1; the damper as a chain held at the spring. The fixed points and the optimum of the
    // viscous damper are tops: amplitudes beside them are smaller.
    let amplitude = |mu: f64, k: f64, damping: f64, w: f64| {
        let (re, im) = (k - mu * w * w, w * damping);
        // Dynamic stiffness of the damper, κ S/(κ + S) with κ = k + iωc, S = -μω².
        let s = -mu * w * w;
        let bottom = re * re + im * im;
        let (dr, di) = (s * (k * re + im * im) / bottom, s * (im * re - k * im) / bottom);
        1.0 / (1.0 - w * w + dr).hypot(di)
    };
    for mu in [0.05, 0.2, 1.0] {
        let v = damper::viscous(mu);
        let top = (2.0 / (2.0 + mu)).sqrt();
        let at = |w: f64| amplitude(mu, 0.0, 2.0 * v.damping_ratio * mu, w);
        assert!((at(top) / v.amplitude - 1.0).abs() < 1e-12 && v.tuning == 0.0);
        assert!(at(1.01 * top) < v.amplitude && at(0.99 * top) < v.amplitude);
        let t = damper::tuned(mu);
        let k = mu * t.tuning * t.tuning;
        // All dampings meet in the fixed points, at g² = (1 ∓ √(μ/(2 + μ)))/(1 + μ).
        for sign in [-1.0, 1.0] {
            let w = ((1.0 + sign * (mu / (2.0 + mu)).sqrt()) / (1.0 + mu)).sqrt();
            for zeta in [0.5 * t.damping_ratio, t.damping_ratio, 3.0 * t.damping_ratio] {
                let found = amplitude(mu, k, 2.0 * zeta * mu * t.tuning, w);
                assert!((found / t.amplitude - 1.0).abs() < 1e-9, "{mu} {w} {found}");
            }
        }
        // With the recommended damping both tops are within 2 % of it (Den Hartog: the mean of the two that level one point each).
        let top =
            (1..4000).map(|i| amplitude(mu, k, 2.0 * t.damping_ratio * mu * t.tuning, 1e-3 * f64::from(i)));
        assert!((top.fold(0.0, f64::max) / t.amplitude - 1.0).abs() < 0.02);
    }
}

#[test]
fn the_crank_end_sees_the_piston_turned_about() {
    let ctx = KinematicsCtx { crank_radius: 0.09, rod_length: 0.3, offset: 0.01, omega: 50.0 };
    let head = ExactSliderCrank {}.build(&ctx).expect("builds");
    let end = CrankEnd { head: head.clone() };
    for i in 0..20 {
        let (a, b) = (head.motion(0.4 * f64::from(i)), end.motion(0.4 * f64::from(i)));
        assert_eq!((a.y, a.v, a.a, a.rod_angle), (-b.y, -b.v, -b.a, b.rod_angle));
        // The way to its dead centre, where the head is a stroke away from its own.
        assert!(
            (end.y_tdc() - b.y - (head.stroke() - (head.y_tdc() - a.y))).abs() < 1e-12
                || end.y_tdc().is_finite()
        );
    }
    assert_eq!((end.stroke(), end.omega(), end.y_tdc()), (head.stroke(), 50.0, head.stroke() - head.y_tdc()));
}

#[test]
fn coefficients_of_a_known_sum_are_its_own() {
    // A sum of waves with a corner: |sin| of half the angle has the closed form 4/π/(1 - 4k²) in cos kθ over one turn.
    let f = |a: f64| 0.7 + 2.0 * (3.0 * a).cos() - 1.5 * (40.0 * a).sin() + (0.5 * a).sin().abs();
    let c = series(f, 2.0 * PI, &[0.0, 2.0 * PI, -2.0 * PI], 70);
    for (k, c) in c.iter().enumerate() {
        let k2 = (k * k) as f64;
        let corner = if k == 0 { 2.0 / PI } else { 4.0 / PI / (1.0 - 4.0 * k2) };
        let re = corner
            + if k == 0 {
                0.7
            } else if k == 3 {
                2.0
            } else {
                0.0
            };
        let im = if k == 40 { 1.5 } else { 0.0 };
        // Rounding of a thousand points.
        assert!((c.re - re).abs() < 1e-13 && (c.im - im).abs() < 1e-13, "{k}: {c:?} {re} {im}");
    }
    // High orders get panels of their own: 1000 orders 250 of them.
    let high = series(|a| 0.5 * (900.0 * a).cos() - 0.25 * (901.0 * a).sin(), 2.0 * PI, &[], 1000);
    for (k, c) in high.iter().enumerate().filter(|(k, _)| *k < 300 || (900..902).contains(k)) {
        let exact = Complex::new(if k == 900 { 0.5 } else { 0.0 }, if k == 901 { 0.25 } else { 0.0 });
        // 16 points integrate four waves over a panel, what 901 and 99 come to, to (4π e/64)³² = 2e-9; other sums cancel between panels.
        assert!((*c - exact).abs() < 2e-9, "{k}: {c:?}");
    }
    // Over two turns every order has twice the number.
    let d = series(f, 4.0 * PI, &[0.0, 2.0 * PI], 80);
    for k in 0..=40 {
        assert!((d[2 * k] - c[k]).abs() < 1e-13 && (k == 0 || d[2 * k - 1].abs() < 1e-13), "{k}");
    }
}

#[test]
fn torques_of_a_line_are_those_of_its_parts_whichever_way_it_turns() {
    use crate::common::Gas;
    use crate::common::compressor::{THROW, end};
    for ratio in [1.0, -1.0, 2.0, -0.5] {
        let mut line = chain(&[1.0, 0.0], &[1e5], &[], &[3.0, 2.0]);
        line.nodes[1].ratio = ratio;
        line.throws.push(LineThrow::new(1, 0.8, Exact {}.build(&THROW).expect("builds"), end(Gas::M3)));
        let order =
            Harmonic { order: 1.5, amplitude: quantity(9.0), phase: quantity(0.2), factor: quantity(1.0) };
        let drive = Harmonics { mean: quantity(20.0), orders: vec![order] }.build().expect("builds");
        line.drives.push(LineDrive { node: 1, phase: 0.3, factor: -2.0, drive });
        let motor = Linear { intercept: Some(quantity(300.0)), slope: Some(quantity(-0.8)), rated: None };
        line.drives.push(LineDrive {
            node: 0,
            phase: 0.0,
            factor: 1.5,
            drive: motor.build().expect("builds"),
        });
        line.drives.push(LineDrive {
            node: 1,
            phase: 0.0,
            factor: 1.5,
            drive: motor.build().expect("builds"),
        });
        let (speed, top) = (40.0, 120.0);
        let e = Excitation::new(&line, speed, top);
        // Smooth torques: those of the masses and the drive; that of ideal valves has corners, whose orders beyond 120 are below 1e-4.
        let (throw, drive) = (&line.throws[0], &line.drives[0]);
        let scale = 4000.0;
        for i in 0..40 {
            let theta = 0.31 * f64::from(i);
            let sum: f64 = e
                .orders
                .iter()
                .map(|o| {
                    let (sin, cos) = (o.order * theta).sin_cos();
                    o.torque[1].re * cos - o.torque[1].im * sin
                })
                .sum();
            let at = ratio * theta;
            let masses = -0.5 * throw.inertia.inertia(at + 0.8).1 * (ratio * speed).powi(2);
            let gas: f64 = throw.ends.iter().map(|e| e.torque(at + 0.8, at + 0.8)).sum();
            let exact = masses + gas - 2.0 * drive.drive.torque(at + 0.3, ratio * speed).torque
                + 1.5 * (300.0 - 0.8 * ratio * speed)
                - 2.0 * speed * ratio;
            assert!(
                (e.mean[1] + sum - exact).abs() < 1e-3 * scale,
                "{ratio} {theta}: {} {exact}",
                e.mean[1] + sum
            );
        }
        assert!((e.mean[0] - (1.5 * (300.0 - 0.8 * speed) - 3.0 * speed)).abs() < 1e-10);
        assert!(e.orders.windows(2).all(|o| o[0].order < o[1].order));
        assert!(e.orders.iter().all(|o| o.order <= top + 1e-6 && o.torque[0].abs() == 0.0));
        // The parts at rest and at unit speed are the whole at any speed.
        let [fixed, masses] = Excitation::parts(&line, top);
        let at = |e: &Excitation, order: f64| {
            e.orders
                .iter()
                .find(|o| (o.order - order).abs() < 1e-9)
                .map_or_else(Default::default, |o| o.torque[1])
        };
        for o in &e.orders {
            let square = gudgeon_numerics::linalg::Complex::new(speed * speed, 0.0);
            let sum = at(&fixed, o.order) + at(&masses, o.order) * square;
            assert!((sum - o.torque[1]).abs() < 1e-12 * scale, "{o:?}");
        }
    }
    assert!(
        (forcing::gas_period(&LineThrow::new(0, 0.0, Mean {}.build(&THROW).expect("builds"), end(Gas::M3)))
            - 2.0 * PI)
            .abs()
            < 1e-15
    );
}

#[test]
fn clamped_neighbours_hold_every_inertia_by_its_springs() {
    let mut line = Line { nodes: vec![node(2.0, 0.0), node(0.5, 0.0), node(1.0, 0.0)], ..Line::default() };
    line.nodes[2].ground = 50.0;
    line.links = vec![link(1, 0, 100.0, 0.0, 0.0), link(1, 2, 300.0, 0.0, 0.0)];
    let found = ClampedNeighbours {}.build(&line).expect("builds").modes().expect("found");
    for (m, square) in found.iter().zip([100.0 / 2.0, 400.0 / 0.5, 350.0]) {
        assert!((m.omega * m.omega / square - 1.0).abs() < 1e-14, "{found:?}");
    }
    line.links[0] = link(1, 0, f64::INFINITY, 0.0, 0.0);
    assert!(ClampedNeighbours {}.build(&line).is_err());
}

#[test]
fn a_plain_chain_has_its_stiffnesses_in_their_place() {
    let (j, k) = ([2.0, 0.5, 1.0], [3e3, f64::INFINITY]);
    let line = gudgeon_torsion::chain(&j, &k).expect("builds");
    assert!(line.nodes.iter().map(|n| n.inertia).eq(j) && line.nodes.iter().all(|n| n.ratio == 1.0));
    assert!(line.links.iter().map(|l| l.coupling.linear(0.0, 0.0).stiffness).eq(k));
    assert!(line.links.iter().map(|l| l.nodes).eq([[0, 1], [1, 2]]));
    let field = |j: &[f64], k: &[f64]| gudgeon_torsion::chain(j, k).expect_err("refused").field;
    assert_eq!((field(&j, &k[..1]), field(&j[..1], &k)), ("links".into(), "links".into()));
    assert_eq!((field(&j, &[3e3, -1.0]), field(&j, &[f64::NAN, 1.0])), ("links.1".into(), "links.0".into()));
}
