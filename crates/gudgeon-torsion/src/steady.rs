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
    /// Its tree, linearised about the mean torques, with the derivatives of the drive torques by the speed as damping.
    pub tree: Tree,
    /// What excites it.
    pub excitation: Excitation,
    /// Mean speed of the reference shaft \[rad/s\].
    pub speed: f64,
    /// Mean torques in the links \[N m\].
    pub mean_torque: Vec<f64>,
    /// Mean angles of the nodes against what balances \[rad\].
    pub mean_angle: Vec<f64>,
    /// Mean torque \[N m\] that holds the speed, at the reference shaft.
    pub balance_torque: f64,
    /// How often the negative pivots of the line were counted: passes through its tree that look for natural frequencies.
    pub pivot_counts: u64,
    /// Shares of the nodes in that torque, by node.
    balance: Vec<f64>,
    /// What excites it at any speed: see [`Excitation::parts`].
    pub(crate) parts: [Excitation; 2],
    /// Damping against the ground without that of the drives, by position.
    drag: Vec<f64>,
    varying: bool,
    /// Whether all links are the same at any mean torque and frequency: the tree keeps what it was built with.
    constant: bool,
    /// Room for the pivots of a count.
    pub(crate) pivots: Vec<f64>,
    work: Work,
    scratch: [Vec<Complex>; 3],
    mean_scratch: [Vec<f64>; 3],
}

/// Damping of the drives: the negative derivatives of their torques by the speed at the mean speed, by position.
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
    /// As [`Tree::new`]; shares of the balance that are not of this line.
    pub fn new(ctx: &TorsionCtx<'_>) -> Result<Self, BuildError> {
        let line = ctx.line.clone();
        let tree = Tree::new(&line)?;
        let n = tree.len();
        let sum: f64 = ctx.balance.iter().sum();
        if ctx.balance.len() > n || (sum - 1.0).abs() > 1e-9 || ctx.balance.iter().any(|s| !s.is_finite()) {
            return Err(BuildError::at(
                "balance",
                "the shares of the torque that balances do not add up to 1",
            ));
        }
        let mut balance = ctx.balance.to_vec();
        balance.resize(n, 0.0);
        let z = vec![Complex::default(); n];
        let mut steady = Self {
            varying: line.links.iter().any(|l| l.coupling.depends_on_frequency()),
            constant: line
                .links
                .iter()
                .all(|l| !l.coupling.depends_on_frequency() && !l.coupling.depends_on_load()),
            excitation: Excitation::default(),
            speed: ctx.speed,
            mean_torque: Vec::new(),
            mean_angle: Vec::new(),
            balance_torque: 0.0,
            pivot_counts: 0,
            balance,
            parts: Excitation::parts(&line, ctx.orders),
            drag: tree.damping.clone(),
            pivots: vec![0.0; n],
            work: Work::new(n),
            scratch: [z.clone(), z.clone(), z],
            mean_scratch: [vec![0.0; n], vec![0.0; n], vec![0.0; n]],
            tree,
            line,
        };
        steady.set_speed(ctx.speed);
        Ok(steady)
    }

    /// Goes to another mean speed \[rad/s\].
    pub fn set_speed(&mut self, speed: f64) {
        self.excitation.orders_of_parts(&self.parts, speed);
        self.stand_at(speed);
    }

    /// Takes the mean state and the tree of another mean speed \[rad/s\], but not its excitation: what natural frequencies depend on.
    pub(crate) fn stand_at(&mut self, speed: f64) {
        self.speed = speed;
        self.excitation.mean_of_parts(&self.parts, &self.line, speed);
        self.linearise();
    }

    /// Leaves the torque of the moving masses out of the excitation, and gives it every multiple of `base` up to the harmonic `count`,
    /// also where nothing excites it.
    pub(crate) fn whole_orders_without_masses(&mut self, base: f64, count: usize) {
        let n = self.line.nodes.len();
        let [fixed, masses] = &mut self.parts;
        masses.orders = (1..=count)
            .map(|k| Order { order: k as f64 * base, torque: vec![Complex::default(); n] })
            .collect();
        let old = std::mem::replace(&mut fixed.orders, masses.orders.clone());
        for o in old {
            let k = (o.order / base).round() as usize;
            if (1..=count).contains(&k) {
                fixed.orders[k - 1].torque = o.torque;
            }
        }
        self.set_speed(self.speed);
    }

    /// The mean state under the means of the excitation, and the tree about it.
    fn linearise(&mut self) {
        if !self.constant {
            self.tree.linearise(&self.line, 0.0, &[]);
        }
        self.tree.damping.clone_from(&self.drag);
        let mean = std::mem::take(&mut self.excitation.mean);
        self.take_mean(&mean);
        self.excitation.mean = mean;
        if !self.constant {
            self.tree.linearise(&self.line, 0.0, &self.mean_torque);
        }
        drive_damping(&self.line, &mut self.tree, self.speed);
    }

    /// The mean state under mean torques by node; the tree stays as it is: mean torques in the links, angles against the mean of the nodes that
    /// balance (against the ground where several places are held) and the torque that balances at the reference shaft.
    pub(crate) fn take_mean(&mut self, mean: &[f64]) {
        let (line, tree, balance) = (&self.line, &self.tree, &self.balance);
        let n = tree.len();
        let [f, twist, phi] = &mut self.mean_scratch;
        f.clear();
        f.extend((0..n).map(|p| mean[tree.node[p]] * tree.ratio[p]));
        let total: f64 = f.iter().sum();
        let held = tree.ground.iter().filter(|g| **g != 0.0).count();
        self.balance_torque = if held > 0 { 0.0 } else { -total };
        if held > 1
            && let Some((torque, angle)) = held_state(line, tree, f)
        {
            (self.mean_torque, self.mean_angle) = (torque, angle);
            return;
        }
        // A line that is held at one place takes up the rest there.
        match tree.ground.iter().position(|g| *g != 0.0) {
            Some(g) => f[g] -= total,
            None => (0..n).for_each(|p| f[p] -= total * balance[tree.node[p]]),
        }
        self.mean_torque.resize(line.links.len(), 0.0);
        for p in 0..n {
            let q = tree.parent[p];
            if q < n {
                f[q] += f[p];
                let s = if tree.forward[p] { 1.0 } else { -1.0 };
                let physical = s * f[p] / tree.link_ratio[p];
                self.mean_torque[tree.link[p]] = physical;
                // φ_child - φ_parent.
                let coupling = &line.links[tree.link[p]].coupling;
                twist[p] = s * coupling.static_twist(physical) / tree.link_ratio[p];
            }
        }
        phi.fill(0.0);
        for p in (0..n).rev() {
            if tree.parent[p] < n {
                phi[p] = phi[tree.parent[p]] + twist[p];
            }
        }
        let zero: f64 = (0..n).map(|p| balance[tree.node[p]] * phi[p]).sum();
        self.mean_angle.resize(n, 0.0);
        for p in 0..n {
            self.mean_angle[tree.node[p]] = (phi[p] - zero) * tree.ratio[p];
        }
    }

    /// Takes the stiffness of the links at angular frequency `omega` \[rad/s\].
    pub(crate) fn at_frequency(&mut self, omega: f64) {
        if self.varying {
            self.tree.linearise(&self.line, omega, &self.mean_torque);
        }
    }

    /// Whether the stiffness of a link depends on the frequency.
    pub(crate) const fn depends_on_frequency(&self) -> bool {
        self.varying
    }

    /// Response to torques of one order (phasors by node).
    ///
    /// # Errors
    /// An undamped resonance (Fatal).
    pub fn respond(&mut self, o: &Order) -> Result<OrderResponse, EvalError> {
        let omega = o.order * self.speed;
        self.at_frequency(omega);
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
                if t.k[p].is_finite() && kappa.im != 0.0 {
                    let twist = q[p] / kappa;
                    r.heat[l] = 0.5 * omega * kappa.im * (twist.re * twist.re + twist.im * twist.im);
                }
            }
        }
        Ok(r)
    }
}

/// Mean torques in the links and mean angles of a line that is held at several places: couplings as the tree has them. None when a part is not held at all.
fn held_state(line: &Line, tree: &Tree, f: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
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
    Some((torque, angle))
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
