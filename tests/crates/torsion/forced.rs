//! Forced vibration against exact solutions, conservation and special cases.

use crate::common::reference::*;
use crate::common::{chain, engine, link, node};
use gudgeon_core::kinds::{Line, LineNode};
use gudgeon_numerics::linalg::Complex;
use gudgeon_torsion::sweep::{LANES, Sweep};
use gudgeon_torsion::tree::{Resonance, Singular, Tree, Work};

fn c(re: f64, im: f64) -> Complex {
    Complex::new(re, im)
}

struct Answer {
    angle: Vec<Complex>,
    transmitted: Vec<Complex>,
}

/// Answer by node and link of the line.
fn solve(line: &Line, omega: f64, torque: &[Complex]) -> Result<Answer, Resonance> {
    let t = Tree::new(line).expect("builds");
    let n = t.len();
    let scaled: Vec<Complex> = (0..n).map(|p| torque[t.node[p]] * c(t.ratio[p], 0.0)).collect();
    let (mut x, mut q) = (vec![Complex::default(); n], vec![Complex::default(); n]);
    t.solve(c(0.0, omega), &scaled, &mut x, &mut q, Singular::Refuse, &mut Work::new(n))?;
    let mut a = Answer {
        angle: vec![Complex::default(); n],
        transmitted: vec![Complex::default(); line.links.len()],
    };
    for p in 0..n {
        a.angle[t.node[p]] = x[p] * c(t.ratio[p], 0.0);
        if t.parent[p] < n {
            let sign = if t.forward[p] { 1.0 } else { -1.0 };
            a.transmitted[t.link[p]] = q[p] * c(sign / t.link_ratio[p], 0.0);
        }
    }
    Ok(a)
}

/// Largest imbalance of any inertia, by the largest term.
fn residual(line: &Line, omega: f64, torque: &[Complex], a: &Answer) -> f64 {
    let mut left: Vec<Complex> = torque.to_vec();
    let mut size = torque.iter().map(|t| t.abs()).fold(0.0, f64::max);
    for (i, n) in line.nodes.iter().enumerate() {
        let own = c(n.ground - omega * omega * n.inertia, omega * n.damping) * a.angle[i];
        size = size.max(own.abs());
        left[i] = left[i] - own;
    }
    for (l, k) in line.links.iter().enumerate() {
        let [i, j] = k.nodes;
        let t = a.transmitted[l];
        size = size.max(t.abs());
        left[i] = left[i] - t;
        left[j] = left[j] + t * c(line.nodes[i].ratio / line.nodes[j].ratio, 0.0);
    }
    left.iter().map(|v| v.abs()).fold(0.0, f64::max) / size
}

fn engine_torque(order: f64, amplitude: f64) -> Vec<Complex> {
    let mut t = vec![Complex::default(); 9];
    for (k, firing) in ENGINE_FIRING.iter().enumerate() {
        let a = -order * firing.to_radians();
        t[2 + k] = c(amplitude * a.cos(), amplitude * a.sin());
    }
    t
}

#[test]
fn nine_inertia_engine() {
    let line = engine();
    let mut worst = 0.0_f64;
    for f in ENGINE_FORCED {
        let amplitude = ENGINE_TORQUE.iter().find(|t| t[0] == f.order).expect("an order")[1];
        let w = f.order * f.rpm * std::f64::consts::PI / 30.0;
        let a = solve(&line, w, &engine_torque(f.order, amplitude)).expect("damped");
        let top = f.amplitude.iter().copied().fold(0.0, f64::max);
        for i in 0..9 {
            let exact = c(f.amplitude[i] * f.phase[i].cos(), f.amplitude[i] * f.phase[i].sin());
            worst = worst.max((a.angle[i] - exact).abs() / top);
        }
        let top = f.torque.iter().copied().fold(0.0, f64::max);
        for i in 0..8 {
            worst = worst.max((a.transmitted[i].abs() - f.torque[i]).abs() / top);
        }
    }
    // Rounding times the magnification of the resonances nearby (less than a hundred).
    assert!(worst < 1e-13, "{worst:e}");
}

#[test]
fn lanes_are_the_careful_elimination() {
    let mut line = engine();
    // Branches, a gear, a rigid link, an inertia of zero, a grounded end, loss factors.
    line.nodes.push(LineNode { ratio: 2.5, ..node(0.01, 0.0) });
    line.links.push(link(8, 9, 3e5, 1.0, 0.02));
    line.nodes.push(node(0.0, 0.0));
    line.links.push(link(4, 10, f64::INFINITY, 0.0, 0.0));
    line.nodes.push(LineNode { ground: 2e4, ..node(0.2, 0.5) });
    line.links.push(link(10, 11, 1e5, 0.0, 0.1));
    let t = Tree::new(&line).expect("builds");
    let n = t.len();
    assert!(!t.chain);
    let mut sweep = Sweep::new(n);
    for k in 0..50 {
        let omega: [f64; LANES] = std::array::from_fn(|l| 20.0 + 37.0 * (k * LANES + l) as f64);
        let torque: Vec<[f64; 2]> =
            (0..n).map(|i| [100.0 * ((i + k) as f64).sin(), 50.0 * (i as f64).cos()]).collect();
        sweep.solve(&t, &omega, &torque).expect("damped");
        for (l, w) in omega.iter().enumerate() {
            let f: Vec<Complex> = torque.iter().map(|f| c(f[0], f[1])).collect();
            let (mut x, mut q) = (vec![Complex::default(); n], vec![Complex::default(); n]);
            t.solve(c(0.0, *w), &f, &mut x, &mut q, Singular::Refuse, &mut Work::new(n)).expect("damped");
            let top = x.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let most = q.iter().map(|x| x.abs()).fold(0.0, f64::max);
            for i in 0..n {
                let lane = c(sweep.angle[i][0][l], sweep.angle[i][1][l]);
                assert!((lane - x[i]).abs() < 1e-13 * top, "{k} {l} {i}");
                let lane = c(sweep.transmitted[i][0][l], sweep.transmitted[i][1][l]);
                assert!((lane - q[i]).abs() < 1e-12 * most, "{k} {l} {i}");
            }
        }
        // Balance of every inertia of the line itself.
        let physical: Vec<Complex> = {
            let mut v = vec![Complex::default(); n];
            for p in 0..n {
                v[t.node[p]] = c(torque[p][0] / t.ratio[p], torque[p][1] / t.ratio[p]);
            }
            v
        };
        let a = solve(&line, omega[0], &physical).expect("damped");
        assert!(residual(&line, omega[0], &physical, &a) < 1e-13);
    }
}

#[test]
fn undamped_resonance_is_refused_and_its_neighbours_are_not() {
    let line = chain(&[2.0, 1.0], &[300.0], &[], &[]);
    let w = (300.0_f64 * 1.5).sqrt();
    let torque = [c(1.0, 0.0), c(0.0, 0.0)];
    assert!(solve(&line, w, &torque).is_err());
    let t = Tree::new(&line).expect("builds");
    // Only the second lane meets it.
    let omega: [f64; LANES] = std::array::from_fn(|l| if l == 0 { 0.5 * w } else { l as f64 * w });
    let refused = Sweep::new(2).solve(&t, &omega, &[[1.0, 0.0], [0.0, 0.0]]);
    assert_eq!(refused.expect_err("resonance").0, 1);
    for near in [1.0 - 1e-6, 1.0 + 1e-6] {
        let a = solve(&line, w * near, &torque).expect("not quite");
        // 1/(k (1/J₁ + 1/J₂) - ω²) J₂-part of the relative motion, to the digits that the distance leaves.
        let lambda = w * w * near * near;
        let exact = -(1.0 / 2.0) * 300.0 / (450.0 - lambda) / (lambda / 1.0 * 1.0) * 1.0;
        assert!((a.angle[1].re / exact - 1.0).abs() < 1e-9, "{} {exact}", a.angle[1].re);
    }
}

#[test]
fn an_absorber_at_its_own_frequency_holds_its_place() {
    // Undamped absorber of 0.5 kg m² on the second of three inertias, excited at its frequency: the second stands still and the
    // absorber's link carries the whole torque that acts on it.
    let ka = 0.5 * 40.0 * 40.0;
    let mut line = chain(&[3.0, 2.0, 1.0], &[5e3, 7e3], &[], &[]);
    line.nodes.push(node(0.5, 0.0));
    line.links.push(link(1, 3, ka, 0.0, 0.0));
    let torque = [c(0.0, 0.0), c(10.0, 4.0), c(0.0, 0.0), c(0.0, 0.0)];
    let a = solve(&line, 40.0, &torque).expect("regular");
    // Rounding of the absorber's own angle, 1e-2.
    assert!(a.angle[..3].iter().all(|x| x.abs() < 1e-17), "{:?}", a.angle);
    assert!((a.transmitted[2] - c(10.0, 4.0)).abs() < 1e-14 * 10.0, "{:?}", a.transmitted);
    assert!((a.angle[3] + c(10.0 / ka, 4.0 / ka)).abs() < 1e-15);
    assert!(residual(&line, 40.0, &torque, &a) < 1e-14);
    // The same through a rigid link, and with a further branch above.
    line.links[2] = link(3, 4, ka, 0.0, 0.0);
    line.nodes.push(node(0.0, 0.0));
    line.links.push(link(1, 4, f64::INFINITY, 0.0, 0.0));
    let torque = [c(0.0, 0.0), c(10.0, 4.0), c(1.0, 0.0), c(0.0, 0.0), c(0.0, 0.0)];
    let a = solve(&line, 40.0, &torque).expect("regular");
    assert!(residual(&line, 40.0, &torque, &a) < 1e-14);
    assert!(a.angle[1].abs() < 1e-17);
    // Two equal absorbers vibrate against each other: that is a resonance of the line.
    let mut twin = chain(&[3.0, 2.0], &[5e3], &[], &[]);
    for _ in 0..2 {
        let n = twin.nodes.len();
        twin.nodes.push(node(0.5, 0.0));
        twin.links.push(link(1, n, ka, 0.0, 0.0));
    }
    let torque = [c(0.0, 0.0), c(0.0, 0.0), c(1.0, 0.0), c(0.0, 0.0)];
    assert!(solve(&twin, 40.0, &torque).is_err());
}

/// Two absorbers on one inertia, the second nearly as well tuned: only in resonance together they have no answer.
#[test]
fn an_absorber_close_to_another_ones_frequency_moves_by_itself() {
    for off in [1e-9, -3e-8, 2e-7] {
        // 20 rad/s: the first absorber's squares and products are without rounding.
        let second = 100.0 * (1.0 + off);
        let mut line = chain(&[3.0, 2.0, 0.5, 0.25, 1.0], &[], &[], &[2.0, 0.5, 0.0, 0.0, 0.1]);
        line.links = vec![
            link(2, 1, 200.0, 0.0, 0.0),
            link(3, 1, second, 0.0, 0.0),
            link(0, 1, 900.0, 3.0, 0.0),
            link(1, 4, 700.0, 1.0, 0.1),
        ];
        let torque = [c(1.0, 2.0), c(-3.0, 1.0), c(0.5, 0.0), c(2.0, -1.0), c(0.0, 1.0)];
        let a = solve(&line, 20.0, &torque).expect("regular");
        // Balanced to rounding of the largest torque.
        assert!(residual(&line, 20.0, &torque, &a) < 1e-14);
        // The first one holds its place, whatever the second does: 0.5 N m from its spring. The second follows the place by its own spring;
        // angles of it, of the order 1/off, leave rounding of their size.
        let place = c(-0.5 / 200.0, 0.0);
        let exact = (c(2.0, -1.0) + c(second, 0.0) * place) / c(second - 100.0, 0.0);
        assert!((a.angle[1] - place).abs() < 1e-15 * exact.abs(), "{off}: {:?}", a.angle[1]);
        assert!(
            (a.angle[3] - exact).abs() < 1e-14 / off.abs() * exact.abs(),
            "{off}: {:?} {exact:?}",
            a.angle[3]
        );
    }
}

#[test]
fn rigid_links_and_inertias_of_zero_leave_no_trace() {
    let stiff = chain(&[1.0, 0.5, 0.0, 2.0], &[1e4, f64::INFINITY, 3e4], &[5.0, 0.0, 7.0], &[]);
    let plain = chain(&[1.0, 0.5, 2.0], &[1e4, 3e4], &[5.0, 7.0], &[]);
    let w = 140.0;
    let a = solve(&stiff, w, &[c(1.0, 0.0), c(2.0, 1.0), c(0.5, 0.0), c(0.0, 0.0)]).expect("damped");
    let b = solve(&plain, w, &[c(1.0, 0.0), c(2.5, 1.0), c(0.0, 0.0)]).expect("damped");
    for (i, j) in [(0, 0), (1, 1), (2, 1), (3, 2)] {
        assert!((a.angle[i] - b.angle[j]).abs() < 1e-15 * b.angle[j].abs());
    }
    // The rigid link carries what the third inertia does not add.
    assert!((a.transmitted[1] + c(0.5, 0.0) - b.transmitted[1]).abs() < 1e-13);
    // A stiffness of 1e12 times its neighbours is nearly rigid.
    let nearly = chain(&[1.0, 0.5, 0.0, 2.0], &[1e4, 1e16, 3e4], &[5.0, 0.0, 7.0], &[]);
    let b = solve(&nearly, w, &[c(1.0, 0.0), c(2.0, 1.0), c(0.5, 0.0), c(0.0, 0.0)]).expect("damped");
    for i in 0..4 {
        assert!((a.angle[i] - b.angle[i]).abs() < 1e-11 * a.angle[i].abs());
    }
    assert!((a.transmitted[1] - b.transmitted[1]).abs() < 1e-11 * a.transmitted[1].abs());
}

#[test]
fn chains_and_trees_of_any_size_balance() {
    // A chain of a thousand and a tree of two hundred branches of five.
    let n = 1000;
    let j: Vec<f64> = (0..n).map(|i| 0.1 + 0.05 * (i as f64).sin()).collect();
    let k: Vec<f64> = (0..n - 1).map(|i| 1e6 * (1.5 + (0.7 * i as f64).cos())).collect();
    let long = chain(&j, &k, &vec![3.0; n - 1], &vec![0.1; n]);
    let mut tree = Line { nodes: vec![node(5.0, 1.0)], ..Line::default() };
    for b in 0..200 {
        let mut at = 0;
        for i in 0..5 {
            let m = tree.nodes.len();
            tree.nodes.push(node(0.05 + 0.01 * f64::from(i), 0.01));
            tree.links.push(link(at, m, 1e5 * (1.0 + 0.01 * f64::from(b)), 2.0, 0.01));
            at = m;
        }
    }
    for line in [long, tree] {
        let torque: Vec<Complex> =
            (0..line.nodes.len()).map(|i| c((i as f64).sin(), (0.3 * i as f64).cos())).collect();
        for w in [10.0, 300.0, 2500.0, 1e5] {
            let a = solve(&line, w, &torque).expect("damped");
            assert!(residual(&line, w, &torque, &a) < 1e-11, "{w}: {:e}", residual(&line, w, &torque, &a));
        }
    }
}
