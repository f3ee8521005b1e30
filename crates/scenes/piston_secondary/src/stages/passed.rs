//! A step that was taken, between its ends.

use gudgeon_numerics::ode::StepView;

/// The cubic through the start, the middle stage and the end of a step, with the rate at its end. That at its start takes no part: where a film was cut off it may
/// belong to a motion that has died out.
pub struct Passed {
    /// Its ends \[rad\].
    pub span: (f64, f64),
    /// Part of the step at which the middle stage stands.
    pub middle: f64,
    /// States at the start, at the middle stage and at the end, and the change over the whole step at the rate of its end.
    pub y: [Vec<f64>; 4],
}

impl StepView for Passed {
    fn t0(&self) -> f64 {
        self.span.0
    }
    fn t1(&self) -> f64 {
        self.span.1
    }
    fn y0(&self) -> &[f64] {
        &self.y[0]
    }
    fn y1(&self) -> &[f64] {
        &self.y[2]
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        // From the end backwards: s is 0 there and 1 at the start.
        let s = (self.span.1 - t) / (self.span.1 - self.span.0);
        let m = 1.0 - self.middle;
        for (k, y) in y.iter_mut().enumerate() {
            let [start, middle, end, rate] = [0, 1, 2, 3].map(|i: usize| self.y[i][k]);
            let (whole, part) = (start - end + rate, (middle - end + m * rate) / (m * m));
            *y = end - rate * s + s * s * (whole + (whole - part) / (1.0 - m) * (s - 1.0));
        }
    }
}
