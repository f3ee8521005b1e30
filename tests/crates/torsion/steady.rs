//! Lines at constant mean speed: mean torques, modes against orders, natural frequencies over the frequency and the speed.

use crate::common::compressor::run;
use crate::common::{chain, link, node};
use crate::elimination::{Numbers, random_line};
use gudgeon_core::kinds::*;
use gudgeon_core::quantity::quantity;
use gudgeon_torsion::coupling::FrequencyDependent;
use gudgeon_torsion::drive::{Constant, Harmonic, Harmonics, Linear};
use gudgeon_torsion::receptance::Receptance;
use gudgeon_torsion::steady::Steady;
use gudgeon_torsion::torsion::{HarmonicBalance, Modal, Orders};
use std::f64::consts::PI;

fn context<'a>(line: &'a Line, speed: f64, balance: &'a [f64]) -> TorsionCtx<'a> {
    TorsionCtx { line, speed, orders: 20.0, period: 4.0 * PI, balance, angles: &[], speeds: &[], times: &[] }
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

/// A motor, a gear to a shaft that turns backwards at 2.5 times the speed, and two loads, one on a branch.
fn geared() -> Line {
    let mut line = chain(&[2.0, 0.5, 0.2, 1.0], &[3e4, 5e5, 2e4], &[4.0, 0.0, 3.0], &[0.2, 0.0, 0.1, 0.3]);
    line.nodes[2].ratio = -2.5;
    line.nodes[3].ratio = -2.5;
    line.nodes.push(node(0.7, 0.0));
    line.links.push(link(4, 1, 1e4, 2.0, 0.0));
    line.drives = vec![
        drive(0, 1.0, &Constant { torque: quantity(900.0) }),
        drive(3, 1.0, &Constant { torque: quantity(150.0) }),
        drive(4, -1.0, &Constant { torque: quantity(200.0) }),
    ];
    line
}

#[test]
fn mean_torques_and_angles_are_in_equilibrium() {
    let (line, speed) = (geared(), 60.0);
    let balance = [0.7, 0.0, 0.0, 0.0, 0.3];
    let out = run(&Orders {}, &context(&line, speed, &balance));
    // Counted at the reference shaft the torques, the drag and what balances make zero.
    let own: Vec<f64> = (0..5)
        .map(|i| {
            let given = [900.0, 0.0, 0.0, 150.0, -200.0][i];
            given - line.nodes[i].damping * speed * line.nodes[i].ratio
        })
        .collect();
    let total: f64 = own.iter().zip(&line.nodes).map(|(t, n)| t * n.ratio).sum();
    assert!((out.balance_torque + total).abs() < 1e-10 && out.speed == speed);
    let mut left: Vec<f64> =
        (0..5).map(|i| own[i] + balance[i] * out.balance_torque / line.nodes[i].ratio).collect();
    for (l, t) in line.links.iter().zip(&out.mean_torque) {
        let [a, b] = l.nodes;
        let gear = line.nodes[a].ratio / line.nodes[b].ratio;
        left[a] -= t;
        left[b] += gear * t;
        // The twist is the torque by the stiffness.
        let twist = out.mean_angle[a] - gear * out.mean_angle[b];
        assert!((twist * l.coupling.linear(0.0, 0.0).stiffness - t).abs() < 1e-9, "{}", l.name);
    }
    assert!(left.iter().all(|t| t.abs() < 1e-9), "{left:?}");
    let zero: f64 = (0..5).map(|i| balance[i] * out.mean_angle[i] / line.nodes[i].ratio).sum();
    assert!(zero.abs() < 1e-15, "{zero}");
}

#[test]
fn a_held_line_rests_on_its_springs() {
    for held in [vec![(3, 5e3)], vec![(0, 2e3), (4, 7e3)]] {
        let mut line = geared();
        for (i, k) in &held {
            line.nodes[*i].ground = *k;
        }
        let out = run(&Orders {}, &context(&line, 60.0, &[1.0]));
        assert_eq!(out.balance_torque, 0.0);
        let mut left: Vec<f64> = (0..5)
            .map(|i| [900.0, 0.0, 0.0, 150.0, -200.0][i] - line.nodes[i].damping * 60.0 * line.nodes[i].ratio)
            .collect();
        for (l, t) in line.links.iter().zip(&out.mean_torque) {
            let [a, b] = l.nodes;
            left[a] -= t;
            left[b] += line.nodes[a].ratio / line.nodes[b].ratio * t;
        }
        if held.len() > 1 {
            for (i, k) in &held {
                left[*i] -= k * out.mean_angle[*i];
            }
        } else {
            // One place takes up the rest, whatever its spring.
            left[held[0].0] = 0.0;
        }
        assert!(left.iter().all(|t| t.abs() < 1e-8), "{left:?}");
    }
}

/// A line whose dampers are proportional to its springs and inertias: its modes are those without damping.
fn proportional(tau: f64, alpha: f64) -> Line {
    let j = [1.5, 0.4, 0.9, 0.3, 0.6];
    let mut line = chain(&j, &[2e4, 5e4, 1e4], &[2e4 * tau, 5e4 * tau, 1e4 * tau], &j.map(|j| alpha * j));
    line.nodes.truncate(4);
    line.nodes.push(LineNode { ratio: -2.0, ..node(j[4], alpha * j[4]) });
    line.links.push(link(4, 1, 3e3, 3e3 * tau, 0.0));
    line.drives = vec![
        drive(0, 1.0, &harmonics(&[(0.5, 40.0), (2.0, 90.0)])),
        drive(4, 1.0, &harmonics(&[(2.0, 30.0)])),
    ];
    line
}

#[test]
fn all_modes_of_proportional_damping_are_the_orders() {
    let line = proportional(2e-4, 0.8);
    let ctx = context(&line, 70.0, &[1.0]);
    let exact = run(&Orders {}, &ctx);
    for static_correction in [true, false] {
        let out = run(&Modal { modes: 5, damping_ratio: None, static_correction }, &ctx);
        // Order 2 of the geared shaft is order 4 of the reference shaft.
        assert_eq!(out.orders.len(), 3);
        for (a, b) in out.orders.iter().zip(exact.orders.iter()) {
            let size = |v: &[[f64; 2]]| v.iter().map(|x| x[0].hypot(x[1])).fold(0.0, f64::max);
            for (x, y) in a.angle.iter().zip(&b.angle) {
                // Rounding of the modes, orthogonal to about 1e-13.
                assert!((x[0] - y[0]).hypot(x[1] - y[1]) < 1e-10 * size(&b.angle), "{x:?} {y:?}");
            }
            for ((x, y), [h, g]) in
                a.torque.iter().zip(&b.torque).zip(a.heat.iter().zip(&b.heat).map(|(h, g)| [h, g]))
            {
                assert!((x[0] - y[0]).hypot(x[1] - y[1]) < 1e-8 * size(&b.torque), "{x:?} {y:?}");
                assert!((h - g).abs() < 1e-7 * b.heat.iter().sum::<f64>(), "{h} {g}");
            }
            assert_eq!((a.order, &a.excitation), (b.order, &b.excitation));
        }
    }
    // Modes left out that follow statically are wrong by (w/ω)², 35 rad/s by the fourth frequency, instead of altogether.
    let error = |static_correction: bool| {
        let out = run(&Modal { modes: 3, damping_ratio: None, static_correction }, &ctx);
        let [found, exact] = [&out, &exact].map(|o| o.orders.get(0).angle);
        let pairs = found.iter().zip(&exact);
        pairs.map(|(x, y)| (x[0] - y[0]).hypot(x[1] - y[1])).fold(0.0, f64::max)
    };
    let fourth = Steady::new(&ctx).expect("builds").frequencies(9).expect("found")[2];
    let (with, without) = (error(true), error(false));
    // Between the static answer and the modes there is the damping as well, 2ζ w/ω of the same size.
    assert!(with < 2.0 * (35.0 / fourth).powi(2) * without && without > 0.0, "{with} {without} {fourth}");
}

#[test]
fn a_damping_ratio_stands_for_that_of_every_mode() {
    // Two inertias: q = φᵀT/(ω² - w² + 2iζωw), by hand for the one elastic mode, and the rigid one beside it.
    let mut line = chain(&[2.0, 0.5], &[8e3], &[], &[]);
    line.drives.push(drive(1, 1.0, &harmonics(&[(2.0, 50.0)])));
    let (w, zeta) = (2.0 * 30.0, 0.07);
    let modal = Modal { modes: 2, damping_ratio: Some(quantity(zeta)), static_correction: true };
    let out = run(&modal, &context(&line, 30.0, &[1.0]));
    let square = 8e3 * (1.0 / 2.0 + 1.0 / 0.5);
    let natural = f64::sqrt(square);
    // The second inertia in the elastic mode: φ₂² = (1/J₂) J₁/(J₁ + J₂); rigid 1/(J₁ + J₂).
    let (elastic, rigid) = ((1.0 / 0.5) * 2.0 / 2.5, 1.0 / 2.5);
    let (re, im) = (square - w * w, 2.0 * zeta * natural * w);
    let torque = [50.0 * f64::cos(0.6), -50.0 * f64::sin(0.6)];
    let d = re * re + im * im;
    let (gr, gi) = (elastic * re / d - rigid / (w * w), -elastic * im / d);
    let exact = [gr * torque[0] - gi * torque[1], gr * torque[1] + gi * torque[0]];
    let found = out.orders.get(0).angle[1];
    assert!(
        (found[0] - exact[0]).hypot(found[1] - exact[1]) < 1e-12 * exact[0].hypot(exact[1]),
        "{found:?} {exact:?}"
    );
    assert_eq!(out.counters["modes"], 2);
}

#[test]
fn modes_refuse_what_they_cannot_carry() {
    let line = proportional(0.0, 0.0);
    let field = |spec: &dyn TorsionSpec, line: &Line| {
        spec.build(&context(line, 70.0, &[1.0])).expect_err("refused").field
    };
    assert_eq!(field(&Modal { modes: 0, ..Modal::default() }, &line), "modes");
    let mut held = line.clone();
    held.nodes[1].ground = 10.0;
    assert_eq!(field(&Modal::default(), &held), "static_correction");
    assert!(
        Modal { static_correction: false, ..Modal::default() }.build(&context(&held, 70.0, &[1.0])).is_ok()
    );
    let mut slack = line.clone();
    slack.nodes[4].inertia = 0.0;
    slack.links[3] = link(4, 1, 0.0, 1.0, 0.0);
    assert_eq!(field(&Modal::default(), &slack), "inertias.4");
    // An order that hits a natural frequency without damping.
    let mut bare = chain(&[1.0, 1.0], &[800.0], &[], &[]);
    bare.drives.push(drive(0, 1.0, &harmonics(&[(2.0, 1.0)])));
    let mut model = Modal::default().build(&context(&bare, 20.0, &[1.0])).expect("builds");
    assert!(model.run(&mut TorsionOut::default()).is_err());
}

#[test]
fn harmonic_balance_wants_orders_that_repeat_with_the_cycle() {
    let mut line = proportional(1e-4, 0.1);
    let law = gudgeon_torsion::coupling::Progressive {
        stiffness: quantity(2e4),
        nominal_torque: quantity(1e3),
        gain: quantity(2.0),
        damping: quantity(5.0),
    };
    line.links[0].coupling = law.build().expect("builds");
    let hb = HarmonicBalance::default();
    let field = |line: &Line, orders: f64, period: f64| {
        hb.build(&TorsionCtx { orders, period, ..context(line, 70.0, &[1.0]) }).err().map(|e| e.field)
    };
    assert_eq!(field(&line, 20.0, 4.0 * PI), None);
    // Half orders do not repeat after one turn.
    assert_eq!(field(&line, 20.0, 2.0 * PI).as_deref(), Some("model"));
    assert_eq!(field(&line, 0.4, 4.0 * PI).as_deref(), Some("orders"));
    assert_eq!(field(&line, 2001.0, 4.0 * PI).as_deref(), Some("orders"));
    // Three places (the ends of the coupling, and the drive on the branch) with 2900 harmonics: 25.2 million numbers in the Krylov space.
    assert_eq!(field(&line, 1450.0, 4.0 * PI).as_deref(), Some("orders"));
    assert_eq!(field(&line, 1400.0, 4.0 * PI), None);
    let strict = HarmonicBalance { tolerance: quantity(1e-15), rounds: 10 };
    assert_eq!(strict.build(&context(&line, 70.0, &[1.0])).expect_err("refused").field, "tolerance");
}

#[test]
fn frequencies_hold_with_the_stiffness_that_they_have() {
    let mut line = chain(&[1.0, 0.5, 2.0], &[1e4, 1e4], &[], &[]);
    let law = FrequencyDependent {
        frequency: vec![0.0, 10.0, 60.0],
        stiffness: vec![5e3, 2e4, 9e4],
        loss_factor: vec![0.1, 0.1, 0.1],
    };
    line.links[1].coupling = law.build().expect("builds");
    let mut steady = Steady::new(&context(&line, 50.0, &[1.0])).expect("builds");
    let found = steady.frequencies(9).expect("found");
    assert_eq!(found.len(), 2);
    for (m, w) in found.iter().enumerate() {
        // The line with the stiffness of this frequency has it as its own.
        let k = line.links[1].coupling.linear(*w, 0.0).stiffness;
        let fixed = chain(&[1.0, 0.5, 2.0], &[1e4, k], &[], &[]);
        let own = Steady::new(&context(&fixed, 50.0, &[1.0])).expect("builds").frequencies(9).expect("found");
        assert!((own[m] / w - 1.0).abs() < 1e-12, "{found:?} {own:?}");
    }
    assert!(!steady.depends_on_speed());
}

#[test]
fn critical_speeds_have_the_damping_of_their_mode() {
    // Proportional damping: the ratio of a mode is ½ (τω + α/ω).
    let line = proportional(2e-4, 0.8);
    let mut steady = Steady::new(&context(&line, 70.0, &[1.0])).expect("builds");
    let natural = steady.frequencies(9).expect("found");
    let found = steady.critical_speeds(&[0.5, 2.0], 1.0, 1e3, 10).expect("converges");
    assert_eq!(found.len(), 2 * natural.len());
    assert!(found.windows(2).all(|c| c[0].speed <= c[1].speed) && steady.speed == 70.0);
    for c in &found {
        let w = natural[c.mode - 1];
        // Halving ends at a few digits of rounding.
        assert!(
            (c.omega / w - 1.0).abs() < 1e-14 && (c.speed * c.order / c.omega - 1.0).abs() < 1e-15,
            "{c:?}"
        );
        assert!((c.damping_ratio / (0.5 * (2e-4 * w + 0.8 / w)) - 1.0).abs() < 1e-10, "{c:?}");
    }
    // Damping by the derivative of a motor's torque-speed line, c = -C₁ ratio².
    let mut motor = chain(&[1.0, 1.0], &[800.0], &[], &[]);
    motor.nodes[1].ratio = -2.0;
    let law = Linear { intercept: Some(quantity(10.0)), slope: Some(quantity(-0.5)), rated: None };
    motor.drives.push(drive(1, 3.0, &law));
    let s = Steady::new(&context(&motor, 70.0, &[1.0])).expect("builds");
    assert!((s.tree.damping[s.tree.position[1]] - 3.0 * 0.5 * 4.0).abs() < 1e-15);
}

/// A main inertia on a spring to the ground with the ring of a viscous damper: `[J, J_d]`, k, c.
fn viscous([main, ring]: [f64; 2], k: f64, c: f64) -> Steady {
    let mut line = chain(&[main, ring], &[0.0], &[c], &[]);
    line.nodes[0].ground = k;
    Steady::new(&context(&line, 70.0, &[1.0])).expect("builds")
}

#[test]
fn a_line_with_a_viscous_damper_has_frequencies_with_damping() {
    // (z + p)(z² + 2 a z + a² + b²) = z³ + c (J + J_d)/(J J_d) z² + k/J z + k c/(J J_d): values for any p, a, b.
    for (p, a, b) in [(0.8, 0.3, 1.0), (0.2, 0.05, 2.0), (5.0, 1.5, 0.7), (40.0, 0.2, 3.0)] {
        let square = a * a + b * b;
        let main = 2.0;
        let k = main * (square + 2.0 * a * p);
        let c_by_ring = p * square / (square + 2.0 * a * p);
        let ring = main * ((p + 2.0 * a) / c_by_ring - 1.0);
        let mut steady = viscous([main, ring], k, c_by_ring * ring);
        assert!(steady.hangs_on_damping());
        let found = steady.frequencies(9).expect("found");
        // Newton on the determinant ends at rounding.
        assert!(found.len() == 1 && (found[0] / b - 1.0).abs() < 1e-11, "{found:?} {b}");
        let critical = steady.critical_speeds(&[0.5, 2.0, 3.0], 0.4 * b, 3.0 * b, 10).expect("converges");
        let speeds: Vec<f64> = critical.iter().map(|c| c.speed).collect();
        // A third of the frequency lies below the range.
        assert_eq!(critical.iter().map(|c| c.order).collect::<Vec<_>>(), [2.0, 0.5], "{critical:?}");
        assert!((speeds[0] / (0.5 * b) - 1.0).abs() < 1e-11 && (speeds[1] / (2.0 * b) - 1.0).abs() < 1e-11);
        let ratio = a / a.hypot(b);
        assert!(critical.iter().all(|c| (c.damping_ratio / ratio - 1.0).abs() < 1e-10 && c.mode == 1));
    }
}

#[test]
fn a_viscous_damper_stands_between_its_ring_free_and_locked() {
    let (main, ring, k) = (3.0, 1.5, 5e4);
    let frequency = |c: f64| viscous([main, ring], k, c).frequencies(9).expect("found")[0];
    let own = f64::sqrt(k / main);
    // The damping ratio of either end is 1e-6, its square what is left.
    assert!((frequency(1e-6 * own) / own - 1.0).abs() < 1e-10);
    assert!((frequency(1e6 * own) / f64::sqrt(k / (main + ring)) - 1.0).abs() < 1e-10);
    let optimum = gudgeon_torsion::damper::viscous(ring / main);
    let best = frequency(2.0 * optimum.damping_ratio * ring * own);
    // Half of the ring, as usual in practice: the root of the cubic is 0.5 % above it for a ring of half of the inertia.
    let half = f64::sqrt(k / (main + 0.5 * ring));
    assert!((best / half - 1.005_158).abs() < 1e-6, "{}", best / half);
}

/// The pivot of the root says where to count next; what is found are the natural frequencies of plain bisection, by the order, for a fraction of
/// its counts.
#[test]
fn critical_speeds_of_random_trees_are_their_natural_frequencies() {
    let mut r = Numbers(20_261_125);
    let (mut counts, mut places) = (0, 0);
    for n in 2..40 {
        let line = random_line(n, &mut r);
        let balance: Vec<f64> = (0..n).map(|i| f64::from(u8::from(i == 0))).collect();
        let mut steady = Steady::new(&context(&line, 70.0, &balance)).expect("builds");
        let mut exact: Vec<f64> = Vec::new();
        for order in [1.0, 3.5] {
            exact.extend(steady.frequencies(n).expect("found").iter().map(|w| w / order));
        }
        exact.sort_unstable_by(f64::total_cmp);
        let (from, to) = (0.5 * exact[0], 2.0 * exact[exact.len() - 1]);
        let before = steady.pivot_counts;
        let found = steady.critical_speeds(&[1.0, 3.5], from, to, 10).expect("converges");
        counts += steady.pivot_counts - before;
        places += found.len();
        assert_eq!(found.len(), exact.len(), "{n}");
        for (c, w) in found.iter().zip(&exact) {
            // Both ends of an interval are a few digits of rounding apart.
            assert!((c.speed / w - 1.0).abs() < 4e-15, "{n}: {c:?} {w}");
        }
    }
    // Bisection takes 52 for every place, and some that part them.
    assert!(counts < 26 * places as u64, "{counts} counts for {places}");
}

#[test]
fn receptances_are_the_response_order_by_order() {
    // An undamped absorber tuned to order 3 of one of the speeds: a pivot that vanishes there.
    let mut line = proportional(2e-4, 0.0);
    line.nodes[4].damping = 0.0;
    line.nodes.push(LineNode { ratio: 2.0, ..node(0.25, 0.0) });
    line.links.push(link(5, 2, 0.25 * 210.0 * 210.0, 0.0, 0.0));
    // The elimination ends at the last inertia: behind the absorber stands another one.
    line.nodes.push(node(0.2, 0.1));
    line.links.push(link(3, 6, 8e3, 1.0, 0.0));
    line.drives.clear();
    let mut steady = Steady::new(&context(&line, 70.0, &[1.0])).expect("builds");
    let mut receptance = Receptance::default();
    let (orders, n) = (12, 7);
    // From speed to speed the same storage, also of fewer orders.
    for (speed, base, orders) in [(70.0, 1.0, orders), (33.0, 0.5, orders), (70.0, 0.5, 7), (140.0, 1.5, 3)] {
        steady.set_speed(speed);
        receptance.factor(&mut steady, base, orders);
        let torque = |i: usize, k: usize| {
            let at = (1 + i * 7 + k * 3) as f64;
            gudgeon_numerics::linalg::Complex::new(10.0 * at.sin(), 10.0 * at.cos())
        };
        for p in 0..n {
            for k in 0..orders {
                let t = torque(steady.tree.node[p], k);
                let at = p * orders + k;
                receptance.field[0][at] = steady.tree.ratio[p] * t.re;
                receptance.field[1][at] = steady.tree.ratio[p] * t.im;
            }
        }
        receptance.solve(&mut steady).expect("no resonance");
        for k in 0..orders {
            let given = (0..n).map(|i| torque(i, k)).collect();
            let order = gudgeon_torsion::forcing::Order { order: base * (k + 1) as f64, torque: given };
            let exact = steady.respond(&order).expect("no resonance");
            let top = exact.angle.iter().map(|a| a[0].hypot(a[1])).fold(0.0, f64::max);
            for p in 0..n {
                let [re, im] = exact.angle[steady.tree.node[p]];
                let (at, ratio) = (p * orders + k, steady.tree.ratio[p]);
                let error =
                    (receptance.field[0][at] * ratio - re).hypot(receptance.field[1][at] * ratio - im);
                // Rounding, times the magnification of resonances nearby.
                assert!(error < 1e-10 * top, "{speed} order {} node {p}: {error:e} of {top:e}", order.order);
            }
        }
    }
    // Without damping the order that meets a natural frequency: √(k (1/J + 1/J)) = 40 rad/s at order 4.
    let bare = chain(&[1.0, 1.0], &[800.0], &[], &[]);
    let mut steady = Steady::new(&context(&bare, 10.0, &[1.0])).expect("builds");
    receptance.factor(&mut steady, 1.0, 6);
    receptance.field[0].fill(1.0);
    receptance.field[0][..6].fill(2.0);
    assert_eq!(receptance.solve(&mut steady).expect_err("a resonance").0, 3);
}

/// A compressor of six throws with the ring of a viscous damper at its free end and loss factors in its shafts: all modes are found, for any damping,
/// and each stands between its ring free and its ring locked.
#[test]
fn loss_factors_and_a_viscous_damper_go_together() {
    let inertia = [120.0, 62.0, 1.81, 1.81, 1.81, 1.81, 1.81, 1.81];
    let stiffness = [1.1e5, 22e6, 26e6, 20e6, 26e6, 20e6, 26e6];
    let line = |ring: f64, c: Option<f64>| {
        let mut j = inertia.to_vec();
        *j.last_mut().expect("a throw") += ring;
        let mut line = chain(&j, &stiffness, &[], &[]);
        for (i, (l, k)) in line.links.iter_mut().zip(stiffness).enumerate() {
            *l = crate::common::link(i, i + 1, k, 0.0, 0.01);
        }
        if let Some(c) = c {
            line.nodes.push(crate::common::node(4.0, 0.0));
            line.links.push(crate::common::link(7, 8, 0.0, c, 0.0));
        }
        let mut steady = Steady::new(&context(&line, 100.0, &[1.0])).expect("builds");
        steady.frequencies(20).expect("found")
    };
    let (free, locked) = (line(0.0, None), line(4.0, None));
    for c in [1.0, 50.0, 1e3, 3.5e3, 2e4, 1e6] {
        let found = line(0.0, Some(c));
        assert_eq!(found.len(), free.len());
        for (w, (free, locked)) in found.iter().zip(free.iter().zip(&locked)) {
            // The loss factor stiffens by an eighth of its square, and damping lowers a mode by half of the square of its ratio, 0.06 at most.
            assert!(*w < 1.001 * free && *w > 0.96 * locked, "{c}: {w} of {locked} to {free}");
        }
    }
}
