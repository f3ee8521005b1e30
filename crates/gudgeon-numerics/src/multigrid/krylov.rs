//! Minimisation of residuals over search directions: the generalised conjugate residual method.

use crate::linalg::dot;

/// Search directions kept by the minimisation of residuals.
pub(super) const DIRECTIONS: usize = 10;

/// Work space of the generalised conjugate residual method.
#[derive(Debug, Clone)]
pub(super) struct Krylov {
    /// Directions, what the matrix makes of them, and the squares of the latter.
    pub z: Vec<Vec<f64>>,
    pub q: Vec<Vec<f64>>,
    pub square: [f64; DIRECTIONS],
    /// What each direction shares with the ones before, and how far to go along it once that is taken out.
    pub share: [[f64; DIRECTIONS]; DIRECTIONS],
    pub step: [f64; DIRECTIONS],
    pub v: Vec<f64>,
    pub r: Vec<f64>,
}

impl Krylov {
    /// For vectors of `n` values.
    pub fn new(n: usize) -> Self {
        let field = || vec![0.0; n];
        Self {
            z: vec![field(); DIRECTIONS],
            q: vec![field(); DIRECTIONS],
            square: [0.0; DIRECTIONS],
            share: [[0.0; DIRECTIONS]; DIRECTIONS],
            step: [0.0; DIRECTIONS],
            v: field(),
            r: field(),
        }
    }

    /// Makes what the matrix does to direction `now` orthogonal to that of the directions before it. Returns its square.
    pub fn orthogonalise(&mut self, now: usize) -> f64 {
        let (done, new) = self.q.split_at_mut(now);
        let new = &mut new[0];
        for (d, qd) in done.iter().enumerate() {
            let share = dot(qd, new) / self.square[d];
            self.share[now][d] = share;
            for (x, y) in new.iter_mut().zip(qd) {
                *x -= share * y;
            }
        }
        self.square[now] = dot(new, new);
        self.square[now]
    }

    /// Goes along direction `now` as far as the residual shrinks.
    pub fn descend(&mut self, now: usize) {
        let step = dot(&self.q[now], &self.r) / self.square[now];
        self.step[now] = step;
        for (r, q) in self.r.iter_mut().zip(&self.q[now]) {
            *r -= step * q;
        }
    }

    /// Adds the first `count` directions to the solution, each with its own step less what later ones took of it.
    pub fn move_along(&mut self, count: usize) {
        for d in (0..count).rev() {
            let later: f64 = (d + 1..count).map(|e| self.share[e][d] * self.step[e]).sum();
            self.step[d] -= later;
            let step = self.step[d];
            for (v, z) in self.v.iter_mut().zip(&self.z[d]) {
                *v += step * z;
            }
        }
    }
}
