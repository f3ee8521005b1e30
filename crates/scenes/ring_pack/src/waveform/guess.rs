//! States in a stage, guessed from the stages before.

use gudgeon_core::states::Stage;

/// Longest extrapolation, over the distance of the two instants.
const FARTHEST: f64 = 5.0;

/// States at a stage.
#[derive(Debug, Clone, Default)]
struct Seen {
    t: f64,
    /// Their rates, and they themselves over what drives them.
    rates: Vec<f64>,
    shares: Vec<f64>,
}

/// Guesses from the last two instants: a state follows from its rates, which change as they did, or it goes with what drives it, as the gas of a small space does with the
/// pressure in the cylinder that a wide passage joins to it. That one counts which was nearer at the stage before.
#[derive(Debug, Clone, Default)]
pub struct Guess {
    /// The stages of the last step that was taken, and of the present one.
    before: [Seen; 2],
    now: [Seen; 2],
    guesses: Vec<[f64; 2]>,
    /// Which guess of a state was nearer.
    nearer: Vec<usize>,
    drive: Option<f64>,
}

impl Guess {
    /// Guesses the states in a stage at `t` that are driven by `drive`, of which no state changes its sign; where nothing drives them, `y` comes as the other guess.
    pub fn apply(&mut self, t: f64, stage: &Stage<'_>, drive: Option<f64>, y: &mut [f64]) {
        let t0 = t - stage.step;
        if stage.number == 1 && (t0 - self.now[1].t).abs() < (t0 - self.before[1].t).abs() {
            std::mem::swap(&mut self.before, &mut self.now);
        }
        self.drive = drive;
        self.guesses.clear();
        let [a, b] = match stage.number {
            1 => [&self.before[0], &self.before[1]],
            _ => [&self.before[1], &self.now[0]],
        };
        let x = (t - b.t) / (b.t - a.t);
        if a.rates.is_empty() || b.rates.is_empty() || !(0.0..FARTHEST).contains(&x) {
            return;
        }
        let on = |a: &[f64], b: &[f64], j: usize| b[j] + x * (b[j] - a[j]);
        self.guesses.extend(y.iter().zip(stage.base).enumerate().map(|(j, (y, base))| {
            let other = drive.map_or(*y, |d| d * on(&a.shares, &b.shares, j));
            [base + stage.step * on(&a.rates, &b.rates, j), other]
        }));
        self.nearer.resize(y.len(), 0);
        for ((y, guesses), nearer) in y.iter_mut().zip(&self.guesses).zip(&self.nearer) {
            if drive.is_none() || guesses[*nearer] * *y > 0.0 {
                *y = guesses[*nearer];
            }
        }
    }

    /// A stage led to `y`.
    pub fn learn(&mut self, t: f64, stage: &Stage<'_>, y: &[f64]) {
        for ((nearer, [rates, other]), y) in self.nearer.iter_mut().zip(&self.guesses).zip(y) {
            *nearer = usize::from((other - y).abs() < (rates - y).abs());
        }
        let now = &mut self.now[stage.number - 1];
        now.t = t;
        now.rates.clear();
        now.rates.extend(y.iter().zip(stage.base).map(|(y, b)| (y - b) / stage.step));
        now.shares.clear();
        now.shares.extend(y.iter().map(|y| y / self.drive.unwrap_or(1.0)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Solves stages of a step of 0.1 from `t0`; how far the guess of the last one was off.
    fn step(guess: &mut Guess, t0: f64, p: impl Fn(f64) -> f64, y: impl Fn(f64) -> f64) -> f64 {
        let mut off = f64::NAN;
        for (number, x) in [(1, 0.3), (2, 1.0)] {
            let (t, step) = (t0 + 0.1 * x, 0.03);
            // The base that leads from the rate `y'` to the state.
            let rate = (y(t + 1e-5) - y(t - 1e-5)) / 2e-5;
            let base = [y(t) - step * rate];
            let stage = Stage {
                number,
                base: &base,
                step: if number == 1 { t - t0 } else { step },
                accuracy: &[1.0],
            };
            let base = [y(t) - stage.step * rate];
            let stage = Stage { base: &base, ..stage };
            let mut guessed = [y(t0)];
            guess.apply(t, &stage, Some(p(t)), &mut guessed);
            off = guessed[0] - y(t);
            guess.learn(t, &stage, &[y(t)]);
        }
        off
    }

    #[test]
    fn a_state_with_a_smooth_rate_follows_it() {
        let mut guess = Guess::default();
        let offs =
            [0.0, 0.1, 0.2].map(|t| step(&mut guess, t, |t| 1.0 + (40.0 * t).sin().abs(), |t| 2.0 + t * t));
        // The rate is a line, known to the error of its difference.
        assert!(offs[2].abs() < 1e-8, "{offs:?}");
    }

    #[test]
    fn a_state_that_goes_with_the_cylinder_follows_that() {
        let p = |t: f64| 1.0 + (40.0 * t).sin().powi(2);
        let mut guess = Guess::default();
        let offs = [0.0, 0.1, 0.2].map(|t| step(&mut guess, t, p, |t| 3.0 * p(t)));
        // Three times the pressure, but for rounding.
        assert!(offs[2].abs() < 1e-14, "{offs:?}");
    }
}
