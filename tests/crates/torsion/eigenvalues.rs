//! Eigenvalues and shapes against exact solutions.

use crate::common::reference::*;
use crate::common::{chain, engine, link, node};
use gudgeon_core::kinds::Line;
use gudgeon_torsion::eigen::{
    damped_eigenvalues, holzer_residual, modes, natural_frequencies, roots, shapes,
};
use gudgeon_torsion::tree::Tree;

fn tree(line: &Line) -> Tree {
    Tree::new(line).expect("builds")
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * b.abs()
}

#[test]
fn equal_chains() {
    for c in EQUAL_CHAINS {
        let (j, k) = (0.02, 1.5e6);
        let mut line = chain(&vec![j; c.n], &vec![k; c.n - 1], &[], &[]);
        if c.ends != "free-free" {
            line.nodes[0].ground = k;
        }
        if c.ends == "fixed-fixed" {
            line.nodes[c.n - 1].ground = k;
        }
        let found = natural_frequencies(&tree(&line), usize::MAX).expect("found");
        assert_eq!(found.len(), c.omega.len());
        for (a, b) in found.iter().zip(c.omega) {
            // Rounding of a root of 50 inertias; values of the chain by QL are refined below 1e-13.
            assert!(close(*a, *b, 2e-13), "{} {}: {a} {b}", c.n, c.ends);
        }
        assert!(c.ends != "free-free" || found[0] == 0.0, "the rigid mode is exact");
    }
}

#[test]
fn discs() {
    let (j, k, w) = TWO_DISCS;
    let found = natural_frequencies(&tree(&chain(&j, &[k], &[], &[])), 9).expect("found");
    assert!(found[0] == 0.0 && close(found[1], w, 1e-15), "{found:?}");
    let (j, k, w) = THREE_DISCS;
    let found = natural_frequencies(&tree(&chain(&j, &k, &[], &[])), 9).expect("found");
    assert!(close(found[1], w[0], 1e-14) && close(found[2], w[1], 1e-15), "{found:?}");
}

#[test]
fn nine_inertia_engine() {
    let t = tree(&engine());
    let found = modes(&t, 20, true).expect("found");
    assert_eq!(found[0].omega, 0.0);
    for (m, (w, d)) in found[1..].iter().zip(ENGINE_OMEGA.iter().zip(ENGINE_DAMPED)) {
        assert!(close(m.omega, *w, 1e-13), "{} {w}", m.omega);
        let (decay, omega) = m.damped.expect("oscillates");
        // The decay is the small part of the eigenvalue: rounding of the whole.
        assert!(close(omega, d[1], 1e-13) && (decay + d[0]).abs() < 1e-13 * d[1], "{decay} {omega} {d:?}");
        assert!(m.residual < 1e-12, "Holzer's residual {}", m.residual);
    }
    for (m, shape) in [(&found[1], ENGINE_MODE_1), (&found[2], ENGINE_MODE_2)] {
        for (a, b) in m.shape.iter().zip(shape) {
            // The source scales to the first inertia.
            assert!((a / m.shape[0] - b).abs() < 1e-12, "{a} {b}");
        }
    }
}

#[test]
fn shaft_of_many_slices_tends_to_the_continuous_one() {
    // A uniform shaft, free at one end, with a disc at the other: tan β = -β Jd/Js for free ends does not fit the source, whose
    // roots solve β tan β = Js/Jd: the far end is held. Errors of n slices with halves at the ends go with 1/n².
    for (ratio, beta) in SHAFT_WITH_DISC {
        assert!((beta[0] * beta[0].tan() - ratio).abs() < 1e-14 * ratio.max(1.0));
        let errors: Vec<f64> = [40, 80]
            .iter()
            .map(|&n| {
                let mut j = vec![1.0 / f64::from(n); n as usize];
                let k = vec![f64::from(n); n as usize - 1];
                let last = j.len() - 1;
                j[last] = 0.5 / f64::from(n) + 1.0 / ratio;
                let mut line = chain(&j, &k, &[], &[]);
                line.nodes[0].ground = f64::from(n);
                natural_frequencies(&tree(&line), 1).expect("found")[0] / beta[0] - 1.0
            })
            .collect();
        let order = (errors[0] / errors[1]).log2();
        assert!(errors[1].abs() < 1e-4 && (order - 2.0).abs() < 0.01, "{errors:?}");
    }
}

#[test]
fn shapes_are_orthogonal_and_give_the_trace() {
    let t = tree(&engine());
    let omega = natural_frequencies(&t, 20).expect("found");
    let v = shapes(&t, &omega);
    for a in 0..9 {
        for b in 0..9 {
            let dot: f64 = (0..9).map(|i| t.inertia[i] * v[a][i] * v[b][i]).sum();
            assert!((dot - f64::from(a == b)).abs() < 1e-12, "{a} {b} {dot}");
        }
    }
    let trace: f64 = (0..8).map(|i| t.k[i] * (1.0 / t.inertia[i] + 1.0 / t.inertia[i + 1])).sum();
    assert!(close(omega.iter().map(|w| w * w).sum(), trace, 1e-14));
}

/// A hub with equal branches of two inertias each.
fn star(branches: usize) -> Line {
    let mut line = Line { nodes: vec![node(1.0, 0.0)], ..Line::default() };
    for b in 0..branches {
        let n = line.nodes.len();
        line.nodes.push(node(0.1, 0.01));
        line.nodes.push(node(0.2, 0.02));
        line.links.push(link(0, n, 1e4, 1.0, 0.0));
        line.links.push(link(n, n + 1, 2e4, 2.0, 0.0));
        let _ = b;
    }
    line
}

#[test]
fn repeated_eigenvalues_of_equal_branches() {
    let m = 5;
    let t = tree(&star(m));
    let omega = natural_frequencies(&t, usize::MAX).expect("found");
    assert_eq!(omega.len(), 2 * m + 1);
    // One branch held at the hub: two masses on springs; each of its frequencies m - 1 times.
    let held = Line {
        nodes: vec![gudgeon_core::kinds::LineNode { ground: 1e4, ..node(0.1, 0.0) }, node(0.2, 0.0)],
        links: vec![link(0, 1, 2e4, 0.0, 0.0)],
        ..Line::default()
    };
    for w in natural_frequencies(&tree(&held), 9).expect("found") {
        let count = omega.iter().filter(|o| close(**o, w, 1e-13)).count();
        assert_eq!(count, m - 1, "{w} in {omega:?}");
    }
    let v = shapes(&t, &omega);
    for a in 0..v.len() {
        assert!(holzer_residual(&t, omega[a], &v[a]) < 1e-9);
        for b in 0..v.len() {
            let dot: f64 = (0..t.len()).map(|i| t.inertia[i] * v[a][i] * v[b][i]).sum();
            // Shapes of a cluster are made orthogonal; between clusters inverse iteration leaves rounding over the gap.
            assert!((dot - f64::from(a == b)).abs() < 1e-9, "{a} {b} {dot}");
        }
    }
    // Damped eigenvalues repeat the same way; the sum of all is the trace of -J⁻¹C.
    let all = roots(&t, &omega, &v).expect("found");
    let sum: f64 = all.pairs.iter().flatten().map(|z| z.re).sum();
    let mut diagonal = t.damping.clone();
    for i in 0..t.len() - 1 {
        diagonal[i] += t.c[i];
        diagonal[t.parent[i]] += t.c[i];
    }
    let trace: f64 = diagonal.iter().zip(&t.inertia).map(|(c, j)| c / j).sum();
    assert!(close(-sum, trace, 1e-12), "{sum} {trace}");
}

#[test]
fn stiffness_ratios_do_not_hurt() {
    // A shaft 1e12 stiffer than its neighbours joins two inertias to one.
    let j = [0.3, 0.2, 0.25, 0.4];
    let stiff = tree(&chain(&j, &[1e4, 1e16, 2e4], &[], &[]));
    let merged = tree(&chain(&[0.3, 0.45, 0.4], &[1e4, 2e4], &[], &[]));
    let rigid = tree(&chain(&j, &[1e4, f64::INFINITY, 2e4], &[], &[]));
    let [a, b, c] = [&stiff, &merged, &rigid].map(|t| natural_frequencies(t, 9).expect("found"));
    for k in 1..3 {
        // Stiff shaft: the exact change is of the order 1e-12.
        assert!(close(a[k], b[k], 1e-11), "{a:?} {b:?}");
        assert!(close(c[k], b[k], 1e-14), "{c:?} {b:?}");
    }
    assert_eq!((a.len(), c.len()), (4, 3));
    assert!(close(a[3], (1e16_f64 * (1.0 / 0.2 + 1.0 / 0.25)).sqrt(), 1e-11));
}

#[test]
fn inertias_of_zero_are_springs_in_series() {
    let a = tree(&chain(&[0.5, 0.0, 0.3, 0.0], &[2e4, 3e4, 1e4], &[], &[]));
    let w = natural_frequencies(&a, 9).expect("found");
    let k = 1.0 / (1.0 / 2e4 + 1.0 / 3e4);
    assert_eq!(w.len(), 2);
    assert!(close(w[1], (k * (1.0 / 0.5 + 1.0 / 0.3_f64)).sqrt(), 1e-14), "{w:?}");
    assert_eq!(w[0], 0.0);
}

#[test]
fn gears_reduce_with_the_square_of_the_ratio() {
    // Pinion on the motor shaft, wheel at a third of its speed, turning the other way.
    let mut line = chain(&[0.5, 0.0, 0.02, 4.0], &[2e4, 1e6, 9e4], &[], &[]);
    line.nodes[2].ratio = -1.0 / 3.0;
    line.nodes[3].ratio = -1.0 / 3.0;
    let w = natural_frequencies(&tree(&line), 9).expect("found");
    let plain = chain(&[0.5, 0.0, 0.02 / 9.0, 4.0 / 9.0], &[2e4, 1e6, 1e4], &[], &[]);
    let v = natural_frequencies(&tree(&plain), 9).expect("found");
    for (a, b) in w.iter().zip(&v) {
        assert!((a - b).abs() <= 1e-13 * b);
    }
    let shape = &modes(&tree(&line), 9, false).expect("found")[1].shape;
    let reduced = &modes(&tree(&plain), 9, false).expect("found")[1].shape;
    let s = shape[0] / reduced[0];
    assert!((shape[3] + reduced[3] * s / 3.0).abs() < 1e-12, "{shape:?} {reduced:?}");
}

#[test]
fn heavily_damped_modes_stop_oscillating() {
    // One inertia on a spring: z² J + z c + k with c above 2 √(k J).
    let mut line = Line { nodes: vec![node(2.0, 0.0), node(1.0, 0.0)], ..Line::default() };
    line.links.push(link(0, 1, 100.0, 300.0, 0.0));
    let t = tree(&line);
    let omega = natural_frequencies(&t, 9).expect("found");
    let z = damped_eigenvalues(&t, &omega, &shapes(&t, &omega)).expect("found");
    let j = 2.0 / 3.0;
    let slow = (-300.0 + (300.0_f64 * 300.0 - 4.0 * j * 100.0).sqrt()) / (2.0 * j);
    let found = z[1].expect("a value");
    // The slow root suffers from cancellation in this formula, not in the iteration.
    assert!(found.im == 0.0 && close(found.re, slow, 1e-9), "{found:?} {slow}");
    assert!(modes(&t, 9, true).expect("found")[1].damped.is_none());
}

#[test]
fn lines_that_cannot_be_are_refused() {
    let message = |line: &Line| Tree::new(line).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(message(&Line::default()).contains("at least one"));
    let mut ring = chain(&[1.0, 1.0, 1.0], &[1.0, 1.0], &[], &[]);
    ring.links.push(link(0, 2, 1.0, 0.0, 0.0));
    assert!(message(&ring).contains("loop"));
    let mut two = chain(&[1.0, 1.0, 1.0], &[1.0], &[], &[]);
    assert!(message(&two).contains("not connected"));
    two.links.push(link(2, 2, 1.0, 0.0, 0.0));
    assert!(message(&two).contains("itself"));
    assert!(message(&chain(&[0.0, 0.0], &[1.0], &[], &[])).contains("zero"));
    let mut odd = chain(&[1.0, 1.0], &[1.0], &[], &[]);
    odd.nodes[1].ratio = 0.0;
    assert!(message(&odd).contains("ratio"));
}
