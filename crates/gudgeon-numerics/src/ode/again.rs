//! Steps of a cycle that the next one takes again, near the periodic state: hardly one of them is rejected, and cycles differ by their starts alone, not by where steps
//! fell. A search then sees a tenth of the noise, and a slow mode, which multiplies that, sooner.

/// How many times as many steps as were chosen are taken again: where a part of the machine flutters each cycle divides others.
const MOST: f64 = 1.1;
/// Largest distance from the start for which steps were chosen, over what counts as one between cycles, from which they are taken again.
const NEAR: f64 = 0.05;

/// The steps of the last cycle, and what they were chosen for.
#[derive(Debug, Default)]
pub struct Again {
    /// Ends of its steps, those apart that an event cut off: it happens at another instant in the next cycle, and the step after it is sought from there.
    ends: Vec<f64>,
    start: Vec<f64>,
    /// How many there were when they were chosen.
    chosen: usize,
    /// Accuracy; zero where no steps were chosen yet.
    rtol: f64,
    /// Whether the last cycle took the steps of the one before.
    repeats: bool,
}

impl Again {
    /// Part of its accuracy by which a cycle in the steps of the one before differs from it, measured on packs and pistons.
    pub const NOISE: f64 = 0.1;

    /// Begins a cycle of accuracy `rtol` at `y`: the ends of its steps for [`super::Options::ends`], or none where these are to be as long as their errors allow. `away` tells
    /// how far `y` is from the start of the cycle for which steps were chosen, over what counts as one between cycles.
    pub fn begin(&mut self, y: &[f64], rtol: f64, away: impl FnOnce(&[f64]) -> f64) -> Vec<f64> {
        let serves = self.serves(rtol, away);
        if !self.repeats {
            self.chosen = self.ends.len();
        }
        self.repeats = serves;
        let ends = std::mem::take(&mut self.ends);
        if self.repeats {
            return ends;
        }
        (self.start, self.rtol) = (y.to_vec(), rtol);
        Vec::new()
    }

    /// Whether a cycle of accuracy `rtol` would take the steps of the last one again; `away` as for [`Self::begin`].
    pub fn serves(&self, rtol: f64, away: impl FnOnce(&[f64]) -> f64) -> bool {
        let chosen = if self.repeats { self.chosen } else { self.ends.len() };
        self.rtol == rtol && self.ends.len() as f64 <= MOST * chosen as f64 && away(&self.start) <= NEAR
    }

    /// A step ends at `t`.
    pub fn step(&mut self, t: f64) {
        self.ends.push(t);
    }

    /// An event happens at `t`, which cuts off the step that ends there.
    pub fn cut_off(&mut self, t: f64) {
        self.ends.pop_if(|end| *end == t);
    }

    /// How much of its accuracy the last cycle may differ by from one that began next to it: [`Self::NOISE`] in the steps of the one before, all of it in others.
    #[must_use]
    pub const fn noise(&self) -> f64 {
        if self.repeats { Self::NOISE } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cycle of `steps` steps from `y`; how many of them were taken again.
    fn cycle(again: &mut Again, y: f64, steps: usize) -> usize {
        let away = |start: &[f64]| (start.first().map_or(f64::INFINITY, |s| s - y)).abs();
        let (serves, ends) = (again.serves(1e-3, away), again.begin(&[y], 1e-3, away));
        assert_eq!(serves, !ends.is_empty());
        (0..steps).for_each(|k| again.step(k as f64));
        ends.len()
    }

    #[test]
    fn steps_serve_near_their_start_until_a_tenth_are_added() {
        let mut again = Again::default();
        let taken = [(1.0, 100), (1.04, 104), (1.02, 111), (1.0, 100), (1.06, 100), (1.1, 90)]
            .map(|(y, steps)| cycle(&mut again, y, steps));
        // The first has none before it; the fourth follows one with more than a tenth more steps than were chosen; the fifth begins farther than a twentieth away.
        assert_eq!(taken, [0, 100, 104, 0, 0, 100]);
    }
}
