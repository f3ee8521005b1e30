//! Past values of a solution as modified divided differences, and the formulas that follow from their spacing.

use crate::ode::add_all;

/// Highest order.
pub(super) const MAX_ORDER: usize = 5;
const DIFFERENCES: usize = MAX_ORDER + 2;

/// Coefficients of one step, in the notation of Brenan, Campbell and Petzold (1996), chapter 5.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Formula {
    pub order: usize,
    /// Fixed leading coefficient `Σ 1/j`.
    pub lead: f64,
    /// Error of the step over the correction.
    pub error: f64,
    /// Error terms of every order over the difference of that order.
    pub sigma: [f64; MAX_ORDER + 1],
    beta: [f64; MAX_ORDER + 1],
    /// Derivative of the predictor over the differences.
    gamma: [f64; MAX_ORDER + 1],
    psi: [f64; DIFFERENCES],
    /// Steps of this size and order so far.
    steady: usize,
}

/// The last values.
#[derive(Debug, Clone)]
pub(super) struct History {
    /// Differences of orders 0 to `MAX_ORDER + 1`, one after the other, each as long as the state.
    phi: Vec<f64>,
    m: usize,
    /// Distances of the last points from the newest, cumulated.
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
    pub fn new(m: usize) -> Self {
        Self {
            phi: vec![0.0; DIFFERENCES * m],
            m,
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

    pub fn forget(&mut self) {
        (self.order, self.last, self.size, self.steady) = (1, 0, 0.0, 0);
        (self.new, self.starting, self.failures) = (true, true, 0);
    }

    pub const fn is_new(&self) -> bool {
        self.new
    }

    /// Whether order and step only grew so far.
    pub const fn is_starting(&self) -> bool {
        self.starting
    }

    fn difference(&self, j: usize) -> &[f64] {
        &self.phi[j * self.m..(j + 1) * self.m]
    }

    fn difference_mut(&mut self, j: usize) -> &mut [f64] {
        &mut self.phi[j * self.m..(j + 1) * self.m]
    }

    /// Begins a step from `x`, at which the rates `f` are known where nothing else is.
    pub fn begin(&mut self, x: &[f64], f: &[f64], h: f64) {
        self.difference_mut(0).copy_from_slice(x);
        if self.new {
            self.psi[0] = h;
            self.difference_mut(1).iter_mut().zip(f).for_each(|(d, f)| *d = h * f);
        }
    }

    /// The formula of a step of size `h`.
    #[expect(clippy::float_cmp, reason = "steps of one size are copies of one number")]
    pub fn formula(&self, h: f64) -> Formula {
        let k = self.order;
        let same = h == self.size && k == self.last;
        let steady = if same { (self.steady + 1).min(self.last + 2) } else { 1 };
        let mut f = Formula { order: k, psi: self.psi, steady, ..Formula::default() };
        let mut alpha = [0.0; MAX_ORDER + 1];
        (f.beta[0], f.sigma[0], alpha[0]) = (1.0, 1.0, 1.0);
        let mut reach = h;
        for i in 1..=k {
            let before = std::mem::replace(&mut f.psi[i - 1], reach);
            f.beta[i] = f.beta[i - 1] * reach / before;
            reach = before + h;
            alpha[i] = h / reach;
            f.sigma[i] = i as f64 * f.sigma[i - 1] * alpha[i];
            f.gamma[i] = f.gamma[i - 1] + alpha[i - 1] / h;
        }
        f.psi[k] = reach;
        f.lead = (1..=k).map(|j| 1.0 / j as f64).sum();
        let all: f64 = alpha[..k].iter().sum();
        f.error = (alpha[k] - f.lead + all).abs().max(alpha[k]);
        f
    }

    /// Value and rate that the past foretells for the end of the step.
    pub fn predict(&self, f: &Formula, x: &mut [f64], rates: &mut [f64]) {
        let count = f.order + 1;
        let mut of_rates = f.gamma;
        of_rates.iter_mut().zip(&f.beta).for_each(|(g, b)| *g *= b);
        x.fill(0.0);
        add_all(x, 1.0, &f.beta[..count], &self.phi);
        rates.fill(0.0);
        add_all(rates, 1.0, &of_rates[..count], &self.phi);
    }

    /// Adds the difference of order `j`, as the step has it.
    pub fn add_difference(&self, f: &Formula, j: usize, v: &mut [f64]) {
        v.iter_mut().zip(self.difference(j)).for_each(|(v, d)| *v += f.beta[j] * d);
    }

    /// The difference of one order more than the step, where steps were steady enough to know it.
    pub fn above(&self, f: &Formula, correction: &[f64], v: &mut [f64]) -> bool {
        let k = f.order;
        if k + 1 >= f.steady || k == self.last + 1 {
            return false;
        }
        for ((v, e), d) in v.iter_mut().zip(correction).zip(self.difference(k + 1)) {
            *v = e - d;
        }
        true
    }

    /// Takes the step with its correction; the next is of order `next`.
    pub fn take(&mut self, f: &Formula, correction: &[f64], h: f64, next: usize) {
        let (k, m) = (f.order, self.m);
        for (j, beta) in f.beta.iter().enumerate().take(k + 1).skip(1) {
            self.difference_mut(j).iter_mut().for_each(|d| *d *= beta);
        }
        if k < MAX_ORDER {
            self.difference_mut(k + 1).copy_from_slice(correction);
        }
        self.difference_mut(k).iter_mut().zip(correction).for_each(|(d, e)| *d += e);
        for j in (0..k).rev() {
            let (low, high) = self.phi.split_at_mut((j + 1) * m);
            low[j * m..].iter_mut().zip(&high[..m]).for_each(|(d, above)| *d += above);
        }
        (self.psi, self.steady, self.last, self.size) = (f.psi, f.steady, k, h);
        self.starting &= next > k;
        (self.order, self.new, self.failures) = (next, false, 0);
    }

    /// The step failed, of which `best` would have been the order: that of the next trial.
    pub fn failed(&mut self, best: usize) -> usize {
        self.failures += 1;
        self.starting = false;
        self.order = if self.failures < 3 { best } else { 1 };
        self.order
    }

    /// The solution at `back` (zero or less) from the newest point, on the polynomial through the last values.
    pub fn value(&self, back: f64, x: &mut [f64]) {
        let mut weights = [0.0; MAX_ORDER + 1];
        (weights[0], weights[1]) = (1.0, back / self.psi[0]);
        for j in 2..=self.last {
            weights[j] = weights[j - 1] * (back + self.psi[j - 2]) / self.psi[j - 1];
        }
        x.fill(0.0);
        add_all(x, 1.0, &weights[..=self.last], &self.phi);
    }
}
