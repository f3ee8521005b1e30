//! Shapes of undamped modes by inverse iteration.

use gudgeon_numerics::linalg::Complex;

use super::rigid::rigid_modes;
use crate::tree::{Singular, Tree, Work};

/// Frequencies closer than this are one cluster, whose shapes are made orthogonal to each other.
pub(super) const CLUSTER: f64 = 1e-7;

/// Inverse iterations for a shape: each gains the digits of the frequency.
const ITERATIONS: usize = 3;

/// Shapes of undamped modes by position, scaled to `Σ J φ² = 1`, first the rigid ones.
///
/// Inverse iteration with the elimination of the tree, from vectors that are the same every time; within a cluster of equal frequencies
/// the shapes are orthogonalised.
#[must_use]
pub fn shapes(tree: &Tree, omega: &[f64]) -> Vec<Vec<f64>> {
    let mut found: Vec<Vec<f64>> = Vec::with_capacity(omega.len());
    let rigid_is_whole = rigid_modes(tree) == 1;
    let mut iteration = InverseIteration::new(tree);
    for (k, &w) in omega.iter().enumerate() {
        let cluster = (0..k).rev().take_while(|&j| w - omega[j] <= CLUSTER * w).last().unwrap_or(k);
        let mut v: Vec<f64> = vec![1.0; tree.len()];
        if w > 0.0 || !rigid_is_whole {
            start(k, &mut v);
            for _ in 0..ITERATIONS {
                iteration.step(w, &mut v);
                orthogonalise(tree, &mut v, &found[cluster..k]);
            }
        }
        let norm = inertia_product(tree, &v, &v).sqrt();
        if norm > 0.0 {
            v.iter_mut().for_each(|v| *v /= norm);
        }
        found.push(v);
    }
    found
}

/// A start without symmetry, different for each mode.
fn start(mode: usize, v: &mut [f64]) {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(mode as u64 + 1);
    for v in v {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        *v = 0.5 + (state >> 11) as f64 / (1_u64 << 53) as f64;
    }
}

/// `Σ J a b`.
fn inertia_product(tree: &Tree, a: &[f64], b: &[f64]) -> f64 {
    (0..tree.len()).map(|i| tree.inertia[i] * a[i] * b[i]).sum()
}

/// Takes the shapes `others`, of unit modal inertia, out of `v`.
fn orthogonalise(tree: &Tree, v: &mut [f64], others: &[Vec<f64>]) {
    for other in others {
        let dot = inertia_product(tree, v, other);
        for (v, o) in v.iter_mut().zip(other) {
            *v -= dot * o;
        }
    }
}

/// `(K - λ J) v' = J v` on the undamped line, scaled to a maximum of 1.
struct InverseIteration<'a> {
    tree: &'a Tree,
    undamped: Tree,
    work: Work,
    rhs: Vec<Complex>,
    angle: Vec<Complex>,
    transmitted: Vec<Complex>,
    /// The shift of rigid modes: their frequency is exact, the elimination needs another.
    rigid_shift: f64,
}

impl<'a> InverseIteration<'a> {
    fn new(tree: &'a Tree) -> Self {
        let zero = vec![Complex::default(); tree.len()];
        let stiffest = tree.k.iter().copied().filter(|k| k.is_finite()).fold(0.0_f64, f64::max);
        let scale = stiffest / tree.total_inertia();
        Self {
            tree,
            undamped: tree.undamped(),
            work: Work::new(tree.len()),
            rhs: zero.clone(),
            angle: zero.clone(),
            transmitted: zero,
            rigid_shift: 1e-14 * scale.max(f64::MIN_POSITIVE),
        }
    }

    /// One iteration; where the elimination has no finite answer, `v` stays.
    fn step(&mut self, omega: f64, v: &mut [f64]) {
        let lambda = if omega > 0.0 { omega * omega } else { self.rigid_shift };
        let z = Complex::new(0.0, lambda.sqrt());
        for ((rhs, v), j) in self.rhs.iter_mut().zip(&*v).zip(&self.tree.inertia) {
            *rhs = Complex::new(v * j, 0.0);
        }
        let (x, t) = (&mut self.angle, &mut self.transmitted);
        if self.undamped.solve(z, &self.rhs, x, t, Singular::Perturb, &mut self.work).is_err() {
            return;
        }
        let top = x.iter().map(|x| x.re.abs()).fold(0.0, f64::max);
        if top > 0.0 && top.is_finite() {
            for (v, x) in v.iter_mut().zip(x) {
                *v = x.re / top;
            }
        }
    }
}
