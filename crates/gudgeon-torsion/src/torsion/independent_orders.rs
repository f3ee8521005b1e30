//! The linear response order by order: the running model of `orders`, and of `harmonic_balance` where nothing is nonlinear.

use gudgeon_core::kinds::{OrderResponse, Torsion, TorsionCtx, TorsionOut};
use gudgeon_core::{BuildError, EvalError};

use crate::forcing::Order;
use crate::steady::Steady;
use crate::sweep::{LANES, Lane, Sweep};

/// A line whose orders do not know of each other.
#[derive(Debug)]
pub(super) struct IndependentOrders {
    steady: Steady,
    sweep: Sweep,
    /// Torques by position and order.
    torque: Vec<[Lane; 2]>,
}

impl IndependentOrders {
    /// # Errors
    /// As [`Steady::new`].
    pub fn new(ctx: &TorsionCtx<'_>) -> Result<Self, BuildError> {
        let steady = Steady::new(ctx)?;
        let n = steady.tree.len();
        Ok(Self { steady, sweep: Sweep::new(n), torque: vec![[[0.0; LANES]; 2]; n] })
    }

    /// Response to some orders.
    fn respond(&mut self, orders: &[Order], out: &mut Vec<OrderResponse>) -> Result<(), EvalError> {
        if self.steady.depends_on_frequency() {
            *out = orders.iter().map(|o| self.steady.respond(o)).collect::<Result<_, _>>()?;
            return Ok(());
        }
        out.resize_with(orders.len(), OrderResponse::default);
        for (some, answers) in orders.chunks(LANES).zip(out.chunks_mut(LANES)) {
            self.respond_together(some, answers)?;
        }
        Ok(())
    }

    /// Response to at most as many orders as there are lanes, side by side.
    fn respond_together(&mut self, orders: &[Order], out: &mut [OrderResponse]) -> Result<(), EvalError> {
        let tree = &self.steady.tree;
        // Lanes that are left over repeat the last order.
        let of_lane = |l: usize| &orders[l.min(orders.len() - 1)];
        let omega: Lane = std::array::from_fn(|l| of_lane(l).order * self.steady.speed);
        for l in 0..LANES {
            let torque = &of_lane(l).torque;
            for ((row, node), ratio) in self.torque.iter_mut().zip(&tree.node).zip(&tree.ratio) {
                let t = torque[*node];
                (row[0][l], row[1][l]) = (ratio * t.re, ratio * t.im);
            }
        }
        let torque = &self.torque;
        if let Err((l, _)) = self.sweep.solve_lanes(tree, &omega, |p| torque[p]) {
            // The elimination of one order says it in its own words.
            self.steady.respond(of_lane(l))?;
            return Err(EvalError::fatal("torsion", "an undamped resonance is hit"));
        }
        self.take(orders, &omega, out);
        Ok(())
    }

    /// The answers of the lanes.
    fn take(&self, orders: &[Order], omega: &Lane, out: &mut [OrderResponse]) {
        let (t, links) = (&self.steady.tree, self.steady.line.links.len());
        let n = t.len();
        for (o, r) in orders.iter().zip(out.iter_mut()) {
            r.order = o.order;
            r.angle.resize(n, [0.0; 2]);
            r.torque.resize(links, [0.0; 2]);
            r.heat.resize(links, 0.0);
            r.excitation.clear();
            r.excitation.extend(o.torque.iter().map(|t| [t.re, t.im]));
        }
        for (p, (x, q)) in self.sweep.angle.iter().zip(&self.sweep.transmitted).enumerate() {
            let (node, s) = (t.node[p], t.ratio[p]);
            for (l, r) in out.iter_mut().enumerate().take(LANES) {
                r.angle[node] = [s * x[0][l], s * x[1][l]];
            }
            if t.parent[p] >= n {
                continue;
            }
            let (link, s) = (t.link[p], if t.forward[p] { 1.0 } else { -1.0 } / t.link_ratio[p]);
            let heat = self.heat(p, omega);
            for (l, r) in out.iter_mut().enumerate().take(LANES) {
                r.torque[link] = [s * q[0][l], s * q[1][l]];
                r.heat[link] = heat[l];
            }
        }
    }

    /// Mean power lost in the link of a node to its parent.
    fn heat(&self, p: usize, omega: &Lane) -> Lane {
        let (t, q) = (&self.steady.tree, &self.sweep.transmitted[p]);
        let stiffness = t.k[p];
        let mut heat = [0.0; LANES];
        if !stiffness.is_finite() {
            return heat;
        }
        for l in 0..LANES {
            let loss = stiffness * t.eta[p] + omega[l] * t.c[p];
            let square = q[0][l] * q[0][l] + q[1][l] * q[1][l];
            let lost = 0.5 * omega[l] * loss * square / (stiffness * stiffness + loss * loss);
            heat[l] = if loss != 0.0 { lost } else { 0.0 };
        }
        heat
    }
}

impl Torsion for IndependentOrders {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        let orders = std::mem::take(&mut self.steady.excitation.orders);
        let found = self.respond(&orders, &mut out.orders);
        self.steady.excitation.orders = orders;
        found?;
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("linear_solutions".into(), out.orders.len() as u64);
        self.steady.describe(out);
        Ok(())
    }
    fn set_speed(&mut self, speed: f64) -> Result<(), EvalError> {
        self.steady.set_speed(speed);
        Ok(())
    }
}
