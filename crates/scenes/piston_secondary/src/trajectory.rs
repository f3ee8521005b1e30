//! One cycle of the motion as its integrator found it: everything told of the cycle is read from here, so that nothing told depends on how
//! densely it is shown.

use gudgeon_numerics::ode::StepView;

use super::oil::OilCycle;

/// Nodes of a step, its ends among them. The dense output of every method used is a polynomial of degree four at most, which five nodes hold
/// exactly.
const NODES: usize = 5;
/// Weights of the integral over a step: exact for such a polynomial.
const BOOLE: [f64; NODES] = [7.0 / 90.0, 32.0 / 90.0, 12.0 / 90.0, 32.0 / 90.0, 7.0 / 90.0];

/// How a motion was found between the ends of its steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Between {
    /// By the polynomial of the method.
    Dense,
    /// Not at all: the method knows the ends of its steps alone.
    Nothing,
}

/// A cycle of coordinates, then of velocities where they are states or where the method found them.
#[derive(Debug, Clone)]
pub struct Trajectory {
    /// Oil of the skirt over it, when it keeps any.
    pub oil: Option<OilCycle>,
    /// What stands between the ends of steps.
    pub between: Between,
    states: usize,
    ends: Vec<f64>,
    /// State after state: the first one, then those of every step without its start.
    values: Vec<f64>,
}

impl Trajectory {
    /// An empty cycle of that many states.
    #[must_use]
    pub fn new(states: usize, between: Between) -> Self {
        Self { oil: None, between, states, ends: Vec::new(), values: Vec::new() }
    }

    /// Starts at `t` \[rad\] from `y`.
    pub fn start(&mut self, t: f64, y: &[f64]) {
        self.ends.clear();
        self.values.clear();
        self.ends.push(t);
        self.values.extend_from_slice(y);
    }

    /// Adds a step of a method with dense output.
    pub fn step(&mut self, view: &dyn StepView) {
        let (t0, t1) = (view.t0(), view.t1());
        for k in 1..NODES {
            let from = self.values.len();
            self.values.resize(from + self.states, 0.0);
            let y = &mut self.values[from..];
            if k + 1 == NODES {
                y.copy_from_slice(view.y1());
            } else {
                view.interpolate(t0 + (t1 - t0) * k as f64 / (NODES - 1) as f64, y);
            }
        }
        self.ends.push(t1);
    }

    /// Adds a step to `t` \[rad\] that ends in `y`.
    pub fn end(&mut self, t: f64, y: &[f64]) {
        self.values.extend_from_slice(y);
        self.ends.push(t);
    }

    /// A motion that stays at `y`, in steps between `ends`.
    #[must_use]
    pub fn still(ends: Vec<f64>, y: &[f64]) -> Self {
        let count = 1 + ends.len().saturating_sub(1) * (NODES - 1);
        Self { oil: None, between: Between::Dense, states: y.len(), ends, values: y.repeat(count) }
    }

    /// Ends of all steps \[rad\], the start of the first one among them.
    #[must_use]
    pub fn ends(&self) -> &[f64] {
        &self.ends
    }

    /// Nodes of a step beside its start.
    fn nodes(&self) -> usize {
        if self.between == Between::Dense { NODES - 1 } else { 1 }
    }

    /// The step that holds `t`.
    fn holds(&self, t: f64) -> usize {
        self.ends.partition_point(|e| *e < t).clamp(1, self.ends.len() - 1) - 1
    }

    /// The end of a step that stands at `t`, when one does.
    #[must_use]
    pub fn end_at(&self, t: f64) -> Option<usize> {
        let k = self.holds(t);
        [k, k + 1].into_iter().find(|k| (self.ends[*k] - t).abs() < 1e-12 * (1.0 + t.abs()))
    }

    /// State at the end `k`.
    #[must_use]
    pub fn at_end(&self, k: usize) -> &[f64] {
        &self.values[k * self.nodes() * self.states..][..self.states]
    }

    /// State `i` at `t`.
    #[must_use]
    pub fn state(&self, t: f64, i: usize) -> f64 {
        let k = self.holds(t);
        let (nodes, h) = (self.nodes(), self.ends[k + 1] - self.ends[k]);
        let s = ((t - self.ends[k]) / h).clamp(0.0, 1.0) * nodes as f64;
        let value = |j: usize| self.values[(k * nodes + j) * self.states + i];
        (0..=nodes)
            .map(|j| {
                let others = (0..=nodes).filter(|l| *l != j);
                others.map(|l| (s - l as f64) / (j as f64 - l as f64)).product::<f64>() * value(j)
            })
            .sum()
    }

    /// Change of state `i` per radian at `t`, seen within the step that holds it.
    #[must_use]
    pub fn slope(&self, t: f64, i: usize) -> f64 {
        let k = self.holds(t);
        let (a, b) = (self.ends[k], self.ends[k + 1]);
        let d = DIFFERENCE * (b - a);
        let (from, to) = ((t - d).max(a), (t + d).min(b));
        (self.state(to, i) - self.state(from, i)) / (to - from)
    }

    /// Mean of state `i` over the cycle.
    #[must_use]
    pub fn mean(&self, i: usize) -> f64 {
        let nodes = self.nodes();
        let mut sum = 0.0;
        for k in 0..self.ends.len() - 1 {
            let h = self.ends[k + 1] - self.ends[k];
            let value = |j: usize| self.values[(k * nodes + j) * self.states + i];
            sum += h * match self.between {
                Between::Dense => BOOLE.iter().enumerate().map(|(j, w)| w * value(j)).sum::<f64>(),
                Between::Nothing => 0.5 * (value(0) + value(1)),
            };
        }
        sum / (self.ends[self.ends.len() - 1] - self.ends[0])
    }
}

/// Part of a step over which a slope is seen: the cube of it, of the third derivative, is lost.
const DIFFERENCE: f64 = 1e-3;
