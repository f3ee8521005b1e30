//! Natural frequencies and damped eigenvalues of lines without a closed form: counts, traces and determinants.

use crate::common::{chain, link, node};
use crate::elimination::{Numbers, random_line};
use gudgeon_core::kinds::Line;
use gudgeon_torsion::eigen::{modal_damping, natural_frequencies, rigid_modes, roots, shapes};
use gudgeon_torsion::tree::Tree;

/// Every frequency is where the number of negative pivots changes, and none is left out.
fn placed_by_counts(t: &Tree, tolerance: f64) {
    let omega = natural_frequencies(t, usize::MAX).expect("found");
    let mut s = vec![0.0; t.len()];
    assert_eq!(omega.iter().filter(|w| **w == 0.0).count(), rigid_modes(t));
    for (k, w) in omega.iter().enumerate().filter(|(_, w)| **w > 0.0) {
        let near = |o: &&f64| (**o - w).abs() <= 2.0 * tolerance * w;
        let first = omega.iter().position(|o| near(&o)).expect("itself");
        let last = first + omega.iter().filter(near).count();
        let at = |f: f64, s: &mut [f64]| t.count_below((w * f).powi(2), s);
        assert_eq!(at(1.0 - tolerance, &mut s), first, "mode {k} of {omega:?}");
        assert_eq!(at(1.0 + tolerance, &mut s), last, "mode {k} of {omega:?}");
    }
    for m in 0..omega.len() {
        assert_eq!(natural_frequencies(t, m).expect("found"), omega[..m]);
    }
}

#[test]
fn frequencies_are_where_counts_change() {
    let mut r = Numbers(5);
    for n in [2, 3, 5, 8] {
        for _ in 0..10 {
            // Bisection ends at the last digit of the square.
            placed_by_counts(&Tree::new(&random_line(n, &mut r)).expect("builds"), 4e-15);
        }
    }
    // Chains with stiffnesses and inertias over twelve powers of ten: the small frequencies lose nothing to the large ones.
    for n in [2, 4, 9, 30] {
        for spread in [0.0, 3.0, 6.0] {
            let j: Vec<f64> = (0..n).map(|_| 10_f64.powf(r.between(-spread, spread) / 3.0)).collect();
            let k: Vec<f64> = (1..n).map(|_| 10_f64.powf(4.0 + r.between(-spread, spread))).collect();
            // The root-free QL method: rounding times the square root of the number of inertias, refined below.
            placed_by_counts(&Tree::new(&chain(&j, &k, &[], &[])).expect("builds"), 1e-12);
        }
    }
}

#[test]
fn weakly_coupled_equal_parts_have_close_frequencies_apart() {
    // Three equal pairs behind shafts a million times weaker: clusters of three, of which every single one counts.
    let soft = 1e-2;
    let line = chain(&[0.5; 6], &[1e4, soft, 1e4, soft, 1e4], &[], &[]);
    placed_by_counts(&Tree::new(&line).expect("builds"), 1e-13);
    let omega = natural_frequencies(&Tree::new(&line).expect("builds"), 9).expect("found");
    // The pairs as a whole, 1 kg m² each on the weak shafts: √(k/J) and √(3 k/J), to the ratio of the stiffnesses.
    for (w, exact) in omega[1..3].iter().zip([soft.sqrt(), (3.0 * soft).sqrt()]) {
        assert!((w / exact - 1.0).abs() < 1e-5, "{omega:?}");
    }
    // The sum of all squares is the trace of J⁻¹K.
    let trace = 2.0 / 0.5 * (3.0 * 1e4 + 2.0 * soft);
    assert!((omega.iter().map(|w| w * w).sum::<f64>() / trace - 1.0).abs() < 1e-14);
}

/// Sum and product of all damped eigenvalues against trace and determinants of a held line.
fn spectrum_is_complete(line: &Line) {
    let t = Tree::new(line).expect("builds");
    let omega = natural_frequencies(&t, usize::MAX).expect("found");
    let normal = shapes(&t, &omega);
    let all = roots(&t, &omega, &normal).expect("found");
    assert_eq!(all.pairs.len(), t.len());
    let damping: Vec<f64> = omega.iter().zip(&normal).map(|(w, v)| modal_damping(&t, *w, v)).collect();
    let size: f64 = all.pairs.iter().flatten().map(|z| z.abs()).sum();
    // The trace of J⁻¹C in the basis of the modes, which are orthonormal to the inertia.
    let sum: f64 = all.pairs.iter().flatten().map(|z| z.re).sum();
    assert!((sum + damping.iter().sum::<f64>()).abs() < 1e-10 * size, "{sum} {damping:?}");
    let imaginary: f64 = all.pairs.iter().flatten().map(|z| z.im).sum();
    assert!(imaginary.abs() < 1e-10 * size, "{:?}", all.pairs);
    // The product of all is det K/det J, the product of the squared frequencies.
    let product: f64 = all.pairs.iter().flatten().map(|z| z.abs().ln()).sum();
    let exact: f64 = omega.iter().map(|w| 2.0 * w.ln()).sum();
    assert!((product - exact).abs() < 1e-9 * (1.0 + exact.abs()), "{product} {exact}");
    // The sum of the inverses is -tr(K⁻¹C): the derivative of the determinant at zero.
    let inverse: f64 = all.pairs.iter().flatten().map(|z| z.re / (z.abs() * z.abs())).sum();
    let mut work = gudgeon_torsion::tree::Work::new(t.len());
    let zero = gudgeon_numerics::linalg::Complex::new(0.0, 0.0);
    let slope = t.log_derivative(zero, &mut work).re;
    assert!((inverse + slope).abs() < 1e-8 * slope.abs(), "{inverse} {slope}");
    for pair in &all.pairs {
        // Conjugates, or two real ones, the slower first.
        let conjugate = pair[0].im > 0.0 && pair[1].im == -pair[0].im && pair[1].re == pair[0].re;
        let real = pair[0].im == 0.0 && pair[1].im == 0.0 && pair[0].re > pair[1].re;
        assert!(conjugate || real, "{pair:?}");
    }
}

#[test]
fn damped_eigenvalues_have_the_sum_and_the_product_of_the_line() {
    // From light damping to lines of which half of the modes no longer oscillate, with dampers that couple the modes.
    for (seed, strength) in [(1, 1e-3), (2, 0.1), (3, 1.0), (4, 3.0), (5, 10.0), (6, 30.0)] {
        let mut r = Numbers(seed);
        for n in [2, 3, 5] {
            let mut line = random_line(n, &mut r);
            line.nodes[0].ground = 1e3;
            for (i, l) in line.links.iter_mut().enumerate() {
                // Uneven dampers: proportional ones would leave the modes as they are.
                let damping = strength * 10.0 * (1.0 + i as f64);
                *l = link(l.nodes[0], l.nodes[1], l.coupling.linear(0.0, 0.0).stiffness, damping, 0.0);
            }
            spectrum_is_complete(&line);
        }
    }
}

#[test]
fn a_line_with_drag_slows_down_at_its_own_rate() {
    // Two inertias with drag of their own: besides zero the roots of the cubic J₁J₂ z³ + (J₁d₂ + J₂d₁ + c J) z² + (kJ + d₁d₂ + c d) z + k d.
    let ([j1, j2], [d1, d2], k, damping) = ([2.0, 0.5], [3.0, 1.0], 400.0, 0.7);
    let mut line = Line { nodes: vec![node(j1, d1), node(j2, d2)], ..Line::default() };
    line.links.push(link(0, 1, k, damping, 0.0));
    let t = Tree::new(&line).expect("builds");
    let omega = natural_frequencies(&t, 9).expect("found");
    let all = roots(&t, &omega, &shapes(&t, &omega)).expect("found");
    let (j, d) = (j1 + j2, d1 + d2);
    let cubic = [k * d, k * j + d1 * d2 + damping * d, j1 * d2 + j2 * d1 + damping * j, j1 * j2];
    assert_eq!(all.pairs[0][0], gudgeon_numerics::linalg::Complex::default());
    for z in [all.pairs[0][1], all.pairs[1][0], all.pairs[1][1]] {
        let real = |v: f64| gudgeon_numerics::linalg::Complex::new(v, 0.0);
        let value = real(cubic[0]) + z * (real(cubic[1]) + z * (real(cubic[2]) + z * real(cubic[3])));
        let size = cubic[0] + z.abs() * (cubic[1] + z.abs() * (cubic[2] + z.abs() * cubic[3]));
        // Rounding of the polynomial.
        assert!(value.abs() < 1e-14 * size, "{z:?}: {value:?}");
    }
    assert!(all.pairs[0][1].im == 0.0 && all.pairs[0][1].re < 0.0);
}

/// Inertias on springs and dampers of their own, joined by nothing: every mode has the two roots of its own square, overdamped or not.
#[test]
fn pairs_stay_with_their_modes_when_some_no_longer_oscillate() {
    let (j, k, c) = ([2.0, 0.5, 1.0, 0.25], [200.0, 5e3, 4e4, 1e5], [2e3, 3.0, 900.0, 2.0]);
    let mut line = chain(&j, &[0.0; 3], &[], &c);
    line.nodes.iter_mut().zip(k).for_each(|(n, k)| n.ground = k);
    let t = Tree::new(&line).expect("builds");
    let omega = natural_frequencies(&t, usize::MAX).expect("found");
    let all = roots(&t, &omega, &shapes(&t, &omega)).expect("found");
    for i in 0..4 {
        let (w, decay) = ((k[i] / j[i]).sqrt(), 0.5 * c[i] / j[i]);
        // Bisection ends at the last digits.
        assert!((omega[i] / w - 1.0).abs() < 1e-14, "{omega:?}");
        let [a, b] = all.pairs[i];
        let square = w * w - decay * decay;
        // Roots of the order of the largest eigenvalue, a thousand, to 1e-10 of it.
        if square > 0.0 {
            assert!((a.re + decay).abs() < 1e-7 && (a.im - square.sqrt()).abs() < 1e-7, "{i}: {a:?}");
            assert!(b.re == a.re && b.im == -a.im, "{i}: {a:?} {b:?}");
        } else {
            let slow = -decay + (-square).sqrt();
            assert!(a.im == 0.0 && (a.re - slow).abs() < 1e-7, "{i}: {a:?} {slow}");
            assert!(b.im == 0.0 && (b.re + 2.0 * decay + slow).abs() < 1e-7, "{i}: {b:?} {slow}");
        }
    }
}
