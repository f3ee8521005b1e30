//! Stages of a cycle guessed by the cycle before: where its steps are taken again each begins with the rates that it had then, elsewhere rates change as they did then.

use gudgeon_core::states::Stage;

/// Rates at the stages of a cycle, by their instants.
#[derive(Debug, Clone, Default)]
struct Rates {
    t: Vec<f64>,
    /// One after the other, as many as there are states.
    rates: Vec<f64>,
}

impl Rates {
    fn clear(&mut self) {
        self.t.clear();
        self.rates.clear();
    }

    /// Moves `next` to the first stage that is not before `t`.
    fn find(&self, next: &mut usize, t: f64) {
        // A step that is tried again in parts goes back.
        while *next > 0 && self.t[*next - 1] >= t {
            *next -= 1;
        }
        while self.t.get(*next).is_some_and(|known| *known < t) {
            *next += 1;
        }
    }

    /// Each of the `n` rates at an instant, on the straight line between the stages `next - 1` and `next`; none before the first stage and behind the last.
    fn line(&self, next: usize, t: f64, n: usize) -> Option<impl Fn(usize) -> f64> {
        let before = next.checked_sub(1)?;
        let (from, to) = (*self.t.get(before)?, *self.t.get(next)?);
        let x = (t - from) / (to - from);
        let [a, b] = [before, next].map(|k| &self.rates[k * n..][..n]);
        Some(move |j: usize| a[j] + x * (b[j] - a[j]))
    }
}

/// What the cycle before tells of the stages of the present one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Serves {
    /// Nothing.
    #[default]
    Nothing,
    /// Their rates: the steps are the same.
    Rates,
    /// How rates change.
    Trend,
}

/// Rates at the stages of the cycle before, and of the present one.
#[derive(Debug, Clone, Default)]
pub struct Repeat {
    before: Rates,
    now: Rates,
    serves: Serves,
    /// The stage of the cycle before that comes next, and that which came next at the stage before.
    next: usize,
    last: usize,
}

impl Repeat {
    /// A cycle begins.
    pub fn begin(&mut self, serves: Serves) {
        std::mem::swap(&mut self.before, &mut self.now);
        self.now.clear();
        (self.serves, self.next, self.last) = (serves, 0, 0);
    }

    /// Guesses the states of a stage at `t`, if the cycle before tells of it.
    pub fn apply(&mut self, t: f64, stage: &Stage<'_>, y: &mut [f64]) {
        match self.serves {
            Serves::Nothing => {}
            Serves::Rates => self.again(t, stage, y),
            Serves::Trend => self.along(t, stage, y),
        }
    }

    /// The rates of the same stage.
    fn again(&mut self, t: f64, stage: &Stage<'_>, y: &mut [f64]) {
        self.before.find(&mut self.next, t);
        if self.before.t.get(self.next) == Some(&t) {
            let rates = &self.before.rates[self.next * y.len()..];
            y.iter_mut().zip(stage.base).zip(rates).for_each(|((y, b), k)| *y = b + stage.step * k);
        }
    }

    /// The rates of the stage before, changed as those of the cycle before did from its instant to this one.
    fn along(&mut self, t: f64, stage: &Stage<'_>, y: &mut [f64]) {
        let n = y.len();
        let Some(now) = self.now.t.iter().rposition(|known| *known < t) else { return };
        let (last, seen) = (self.now.t[now], &self.now.rates[now * n..][..n]);
        self.before.find(&mut self.last, last);
        self.before.find(&mut self.next, t);
        let (from, to) = (self.before.line(self.last, last, n), self.before.line(self.next, t, n));
        if let (Some(from), Some(to)) = (from, to) {
            for (j, (y, base)) in y.iter_mut().zip(stage.base).enumerate() {
                *y = base + stage.step * (seen[j] + to(j) - from(j));
            }
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
        repeat.begin(Serves::Rates);
        let mut at = |t: f64| {
            let mut y = [0.0];
            repeat.apply(t, &stage(&[10.0]), &mut y);
            y[0]
        };
        // The states of then less their base, from the new base; nothing where no stage was, and none of the refused step.
        assert_eq!([at(0.5), at(1.0), at(0.75), at(2.0), at(0.5)], [11.0, 13.0, 0.0, 0.0, 11.0]);
    }

    #[test]
    fn rates_change_as_they_did() {
        // Rates that are a line between stages, and half of it more in the next cycle.
        let rate = |t: f64| 3.0 + 2.0 * t;
        let led = |t: f64, more: f64| [1.0 + 0.5 * (rate(t) + more)];
        let mut repeat = Repeat::default();
        for t in [0.25, 0.75, 1.25, 1.75] {
            repeat.learn(t, &stage(&[1.0]), &led(t, 0.0));
        }
        repeat.begin(Serves::Trend);
        let mut at = |t: f64, repeat: &mut Repeat| {
            let mut y = [f64::NAN];
            repeat.apply(t, &stage(&[1.0]), &mut y);
            repeat.learn(t, &stage(&[1.0]), &led(t, 0.5));
            y[0]
        };
        // Nothing is known before the first stage; then all but rounding, of a step that is refused and of its parts too.
        assert!(at(0.5, &mut repeat).is_nan());
        for t in [1.0, 1.5, 1.0, 1.25, 1.7] {
            assert!((at(t, &mut repeat) - led(t, 0.5)[0]).abs() < 1e-15, "{t}");
        }
        // Nor behind the last.
        assert!(at(1.8, &mut repeat).is_nan());
    }
}
