//! Modal damping.

use crate::tree::Tree;

/// Modal damping `φᵀ C φ` of a shape with unit modal inertia, the loss factors as equivalent viscous damping.
#[must_use]
pub fn modal_damping(tree: &Tree, omega: f64, v: &[f64]) -> f64 {
    let n = tree.len();
    let mut sum = 0.0;
    for i in 0..n {
        sum += tree.damping[i] * v[i] * v[i];
        if tree.parent[i] < n && tree.k[i].is_finite() {
            let d = v[i] - v[tree.parent[i]];
            let loss = if omega > 0.0 { tree.k[i] * tree.eta[i] / omega } else { 0.0 };
            sum += (tree.c[i] + loss) * d * d;
        }
    }
    sum
}
