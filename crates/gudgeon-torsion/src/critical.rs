//! Natural frequencies about the mean torque of a speed, and the speeds at which an order meets one.

use gudgeon_core::EvalError;

use crate::bracket::{Bracket, Look};
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
            let (mut low, mut high) = (self.look_at(0.0), self.look_at(guess));
            // Stiffer with the frequency, mostly: look further up.
            for _ in 0..DOUBLINGS {
                if high.count > rigid + k {
                    break;
                }
                (low, high) = (high, self.look_at(2.0 * high.at));
            }
            let mut bracket = Bracket::new(low, high);
            while !bracket.is_closed() {
                let look = self.look_at(bracket.trial());
                bracket = bracket.with(usize::from(look.count > rigid + k), look);
            }
            found.push(bracket.ends[1].at);
        }
        Ok(found)
    }

    /// Natural frequencies below `omega` with the stiffness that links have there.
    fn look_at(&mut self, omega: f64) -> Look {
        self.at_frequency(omega);
        self.pivot_counts += 1;
        let (count, pivot) = self.tree.count_and_pivot(omega * omega, &mut self.pivots);
        Look { at: omega, count, pivot }
    }

    /// All speeds from `from` to `to` \[rad/s\] at which one of `orders` meets a natural frequency; ascending. `grid` is the number of
    /// intervals at whose ends the stiffness of a line that depends on the speed is evaluated.
    ///
    /// Counts of negative pivots at both ends of an interval give the number of natural frequencies that the order passes in it; the pivot of
    /// the root says where about, and further counts place them to rounding. An order that passes a frequency forth and back within one interval is not seen.
    pub fn critical_speeds(&mut self, orders: &[f64], from: f64, to: f64, grid: usize) -> Vec<CriticalSpeed> {
        let speed = self.speed;
        let steps = if self.depends_on_speed() { grid.max(2) } else { 1 };
        let mut found = Vec::new();
        for &order in orders {
            let at = |i: usize| from + (to - from) * i as f64 / steps as f64;
            let mut open = Vec::new();
            let mut last = self.look_by_order(order, at(0));
            for i in 1..=steps {
                let next = self.look_by_order(order, at(i));
                open.push(Bracket::new(last, next));
                last = next;
            }
            self.narrow(order, open, &mut found);
        }
        found.sort_unstable_by(|a, b| {
            a.speed.total_cmp(&b.speed).then(a.order.total_cmp(&b.order)).then(a.mode.cmp(&b.mode))
        });
        for c in &mut found {
            if self.depends_on_speed() {
                self.stand_at(c.speed);
            }
            self.at_frequency(c.omega);
            let shape = shapes(&self.tree, &[c.omega]);
            c.damping_ratio = 0.5 * modal_damping(&self.tree, c.omega, &shape[0]) / c.omega;
        }
        self.set_speed(speed);
        found
    }

    /// Natural frequencies below the frequency of an order at a speed, with the stiffness that holds there.
    fn look_by_order(&mut self, order: f64, speed: f64) -> Look {
        if self.depends_on_speed() {
            self.stand_at(speed);
        }
        Look { at: speed, ..self.look_at(order * speed) }
    }

    /// Narrows intervals down to the speeds at which the count changes.
    fn narrow(&mut self, order: f64, mut open: Vec<Bracket>, found: &mut Vec<CriticalSpeed>) {
        let rigid = rigid_modes(&self.tree);
        while let Some(bracket) = open.pop() {
            let [a, b] = bracket.ends;
            if a.count == b.count {
                continue;
            }
            if bracket.is_closed() {
                let (low, high) = (a.count.min(b.count).max(rigid), a.count.max(b.count));
                found.extend((low..high).map(|k| CriticalSpeed {
                    speed: b.at,
                    order,
                    mode: k + 1 - rigid,
                    omega: order * b.at,
                    damping_ratio: 0.0,
                }));
                continue;
            }
            let look = self.look_by_order(order, bracket.trial());
            open.extend([1, 0].map(|end| bracket.with(end, look)));
        }
    }
}
