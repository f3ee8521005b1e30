//! Accelerations of the groups with their derivatives, and torques in the links.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::Line;

use super::groups::{Coefficients, Groups};
use super::links::Elastic;
use super::newton::Newton;
use crate::tree::Tree;

/// `J_g(θ) dω_g/dt = torques - ½ J_g'(θ) ω_g²` for every group of inertias that rigid links join, with gear ratios in the links.
///
/// The angle of inertia i of a group is `ρ_i` times that of the group, so its torques count `ρ_i` times and its inertia `ρ_i²` times.
/// Without rigid links every inertia is a group of its own.
#[derive(Debug, Clone)]
pub(crate) struct Dynamics {
    pub line: Line,
    tree: Tree,
    groups: Groups,
    constant: Coefficients,
    links: Vec<Elastic>,
    /// Groups in the order of elimination, each with its link; the last has none.
    order: Vec<(usize, Option<usize>)>,
    variable: bool,
    /// Torques of the throws and the drives at the last evaluation.
    pub gas: Vec<f64>,
    pub drive: Vec<f64>,
    /// Inertias at the last evaluation.
    inertia: Vec<f64>,
    newton: Newton,
}

impl Dynamics {
    /// # Errors
    /// As [`Tree::new`]; a group without inertia.
    pub fn new(line: &Line) -> Result<Self, BuildError> {
        let tree = Tree::new(line)?;
        let groups = Groups::new(line, &tree);
        let constant = groups.coefficients(line)?;
        let (links, number) = Elastic::of_line(line, &groups);
        let to_parent = |p: usize| if tree.parent[p] < tree.len() { number[tree.link[p]] } else { None };
        Ok(Self {
            newton: Newton::new(groups.len(), links.len()),
            order: groups.heads.iter().map(|&(g, p)| (g, to_parent(p))).collect(),
            variable: line.throws.iter().any(|t| !t.inertia.is_constant()),
            gas: vec![0.0; line.throws.len()],
            drive: vec![0.0; line.drives.len()],
            inertia: vec![0.0; groups.len()],
            line: line.clone(),
            tree,
            groups,
            constant,
            links,
        })
    }

    /// Number of groups.
    pub fn len(&self) -> usize {
        self.groups.len()
    }

    /// Angles or speeds of the groups from those of the inertias, which rigid links have agree.
    pub fn condense(&self, of_nodes: &[f64]) -> Vec<f64> {
        self.groups.condense(of_nodes)
    }

    /// Angles or speeds of the inertias from those of the groups.
    pub fn expand(&self, of_groups: &[f64]) -> Vec<f64> {
        self.groups.expand(of_groups)
    }

    /// Adds the torques of the links to `out`.
    fn elastic(&self, theta: &[f64], omega: &[f64], out: &mut [f64]) {
        for l in &self.links {
            let ([a, b], [x, y]) = (l.groups, l.scale);
            let torque = match l.law {
                Some([k, c]) => {
                    let (twist, rate) = l.twist(theta, omega);
                    k * twist + c * rate
                }
                None => l.torque(&self.line, theta, omega).torque,
            };
            out[a] -= x * torque;
            out[b] += y * torque;
        }
    }

    /// Adds to `out` what acts on each group by itself and divides by its inertia.
    fn local(&mut self, omega: &[f64], decided: &[f64], ahead: &[f64], out: &mut [f64]) {
        for (g, t) in self.gas.iter_mut().zip(&self.line.throws) {
            let (i, s) = (self.groups.of[t.node], self.groups.scale[t.node]);
            *g = t.gas_torque(s * decided[i], s * ahead[i]);
            out[i] += s * *g;
        }
        for (m, d) in self.drive.iter_mut().zip(&self.line.drives) {
            let (i, s) = (self.groups.of[d.node], self.groups.scale[d.node]);
            *m = d.factor * d.drive.torque(s * decided[i] + d.phase, s * omega[i]).torque;
            out[i] += s * *m;
        }
        self.inertia.copy_from_slice(&self.constant.inertia);
        if self.variable {
            for t in self.line.throws.iter().filter(|t| !t.inertia.is_constant()) {
                let (i, s) = (self.groups.of[t.node], self.groups.scale[t.node]);
                let (j, dj) = t.inertia.inertia(s * decided[i] + t.phase);
                self.inertia[i] += s * s * j;
                out[i] -= s * 0.5 * dj * (s * omega[i]) * (s * omega[i]);
            }
        }
        for (o, j) in out.iter_mut().zip(&self.inertia) {
            *o /= j;
        }
    }

    /// Accelerations of the groups at their angles and speeds; what goes with the angle is taken at `decided`, the gas torque at
    /// `ahead` where fixed angles decide.
    pub fn accelerations(
        &mut self,
        theta: &[f64],
        omega: &[f64],
        decided: &[f64],
        ahead: &[f64],
        out: &mut [f64],
    ) {
        for i in 0..theta.len() {
            out[i] = -self.constant.damping[i] * omega[i] - self.constant.ground[i] * theta[i];
        }
        self.elastic(theta, omega, out);
        self.local(omega, decided, ahead, out);
    }

    /// Torques in the links of the line at the state and the accelerations of the last evaluation: those of rigid links by what the
    /// inertias behind them need.
    pub fn link_torques(&self, theta: &[f64], omega: &[f64], decided: &[f64], alpha: &[f64]) -> Vec<f64> {
        let t = &self.tree;
        let n = t.len();
        let own = self.loads(theta, omega, decided, alpha);
        let mut out = vec![0.0; self.line.links.len()];
        for l in &self.links {
            out[l.link] = l.torque(&self.line, theta, omega).torque;
        }
        let mut load: Vec<f64> = (0..n).map(|p| own[t.node[p]] * t.ratio[p]).collect();
        for p in 0..n {
            let q = t.parent[p];
            if q >= n {
                continue;
            }
            let sign = if t.forward[p] { 1.0 } else { -1.0 };
            if t.k[p] == f64::INFINITY {
                out[t.link[p]] = sign * load[p] / t.link_ratio[p];
                load[q] += load[p];
            } else {
                load[q] += sign * out[t.link[p]] * t.link_ratio[p];
            }
        }
        out
    }

    /// What each inertia leaves over for its links: its torques less what its own acceleration takes.
    fn loads(&self, theta: &[f64], omega: &[f64], decided: &[f64], alpha: &[f64]) -> Vec<f64> {
        let mut own: Vec<f64> = vec![0.0; self.tree.len()];
        for (i, node) in self.line.nodes.iter().enumerate() {
            let (g, s) = (self.groups.of[i], self.groups.scale[i]);
            own[i] = -s * (node.damping * omega[g] + node.ground * theta[g] + node.inertia * alpha[g]);
        }
        for (torque, throw) in self.gas.iter().zip(&self.line.throws) {
            let (g, s) = (self.groups.of[throw.node], self.groups.scale[throw.node]);
            let (j, dj) = throw.inertia.inertia(s * decided[g] + throw.phase);
            own[throw.node] += torque - j * s * alpha[g] - 0.5 * dj * (s * omega[g]) * (s * omega[g]);
        }
        for (torque, drive) in self.drive.iter().zip(&self.line.drives) {
            own[drive.node] += torque;
        }
        own
    }

    /// Takes the derivatives at a state for [`Dynamics::factor`].
    pub fn linearise(&mut self, theta: &[f64], omega: &[f64]) {
        let mut w = std::mem::take(&mut self.newton);
        for (law, l) in w.law.iter_mut().zip(&self.links) {
            *law = l.law.unwrap_or_else(|| {
                let t = l.torque(&self.line, theta, omega);
                [t.stiffness, t.damping]
            });
        }
        w.held.fill(0.0);
        self.elastic(theta, omega, &mut w.held);
        let [at, moved, out] = &mut w.trial;
        // What a group does to itself, by differences: gas, drives, moving masses. One evaluation serves all groups.
        self.accelerations_under(&w.held, theta, omega, at);
        w.inertia.copy_from_slice(&self.inertia);
        for (m, v) in moved.iter_mut().zip(theta) {
            *m = v + increment(*v);
        }
        self.accelerations_under(&w.held, moved, omega, out);
        for i in 0..theta.len() {
            w.by_angle[i] = (out[i] - at[i]) / (moved[i] - theta[i]);
        }
        for (m, v) in moved.iter_mut().zip(omega) {
            *m = v + increment(*v);
        }
        self.accelerations_under(&w.held, theta, moved, out);
        for i in 0..theta.len() {
            w.by_speed[i] = (out[i] - at[i]) / (moved[i] - omega[i]);
        }
        self.newton = w;
    }

    /// Accelerations where the torques of the links are `held`.
    fn accelerations_under(&mut self, held: &[f64], theta: &[f64], omega: &[f64], out: &mut [f64]) {
        for i in 0..theta.len() {
            out[i] = held[i] - self.constant.damping[i] * omega[i] - self.constant.ground[i] * theta[i];
        }
        self.local(omega, theta, theta, out);
    }

    /// Prepares [`Dynamics::solve`] for `z`; false when the matrix is singular.
    pub fn factor(&mut self, z: f64) -> bool {
        self.newton.factor(z, &self.links, &self.order)
    }

    /// Solves for the angles `b[..n]` and speeds `b[n..]` in place.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.newton.solve(b, &self.links, &self.order);
    }
}

/// Increment of a difference quotient: the root of rounding.
fn increment(v: f64) -> f64 {
    (v + 1.5e-8 * v.abs().max(1.0)) - v
}
