//! A block of components of the solution: their past and the step that is tried.

use super::blocks::{Block, Norm, Sum, WIDTH, ZERO, add};
use super::history::{DIFFERENCES, Formula};

/// What is known of the components of one block beside their values and rates, which the right-hand side wants without gaps.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Lane {
    /// Modified divided differences of orders 0 to `MAX_ORDER + 1`.
    phi: [Block; DIFFERENCES],
    /// Rates that belong to the point of the step, and the distance of that point from the predicted one.
    rates: Block,
    correction: Block,
    /// Absolute and relative error that is admitted, and one over their sum.
    pub atol: Block,
    pub rtol: Block,
    per_error: Block,
}

impl Lane {
    pub const fn new() -> Self {
        Self {
            phi: [ZERO; DIFFERENCES],
            rates: ZERO,
            correction: ZERO,
            atol: [1.0; WIDTH],
            rtol: ZERO,
            per_error: ZERO,
        }
    }

    /// A past of one point, with its rates.
    pub fn begin(&mut self, x: &[f64], f: &[f64], h: f64) {
        self.phi[0][..x.len()].copy_from_slice(x);
        self.phi[1].iter_mut().zip(f).for_each(|(d, f)| *d = h * f);
    }

    /// The end of the step as the past foretells it, where the step then stands; sets what its errors are divided by.
    #[inline]
    pub fn predict(&mut self, f: &Formula) -> Block {
        let start = &self.phi[0];
        let (mut x, mut rates) = (*start, ZERO);
        // The polynomial begins with a constant.
        for (d, (b, g)) in self.phi.iter().zip(f.weights()).skip(1) {
            add(&mut x, b, d);
            add(&mut rates, g, d);
        }
        for i in 0..WIDTH {
            let (a, b) = (start[i].abs(), x[i].abs());
            self.per_error[i] = 1.0 / (self.atol[i] + self.rtol[i] * if a > b { a } else { b });
        }
        (self.rates, self.correction) = (rates, ZERO);
        x
    }

    /// The residual of the equation from the rates that the right-hand side gives.
    #[inline]
    pub fn residual(&self, f: &mut Block) {
        for i in 0..WIDTH {
            f[i] = self.rates[i] - f[i];
        }
    }

    /// Goes back from `x` by `step`, which `norm` and `sum` take.
    #[inline]
    pub fn go(&mut self, x: &mut Block, step: &Block, lead: f64, norm: &mut Norm, sum: &mut Sum) {
        add(x, -1.0, step);
        add(&mut self.correction, -1.0, step);
        add(&mut self.rates, -lead, step);
        norm.add(step, &self.per_error);
        sum.add(step);
    }

    /// The correction, and what it would be at the order below.
    #[inline]
    pub fn errors(&self, f: &Formula, own: &mut Norm, below: &mut Norm) {
        own.add(&self.correction, &self.per_error);
        below.add(&self.correction_below(f), &self.per_error);
    }

    /// What the correction would be two orders below.
    #[inline]
    pub fn error_two_below(&self, f: &Formula, norm: &mut Norm) {
        let mut v = self.correction_below(f);
        add(&mut v, f.beta[f.order - 1], &self.phi[f.order - 1]);
        norm.add(&v, &self.per_error);
    }

    #[inline]
    fn correction_below(&self, f: &Formula) -> Block {
        let mut v = self.correction;
        add(&mut v, f.beta[f.order], &self.phi[f.order]);
        v
    }

    /// The difference of one order more than the step, where the steps before were as long.
    #[inline]
    pub fn error_above(&self, f: &Formula, norm: &mut Norm) {
        let mut v = self.correction;
        add(&mut v, -1.0, &self.phi[f.order + 1]);
        norm.add(&v, &self.per_error);
    }

    /// Takes the step to `x`.
    #[inline]
    pub fn take(&mut self, f: &Formula, x: &Block) {
        let k = f.order;
        let mut above = self.correction;
        self.phi[k + 1] = above;
        for (d, beta) in self.phi.iter_mut().zip(&f.beta).take(k + 1).skip(1).rev() {
            add(&mut above, *beta, d);
            *d = above;
        }
        self.phi[0] = *x;
    }

    /// A sum of differences.
    pub fn sum(&self, weights: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        for (w, d) in weights.iter().zip(&self.phi) {
            x.iter_mut().zip(d).for_each(|(x, d)| *x += w * d);
        }
    }
}
