//! Natural frequencies about the mean torque of a speed, and the speeds at which an order meets one.
//!
//! They are the undamped ones, but for a line of which a part hangs on damping alone: the ring of a viscous damper, a fluid coupling. Without
//! damping such a part does not take part in the motion, and with it resonance stands between the frequencies with the part free and with the part
//! locked. There the frequencies with damping count, `ω = Im z` of `det(K + z C + z² J) = 0`, and the damping ratio is `-Re z/|z|`. For one
//! inertia `J` on a spring `k` and a ring `J_d` on a damper `c` that is the complex root of
//!
//! ```text
//! J J_d z³ + c (J + J_d) z² + k J_d z + k c = 0
//! ```
//!
//! between `√(k/J)` (no damper) and `√(k/(J + J_d))` (ring locked). At the optimum of Den Hartog (1956) the amplitude has its maximum at
//! `√(k/(J + J_d/2))`, half of the ring counted as usual in practice; the root is within 2 % of that for rings up to `J_d = J`. A mode that does
//! not oscillate any more has the frequency zero.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::Complex;
use gudgeon_numerics::roots::itp;

use crate::bracket::{Bracket, Look};
use crate::eigen::{damped_eigenvalues, modal_damping, natural_frequencies, rigid_modes, shapes};
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
/// Most repetitions until a law over the frequency stands at the frequency with damping. Each leaves half of the slope of `ln k` over `ln ω`, at
/// most 1 for the laws of catalogues.
const FREQUENCY_STEPS: usize = 60;
/// Part of the highest speed to which a critical speed is found that moves with the speed.
const ROUNDING: f64 = 1e-12;

fn ascending(found: &mut [CriticalSpeed]) {
    found.sort_unstable_by(|a, b| {
        a.speed.total_cmp(&b.speed).then(a.order.total_cmp(&b.order)).then(a.mode.cmp(&b.mode))
    });
}

impl Steady {
    /// Whether natural frequencies depend on the speed: by the mean torque of a coupling, which drives and drag change.
    #[must_use]
    pub fn depends_on_speed(&self) -> bool {
        self.line.links.iter().any(|l| l.coupling.depends_on_load())
            && (!self.line.drives.is_empty() || self.line.nodes.iter().any(|n| n.damping != 0.0))
    }

    /// Whether a part of the line hangs on damping alone, so that its frequencies are those with damping: see the module.
    #[must_use]
    pub fn hangs_on_damping(&self) -> bool {
        let t = &self.tree;
        (0..t.len()).any(|p| t.parent[p] < t.len() && t.k[p] == 0.0 && t.c[p] > 0.0)
    }

    /// Natural frequencies \[rad/s\] of the elastic modes at the speed it stands at, by mode, at most `max_modes` modes with the rigid ones:
    /// undamped and ascending, or with damping where a part of the line hangs on damping alone. A law over the frequency is taken at the
    /// natural frequency itself.
    ///
    /// # Errors
    /// No convergence (Fatal).
    pub fn frequencies(&mut self, max_modes: usize) -> Result<Vec<f64>, EvalError> {
        if self.hangs_on_damping() {
            return Ok(self.damped(max_modes)?.iter().map(|z| z.im).collect());
        }
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

    /// Eigenvalues of the elastic modes, by mode; of a mode that does not oscillate the slower real one.
    fn damped(&mut self, max_modes: usize) -> Result<Vec<Complex>, EvalError> {
        let mut found = self.damped_at(0.0, max_modes)?;
        if self.depends_on_frequency() {
            for k in 0..found.len() {
                for _ in 0..FREQUENCY_STEPS {
                    let omega = found[k].im;
                    found[k] = self.damped_at(omega, max_modes)?[k];
                    if (found[k].im - omega).abs() <= 1e-12 * omega {
                        break;
                    }
                }
            }
        }
        Ok(found)
    }

    /// The same with the stiffness that links have at `omega`.
    fn damped_at(&mut self, omega: f64, max_modes: usize) -> Result<Vec<Complex>, EvalError> {
        self.at_frequency(omega);
        // All modes: where one is found twice, all are corrected together.
        let undamped = natural_frequencies(&self.tree, self.tree.len())?;
        let all = damped_eigenvalues(&self.tree, &undamped, &shapes(&self.tree, &undamped))?;
        let elastic = all.into_iter().take(max_modes).skip(rigid_modes(&self.tree));
        Ok(elastic.map(Option::unwrap_or_default).collect())
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
    /// the root says where about, and further counts place them to rounding. An order that passes a frequency forth and back within one interval is not
    /// seen. Frequencies with damping are followed over the same intervals instead.
    ///
    /// # Errors
    /// No convergence of frequencies with damping (Fatal).
    pub fn critical_speeds(
        &mut self,
        orders: &[f64],
        from: f64,
        to: f64,
        grid: usize,
    ) -> Result<Vec<CriticalSpeed>, EvalError> {
        let speed = self.speed;
        if self.hangs_on_damping() {
            let found = self.damped_critical_speeds(orders, from, to, grid);
            self.set_speed(speed);
            return found;
        }
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
        ascending(&mut found);
        for c in &mut found {
            if self.depends_on_speed() {
                self.stand_at(c.speed);
            }
            self.at_frequency(c.omega);
            let shape = shapes(&self.tree, &[c.omega]);
            c.damping_ratio = 0.5 * modal_damping(&self.tree, c.omega, &shape[0]) / c.omega;
        }
        self.set_speed(speed);
        Ok(found)
    }

    /// Speeds at which orders meet the frequencies with damping.
    fn damped_critical_speeds(
        &mut self,
        orders: &[f64],
        from: f64,
        to: f64,
        grid: usize,
    ) -> Result<Vec<CriticalSpeed>, EvalError> {
        let moves = self.depends_on_speed();
        let steps = if moves { grid.max(2) } else { 1 };
        let speeds: Vec<f64> = (0..=steps).map(|i| from + (to - from) * i as f64 / steps as f64).collect();
        let mut known = Vec::with_capacity(speeds.len());
        for w in &speeds {
            known.push(self.damped_over_speed(*w)?);
        }
        let mut found = Vec::new();
        for &order in orders {
            for mode in 0..known[0].len() {
                let beyond = |i: usize| order * speeds[i] >= known[i][mode].im;
                for i in (0..steps).filter(|i| beyond(*i) != beyond(i + 1)) {
                    let mut z = known[i][mode];
                    if moves {
                        let off =
                            |w: f64| Ok::<_, EvalError>(order * w - self.damped_over_speed(w)?[mode].im);
                        let Ok(root) = itp(off, speeds[i], speeds[i + 1], ROUNDING * to) else { continue };
                        z = self.damped_over_speed(root.x)?[mode];
                    }
                    if z.im > 0.0 {
                        let damping_ratio = -z.re / z.abs();
                        let speed = z.im / order;
                        found.push(CriticalSpeed {
                            speed,
                            order,
                            mode: mode + 1,
                            omega: z.im,
                            damping_ratio,
                        });
                    }
                }
            }
        }
        ascending(&mut found);
        Ok(found)
    }

    fn damped_over_speed(&mut self, speed: f64) -> Result<Vec<Complex>, EvalError> {
        self.stand_at(speed);
        self.damped(self.tree.len())
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
