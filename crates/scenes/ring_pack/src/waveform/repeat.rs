//! Stages of a cycle whose steps are those of the cycle before: each begins with the rates that it had then.

use gudgeon_core::states::Stage;

/// Rates at the stages of a cycle, by their instants.
#[derive(Debug, Clone, Default)]
struct Rates {
    t: Vec<f64>,
    /// One after the other, as many as there are states.
    rates: Vec<f64>,
}

/// Rates at the stages of the cycle before, and of the present one.
#[derive(Debug, Clone, Default)]
pub struct Repeat {
    before: Rates,
    now: Rates,
    /// The stage of the cycle before that comes next.
    next: usize,
}

impl Repeat {
    /// A cycle begins, which takes the steps of the cycle before `again` or steps of its own.
    pub fn begin(&mut self, again: bool) {
        std::mem::swap(&mut self.before, &mut self.now);
        if !again {
            self.before.t.clear();
        }
        self.now.t.clear();
        self.now.rates.clear();
        self.next = 0;
    }

    /// Guesses the states of a stage at `t`, if the cycle before had one there.
    pub fn apply(&mut self, t: f64, stage: &Stage<'_>, y: &mut [f64]) {
        let times = &self.before.t;
        // A step that is tried again in parts goes back.
        while self.next > 0 && times[self.next - 1] >= t {
            self.next -= 1;
        }
        while times.get(self.next).is_some_and(|known| *known < t) {
            self.next += 1;
        }
        if times.get(self.next) == Some(&t) {
            let rates = &self.before.rates[self.next * y.len()..];
            y.iter_mut().zip(stage.base).zip(rates).for_each(|((y, b), k)| *y = b + stage.step * k);
        }
    }

    /// A stage led to `y`.
    pub fn learn(&mut self, t: f64, stage: &Stage<'_>, y: &[f64]) {
        let Rates { t: times, rates } = &mut self.now;
        while times.last().is_some_and(|last| *last >= t) {
            times.pop();
        }
        rates.truncate(times.len() * y.len());
        times.push(t);
        rates.extend(y.iter().zip(stage.base).map(|(y, b)| (y - b) / stage.step));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stage(base: &[f64]) -> Stage<'_> {
        Stage { number: 1, base, step: 0.5, accuracy: &[1.0] }
    }

    #[test]
    fn a_stage_begins_with_the_rate_that_it_had() {
        let mut repeat = Repeat::default();
        // A step that was refused, then its parts.
        for (t, y) in [(1.0, 3.0), (2.0, 9.0), (0.5, 2.0), (1.0, 4.0)] {
            repeat.learn(t, &stage(&[1.0]), &[y]);
        }
        repeat.begin(true);
        let mut at = |t: f64| {
            let mut y = [0.0];
            repeat.apply(t, &stage(&[10.0]), &mut y);
            y[0]
        };
        // The states of then less their base, from the new base; nothing where no stage was, and none of the refused step.
        assert_eq!([at(0.5), at(1.0), at(0.75), at(2.0), at(0.5)], [11.0, 13.0, 0.0, 0.0, 11.0]);
    }
}
