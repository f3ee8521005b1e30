//! Rigid modes.

use crate::tree::Tree;

/// Parts of the line that no stiffness joins to each other: for each position that of its part nearest to the root.
#[must_use]
pub fn connected_parts(tree: &Tree) -> Vec<usize> {
    let n = tree.len();
    let mut part: Vec<usize> = (0..n).collect();
    for i in (0..n).rev() {
        if tree.parent[i] < n && tree.k[i] > 0.0 {
            part[i] = part[tree.parent[i]];
        }
    }
    part
}

/// Number of rigid modes: parts of the line that no stiffness joins to each other or to the ground.
#[must_use]
pub fn rigid_modes(tree: &Tree) -> usize {
    let n = tree.len();
    // A part is free when none of its nodes is held.
    let part = connected_parts(tree);
    let (mut held, mut heavy) = (vec![false; n], vec![false; n]);
    for i in 0..n {
        held[part[i]] |= tree.ground[i] != 0.0;
        heavy[part[i]] |= tree.inertia[i] != 0.0;
    }
    (0..n).filter(|&p| part[p] == p && !held[p] && heavy[p]).count()
}
