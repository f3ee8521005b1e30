//! The spacing of the last points, and the formulas that follow from it.

/// Highest order.
pub(super) const MAX_ORDER: usize = 5;
pub(super) const DIFFERENCES: usize = MAX_ORDER + 2;
/// Fixed leading coefficient `Σ 1/j` of every order.
const LEAD: [f64; MAX_ORDER + 1] = [0.0, 1.0, 3.0 / 2.0, 11.0 / 6.0, 25.0 / 12.0, 137.0 / 60.0];
/// Failures of one step after which the past is not believed any more. At a kink the error falls by little more than the step does, at any order, so some failures are
/// usual there; an order that was given up for them takes several steps to come back, and at tight tolerances many.
const MISLED: u32 = 10;

/// Coefficients of one step, in the notation of Brenan, Campbell and Petzold (1996), chapter 5.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Formula {
    pub order: usize,
    /// Size of the step.
    h: f64,
    /// Fixed leading coefficient.
    pub lead: f64,
    /// Error of the step over the correction.
    pub error: f64,
    /// Error terms of every order over the difference of that order.
    pub sigma: [f64; MAX_ORDER + 1],
    pub beta: [f64; MAX_ORDER + 1],
    /// Derivative of the predictor over the differences.
    gamma: [f64; MAX_ORDER + 1],
    psi: [f64; DIFFERENCES],
    /// Steps of this size and order so far.
    steady: usize,
}

impl Formula {
    /// What every difference counts in the predicted value and in its derivative.
    #[inline]
    pub fn weights(&self) -> impl Iterator<Item = (f64, f64)> {
        let both = self.beta.iter().zip(&self.gamma).take(self.order + 1);
        both.map(|(beta, gamma)| (*beta, gamma * beta))
    }

    /// Whether the order above can be judged: the steps that say so have one size, but for the oldest.
    pub const fn is_steady(&self) -> bool {
        self.steady > self.order
    }
}

/// The last points.
#[derive(Debug, Clone)]
pub(super) struct History {
    /// Their distances from the newest, cumulated.
    psi: [f64; DIFFERENCES],
    /// Order of the coming step; order and size of the last one.
    order: usize,
    last: usize,
    size: f64,
    steady: usize,
    /// Whether no step was taken yet, and whether order and step still only grow.
    new: bool,
    starting: bool,
    failures: u32,
}

impl History {
    pub const fn new() -> Self {
        Self {
            psi: [0.0; DIFFERENCES],
            order: 1,
            last: 0,
            size: 0.0,
            steady: 0,
            new: true,
            starting: true,
            failures: 0,
        }
    }

    pub const fn is_new(&self) -> bool {
        self.new
    }

    /// Whether order and step only grew so far.
    pub const fn is_starting(&self) -> bool {
        self.starting
    }

    /// Makes `f`, the formula of the last trial, that of a step of size `h`.
    #[expect(clippy::float_cmp, reason = "steps of one size are copies of one number")]
    pub fn formulate(&self, h: f64, f: &mut Formula) {
        let k = self.order;
        let same = h == self.size && k == self.last;
        // Of equidistant points, which were so before.
        let known = same && self.steady > k && (f.h, f.order) == (h, k);
        if !known {
            self.space(h, f);
        }
        f.steady = if same { (self.steady + 1).min(k + 2) } else { 1 };
    }

    fn space(&self, h: f64, f: &mut Formula) {
        let k = self.order;
        (f.order, f.h, f.lead, f.psi) = (k, h, LEAD[k], self.psi);
        if self.new {
            f.psi[0] = h;
        }
        (f.beta[0], f.sigma[0], f.gamma[0]) = (1.0, 1.0, 0.0);
        let (per_step, mut reach, mut alpha, mut sum) = (1.0 / h, h, 1.0, 0.0);
        for i in 1..=k {
            let before = std::mem::replace(&mut f.psi[i - 1], reach);
            f.beta[i] = f.beta[i - 1] * (reach / before);
            reach = before + h;
            f.gamma[i] = f.gamma[i - 1] + alpha * per_step;
            sum += alpha;
            alpha = h / reach;
            f.sigma[i] = i as f64 * f.sigma[i - 1] * alpha;
        }
        f.psi[k] = reach;
        f.error = (alpha - f.lead + sum).abs().max(alpha);
    }

    /// The step of the formula was taken; the next is of order `next`.
    pub fn take(&mut self, f: &Formula, next: usize) {
        let k = f.order;
        (self.psi, self.steady, self.last, self.size) = (f.psi, f.steady, k, f.h);
        self.starting &= next > k;
        (self.order, self.new, self.failures) = (next, false, 0);
    }

    /// The step failed, of which `best` would have been the order: that of the next trial.
    pub const fn failed(&mut self, best: usize) -> usize {
        self.failures += 1;
        self.starting = false;
        self.order = if self.failures < MISLED { best } else { 1 };
        self.order
    }

    /// Weights of the differences in the solution at `back` (zero or less) from the newest point, on the polynomial through the last values, and their number.
    pub fn weights(&self, back: f64) -> ([f64; MAX_ORDER + 1], usize) {
        let mut weights = [0.0; MAX_ORDER + 1];
        (weights[0], weights[1]) = (1.0, back / self.psi[0]);
        for j in 2..=self.last {
            weights[j] = weights[j - 1] * (back + self.psi[j - 2]) / self.psi[j - 1];
        }
        (weights, self.last + 1)
    }
}
