//! The periodic motion of a line at constant mean speed, order by order: what several torsion models share.

use gudgeon_core::kinds::{CouplingSpec, Line, LinearCoupling, OrderResponse, TorsionCtx};
use gudgeon_core::quantity::quantity;
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::linalg::Complex;

use crate::coupling::Linear;
use crate::forcing::{Excitation, Order};
use crate::tree::{Singular, Tree, Work};

/// A line at constant mean speed.
#[derive(Debug)]
pub struct Steady {
    /// The line.
    pub line: Line,
    /// Its tree, linearised about the mean torques, with the slopes of the drives as damping.
    pub tree: Tree,
    /// What excites it.
    pub excitation: Excitation,
    /// Mean speed of the reference shaft \[rad/s\].
    pub speed: f64,
    /// Mean torques in the links \[N m\].
    pub mean_torque: Vec<f64>,
    /// Mean angles of the nodes against the one that balances \[rad\].
    pub mean_angle: Vec<f64>,
    /// Mean torque that the balancing node adds \[N m\].
    pub balance_torque: f64,
    varying: bool,
    work: Work,
    scratch: [Vec<Complex>; 3],
}

/// Damping of the drives: the slopes of their torques at the mean speed, by position.
pub(crate) fn drive_damping(line: &Line, tree: &mut Tree, speed: f64) {
    for d in &line.drives {
        let p = tree.position[d.node];
        let ratio = line.nodes[d.node].ratio;
        tree.damping[p] -= d.factor * d.drive.torque(0.0, speed * ratio).slope * ratio * ratio;
    }
}

/// The line with the couplings that depend on their mean torque replaced by what they are in small vibration about it: the line whose
/// natural frequencies are those at the speed of `ctx`. Laws over the frequency stay as they are.
///
/// # Errors
/// As [`Tree::new`].
pub fn about_mean_torque(ctx: &TorsionCtx<'_>) -> Result<Line, BuildError> {
    let mut line = ctx.line.clone();
    if line.links.iter().all(|l| !l.coupling.depends_on_load()) {
        return Ok(line);
    }
    let mean = Steady::new(ctx)?.mean_torque;
    for (l, mean) in line.links.iter_mut().zip(mean).filter(|(l, _)| l.coupling.depends_on_load()) {
        let LinearCoupling { stiffness, damping, loss_factor } = l.coupling.linear(0.0, mean);
        let law = Linear {
            stiffness: quantity(stiffness),
            damping: quantity(damping),
            loss_factor: quantity(loss_factor),
        };
        l.coupling = law.build()?;
    }
    Ok(line)
}

impl Steady {
    /// Mean torques, excitation and tree.
    ///
    /// # Errors
    /// As [`Tree::new`].
    pub fn new(ctx: &TorsionCtx<'_>) -> Result<Self, BuildError> {
        Self::with(ctx, Excitation::new(ctx.line, ctx.speed, ctx.orders))
    }

    /// [`Steady::new`] with an excitation that is known already.
    pub(crate) fn with(ctx: &TorsionCtx<'_>, excitation: Excitation) -> Result<Self, BuildError> {
        let line = ctx.line.clone();
        let mut tree = Tree::new(&line)?;
        let n = tree.len();
        if ctx.balance >= n {
            return Err(BuildError::at("balance", "the inertia that balances does not exist"));
        }
        let (mean_torque, mean_angle, balance_torque) =
            mean_state(&line, &tree, &excitation.mean, ctx.balance);
        tree.linearise(&line, 0.0, &mean_torque);
        drive_damping(&line, &mut tree, ctx.speed);
        let varying = line.links.iter().any(|l| l.coupling.depends_on_frequency());
        let z = vec![Complex::default(); n];
        Ok(Self {
            tree,
            excitation,
            speed: ctx.speed,
            mean_torque,
            mean_angle,
            balance_torque,
            varying,
            work: Work::new(n),
            scratch: [z.clone(), z.clone(), z],
            line,
        })
    }

    /// Response to torques of one order (phasors by node).
    ///
    /// # Errors
    /// An undamped resonance (Fatal).
    pub fn respond(&mut self, o: &Order) -> Result<OrderResponse, EvalError> {
        let omega = o.order * self.speed;
        if self.varying {
            self.tree.linearise(&self.line, omega, &self.mean_torque);
        }
        let t = &self.tree;
        let n = t.len();
        let [f, x, q] = &mut self.scratch;
        for p in 0..n {
            f[p] = o.torque[t.node[p]] * Complex::new(t.ratio[p], 0.0);
        }
        t.solve(Complex::new(0.0, omega), f, x, q, Singular::Refuse, &mut self.work).map_err(|_| {
            EvalError::fatal(
                "torsion",
                format!(
                    "order {} at {:.6} rpm hits an undamped natural frequency ({:.6} Hz): without damping the vibration grows without bound",
                    o.order,
                    self.speed * 30.0 / std::f64::consts::PI,
                    omega / (2.0 * std::f64::consts::PI)
                ),
            )
        })?;
        let mut r = OrderResponse {
            order: o.order,
            angle: vec![[0.0; 2]; n],
            torque: vec![[0.0; 2]; self.line.links.len()],
            heat: vec![0.0; self.line.links.len()],
            excitation: o.torque.iter().map(|t| [t.re, t.im]).collect(),
        };
        for p in 0..n {
            let s = t.ratio[p];
            r.angle[t.node[p]] = [x[p].re * s, x[p].im * s];
            if t.parent[p] < n {
                let l = t.link[p];
                let s = if t.forward[p] { 1.0 } else { -1.0 } / t.link_ratio[p];
                r.torque[l] = [q[p].re * s, q[p].im * s];
                let kappa = Complex::new(t.k[p], t.k[p] * t.eta[p] + omega * t.c[p]);
                if t.k[p].is_finite() && kappa.norm1() > 0.0 {
                    let size = q[p].abs() / kappa.abs();
                    r.heat[l] = 0.5 * omega * kappa.im * size * size;
                }
            }
        }
        Ok(r)
    }
}

/// Mean torques in the links, angles against the balancing node (against the ground where several places are held) and its torque, for
/// mean torques by node.
pub(crate) fn mean_state(
    line: &Line,
    tree: &Tree,
    mean: &[f64],
    balance: usize,
) -> (Vec<f64>, Vec<f64>, f64) {
    let n = tree.len();
    let mut f: Vec<f64> = (0..n).map(|p| mean[tree.node[p]] * tree.ratio[p]).collect();
    let at = tree.position[balance];
    let total: f64 = f.iter().sum();
    let held = tree.ground.iter().filter(|g| **g != 0.0).count();
    let balance_torque = if held > 0 { 0.0 } else { -total / tree.ratio[at] };
    if held > 1
        && let Some(answer) = held_state(line, tree, &f)
    {
        return answer;
    }
    // A line that is held at one place takes up the rest there.
    match tree.ground.iter().position(|g| *g != 0.0) {
        Some(g) => f[g] -= total,
        None => f[at] -= total,
    }
    let mut torque = vec![0.0; line.links.len()];
    let mut twist = vec![0.0; n];
    for p in 0..n {
        let q = tree.parent[p];
        if q < n {
            f[q] += f[p];
            let s = if tree.forward[p] { 1.0 } else { -1.0 };
            let physical = s * f[p] / tree.link_ratio[p];
            torque[tree.link[p]] = physical;
            // φ_child - φ_parent.
            twist[p] = s * line.links[tree.link[p]].coupling.static_twist(physical) / tree.link_ratio[p];
        }
    }
    let mut phi = vec![0.0; n];
    for p in (0..n).rev() {
        if tree.parent[p] < n {
            phi[p] = phi[tree.parent[p]] + twist[p];
        }
    }
    let zero = phi[at];
    let mut angle = vec![0.0; n];
    for p in 0..n {
        angle[tree.node[p]] = (phi[p] - zero) * tree.ratio[p];
    }
    (torque, angle, balance_torque)
}

/// Static state of a line that is held at several places: couplings as the tree has them. None when a part is not held at all.
fn held_state(line: &Line, tree: &Tree, f: &[f64]) -> Option<(Vec<f64>, Vec<f64>, f64)> {
    let n = tree.len();
    let load: Vec<Complex> = f.iter().map(|f| Complex::new(*f, 0.0)).collect();
    let (mut x, mut q) = (vec![Complex::default(); n], vec![Complex::default(); n]);
    tree.solve(Complex::default(), &load, &mut x, &mut q, Singular::Refuse, &mut Work::new(n)).ok()?;
    let (mut torque, mut angle) = (vec![0.0; line.links.len()], vec![0.0; n]);
    for p in 0..n {
        angle[tree.node[p]] = x[p].re * tree.ratio[p];
        if tree.parent[p] < n {
            let s = if tree.forward[p] { 1.0 } else { -1.0 };
            torque[tree.link[p]] = s * q[p].re / tree.link_ratio[p];
        }
    }
    Some((torque, angle, 0.0))
}

impl Steady {
    /// Writes the mean state.
    pub(crate) fn describe(&self, out: &mut gudgeon_core::kinds::TorsionOut) {
        out.mean_torque.clone_from(&self.mean_torque);
        out.mean_angle.clone_from(&self.mean_angle);
        out.balance_torque = self.balance_torque;
        out.speed = self.speed;
    }
}
