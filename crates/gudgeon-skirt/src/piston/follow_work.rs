//! Work arrays of the search along the motion towards a balance.

use gudgeon_numerics::linalg::lu_solve;

/// What the search along the motion towards a balance works with.
#[derive(Default)]
pub(super) struct FollowWork {
    /// Derivatives of the forces of full films.
    pub(super) full: Vec<f64>,
    pub(super) lu: Vec<f64>,
    pub(super) piv: Vec<usize>,
    pub(super) error: Vec<f64>,
    pub(super) solved: Vec<f64>,
}

impl FollowWork {
    pub(super) fn new(n: usize) -> Self {
        let v = |n: usize| vec![0.0; n];
        Self { full: v(n * n), lu: v(n * n), piv: vec![0; n], error: v(n), solved: v(n) }
    }

    /// Sum of the squares of the rates `B^-1 r` that forces `r` on the coordinates from `first` on give to full films.
    pub(super) fn motion(lu: &[f64], piv: &[usize], solved: &mut [f64], r: &[f64]) -> f64 {
        solved.copy_from_slice(r);
        lu_solve(lu, r.len(), piv, solved);
        solved.iter().map(|s| s * s).sum::<f64>()
    }
}
