//! When a simplified Newton method has converged, and when its Jacobian has served its time.

use crate::elementary;

/// Corrections a step at most.
const ITERATIONS: u32 = 4;
/// Part of the tolerance of a step that is left for its equation.
const LEFT: f64 = 0.1;
/// Contraction above which the method is given up, and above which the next step has a new Jacobian.
const DIVERGES: f64 = 0.9;
const SLOW: f64 = 0.4;
/// Steps that a Jacobian serves at most.
const OLDEST: u32 = 12;
/// Sum of the corrections to come over the last one, where nothing is known of it.
const UNKNOWN: f64 = 100.0;

/// The iteration of one step, and what is known from the steps before.
#[derive(Debug, Clone)]
pub(super) struct Newton {
    iterations: u32,
    first: f64,
    /// Sum of the corrections to come over the last one.
    rest: f64,
    /// Steps since the Jacobian was new; none: there is no usable one.
    age: Option<u32>,
    /// Leading coefficient with which it is factored.
    lead: f64,
}

impl Default for Newton {
    fn default() -> Self {
        Self { iterations: 0, first: 0.0, rest: UNKNOWN, age: None, lead: 0.0 }
    }
}

impl Newton {
    pub const fn forget(&mut self) {
        self.age = None;
    }

    /// Whether the Jacobian has to be evaluated; it then counts as new.
    pub const fn wants_jacobian(&mut self) -> bool {
        let wants = self.age.is_none();
        if wants {
            (self.age, self.rest) = (Some(0), UNKNOWN);
        }
        wants
    }

    /// Whether the matrix has to be factored for the leading coefficient.
    #[expect(clippy::float_cmp, reason = "steps of one size have copies of one number")]
    pub fn wants_factors(&mut self, lead: f64, fresh: bool) -> bool {
        let wants = fresh || lead != self.lead;
        self.lead = lead;
        wants
    }

    pub const fn begin(&mut self) {
        self.iterations = 0;
    }

    /// Whether the iteration has converged, or never will, after a correction of a norm; `None`: once more.
    pub fn judge(&mut self, change: f64) -> Option<bool> {
        self.iterations += 1;
        if self.iterations == 1 {
            self.first = change;
        } else {
            let all = change / self.first;
            let rate = if self.iterations == 2 {
                all
            } else {
                elementary::powf(all, 1.0 / f64::from(self.iterations - 1))
            };
            if rate.is_nan() || rate > DIVERGES {
                return self.failed();
            }
            self.rest = rate / (1.0 - rate);
            if rate > SLOW {
                self.age = self.age.map(|age| age.max(OLDEST));
            }
        }
        if change == 0.0 || self.rest * change <= LEFT {
            return Some(true);
        }
        if self.iterations < ITERATIONS && change.is_finite() { None } else { self.failed() }
    }

    const fn failed(&mut self) -> Option<bool> {
        self.age = None;
        Some(false)
    }

    /// A step was taken.
    pub fn age(&mut self) {
        self.age = self.age.map(|age| age + 1).filter(|age| *age < OLDEST);
    }
}
