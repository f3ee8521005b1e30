//! The linear systems of an implicit step, eliminated along the tree.

use super::links::Elastic;

/// The linear systems `(z I - ∂f/∂y) u = b` of an implicit step, y = (θ, ω) of the groups.
///
/// With `u_ω = z u_θ - b_θ` a system of half the size is left, that of the tree with `κ = k + z c` in its links. It is eliminated like
/// that of forced vibration, springs in series, in a time that goes with the number of inertias.
#[derive(Debug, Clone, Default)]
pub(super) struct Newton {
    z: f64,
    /// Stiffness and damping of the links.
    pub law: Vec<[f64; 2]>,
    /// Derivatives of the accelerations by own angle and own speed, the torques of the links held.
    pub by_angle: Vec<f64>,
    pub by_speed: Vec<f64>,
    pub inertia: Vec<f64>,
    /// Torques of the links on the groups.
    pub held: Vec<f64>,
    /// Pivots, `κ` by pivot, right-hand sides.
    s: Vec<f64>,
    share: Vec<f64>,
    f: Vec<f64>,
    /// Accelerations at the state, a state beside it, accelerations there.
    pub trial: [Vec<f64>; 3],
}

impl Newton {
    pub fn new(groups: usize, links: usize) -> Self {
        let zero = || vec![0.0; groups];
        Self {
            z: 0.0,
            law: vec![[0.0; 2]; links],
            by_angle: zero(),
            by_speed: zero(),
            inertia: zero(),
            held: zero(),
            s: zero(),
            share: zero(),
            f: zero(),
            trial: [zero(), zero(), zero()],
        }
    }

    /// Prepares [`Newton::solve`] for `z`; false when the matrix is singular.
    pub fn factor(&mut self, z: f64, links: &[Elastic], order: &[(usize, Option<usize>)]) -> bool {
        self.z = z;
        for i in 0..self.s.len() {
            self.s[i] = self.inertia[i] * (z * (z - self.by_speed[i]) - self.by_angle[i]);
        }
        for &(g, link) in order {
            let Some(l) = link else {
                return self.s[g] != 0.0 && self.s[g].is_finite();
            };
            // Angles of both ends as those of the link: what twists it is their difference.
            let e = &links[l];
            let k = self.law[l][0] + z * self.law[l][1];
            let (own, other, above) = e.ends(g);
            let s = self.s[g] / (own * own);
            let d = k + s;
            if d == 0.0 || !d.is_finite() {
                return false;
            }
            self.share[g] = k / d;
            self.s[above] += other * other * s * self.share[g];
            // The pivot itself is what the way back divides by.
            self.s[g] = d;
        }
        false
    }

    /// Solves for the angles `b[..n]` and speeds `b[n..]` in place.
    pub fn solve(&mut self, b: &mut [f64], links: &[Elastic], order: &[(usize, Option<usize>)]) {
        let n = self.s.len();
        let (angle, speed) = b.split_at_mut(n);
        for i in 0..n {
            self.f[i] = self.inertia[i] * (speed[i] + (self.z - self.by_speed[i]) * angle[i]);
        }
        for (l, e) in links.iter().enumerate() {
            let ([a, b], [x, y]) = (e.groups, e.scale);
            let t = self.law[l][1] * (x * angle[a] - y * angle[b]);
            self.f[a] += x * t;
            self.f[b] -= y * t;
        }
        for &(g, link) in order {
            let Some(l) = link else { continue };
            let (own, other, above) = links[l].ends(g);
            self.f[g] /= own;
            self.f[above] += other * self.f[g] * self.share[g];
        }
        for &(g, link) in order.iter().rev() {
            let u = match link {
                None => self.f[g] / self.s[g],
                Some(l) => {
                    let (own, other, above) = links[l].ends(g);
                    // The solution of the parent stands in the place of its right-hand side.
                    (self.f[g] / self.s[g] + self.share[g] * other * self.f[above]) / own
                }
            };
            self.f[g] = u;
        }
        for i in 0..n {
            speed[i] = self.z * self.f[i] - angle[i];
            angle[i] = self.f[i];
        }
    }
}
