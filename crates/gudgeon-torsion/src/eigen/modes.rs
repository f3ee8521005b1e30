//! Modes with shapes, damped eigenvalues and their checks.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::Mode;

use super::damped::damped_eigenvalues;
use super::shapes::shapes;
use super::undamped::natural_frequencies;
use crate::tree::Tree;

/// Modes with shapes over the nodes of the line (the largest angle 1) and damped eigenvalues.
///
/// # Errors
/// No convergence (Fatal).
pub fn modes(tree: &Tree, max_modes: usize, with_damping: bool) -> Result<Vec<Mode>, EvalError> {
    let omega = natural_frequencies(tree, max_modes)?;
    let normal = shapes(tree, &omega);
    let damped = if with_damping { damped_eigenvalues(tree, &omega, &normal)? } else { Vec::new() };
    let n = tree.len();
    Ok(omega
        .iter()
        .zip(&normal)
        .enumerate()
        .map(|(k, (&w, v))| {
            let mut shape = vec![0.0; n];
            for i in 0..n {
                shape[tree.node[i]] = v[i] * tree.ratio[i];
            }
            let top = shape.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
            if top != 0.0 {
                shape.iter_mut().for_each(|x| *x /= top);
            }
            Mode {
                omega: w,
                damped: damped
                    .get(k)
                    .copied()
                    .flatten()
                    .filter(|_| w > 0.0)
                    .filter(|z| z.im > 0.0)
                    .map(|z| (-z.re, z.im)),
                shape,
                residual: holzer_residual(tree, w, v),
            }
        })
        .collect())
}

/// Holzer's residual of a shape: torque left over at the end, by the largest torque on the way.
#[must_use]
pub fn holzer_residual(tree: &Tree, omega: f64, shape: &[f64]) -> f64 {
    let n = tree.len();
    let mut carried = vec![0.0; n];
    let (mut largest, mut left) = (0.0_f64, 0.0);
    for i in 0..n {
        carried[i] += (omega * omega * tree.inertia[i] - tree.ground[i]) * shape[i];
        largest = largest.max(carried[i].abs());
        match tree.parent.get(i) {
            Some(&p) if p < n => carried[p] += carried[i],
            _ => left = carried[i],
        }
    }
    if largest > 0.0 { left.abs() / largest } else { 0.0 }
}
