//! Past values of a solution as modified divided differences, and the formulas that follow from their spacing.

use super::blocks::{Block, WIDTH, add};

/// Highest order.
pub(super) const MAX_ORDER: usize = 5;
const DIFFERENCES: usize = MAX_ORDER + 2;
/// Failures of one step after which the past is not believed any more. At a kink the error falls by little more than the step does, at any order, so some failures are
/// usual there; an order that was given up for them takes several steps to come back, and at tight tolerances many.
const MISLED: u32 = 10;

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
    /// Differences of orders 0 to `MAX_ORDER + 1`, all of one block together.
    phi: Vec<[Block; DIFFERENCES]>,
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
            phi: vec![[[0.0; WIDTH]; DIFFERENCES]; m.div_ceil(WIDTH)],
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

    /// The state where a step begins.
    pub fn start(&self) -> impl Iterator<Item = &Block> {
        self.phi.iter().map(|d| &d[0])
    }

    /// Begins a step from `x`, at which the rates `f` are known where nothing else is.
    pub fn begin(&mut self, x: &[f64], f: &[f64], h: f64) {
        if self.new {
            self.psi[0] = h;
            for ((d, x), f) in self.phi.iter_mut().zip(x.chunks(WIDTH)).zip(f.chunks(WIDTH)) {
                d[0][..x.len()].copy_from_slice(x);
                d[1].iter_mut().zip(f).for_each(|(d, f)| *d = h * f);
            }
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
            f.beta[i] = f.beta[i - 1] * (reach / before);
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
    pub fn predict(&self, f: &Formula, x: &mut [Block], rates: &mut [Block]) {
        let weights: [(f64, f64); MAX_ORDER + 1] =
            std::array::from_fn(|j| (f.beta[j], f.gamma[j] * f.beta[j]));
        for ((x, rate), d) in x.iter_mut().zip(rates).zip(&self.phi) {
            // The polynomial begins with a constant.
            let mut at = (d[0], [0.0; WIDTH]);
            for (d, (b, g)) in d.iter().zip(&weights).take(f.order + 1).skip(1) {
                add(&mut at.0, *b, d);
                add(&mut at.1, *g, d);
            }
            (*x, *rate) = at;
        }
    }

    /// Adds the difference of order `j`, as the step has it.
    pub fn add_difference(&self, f: &Formula, j: usize, v: &mut [Block]) {
        v.iter_mut().zip(&self.phi).for_each(|(v, d)| add(v, f.beta[j], &d[j]));
    }

    /// The difference of one order more than the step, where steps were steady enough to know it: all it is made of have one size, but for the oldest.
    pub fn above(&self, f: &Formula, correction: &[Block], v: &mut [Block]) -> bool {
        let k = f.order;
        if k >= f.steady || k == self.last + 1 {
            return false;
        }
        for ((v, e), d) in v.iter_mut().zip(correction).zip(&self.phi) {
            *v = *e;
            add(v, -1.0, &d[k + 1]);
        }
        true
    }

    /// Takes the step to `x` with its correction; the next is of order `next`.
    pub fn take(&mut self, f: &Formula, x: &[Block], correction: &[Block], h: f64, next: usize) {
        let k = f.order;
        for ((d, x), e) in self.phi.iter_mut().zip(x).zip(correction) {
            d[k + 1] = *e;
            let mut above = *e;
            for (d, beta) in d.iter_mut().zip(&f.beta).take(k + 1).skip(1).rev() {
                add(&mut above, *beta, d);
                *d = above;
            }
            d[0] = *x;
        }
        (self.psi, self.steady, self.last, self.size) = (f.psi, f.steady, k, h);
        self.starting &= next > k;
        (self.order, self.new, self.failures) = (next, false, 0);
    }

    /// The step failed, of which `best` would have been the order: that of the next trial.
    pub fn failed(&mut self, best: usize) -> usize {
        self.failures += 1;
        self.starting = false;
        self.order = if self.failures < MISLED { best } else { 1 };
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
        for (x, d) in x.chunks_mut(WIDTH).zip(&self.phi) {
            for (w, d) in weights[..=self.last].iter().zip(d) {
                x.iter_mut().zip(d).for_each(|(x, d)| *x += w * d);
            }
        }
    }
}
