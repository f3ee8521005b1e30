//! Damped eigenvalues: one after the other from the undamped modes, or all of them together.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::Complex;

use super::determinant::{Determinant, real};
use super::modal_damping::modal_damping;
use super::rigid::connected_parts;
use super::shapes::CLUSTER;
use super::simultaneous::simultaneous;
use crate::tree::Tree;

/// All eigenvalues `z` of `z² J + z C + K`, those with positive imaginary part first in each pair of a mode: see [`roots`].
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// For each mode its two eigenvalues.
    pub pairs: Vec<[Complex; 2]>,
    /// Evaluations of the determinant.
    pub evaluations: u64,
}

/// The eigenvalue of each mode with positive imaginary part, or its slower real one when the mode no longer oscillates; `None` for
/// rigid modes.
///
/// # Errors
/// No convergence (Fatal).
pub fn damped_eigenvalues(
    tree: &Tree,
    omega: &[f64],
    normal: &[Vec<f64>],
) -> Result<Vec<Option<Complex>>, EvalError> {
    let s = roots(tree, omega, normal)?;
    Ok(s.pairs.iter().zip(omega).map(|(p, w)| (*w > 0.0).then_some(p[0])).collect())
}

/// Eigenvalues of the damped line: Newton's method on the determinant, which the tree gives with its derivative in linear time, from
/// the undamped modes; where that does not find every eigenvalue once, all are corrected together (aberth1973).
///
/// `omega` and `normal` are all undamped frequencies \[rad/s\] and shapes of unit modal inertia.
///
/// # Errors
/// No convergence (Fatal).
pub fn roots(tree: &Tree, omega: &[f64], normal: &[Vec<f64>]) -> Result<Spectrum, EvalError> {
    let mut determinant = Determinant::new(tree);
    let damping: Vec<f64> = omega.iter().zip(normal).map(|(w, v)| modal_damping(tree, *w, v)).collect();
    let (mut pairs, found) = one_by_one(tree, &mut determinant, omega, &damping);
    if !(found && all_differ(&pairs, omega)) {
        let (mut known, count, beyond) = rigid_roots(tree);
        let mut rates = Vec::new();
        for _ in 0..count {
            let (rate, found) = determinant.real_root(beyond, &known);
            if found { known.push(rate) } else { rates.push(real(beyond)) }
        }
        let modes: Vec<[f64; 2]> =
            omega.iter().zip(&damping).filter(|(w, _)| **w != 0.0).map(|(w, c)| [*w, *c]).collect();
        let elastic = simultaneous(&mut determinant, &modes, &rates, &known)?;
        let places = pairs.iter_mut().zip(omega).filter(|(_, w)| **w > 0.0);
        for ((pair, _), found) in places.zip(elastic) {
            *pair = found;
        }
    }
    Ok(Spectrum { pairs, evaluations: determinant.evaluations })
}

/// The pair of each mode from its undamped frequency and modal damping, and whether all were found.
fn one_by_one(
    tree: &Tree,
    determinant: &mut Determinant<'_>,
    omega: &[f64],
    damping: &[f64],
) -> (Vec<[Complex; 2]>, bool) {
    let mut pairs = vec![[Complex::default(); 2]; omega.len()];
    let drag: f64 = tree.damping.iter().sum();
    let mut all = true;
    for (pair, (&w, &c)) in pairs.iter_mut().zip(omega.iter().zip(damping)) {
        if w == 0.0 {
            // Rigid modes: zero, and the rate at which the whole slows down.
            let decay =
                if drag == 0.0 { real(-c) } else { determinant.real_root(-c, &[Complex::default()]).0 };
            *pair = [Complex::default(), decay];
        } else if c.abs() >= 2.0 * w {
            all = false;
        } else {
            let start = Complex::new(-0.5 * c, (w * w - 0.25 * c * c).sqrt());
            let multiplicity = omega.iter().filter(|o| (**o - w).abs() <= CLUSTER * w).count();
            let (z, found) =
                if c == 0.0 { (start, true) } else { determinant.root(start, multiplicity as f64) };
            all &= found && z.im > 0.0;
            *pair = [z, Complex::new(z.re, -z.im)];
        }
    }
    (pairs, all)
}

/// Roots of the rigid modes: those that are known to be zero; how many others there are, the rates at which parts that hang on damping come to
/// rest; and a rate beyond all of those, that of every braked inertia alone between neighbours at rest, added up. Newton's method comes from there
/// to the fastest without passing it.
fn rigid_roots(tree: &Tree) -> (Vec<Complex>, usize, f64) {
    let n = tree.len();
    let part = connected_parts(tree);
    let (mut held, mut inertia, mut brake) = (vec![false; n], vec![0.0; n], vec![0.0; n]);
    let mut at = tree.damping.clone();
    for i in (0..n).filter(|&i| tree.parent[i] < n && tree.k[i] == 0.0) {
        at[i] += tree.c[i];
        at[tree.parent[i]] += tree.c[i];
    }
    for i in 0..n {
        held[part[i]] |= tree.ground[i] != 0.0;
        inertia[part[i]] += tree.inertia[i];
        brake[part[i]] += at[i];
    }
    let own = |i: usize| if tree.inertia[i] > 0.0 { tree.inertia[i] } else { inertia[part[i]] };
    let beyond = (0..n).filter(|&i| at[i] != 0.0 && own(i) > 0.0).map(|i| at[i] / own(i)).sum::<f64>();
    let free: Vec<usize> = (0..n).filter(|&p| part[p] == p && !held[p] && inertia[p] != 0.0).collect();
    let mut known = vec![Complex::default(); free.len()];
    let mut rates = free.iter().filter(|p| brake[**p] != 0.0).count();
    known.resize(known.len() + free.len() - rates, Complex::default());
    // A line that nothing brakes turns on as a whole.
    if rates > 0 && !tree.is_grounded() && tree.damping.iter().all(|c| *c == 0.0) {
        rates -= 1;
        known.push(Complex::default());
    }
    (known, rates, -beyond)
}

/// Whether modes of different frequency have different eigenvalues: otherwise two searches ended in one root, and another is missing.
fn all_differ(pairs: &[[Complex; 2]], omega: &[f64]) -> bool {
    (0..pairs.len()).all(|i| {
        (0..i).all(|j| {
            let same = (pairs[i][0] - pairs[j][0]).norm1() <= 1e-9 * pairs[i][0].norm1();
            !(same && omega[i] > 0.0 && (omega[i] - omega[j]).abs() > CLUSTER * omega[i])
        })
    })
}
