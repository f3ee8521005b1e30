//! Damped eigenvalues: one after the other from the undamped modes, or all of them together.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::Complex;

use super::determinant::{Determinant, real};
use super::modal_damping::modal_damping;
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
        let rigid: Vec<Complex> =
            pairs.iter().zip(omega).filter(|(_, w)| **w == 0.0).flat_map(|(p, _)| *p).collect();
        let modes: Vec<[f64; 2]> =
            omega.iter().zip(&damping).filter(|(w, _)| **w != 0.0).map(|(w, c)| [*w, *c]).collect();
        let elastic = simultaneous(&mut determinant, &modes, &rigid)?;
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
            let decay = if drag == 0.0 { real(-c) } else { determinant.rigid_decay(-c) };
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

/// Whether modes of different frequency have different eigenvalues: otherwise two searches ended in one root, and another is missing.
fn all_differ(pairs: &[[Complex; 2]], omega: &[f64]) -> bool {
    (0..pairs.len()).all(|i| {
        (0..i).all(|j| {
            let same = (pairs[i][0] - pairs[j][0]).norm1() <= 1e-9 * pairs[i][0].norm1();
            !(same && omega[i] > 0.0 && (omega[i] - omega[j]).abs() > CLUSTER * omega[i])
        })
    })
}
