//! Places of natural frequencies between counts of negative pivots.

/// What one pass through the tree says of a frequency.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Look {
    /// Where: the frequency, or a speed by which it goes.
    pub at: f64,
    /// Natural frequencies below.
    pub count: usize,
    /// Pivot of the root, which passes zero at every natural frequency that moves the root.
    pub pivot: f64,
}

/// Trials of which the last halves the interval, whatever the pivots say.
const TRIALS: u32 = 5;

/// An interval in which the count changes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bracket {
    pub ends: [Look; 2],
    trials: u32,
    /// End that the last trial replaced.
    replaced: Option<usize>,
}

impl Bracket {
    pub fn new(low: Look, high: Look) -> Self {
        Self { ends: [low, high], trials: 0, replaced: None }
    }

    /// Whether no number is left between the ends that tells them apart by more than rounding.
    pub fn is_closed(&self) -> bool {
        let [low, high] = self.ends.map(|l| l.at);
        let middle = 0.5 * (low + high);
        middle <= low || middle >= high || high - low <= 4.0 * f64::EPSILON * high
    }

    /// Where to look next: where a straight line between the pivots passes zero, if one natural frequency lies between the ends and
    /// the signs say that the root moves with it; every fifth time, and else, in the middle.
    ///
    /// The counts decide what becomes of the interval, so a pole of the pivot costs a trial and no more.
    pub fn trial(&self) -> f64 {
        let [low, high] = self.ends;
        let middle = 0.5 * (low.at + high.at);
        let one = low.count.abs_diff(high.count) == 1 && low.pivot * high.pivot < 0.0;
        if !one || self.trials % TRIALS == TRIALS - 1 {
            return middle;
        }
        let zero = low.at + (high.at - low.at) * (low.pivot / (low.pivot - high.pivot));
        let least = 2.0 * f64::EPSILON * high.at;
        let inside = zero.max(low.at + least).min(high.at - least);
        if inside > low.at && inside < high.at { inside } else { middle }
    }

    /// The interval with one end replaced. Of an end that stays a second time the pivot counts half (the Illinois rule), or straight lines
    /// would leave it where it is.
    pub fn with(mut self, end: usize, look: Look) -> Self {
        if self.replaced == Some(end) {
            self.ends[1 - end].pivot *= 0.5;
        }
        self.ends[end] = look;
        self.replaced = Some(end);
        self.trials += 1;
        self
    }
}
