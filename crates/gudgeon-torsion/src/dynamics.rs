//! Equations of motion over time: what the models that integrate share.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{Line, TorsionOut};

use crate::tree::Tree;

/// `J_g(θ) dω_g/dt = torques - ½ J_g'(θ) ω_g²` for every group of inertias that rigid links join, with gear ratios in the links.
///
/// The angle of inertia i of a group is `ρ_i` times that of the group, so its torques count `ρ_i` times and its inertia `ρ_i²` times.
/// Without rigid links every inertia is a group of its own.
#[derive(Debug, Clone)]
pub(crate) struct Dynamics {
    pub line: Line,
    tree: Tree,
    /// Group of each inertia, and its angle by that of the group.
    group: Vec<usize>,
    scale: Vec<f64>,
    /// Constant part of the inertias of the groups.
    base: Vec<f64>,
    damping: Vec<f64>,
    ground: Vec<f64>,
    links: Vec<Elastic>,
    /// Groups in the order of elimination, each with its link; the last has none.
    order: Vec<(usize, Option<usize>)>,
    variable: bool,
    /// Torques of the throws and the drives at the last evaluation.
    pub gas: Vec<f64>,
    pub drive: Vec<f64>,
    inertia: Vec<f64>,
    newton: Newton,
}

/// A link that is not rigid.
#[derive(Debug, Clone)]
struct Elastic {
    /// Link of the line.
    link: usize,
    /// Groups, and what an angle of each twists the link.
    groups: [usize; 2],
    scale: [f64; 2],
    /// Stiffness and damping; `None` when the law is not linear.
    law: Option<[f64; 2]>,
}

/// The linear systems `(z I - ∂f/∂y) u = b` of an implicit step, y = (θ, ω) of the groups.
///
/// With `u_ω = z u_θ - b_θ` a system of half the size is left, that of the tree with `κ = k + z c` in its links. It is eliminated like
/// that of forced vibration, springs in series, in a time that goes with the number of inertias.
#[derive(Debug, Clone, Default)]
struct Newton {
    z: f64,
    /// Stiffness and damping of the links.
    law: Vec<[f64; 2]>,
    /// Derivatives of the accelerations by own angle and own speed, the torques of the links held.
    by_angle: Vec<f64>,
    by_speed: Vec<f64>,
    inertia: Vec<f64>,
    /// Torques of the links on the groups.
    held: Vec<f64>,
    /// Pivots, `κ` by pivot, right-hand sides.
    s: Vec<f64>,
    share: Vec<f64>,
    f: Vec<f64>,
    trial: [Vec<f64>; 3],
}

impl Dynamics {
    /// # Errors
    /// As [`Tree::new`]; a group without inertia.
    pub fn new(line: &Line) -> Result<Self, BuildError> {
        let tree = Tree::new(line)?;
        let n = tree.len();
        // Groups by their first inertia in the order of the line, so that a line without rigid links keeps its order.
        let mut head: Vec<usize> = (0..n).collect();
        for p in (0..n).rev() {
            if tree.parent[p] < n && tree.k[p] == f64::INFINITY {
                head[p] = head[tree.parent[p]];
            }
        }
        let mut of_head = vec![usize::MAX; n];
        let mut first = Vec::new();
        let mut group = vec![0; n];
        for i in 0..n {
            let h = head[tree.position[i]];
            if of_head[h] == usize::MAX {
                of_head[h] = first.len();
                first.push(i);
            }
            group[i] = of_head[h];
        }
        let count = first.len();
        let ratio = |i: usize| line.nodes[i].ratio;
        let scale: Vec<f64> = (0..n).map(|i| ratio(i) / ratio(first[group[i]])).collect();
        let (mut base, mut damping, mut ground, mut mean) =
            (vec![0.0; count], vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        for i in 0..n {
            let (g, square) = (group[i], scale[i] * scale[i]);
            base[g] += square * line.nodes[i].inertia;
            damping[g] += square * line.nodes[i].damping;
            ground[g] += square * line.nodes[i].ground;
            mean[g] += square * line.mean_inertia(i);
        }
        for t in line.throws.iter().filter(|t| t.inertia.is_constant()) {
            base[group[t.node]] += scale[t.node] * scale[t.node] * t.inertia.mean();
        }
        if let Some(g) = mean.iter().position(|j| *j <= 0.0) {
            let i = first[g];
            let what = format!("the inertia of `{}` is zero: motion over time wants one", line.nodes[i].name);
            return Err(BuildError::at(format!("inertias.{i}"), what).help(
                "join it to its neighbour by a rigid link (coupling `off`), or make one shaft of the two beside it (1/k = 1/k1 + 1/k2)",
            ));
        }
        // A crank without inertia stands still with its piston at the dead centres.
        for g in
            (0..count).filter(|g| line.throws.iter().any(|t| group[t.node] == *g && !t.inertia.is_constant()))
        {
            let varying = || line.throws.iter().filter(|t| group[t.node] == g && !t.inertia.is_constant());
            let at = |angle: f64| {
                base[g]
                    + varying()
                        .map(|t| {
                            let s = scale[t.node];
                            s * s * t.inertia.inertia(s * angle + t.phase).0
                        })
                        .sum::<f64>()
            };
            let dead = varying().flat_map(|t| [0.0, PI].map(|a| (a - t.phase) / scale[t.node]));
            let least =
                (0..720).map(|i| PI / 360.0 * f64::from(i)).chain(dead).map(at).fold(f64::INFINITY, f64::min);
            if least.is_nan() || least <= 1e-6 * mean[g] {
                let i = first[g];
                let what =
                    format!("the inertia of `{}` vanishes at an angle of its crank", line.nodes[i].name);
                return Err(BuildError::at(format!("inertias.{i}"), what).help("give the crank its inertia"));
            }
        }
        let mut links = Vec::new();
        let mut number = vec![None; line.links.len()];
        for (l, link) in line.links.iter().enumerate() {
            let law = link.coupling.linear(0.0, 0.0);
            if law.stiffness == f64::INFINITY {
                continue;
            }
            let [a, b] = link.nodes;
            let gear = ratio(a) / ratio(b);
            number[l] = Some(links.len());
            links.push(Elastic {
                link: l,
                groups: [group[a], group[b]],
                scale: [scale[a], gear * scale[b]],
                law: link.coupling.is_linear().then_some([law.stiffness, law.damping]),
            });
        }
        let order = (0..n)
            .filter(|&p| head[p] == p)
            .map(|p| (of_head[p], if tree.parent[p] < n { number[tree.link[p]] } else { None }))
            .collect();
        let zero = || vec![0.0; count];
        Ok(Self {
            newton: Newton {
                z: 0.0,
                law: vec![[0.0; 2]; links.len()],
                by_angle: zero(),
                by_speed: zero(),
                inertia: zero(),
                held: zero(),
                s: zero(),
                share: zero(),
                f: zero(),
                trial: [zero(), zero(), zero()],
            },
            tree,
            group,
            scale,
            base,
            damping,
            ground,
            links,
            order,
            variable: line.throws.iter().any(|t| !t.inertia.is_constant()),
            gas: vec![0.0; line.throws.len()],
            drive: vec![0.0; line.drives.len()],
            inertia: zero(),
            line: line.clone(),
        })
    }

    /// Number of groups.
    pub fn len(&self) -> usize {
        self.base.len()
    }

    /// Angles or speeds of the groups from those of the inertias, which rigid links have agree.
    pub fn condense(&self, of_nodes: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        for (i, v) in of_nodes.iter().enumerate().rev() {
            out[self.group[i]] = v / self.scale[i];
        }
        out
    }

    /// Angles or speeds of the inertias from those of the groups.
    pub fn expand(&self, of_groups: &[f64]) -> Vec<f64> {
        self.group.iter().zip(&self.scale).map(|(g, s)| s * of_groups[*g]).collect()
    }

    /// Adds the torques of the links to `out`.
    fn elastic(&self, theta: &[f64], omega: &[f64], out: &mut [f64]) {
        for l in &self.links {
            let ([a, b], [x, y]) = (l.groups, l.scale);
            let (twist, rate) = (x * theta[a] - y * theta[b], x * omega[a] - y * omega[b]);
            let torque = match l.law {
                Some([k, c]) => k * twist + c * rate,
                None => self.line.links[l.link].coupling.torque(twist, rate).torque,
            };
            out[a] -= x * torque;
            out[b] += y * torque;
        }
    }

    /// Adds to `out` what acts on each group by itself and divides by its inertia.
    fn local(&mut self, omega: &[f64], decided: &[f64], ahead: &[f64], out: &mut [f64]) {
        for (g, t) in self.gas.iter_mut().zip(&self.line.throws) {
            let (i, s) = (self.group[t.node], self.scale[t.node]);
            *g = t.gas_torque(s * decided[i], s * ahead[i]);
            out[i] += s * *g;
        }
        for (m, d) in self.drive.iter_mut().zip(&self.line.drives) {
            let (i, s) = (self.group[d.node], self.scale[d.node]);
            *m = d.factor * d.drive.torque(s * decided[i] + d.phase, s * omega[i]).torque;
            out[i] += s * *m;
        }
        self.inertia.copy_from_slice(&self.base);
        if self.variable {
            for t in self.line.throws.iter().filter(|t| !t.inertia.is_constant()) {
                let (i, s) = (self.group[t.node], self.scale[t.node]);
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
            out[i] = -self.damping[i] * omega[i] - self.ground[i] * theta[i];
        }
        self.elastic(theta, omega, out);
        self.local(omega, decided, ahead, out);
    }

    /// Torques in the links of the line at the state and the accelerations of the last evaluation: those of rigid links by what the
    /// inertias behind them need.
    pub fn link_torques(&self, theta: &[f64], omega: &[f64], decided: &[f64], alpha: &[f64]) -> Vec<f64> {
        let t = &self.tree;
        let n = t.len();
        let mut own: Vec<f64> = vec![0.0; n];
        for (i, node) in self.line.nodes.iter().enumerate() {
            let (g, s) = (self.group[i], self.scale[i]);
            own[i] = -s * (node.damping * omega[g] + node.ground * theta[g] + node.inertia * alpha[g]);
        }
        for (torque, throw) in self.gas.iter().zip(&self.line.throws) {
            let (g, s) = (self.group[throw.node], self.scale[throw.node]);
            let (j, dj) = throw.inertia.inertia(s * decided[g] + throw.phase);
            own[throw.node] += torque - j * s * alpha[g] - 0.5 * dj * (s * omega[g]) * (s * omega[g]);
        }
        for (torque, drive) in self.drive.iter().zip(&self.line.drives) {
            own[drive.node] += torque;
        }
        let mut out = vec![0.0; self.line.links.len()];
        for l in &self.links {
            let ([a, b], [x, y]) = (l.groups, l.scale);
            let (twist, rate) = (x * theta[a] - y * theta[b], x * omega[a] - y * omega[b]);
            out[l.link] = self.line.links[l.link].coupling.torque(twist, rate).torque;
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

    /// Takes the derivatives at a state for [`Dynamics::factor`].
    pub fn linearise(&mut self, theta: &[f64], omega: &[f64]) {
        let mut w = std::mem::take(&mut self.newton);
        for (law, l) in w.law.iter_mut().zip(&self.links) {
            *law = l.law.unwrap_or_else(|| {
                let ([a, b], [x, y]) = (l.groups, l.scale);
                let (twist, rate) = (x * theta[a] - y * theta[b], x * omega[a] - y * omega[b]);
                let t = self.line.links[l.link].coupling.torque(twist, rate);
                [t.stiffness, t.damping]
            });
        }
        w.held.fill(0.0);
        self.elastic(theta, omega, &mut w.held);
        let [at, moved, out] = &mut w.trial;
        // What a group does to itself, by differences: gas, drives, moving masses. One evaluation serves all groups.
        let evaluate = |theta: &[f64], omega: &[f64], out: &mut [f64], own: &mut Self| {
            for i in 0..theta.len() {
                out[i] = w.held[i] - own.damping[i] * omega[i] - own.ground[i] * theta[i];
            }
            own.local(omega, theta, theta, out);
        };
        evaluate(theta, omega, at, self);
        w.inertia.copy_from_slice(&self.inertia);
        let step = |v: f64, least: f64| (v + 1.5e-8 * v.abs().max(least)) - v;
        for (m, v) in moved.iter_mut().zip(theta) {
            *m = v + step(*v, 1.0);
        }
        evaluate(moved, omega, out, self);
        for i in 0..theta.len() {
            w.by_angle[i] = (out[i] - at[i]) / (moved[i] - theta[i]);
        }
        for (m, v) in moved.iter_mut().zip(omega) {
            *m = v + step(*v, 1.0);
        }
        evaluate(theta, moved, out, self);
        for i in 0..theta.len() {
            w.by_speed[i] = (out[i] - at[i]) / (moved[i] - omega[i]);
        }
        self.newton = w;
    }

    /// Prepares [`Dynamics::solve`] for `z`; false when the matrix is singular.
    pub fn factor(&mut self, z: f64) -> bool {
        let w = &mut self.newton;
        w.z = z;
        for i in 0..w.s.len() {
            w.s[i] = w.inertia[i] * (z * (z - w.by_speed[i]) - w.by_angle[i]);
        }
        for &(g, link) in &self.order {
            let Some(l) = link else {
                return w.s[g] != 0.0 && w.s[g].is_finite();
            };
            // Angles of both ends as those of the link: what twists it is their difference.
            let e = &self.links[l];
            let k = w.law[l][0] + z * w.law[l][1];
            let (own, other, above) = e.ends(g);
            let s = w.s[g] / (own * own);
            let d = k + s;
            if d == 0.0 || !d.is_finite() {
                return false;
            }
            w.share[g] = k / d;
            w.s[above] += other * other * s * w.share[g];
            // The pivot itself is what the way back divides by.
            w.s[g] = d;
        }
        false
    }

    /// Solves for the angles `b[..n]` and speeds `b[n..]` in place.
    pub fn solve(&mut self, b: &mut [f64]) {
        let w = &mut self.newton;
        let n = w.s.len();
        let (angle, speed) = b.split_at_mut(n);
        for i in 0..n {
            w.f[i] = w.inertia[i] * (speed[i] + (w.z - w.by_speed[i]) * angle[i]);
        }
        for (l, e) in self.links.iter().enumerate() {
            let ([a, b], [x, y]) = (e.groups, e.scale);
            let t = w.law[l][1] * (x * angle[a] - y * angle[b]);
            w.f[a] += x * t;
            w.f[b] -= y * t;
        }
        for &(g, link) in &self.order {
            let Some(l) = link else { continue };
            let (own, other, above) = self.links[l].ends(g);
            w.f[g] /= own;
            w.f[above] += other * w.f[g] * w.share[g];
        }
        for &(g, link) in self.order.iter().rev() {
            let u = match link {
                None => w.f[g] / w.s[g],
                Some(l) => {
                    let (own, other, above) = self.links[l].ends(g);
                    // The solution of the parent stands in the place of its right-hand side.
                    (w.f[g] / w.s[g] + w.share[g] * other * w.f[above]) / own
                }
            };
            w.f[g] = u;
        }
        for i in 0..n {
            speed[i] = w.z * w.f[i] - angle[i];
            angle[i] = w.f[i];
        }
    }
}

/// Writes an instant: angles and speeds of the inertias, torques as they are there.
pub(crate) fn record(dynamics: &mut Dynamics, t: f64, theta: &[f64], omega: &[f64], out: &mut TorsionOut) {
    let mut alpha = vec![0.0; theta.len()];
    dynamics.accelerations(theta, omega, theta, theta, &mut alpha);
    out.times.push(t);
    out.angles.push(dynamics.expand(theta));
    out.speeds.push(dynamics.expand(omega));
    out.torque.push(dynamics.link_torques(theta, omega, theta, &alpha));
    out.gas.push(dynamics.gas.clone());
    out.drive.push(dynamics.drive.clone());
}

impl Elastic {
    /// Scale of group `g`, scale of the other end, and the other end.
    fn ends(&self, g: usize) -> (f64, f64, usize) {
        if self.groups[0] == g {
            (self.scale[0], self.scale[1], self.groups[1])
        } else {
            (self.scale[1], self.scale[0], self.groups[0])
        }
    }
}
