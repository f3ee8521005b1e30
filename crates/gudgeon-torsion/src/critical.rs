//! Natural frequencies about the mean torque of a speed, and the speeds at which an order meets one.

use gudgeon_core::EvalError;

use crate::eigen::{modal_damping, natural_frequencies, rigid_modes, shapes};
use crate::steady::Steady;

/// A speed at which an order excites a mode at its natural frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CriticalSpeed {
    /// Speed of the reference shaft \[rad/s\].
    pub speed: f64,
    /// The order.
    pub order: f64,
    /// Number of the mode, 1 for the lowest elastic one.
    pub mode: usize,
    /// Its angular frequency \[rad/s\].
    pub omega: f64,
    /// Its damping ratio.
    pub damping_ratio: f64,
}

/// Halvings of an interval that place a frequency to rounding.
const BISECTIONS: usize = 60;
/// Doublings of a guess until it lies above the frequency.
const DOUBLINGS: usize = 40;

impl Steady {
    /// Whether natural frequencies depend on the speed: by the mean torque of a coupling, which drives and drag change.
    #[must_use]
    pub fn depends_on_speed(&self) -> bool {
        self.line.links.iter().any(|l| l.coupling.depends_on_load())
            && (!self.line.drives.is_empty() || self.line.nodes.iter().any(|n| n.damping != 0.0))
    }

    /// Undamped natural frequencies \[rad/s\] of the elastic modes at the speed it stands at, ascending, at most `max_modes` modes with the
    /// rigid ones. A law over the frequency is taken at the natural frequency itself.
    ///
    /// # Errors
    /// No convergence (Fatal).
    pub fn frequencies(&mut self, max_modes: usize) -> Result<Vec<f64>, EvalError> {
        self.at_frequency(0.0);
        let first = natural_frequencies(&self.tree, max_modes)?;
        let rigid = rigid_modes(&self.tree);
        let elastic = first.iter().skip(rigid);
        if !self.line.links.iter().any(|l| l.coupling.depends_on_frequency()) {
            return Ok(elastic.copied().collect());
        }
        let guesses: Vec<f64> = elastic.copied().collect();
        let mut found = Vec::with_capacity(guesses.len());
        for (k, guess) in guesses.into_iter().enumerate() {
            let below = |s: &mut Self, w: f64| s.count_at(w) <= rigid + k;
            let (mut low, mut high) = (0.0, guess);
            // Stiffer with the frequency, mostly: look further up.
            for _ in 0..DOUBLINGS {
                if !below(self, high) {
                    break;
                }
                (low, high) = (high, 2.0 * high);
            }
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (low + high);
                if below(self, middle) { low = middle } else { high = middle }
            }
            found.push(high);
        }
        Ok(found)
    }

    /// Number of natural frequencies below `omega` with the stiffness that links have there.
    fn count_at(&mut self, omega: f64) -> usize {
        self.at_frequency(omega);
        self.pivot_counts += 1;
        let mut work = vec![0.0; self.tree.len()];
        self.tree.count_below(omega * omega, &mut work)
    }

    /// All speeds from `from` to `to` \[rad/s\] at which one of `orders` meets a natural frequency; ascending. `grid` is the number of
    /// intervals at whose ends the stiffness of a line that depends on the speed is evaluated.
    ///
    /// Counts of negative pivots at both ends of an interval give the number of natural frequencies that the order passes in it; bisection
    /// places them to rounding. An order that passes a frequency forth and back within one interval is not seen.
    pub fn critical_speeds(&mut self, orders: &[f64], from: f64, to: f64, grid: usize) -> Vec<CriticalSpeed> {
        let speed = self.speed;
        let steps = if self.depends_on_speed() { grid.max(2) } else { 1 };
        let mut found = Vec::new();
        for &order in orders {
            let at = |i: usize| from + (to - from) * i as f64 / steps as f64;
            let mut open: Vec<[(f64, usize); 2]> = Vec::new();
            let mut last = (at(0), self.count_by_order(order, at(0)));
            for i in 1..=steps {
                let next = (at(i), self.count_by_order(order, at(i)));
                open.push([last, next]);
                last = next;
            }
            self.bisect(order, open, &mut found);
        }
        found.sort_unstable_by(|a, b| {
            a.speed.total_cmp(&b.speed).then(a.order.total_cmp(&b.order)).then(a.mode.cmp(&b.mode))
        });
        for c in &mut found {
            if self.depends_on_speed() {
                self.set_speed(c.speed);
            }
            self.at_frequency(c.omega);
            let shape = shapes(&self.tree, &[c.omega]);
            c.damping_ratio = 0.5 * modal_damping(&self.tree, c.omega, &shape[0]) / c.omega;
        }
        self.set_speed(speed);
        found
    }

    /// Number of natural frequencies below the frequency of an order at a speed, with the stiffness that holds there.
    fn count_by_order(&mut self, order: f64, speed: f64) -> usize {
        if self.depends_on_speed() {
            self.set_speed(speed);
        }
        self.count_at(order * speed)
    }

    /// Halves intervals, each given by speeds and counts at its ends, down to the speeds at which the count changes.
    fn bisect(&mut self, order: f64, mut open: Vec<[(f64, usize); 2]>, found: &mut Vec<CriticalSpeed>) {
        let rigid = rigid_modes(&self.tree);
        while let Some([a, b]) = open.pop() {
            if a.1 == b.1 {
                continue;
            }
            let middle = 0.5 * (a.0 + b.0);
            if middle <= a.0 || middle >= b.0 || b.0 - a.0 <= 4.0 * f64::EPSILON * b.0 {
                let (low, high) = (a.1.min(b.1).max(rigid), a.1.max(b.1));
                found.extend((low..high).map(|k| CriticalSpeed {
                    speed: b.0,
                    order,
                    mode: k + 1 - rigid,
                    omega: order * b.0,
                    damping_ratio: 0.0,
                }));
                continue;
            }
            let m = (middle, self.count_by_order(order, middle));
            open.push([a, m]);
            open.push([m, b]);
        }
    }
}
