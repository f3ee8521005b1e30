//! Dense output of a step of the methods that share the step loop, made when somebody looks inside the step.

use std::cell::{Cell, Ref, RefCell};

use super::integrator::StepView;

/// What knows the coefficients of the dense output of the step that it tried last.
pub(crate) trait Interpolant {
    /// The coefficients `c0`, `c1`, `c2` of [`Dense`] for a step of size `h`, states first, then quadratures.
    fn coefficients(&self, h: f64, c: &mut [Vec<f64>; 3]);
}

/// Coefficients of one step, once they have been asked for.
#[derive(Default)]
pub(super) struct Coefficients {
    known: Cell<bool>,
    c: RefCell<[Vec<f64>; 3]>,
}

impl Coefficients {
    /// Another step follows.
    pub fn forget(&self) {
        self.known.set(false);
    }

    fn of(&self, source: &dyn Interpolant, h: f64) -> Ref<'_, [Vec<f64>; 3]> {
        if !self.known.replace(true) {
            source.coefficients(h, &mut self.c.borrow_mut());
        }
        self.c.borrow()
    }
}

/// `x(θ) = (1-θ) x0 + θ (x1 + (1-θ)(c0 + θ (c1 + θ c2)))`, states first, then quadratures.
#[derive(Clone, Copy)]
pub(super) struct Dense<'a> {
    pub t: f64,
    pub h: f64,
    pub x0: &'a [f64],
    pub x1: &'a [f64],
    pub coefficients: &'a Coefficients,
    pub source: &'a dyn Interpolant,
}

impl Dense<'_> {
    /// Components `from..from + out.len()` at time `t`.
    pub fn eval(&self, t: f64, from: usize, out: &mut [f64]) {
        let th = (t - self.t) / self.h;
        let om = 1.0 - th;
        let k = out.len();
        let r = from..from + k;
        let (x0, x1) = (&self.x0[r.clone()], &self.x1[r.clone()]);
        let c = self.coefficients.of(self.source, self.h);
        let (c0, c1, c2) = (&c[0][r.clone()], &c[1][r.clone()], &c[2][r]);
        for i in 0..k {
            // Written around x0 so that a constant stays that constant.
            out[i] = x0[i] + th * ((x1[i] - x0[i]) + om * (c0[i] + th * (c1[i] + th * c2[i])));
        }
    }
}

/// A step, or the piece of one between two events, as the observer sees it.
pub(super) struct Piece<'a> {
    n: usize,
    t: [f64; 2],
    x: [&'a [f64]; 2],
    dense: Dense<'a>,
}

impl<'a> Piece<'a> {
    /// From `(t0, x0)` to `(t1, x1)`, states (the first `n`) and quadratures together.
    pub fn new(n: usize, (t0, x0): (f64, &'a [f64]), (t1, x1): (f64, &'a [f64]), dense: Dense<'a>) -> Self {
        Self { n, t: [t0, t1], x: [x0, x1], dense }
    }
}

impl StepView for Piece<'_> {
    fn t0(&self) -> f64 {
        self.t[0]
    }
    fn t1(&self) -> f64 {
        self.t[1]
    }
    fn y0(&self) -> &[f64] {
        &self.x[0][..self.n]
    }
    fn y1(&self) -> &[f64] {
        &self.x[1][..self.n]
    }
    fn q0(&self) -> &[f64] {
        &self.x[0][self.n..]
    }
    fn q1(&self) -> &[f64] {
        &self.x[1][self.n..]
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        self.dense.eval(t, 0, y);
    }
    fn interpolate_quad(&self, t: f64, q: &mut [f64]) {
        self.dense.eval(t, self.n, q);
    }
}
