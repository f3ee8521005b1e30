//! Equations of motion over time: what the models that integrate share.

use gudgeon_core::kinds::Line;

/// `J_i(θ) dω_i/dt = torques - ½ J_i'(θ) ω_i²`, with gear ratios in the links.
#[derive(Debug, Clone)]
pub(crate) struct Dynamics {
    pub line: Line,
    /// Constant part of the inertias.
    base: Vec<f64>,
    damping: Vec<f64>,
    ground: Vec<f64>,
    /// Nodes and linear coefficients of the links; `None` when the law is not linear.
    links: Vec<([usize; 2], Option<[f64; 2]>, f64)>,
    variable: bool,
    /// Torques of the throws and the drives at the last evaluation.
    pub gas: Vec<f64>,
    pub drive: Vec<f64>,
    inertia: Vec<f64>,
}

impl Dynamics {
    pub fn new(line: &Line) -> Self {
        let n = line.nodes.len();
        let mut base: Vec<f64> = line.nodes.iter().map(|n| n.inertia).collect();
        for t in line.throws.iter().filter(|t| t.inertia.is_constant()) {
            base[t.node] += t.inertia.mean();
        }
        let links = line
            .links
            .iter()
            .map(|l| {
                let law = l.coupling.linear(0.0, 0.0);
                let gear = line.nodes[l.nodes[0]].ratio / line.nodes[l.nodes[1]].ratio;
                (l.nodes, l.coupling.is_linear().then_some([law.stiffness, law.damping]), gear)
            })
            .collect();
        Self {
            base,
            damping: line.nodes.iter().map(|n| n.damping).collect(),
            ground: line.nodes.iter().map(|n| n.ground).collect(),
            links,
            variable: line.throws.iter().any(|t| !t.inertia.is_constant()),
            gas: vec![0.0; line.throws.len()],
            drive: vec![0.0; line.drives.len()],
            inertia: vec![0.0; n],
            line: line.clone(),
        }
    }

    /// Accelerations at angles and speeds; the gas torques at the angles `ahead`, decided at `decided`.
    pub fn accelerations(
        &mut self,
        theta: &[f64],
        omega: &[f64],
        decided: &[f64],
        ahead: &[f64],
        out: &mut [f64],
    ) {
        let n = theta.len();
        for i in 0..n {
            out[i] = -self.damping[i] * omega[i] - self.ground[i] * theta[i];
        }
        for (l, (nodes, law, gear)) in self.links.iter().enumerate() {
            let [a, b] = *nodes;
            let (twist, rate) = (theta[a] - gear * theta[b], omega[a] - gear * omega[b]);
            let torque = match law {
                Some([k, c]) => k * twist + c * rate,
                None => self.line.links[l].coupling.torque(twist, rate).torque,
            };
            out[a] -= torque;
            out[b] += gear * torque;
        }
        for (g, t) in self.gas.iter_mut().zip(&self.line.throws) {
            *g = t.gas_torque(decided[t.node], ahead[t.node]);
            out[t.node] += *g;
        }
        for (m, d) in self.drive.iter_mut().zip(&self.line.drives) {
            *m = d.factor * d.drive.torque(theta[d.node] + d.phase, omega[d.node]).torque;
            out[d.node] += *m;
        }
        if self.variable {
            self.inertia.copy_from_slice(&self.base);
            for t in self.line.throws.iter().filter(|t| !t.inertia.is_constant()) {
                let (j, dj) = t.inertia.inertia(theta[t.node] + t.phase);
                self.inertia[t.node] += j;
                out[t.node] -= 0.5 * dj * omega[t.node] * omega[t.node];
            }
            for (o, j) in out.iter_mut().zip(&self.inertia) {
                *o /= j;
            }
        } else {
            for (o, j) in out.iter_mut().zip(&self.base) {
                *o /= j;
            }
        }
    }

    /// Nodes whose acceleration depends on each node, itself included.
    pub fn neighbours(&self) -> Vec<Vec<usize>> {
        let mut all: Vec<Vec<usize>> = (0..self.base.len()).map(|i| vec![i]).collect();
        for ([a, b], _, _) in &self.links {
            all[*a].push(*b);
            all[*b].push(*a);
        }
        all
    }
}
