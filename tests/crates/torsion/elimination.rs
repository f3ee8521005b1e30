//! Elimination along the tree against dense matrices.

use crate::common::{link, node};
use gudgeon_core::kinds::{Line, LineNode};
use gudgeon_numerics::linalg::Complex;
use gudgeon_torsion::eigen::{natural_frequencies, shapes};
use gudgeon_torsion::sweep::{LANES, Sweep};
use gudgeon_torsion::tree::{Resonance, Singular, Tree, Work};

fn c(re: f64, im: f64) -> Complex {
    Complex::new(re, im)
}

/// Numbers between 0 and 1 that are the same every time.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    pub fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
}

/// A tree of `n` inertias with gears, drag, held places, viscous damping and loss factors.
pub fn random_line(n: usize, r: &mut Numbers) -> Line {
    let mut line = Line::default();
    for i in 0..n {
        let ground = if r.next() < 0.2 { r.between(100.0, 1e3) } else { 0.0 };
        let ratio = if r.next() < 0.4 { r.between(-3.0, -0.5) } else { 1.0 };
        line.nodes.push(LineNode { ground, ratio, ..node(r.between(0.1, 2.0), r.between(0.0, 3.0)) });
        if i > 0 {
            let to = (r.next() * i as f64) as usize;
            let ends = if r.next() < 0.5 { (i, to) } else { (to, i) };
            let (k, damping, eta) = (r.between(1e3, 3e4), r.between(0.0, 20.0), r.between(0.0, 0.2));
            line.links.push(link(ends.0, ends.1, k, damping, eta));
        }
    }
    line
}

/// `g + z c + z² J + links` by node, angles and torques as they are (not by the reference shaft).
fn matrix(line: &Line, z: Complex) -> Vec<Vec<Complex>> {
    let n = line.nodes.len();
    let mut m = vec![vec![Complex::default(); n]; n];
    for (i, node) in line.nodes.iter().enumerate() {
        m[i][i] = c(node.ground, 0.0) + z * c(node.damping, 0.0) + z * z * c(node.inertia, 0.0);
    }
    for l in &line.links {
        let [a, b] = l.nodes;
        let law = l.coupling.linear(0.0, 0.0);
        let loss = if z.im < 0.0 { -law.loss_factor } else { law.loss_factor };
        let kappa = c(law.stiffness, law.stiffness * loss) + z * c(law.damping, 0.0);
        // Twist θ_a - g θ_b; the torque on the first is -κ twist, on the second g κ twist.
        let gear = c(line.nodes[a].ratio / line.nodes[b].ratio, 0.0);
        m[a][a] = m[a][a] + kappa;
        m[a][b] = m[a][b] - kappa * gear;
        m[b][a] = m[b][a] - kappa * gear;
        m[b][b] = m[b][b] + kappa * gear * gear;
    }
    m
}

/// Gaussian elimination with the largest pivot: the solution, and the determinant.
fn dense(mut m: Vec<Vec<Complex>>, mut b: Vec<Complex>) -> (Vec<Complex>, Complex) {
    let n = b.len();
    let mut determinant = c(1.0, 0.0);
    for k in 0..n {
        let p = (k..n).max_by(|i, j| m[*i][k].abs().total_cmp(&m[*j][k].abs())).expect("a row");
        if p != k {
            m.swap(p, k);
            b.swap(p, k);
            determinant = determinant * c(-1.0, 0.0);
        }
        determinant = determinant * m[k][k];
        for i in k + 1..n {
            let f = m[i][k] / m[k][k];
            for j in k..n {
                m[i][j] = m[i][j] - f * m[k][j];
            }
            b[i] = b[i] - f * b[k];
        }
    }
    for i in (0..n).rev() {
        for j in i + 1..n {
            b[i] = b[i] - m[i][j] * b[j];
        }
        b[i] = b[i] / m[i][i];
    }
    (b, determinant)
}

/// Angles by node and torques from the first to the second node of each link.
fn by_tree(line: &Line, z: Complex, torque: &[Complex]) -> Result<(Vec<Complex>, Vec<Complex>), Resonance> {
    let t = Tree::new(line).expect("builds");
    let n = t.len();
    let f: Vec<Complex> = (0..n).map(|p| torque[t.node[p]] * c(t.ratio[p], 0.0)).collect();
    let (mut x, mut q) = (vec![Complex::default(); n], vec![Complex::default(); n]);
    t.solve(z, &f, &mut x, &mut q, Singular::Refuse, &mut Work::new(n))?;
    let (mut angle, mut carried) = (vec![Complex::default(); n], vec![Complex::default(); line.links.len()]);
    for p in 0..n {
        angle[t.node[p]] = x[p] * c(t.ratio[p], 0.0);
        if t.parent[p] < n {
            let sign = if t.forward[p] { 1.0 } else { -1.0 };
            carried[t.link[p]] = q[p] * c(sign / t.link_ratio[p], 0.0);
        }
    }
    Ok((angle, carried))
}

fn agrees(line: &Line, z: Complex, torque: &[Complex]) {
    let (angle, carried) = by_tree(line, z, torque).expect("regular");
    let (exact, _) = dense(matrix(line, z), torque.to_vec());
    let top = exact.iter().map(|x| x.abs()).fold(0.0, f64::max);
    for (a, e) in angle.iter().zip(&exact) {
        // Rounding of the dense elimination, with condition numbers up to some thousand.
        assert!((*a - *e).abs() < 1e-11 * top, "{z:?}: {a:?} {e:?}");
    }
    for (l, q) in line.links.iter().zip(&carried) {
        let [a, b] = l.nodes;
        let law = l.coupling.linear(0.0, 0.0);
        let loss = if z.im < 0.0 { -law.loss_factor } else { law.loss_factor };
        let kappa = c(law.stiffness, law.stiffness * loss) + z * c(law.damping, 0.0);
        let twist = exact[a] - exact[b] * c(line.nodes[a].ratio / line.nodes[b].ratio, 0.0);
        assert!((*q - kappa * twist).abs() < 1e-10 * kappa.abs() * top, "{z:?}: {q:?}");
    }
}

#[test]
fn any_tree_at_any_complex_frequency_is_its_dense_matrix() {
    let mut r = Numbers(7);
    for n in [1, 2, 3, 5, 9] {
        for _ in 0..20 {
            let line = random_line(n, &mut r);
            let z = c(r.between(-30.0, 30.0), r.between(-300.0, 300.0));
            let torque: Vec<Complex> =
                (0..n).map(|_| c(r.between(-9.0, 9.0), r.between(-9.0, 9.0))).collect();
            agrees(&line, z, &torque);
        }
    }
}

#[test]
fn a_branch_in_resonance_is_eliminated_with_its_parent() {
    // An undamped branch of two inertias, in resonance when its parent stands still, at the frequency and beside it; the parent has
    // a parent of its own, drag, and a further branch.
    let (j1, j2, k1, k2) = (0.5_f64, 0.2_f64, 800.0_f64, 600.0_f64);
    let mean = 0.5 * ((k1 + k2) / j1 + k2 / j2);
    let held = (mean - (mean * mean - k1 * k2 / (j1 * j2)).sqrt()).sqrt();
    for off in [0.0, 1e-12, 1e-9, 1e-7, -1e-8] {
        let mut line = Line::default();
        for (j, drag) in [(3.0, 2.0), (2.0, 0.5), (j1, 0.0), (j2, 0.0), (1.0, 0.1)] {
            line.nodes.push(node(j, drag));
        }
        line.nodes[2].ratio = 1.0;
        line.links = vec![
            link(2, 3, k2, 0.0, 0.0),
            link(1, 2, k1, 0.0, 0.0),
            link(0, 1, 900.0, 3.0, 0.0),
            link(4, 1, 700.0, 1.0, 0.1),
        ];
        let torque = [c(1.0, 2.0), c(-3.0, 1.0), c(0.5, 0.0), c(2.0, -1.0), c(0.0, 1.0)];
        agrees(&line, c(0.0, held * (1.0 + off)), &torque);
    }
}

#[test]
fn the_logarithmic_derivative_is_that_of_the_dense_determinant() {
    let mut r = Numbers(11);
    for n in [1, 2, 4, 7] {
        for _ in 0..10 {
            let line = random_line(n, &mut r);
            let t = Tree::new(&line).expect("builds");
            let z = c(r.between(-30.0, 30.0), r.between(20.0, 300.0));
            let h = 1e-3 * z.abs();
            let det = |z: Complex| dense(matrix(&line, z), vec![Complex::default(); n]).1;
            // Central differences of fourth order; the determinant is a polynomial of degree 2n, so its fifth derivative by its first
            // is below (2n/|z|)⁴ away from roots.
            let d = |s: f64| det(c(z.re + s * h, z.im));
            let difference = (d(1.0) - d(-1.0)) * c(8.0, 0.0) - (d(2.0) - d(-2.0));
            let exact = difference / (c(12.0 * h, 0.0) * det(z));
            let found = t.log_derivative(z, &mut Work::new(n));
            assert!((found - exact).abs() < 1e-5 * exact.abs(), "{n}: {found:?} {exact:?}");
        }
    }
}

#[test]
fn an_end_with_neither_inertia_nor_stiffness_is_refused() {
    // Any angle of it would do: without a refusal the answer were no number.
    let mut line = Line { nodes: vec![node(1.0, 0.0), node(0.0, 0.0), node(2.0, 0.0)], ..Line::default() };
    line.links = vec![link(1, 0, 0.0, 0.0, 0.0), link(0, 2, 1e3, 0.0, 0.0)];
    let torque = [c(1.0, 0.0), c(0.0, 0.0), c(0.0, 0.0)];
    assert_eq!(by_tree(&line, c(0.0, 3.0), &torque).err(), Some(Resonance));
}

#[test]
fn what_is_no_line_is_refused_at_its_place() {
    let field = |line: &Line| Tree::new(line).expect_err("refused").field;
    let three = || Line {
        nodes: (0..3).map(|_| node(1.0, 0.0)).collect(),
        links: vec![link(0, 1, 1e3, 0.0, 0.0), link(1, 2, 1e3, 0.0, 0.0)],
        ..Line::default()
    };
    assert_eq!(field(&Line::default()), "inertias");
    for ends in [[1, 1], [3, 0], [0, 3]] {
        let mut line = three();
        line.links[1].nodes = ends;
        assert_eq!(field(&line), "links.1");
    }
    let mut line = three();
    line.links.push(link(2, 0, 1e3, 0.0, 0.0));
    assert!(field(&line).starts_with("links."));
    line.links = vec![link(0, 1, 1e3, 0.0, 0.0)];
    // The root is the last inertia: the others are not connected with it.
    assert_eq!(field(&line), "inertias.0");
    for (name, v) in [
        ("inertia", -1.0),
        ("inertia", f64::NAN),
        ("ground", -1.0),
        ("ratio", 0.0),
        ("damping", f64::INFINITY),
    ] {
        let mut line = three();
        let node = &mut line.nodes[1];
        *match name {
            "inertia" => &mut node.inertia,
            "ground" => &mut node.ground,
            "ratio" => &mut node.ratio,
            _ => &mut node.damping,
        } = v;
        assert_eq!(field(&line), format!("inertias.1.{name}"));
    }
    // Damping may be negative: a drive can feed a vibration.
    let mut line = three();
    line.nodes[1].damping = -1.0;
    assert!(Tree::new(&line).is_ok());
    line.nodes.iter_mut().for_each(|n| n.inertia = 0.0);
    assert_eq!(field(&line), "inertias");
}

#[test]
fn shapes_do_not_know_of_damping() {
    let mut r = Numbers(3);
    for _ in 0..5 {
        let line = random_line(6, &mut r);
        let t = Tree::new(&line).expect("builds");
        let mut bare = line.clone();
        for l in &mut bare.links {
            *l = link(l.nodes[0], l.nodes[1], l.coupling.linear(0.0, 0.0).stiffness, 0.0, 0.0);
        }
        bare.nodes.iter_mut().for_each(|n| n.damping = 0.0);
        let omega = natural_frequencies(&t, 9).expect("found");
        assert_eq!(shapes(&t, &omega), shapes(&Tree::new(&bare).expect("builds"), &omega));
    }
}

#[test]
fn lanes_of_any_tree_are_the_careful_elimination() {
    let mut r = Numbers(23);
    for case in 0..60 {
        let n = 1 + case % 6;
        let mut line = random_line(n, &mut r);
        if case % 3 == 0 {
            // Without damping, with a rigid link and an inertia of zero.
            line.nodes.iter_mut().for_each(|n| n.damping = 0.0);
            for l in &mut line.links {
                *l = link(l.nodes[0], l.nodes[1], l.coupling.linear(0.0, 0.0).stiffness, 0.0, 0.0);
            }
            if let Some(l) = line.links.last_mut() {
                *l = link(l.nodes[0], l.nodes[1], f64::INFINITY, 0.0, 0.0);
            }
            line.nodes[0].ground = 500.0;
        }
        let t = Tree::new(&line).expect("builds");
        let torque: Vec<[f64; 2]> = (0..n).map(|_| [r.between(-9.0, 9.0), r.between(-9.0, 9.0)]).collect();
        let omega: [f64; LANES] = std::array::from_fn(|l| 30.0 * l as f64 + r.between(5.0, 25.0));
        let mut sweep = Sweep::new(n);
        sweep.solve(&t, &omega, &torque).expect("no resonance");
        let f: Vec<Complex> = torque.iter().map(|f| c(f[0], f[1])).collect();
        let (mut x, mut q) = (vec![Complex::default(); n], vec![Complex::default(); n]);
        for (l, w) in omega.iter().enumerate() {
            t.solve(c(0.0, *w), &f, &mut x, &mut q, Singular::Refuse, &mut Work::new(n))
                .expect("no resonance");
            let top = x.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let size = q.iter().map(|x| x.abs()).fold(0.0, f64::max);
            for i in 0..n {
                // Rounding, times the magnification of an undamped resonance in the neighbourhood.
                let lane = c(sweep.angle[i][0][l], sweep.angle[i][1][l]);
                assert!((lane - x[i]).abs() < 1e-10 * top, "{case} {l} {i}: {lane:?} {:?}", x[i]);
                let lane = c(sweep.transmitted[i][0][l], sweep.transmitted[i][1][l]);
                assert!((lane - q[i]).abs() <= 1e-10 * size, "{case} {l} {i}: {lane:?} {:?}", q[i]);
            }
        }
    }
    // One inertia on a spring, and its resonance in one lane: 9 rad/s, which is a number without rounding.
    let line = Line { nodes: vec![LineNode { ground: 162.0, ..node(2.0, 0.0) }], ..Line::default() };
    let t = Tree::new(&line).expect("builds");
    let omega: [f64; LANES] = std::array::from_fn(|l| 6.0 + l as f64);
    assert_eq!(Sweep::new(1).solve(&t, &omega, &[[1.0, 0.0]]), Err((3, Resonance)));
}
