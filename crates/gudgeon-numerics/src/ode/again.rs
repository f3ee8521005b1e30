//! Steps of a cycle that the next one takes again, near the periodic state: hardly one of them is rejected, and cycles differ by their starts alone, not by where steps
//! fell. A search then sees a tenth of the noise, and a slow mode, which multiplies that, sooner.

/// How many times as many steps as were chosen are taken again: where a part of the machine flutters each cycle divides others.
const MOST: f64 = 1.1;

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
    /// Begins a cycle of accuracy `rtol` at `y`: the ends of its steps for [`super::Options::ends`], or none where these are to be as long as their errors allow. `near` says
    /// whether `y` is as near to the start of the cycle for which steps were chosen as their taking again asks for.
    pub fn begin(&mut self, y: &[f64], rtol: f64, near: impl FnOnce(&[f64]) -> bool) -> Vec<f64> {
        if !self.repeats {
            self.chosen = self.ends.len();
        }
        self.repeats =
            self.rtol == rtol && self.ends.len() as f64 <= MOST * self.chosen as f64 && near(&self.start);
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

    /// Whether the last cycle took the steps of the one before.
    #[must_use]
    pub const fn repeats(&self) -> bool {
        self.repeats
    }
}
