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
        if !self.repeats {
            self.chosen = self.ends.len();
        }
        self.repeats = self.rtol == rtol
            && self.ends.len() as f64 <= MOST * self.chosen as f64
            && away(&self.start) <= NEAR;
        let ends = std::mem::take(&mut self.ends);
        if self.repeats {
            return ends;
        }
        (self.start, self.rtol) = (y.to_vec(), rtol);
        Vec::new()
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
