//! The linear response order by order: the running model of `orders`, and of `harmonic_balance` where nothing is nonlinear.

use gudgeon_core::kinds::{OrderResponse, OrderResponses, Torsion, TorsionCtx, TorsionOut};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::vectors::{Vectorised, widest};

use crate::forcing::Excitation;
use crate::steady::Steady;
use crate::sweep::{LANES, Lane, Sweep};

/// A line whose orders do not know of each other.
#[derive(Debug)]
pub(super) struct IndependentOrders {
    steady: Steady,
    sweep: Sweep,
    groups: Vec<Group>,
    /// Torques by position and order.
    torque: Vec<[Lane; 2]>,
}

/// Neighbouring orders that are solved side by side; lanes that are left over repeat the last one.
#[derive(Debug)]
struct Group {
    first: usize,
    count: usize,
    order: Lane,
    /// Torques by position: those that do not depend on the speed, and those of the moving masses at unit speed.
    parts: [Vec<[Lane; 2]>; 2],
}

/// The orders of a line by groups.
fn groups(steady: &Steady) -> Vec<Group> {
    let [fixed, _] = &steady.parts;
    let of = |first: usize| {
        let count = LANES.min(fixed.orders.len() - first);
        let of_lane = |l: usize| first + l.min(count - 1);
        let torques = |part: &Excitation| {
            let at = |node: usize, l: usize| part.orders[of_lane(l)].torque[node];
            let lanes = |node: &usize| {
                [std::array::from_fn(|l| at(*node, l).re), std::array::from_fn(|l| at(*node, l).im)]
            };
            steady.tree.node.iter().map(lanes).collect()
        };
        Group {
            first,
            count,
            order: std::array::from_fn(|l| fixed.orders[of_lane(l)].order),
            parts: steady.parts.each_ref().map(torques),
        }
    };
    (0..fixed.orders.len()).step_by(LANES).map(of).collect()
}

impl IndependentOrders {
    /// # Errors
    /// As [`Steady::new`].
    pub fn new(ctx: &TorsionCtx<'_>) -> Result<Self, BuildError> {
        let steady = Steady::new(ctx)?;
        let n = steady.tree.len();
        let groups = groups(&steady);
        Ok(Self { steady, sweep: Sweep::new(n), groups, torque: vec![[[0.0; LANES]; 2]; n] })
    }

    /// Response to all orders.
    fn respond(&mut self, out: &mut OrderResponses) -> Result<(), EvalError> {
        if self.steady.depends_on_frequency() {
            *out = self.one_by_one()?.as_slice().into();
            return Ok(());
        }
        let orders = self.steady.parts[0].orders.iter().map(|o| o.order);
        out.reset(orders, self.steady.tree.len(), self.steady.line.links.len());
        for g in 0..self.groups.len() {
            self.respond_together(g, out)?;
        }
        Ok(())
    }

    /// The careful elimination of one order after the other.
    fn one_by_one(&mut self) -> Result<Vec<OrderResponse>, EvalError> {
        self.steady.set_speed(self.steady.speed);
        let orders = std::mem::take(&mut self.steady.excitation.orders);
        let found = orders.iter().map(|o| self.steady.respond(o)).collect();
        self.steady.excitation.orders = orders;
        found
    }

    /// Response to a group of orders, side by side.
    fn respond_together(&mut self, g: usize, out: &mut OrderResponses) -> Result<(), EvalError> {
        let Self { steady, sweep, groups, torque } = self;
        let (tree, group) = (&steady.tree, &groups[g]);
        let omega: Lane = std::array::from_fn(|l| group.order[l] * steady.speed);
        widest(Excite { group, steady, torque, out });
        let at = |p: usize| scaled(&torque[p], tree.ratio[p]);
        if sweep.solve_lanes(tree, &omega, at).is_err() {
            // The elimination of one order says it in its own words.
            self.one_by_one()?;
            return Err(EvalError::fatal("torsion", "an undamped resonance is hit"));
        }
        widest(Answer { group, steady, sweep, omega: &omega, out });
        Ok(())
    }
}

/// Torques of a group at the speed of a line, by position and among the answers.
struct Excite<'e> {
    group: &'e Group,
    steady: &'e Steady,
    torque: &'e mut [[Lane; 2]],
    out: &'e mut OrderResponses,
}

impl Vectorised for Excite<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let square = self.steady.speed * self.steady.speed;
        let [fixed, masses] = &self.group.parts;
        for (p, node) in self.steady.tree.node.iter().enumerate() {
            let (own, fixed, masses) = (&mut self.torque[p], &fixed[p], &masses[p]);
            for l in 0..LANES {
                own[0][l] = fixed[0][l] + masses[0][l] * square;
            }
            for l in 0..LANES {
                own[1][l] = fixed[1][l] + masses[1][l] * square;
            }
            self.group.write(own, self.out.excitation_mut(*node));
        }
    }
}

/// Takes the answers of a sweep.
struct Answer<'s> {
    group: &'s Group,
    steady: &'s Steady,
    sweep: &'s Sweep,
    omega: &'s Lane,
    out: &'s mut OrderResponses,
}

impl Vectorised for Answer<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { group, steady, sweep, omega, out } = self;
        let t = &steady.tree;
        let n = t.len();
        for (p, (x, q)) in sweep.angle.iter().zip(&sweep.transmitted).enumerate() {
            group.write(&scaled(x, t.ratio[p]), out.angle_mut(t.node[p]));
            if t.parent[p] >= n {
                continue;
            }
            let s = if t.forward[p] { 1.0 } else { -1.0 } / t.link_ratio[p];
            group.write(&scaled(q, s), out.torque_mut(t.link[p]));
            group.write_row(&heat(steady, p, q, omega), out.heat_mut(t.link[p]));
        }
    }
}

impl Group {
    /// Writes the lanes of its orders into rows of all.
    #[inline(always)]
    fn write(&self, lanes: &[Lane; 2], [re, im]: [&mut [f64]; 2]) {
        self.write_row(&lanes[0], re);
        self.write_row(&lanes[1], im);
    }

    #[inline(always)]
    fn write_row(&self, lanes: &Lane, row: &mut [f64]) {
        let row = &mut row[self.first..][..self.count];
        match <&mut Lane>::try_from(&mut *row) {
            Ok(whole) => *whole = *lanes,
            Err(_) => row.copy_from_slice(&lanes[..self.count]),
        }
    }
}

#[inline(always)]
fn scaled(lanes: &[Lane; 2], by: f64) -> [Lane; 2] {
    let mut out = [[0.0; LANES]; 2];
    for l in 0..LANES {
        out[0][l] = by * lanes[0][l];
        out[1][l] = by * lanes[1][l];
    }
    out
}

/// Mean power lost in the link of a node to its parent, which transmits `q`.
#[inline(always)]
fn heat(steady: &Steady, p: usize, q: &[Lane; 2], omega: &Lane) -> Lane {
    let t = &steady.tree;
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

impl Torsion for IndependentOrders {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        self.respond(&mut out.orders)?;
        let counts = [("time_steps", 0), ("linear_solutions", out.orders.len() as u64)];
        for (name, n) in counts {
            // At most speeds they are there already.
            match out.counters.get_mut(name) {
                Some(own) => *own = n,
                None => drop(out.counters.insert(name.into(), n)),
            }
        }
        self.steady.describe(out);
        Ok(())
    }
    fn set_speed(&mut self, speed: f64) -> Result<(), EvalError> {
        // Its excitation is made up where the orders are solved.
        self.steady.stand_at(speed);
        Ok(())
    }
}
