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
    groups: Vec<Group>,
}

/// Neighbouring orders that are solved side by side; lanes that are left over repeat the last one.
#[derive(Debug)]
struct Group {
    order: Lane,
    /// Torques by position: those that do not depend on the speed, and those of the moving masses at unit speed.
    parts: [Vec<[Lane; 2]>; 2],
    /// Their sum at the speed of the line, and the answer to it.
    torque: Vec<[Lane; 2]>,
    omega: Lane,
    sweep: Sweep,
}

/// The orders of a line by groups of [`LANES`].
fn groups(steady: &Steady) -> Vec<Group> {
    let [fixed, _] = &steady.parts;
    let n = steady.tree.len();
    let of = |first: usize| {
        let last = (first + LANES).min(fixed.orders.len()) - 1;
        let of_lane = |l: usize| (first + l).min(last);
        let torques = |part: &Excitation| {
            let at = |node: usize, l: usize| part.orders[of_lane(l)].torque[node];
            let lanes = |node: &usize| {
                [std::array::from_fn(|l| at(*node, l).re), std::array::from_fn(|l| at(*node, l).im)]
            };
            steady.tree.node.iter().map(lanes).collect()
        };
        Group {
            order: std::array::from_fn(|l| fixed.orders[of_lane(l)].order),
            parts: steady.parts.each_ref().map(torques),
            torque: vec![[[0.0; LANES]; 2]; n],
            omega: [0.0; LANES],
            sweep: Sweep::new(n),
        }
    };
    (0..fixed.orders.len()).step_by(LANES).map(of).collect()
}

impl IndependentOrders {
    /// # Errors
    /// As [`Steady::new`].
    pub fn new(ctx: &TorsionCtx<'_>) -> Result<Self, BuildError> {
        let steady = Steady::new(ctx)?;
        Ok(Self { groups: groups(&steady), steady })
    }

    /// Response to all orders.
    fn respond(&mut self, out: &mut OrderResponses) -> Result<(), EvalError> {
        if self.steady.depends_on_frequency() {
            *out = self.one_by_one()?.as_slice().into();
            return Ok(());
        }
        let orders = self.steady.parts[0].orders.iter().map(|o| o.order);
        out.reset(orders, self.steady.tree.len(), self.steady.line.links.len());
        let Self { steady, groups } = self;
        widest(Excite { groups, steady, out });
        for g in groups.iter_mut() {
            let (tree, torque) = (&steady.tree, &g.torque);
            if g.sweep.solve_lanes(tree, &g.omega, |p| scaled(&torque[p], tree.ratio[p])).is_err() {
                // The elimination of one order says it in its own words.
                self.one_by_one()?;
                return Err(EvalError::fatal("torsion", "an undamped resonance is hit"));
            }
        }
        widest(Answer { groups, steady, out });
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
}

/// Torques of all orders at the speed of a line, by group and among the answers.
struct Excite<'e> {
    groups: &'e mut [Group],
    steady: &'e Steady,
    out: &'e mut OrderResponses,
}

impl Vectorised for Excite<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { groups, steady, out } = self;
        let square = steady.speed * steady.speed;
        for g in groups.iter_mut() {
            for l in 0..LANES {
                g.omega[l] = g.order[l] * steady.speed;
            }
        }
        for (p, node) in steady.tree.node.iter().enumerate() {
            for g in groups.iter_mut() {
                let (own, fixed, masses) = (&mut g.torque[p], &g.parts[0][p], &g.parts[1][p]);
                // Into numbers of their own first: places in three lists may be the same for all that the compiler knows.
                let mut sum = [[0.0; LANES]; 2];
                for l in 0..LANES {
                    sum[0][l] = fixed[0][l] + masses[0][l] * square;
                    sum[1][l] = fixed[1][l] + masses[1][l] * square;
                }
                *own = sum;
            }
            let [re, im] = out.excitation_mut(*node);
            write(re, groups, 1.0, |g| &g.torque[p][0]);
            write(im, groups, 1.0, |g| &g.torque[p][1]);
        }
    }
}

/// Takes the answers of the sweeps.
struct Answer<'s> {
    groups: &'s [Group],
    steady: &'s Steady,
    out: &'s mut OrderResponses,
}

impl Vectorised for Answer<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { groups, steady, out } = self;
        let t = &steady.tree;
        let n = t.len();
        for p in 0..n {
            let [re, im] = out.angle_mut(t.node[p]);
            write(re, groups, t.ratio[p], |g| &g.sweep.angle[p][0]);
            write(im, groups, t.ratio[p], |g| &g.sweep.angle[p][1]);
            if t.parent[p] >= n {
                continue;
            }
            let s = if t.forward[p] { 1.0 } else { -1.0 } / t.link_ratio[p];
            let [re, im] = out.torque_mut(t.link[p]);
            write(re, groups, s, |g| &g.sweep.transmitted[p][0]);
            write(im, groups, s, |g| &g.sweep.transmitted[p][1]);
            let (whole, rest) = out.heat_mut(t.link[p]).as_chunks_mut::<LANES>();
            for (own, g) in whole.iter_mut().zip(groups) {
                *own = heat(steady, p, &g.sweep.transmitted[p], &g.omega);
            }
            if let Some(g) = groups.get(whole.len()) {
                rest.copy_from_slice(&heat(steady, p, &g.sweep.transmitted[p], &g.omega)[..rest.len()]);
            }
        }
    }
}

/// Writes what the groups have, times a factor, into a row of all orders.
#[inline(always)]
fn write<'g>(row: &mut [f64], groups: &'g [Group], by: f64, of: impl Fn(&'g Group) -> &'g Lane) {
    let (whole, rest) = row.as_chunks_mut::<LANES>();
    for (own, g) in whole.iter_mut().zip(groups) {
        let lanes = of(g);
        let mut scaled = [0.0; LANES];
        for l in 0..LANES {
            scaled[l] = by * lanes[l];
        }
        *own = scaled;
    }
    // Lanes of the last group that are left over have no place.
    if let Some(g) = groups.get(whole.len()) {
        for (own, x) in rest.iter_mut().zip(of(g)) {
            *own = by * x;
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
            // At most speeds they are there already, and to compare few names takes less than to hash one.
            match out.counters.iter_mut().find(|(known, _)| *known == name) {
                Some((_, own)) => *own = n,
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
