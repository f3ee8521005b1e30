//! Backward differentiation formulas of orders 1 to 5, variable in step and order.

use crate::EvalError;
use crate::elementary;
use crate::linalg::dot;
use crate::ode::{
    ColumnGroups, Core, Flow, IntegrateError, Integrator, Interpolant, OdeSystem, Options, Scheme, Stats,
    StepMatrix, StepView, Trial, drive,
};

mod blocks;
mod history;
mod newton;

use blocks::{Block, WIDTH, add, norm, set, zeros};
use history::{Formula, History, MAX_ORDER};
use newton::Newton;

/// Backward differentiation formulas in fixed leading coefficient form, and the work arrays for systems of one size.
///
/// The polynomial through the last `k + 1` values predicts `y_p` and `y'_p` at the end of a step of size `h`; what is solved for is
///
/// ```text
/// y'_p + (s/h)(y - y_p) = f(t + h, y)      s = Σ_{j=1}^k 1/j
/// ```
///
/// by a simplified Newton method. The distance `y - y_p` tells the error at this order and those beside it, and the order that allows the longest step
/// is taken. Stable for stiff systems at orders 1 and 2, nearly so at 3 to 5.
///
/// Beside [`crate::rodas`] a step costs one or two right-hand sides and a back substitution each; the Jacobian is kept while Newton's method converges.
/// Formulas of changing steps grow errors that no state shows: quadratures take part in the error control, and [`Options::atol_quad`] must be given for them.
/// After every event and breakpoint it begins anew at order 1, so it is for solutions that are smooth for many steps.
///
/// References: `brenan1996`, `hairer1996`.
#[derive(Debug, Clone)]
pub struct Bdf {
    core: Core,
    matrix: StepMatrix,
    history: History,
    newton: Newton,
    /// The formula of the step just tried.
    formula: Formula,
    /// Highest order that is taken.
    highest: usize,
    /// Point, rates and correction of the step just tried, states first, then quadratures.
    x: Vec<Block>,
    rates: Vec<Block>,
    correction: Vec<Block>,
    f: Vec<Block>,
    /// Absolute and relative error that is admitted in every component, and one over their sum.
    atol: Vec<Block>,
    rtol: Vec<Block>,
    per_error: Vec<Block>,
    /// Errors of the step just tried, as norms.
    errors: Errors,
}

/// Errors of a step at its order and the orders below, times a constant that depends on the order alone, and the order that is best among them.
#[derive(Debug, Clone, Copy, Default)]
struct Errors {
    /// Norm of the correction.
    size: f64,
    own: f64,
    below: f64,
    order: usize,
    estimate: f64,
}

impl Bdf {
    /// Work arrays for `dim` states and `quad_dim` quadratures. `groups`: columns of a difference Jacobian that share a
    /// right-hand side; `None`: one each.
    #[must_use]
    pub fn new(dim: usize, quad_dim: usize, groups: Option<ColumnGroups>) -> Self {
        let m = dim + quad_dim;
        Self {
            core: Core::new(dim, quad_dim, groups, false),
            matrix: StepMatrix::by_products(dim),
            history: History::new(m),
            newton: Newton::default(),
            formula: Formula::default(),
            highest: MAX_ORDER,
            x: zeros(m),
            rates: zeros(m),
            correction: zeros(m),
            f: zeros(m),
            atol: vec![[1.0; WIDTH]; m.div_ceil(WIDTH)],
            rtol: zeros(m),
            per_error: zeros(m),
            errors: Errors::default(),
        }
    }

    /// Takes orders up to `order` alone, from 1 to 5. Order 5 is stable in the smallest part of the left half plane and asks for five smooth derivatives. On a network of
    /// orifices order 4 was faster for errors of 1e-6 and less.
    #[must_use]
    pub fn up_to_order(self, order: usize) -> Self {
        Self { highest: order.clamp(1, MAX_ORDER), ..self }
    }

    /// Sets the errors that are admitted from the start of the step on.
    fn set_tolerances(&mut self, opts: &Options) {
        set(&mut self.atol, &self.core.atol);
        if self.history.is_new() {
            let n = self.core.n;
            self.atol.as_flattened_mut()[n..self.core.m].copy_from_slice(&opts.atol_quad);
            let relative = self.rtol.as_flattened_mut()[..self.core.m].iter_mut().enumerate();
            relative.for_each(|(i, r)| *r = opts.relative(i));
        }
    }

    /// Solves for the end of the step: `true` when Newton's method has converged, with `x` and `correction`.
    fn correct<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t1: f64,
        h: f64,
        stats: &mut Stats,
    ) -> Result<bool, EvalError> {
        let lead = self.formula.lead / h;
        self.history.predict(&self.formula, &mut self.x, &mut self.rates);
        self.set_norm();
        self.correction.fill([0.0; WIDTH]);
        self.newton.begin();
        let (n, m, te) = (self.core.n, self.core.m, self.core.clamp_time(t1));
        loop {
            let f = &mut self.f.as_flattened_mut()[..m];
            Core::checked_rhs(sys, te, &self.x.as_flattened()[..n], f, stats)?;
            self.residual();
            self.solve(sys, lead);
            stats.solves += 1;
            self.step(lead);
            if let Some(converged) = self.newton.judge(norm(&self.f, &self.per_error)) {
                return Ok(converged);
            }
        }
    }

    /// The residual of the equation from the rates in `f`.
    fn residual(&mut self) {
        for (f, rate) in self.f.iter_mut().zip(&self.rates) {
            for i in 0..WIDTH {
                f[i] = rate[i] - f[i];
            }
        }
    }

    /// The step from the residual, both in `f`.
    fn solve<S: OdeSystem + ?Sized>(&mut self, sys: &mut S, lead: f64) {
        let n = self.core.n;
        let (step, quads) = self.f.as_flattened_mut()[..self.core.m].split_at_mut(n);
        self.matrix.solve(&self.core, sys, step);
        for (q, row) in quads.iter_mut().zip(self.core.jac[n * n..].chunks_exact(n)) {
            *q = (*q + dot(row, step)) / lead;
        }
    }

    /// Takes the step in `f`.
    fn step(&mut self, lead: f64) {
        for (i, step) in self.f.iter().enumerate() {
            add(&mut self.x[i], -1.0, step);
            add(&mut self.correction[i], -1.0, step);
            add(&mut self.rates[i], -lead, step);
        }
    }

    /// Sets what errors are divided by in this step, from its start and its predicted end.
    fn set_norm(&mut self) {
        let ends = self.history.start().zip(&self.x);
        let admitted = self.atol.iter().zip(&self.rtol);
        for ((per, (x0, x1)), (atol, rtol)) in self.per_error.iter_mut().zip(ends).zip(admitted) {
            for i in 0..WIDTH {
                let (a, b) = (x0[i].abs(), x1[i].abs());
                per[i] = 1.0 / (atol[i] + rtol[i] * if a > b { a } else { b });
            }
        }
    }

    /// Errors at the order of the step and below, and which of these orders is best.
    fn judge(&mut self) {
        let k = self.formula.order;
        let sigma = &self.formula.sigma;
        let size = norm(&self.correction, &self.per_error);
        let own = sigma[k] * size;
        let mut found = Errors { size, own, below: f64::INFINITY, order: k, estimate: own };
        if k > 1 {
            self.f.iter_mut().zip(&self.correction).for_each(|(f, e)| *f = *e);
            self.history.add_difference(&self.formula, k, &mut self.f);
            let below = sigma[k - 1] * norm(&self.f, &self.per_error);
            found.below = below;
            let lower = if k > 2 {
                self.history.add_difference(&self.formula, k - 1, &mut self.f);
                let two = sigma[k - 2] * norm(&self.f, &self.per_error);
                terms(k - 1, below).max(terms(k - 2, two)) <= terms(k, own)
            } else {
                terms(1, below) <= 0.5 * terms(2, own)
            };
            if lower {
                (found.order, found.estimate) = (k - 1, below);
            }
        }
        self.errors = found;
    }

    /// The order of the next step and the error that an equal step would have then: that above is weighed too, where it is known.
    fn best(&mut self) -> (usize, f64) {
        let (k, errors) = (self.formula.order, self.errors);
        let same = (errors.order, errors.estimate);
        if errors.order < k
            || k >= self.highest
            || !self.history.above(&self.formula, &self.correction, &mut self.f)
        {
            return same;
        }
        let above = norm(&self.f, &self.per_error) / (k + 2) as f64;
        let (own, raised) = (terms(k, errors.own), terms(k + 1, above));
        if k > 1 && terms(k - 1, errors.below) <= own.min(raised) {
            (k - 1, errors.below)
        } else if raised < if k > 1 { own } else { 0.5 * own } {
            (k + 1, above)
        } else {
            same
        }
    }
}

/// Term of an order in the expansion of the error: what orders are compared by.
fn terms(order: usize, error: f64) -> f64 {
    (order + 1) as f64 * error
}

/// Growth of the step while order and step only grow.
const DOUBLED: f64 = 2.0;
/// Part of the step after an event or a breakpoint: order 1 allows less.
const AFRESH: f64 = 0.1;
/// What an estimated error counts for the next step: the constants of its expansion are those of equal steps.
const BIAS: f64 = 3.0;
/// Errors below this say nothing of how much longer a step may be.
const LEAST_ERROR: f64 = 1e-4;
/// Part of the step that the estimate of a failed one admits which is tried next: the estimate misses most where a step fails.
const CAUTION: f64 = 0.8;
/// Growth of the step below which it stays as it is: a change costs a factorisation, and errors of formulas for steps of other sizes.
const LEAST_GROWTH: f64 = 2.0;

impl Scheme for Bdf {
    const GROWTH: f64 = 2.0;
    const RATES: bool = false;
    const JUDGES_QUADRATURES: bool = true;

    fn exponent(&self) -> f64 {
        1.0 / (self.formula.order + 1) as f64
    }

    fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    fn tried(&self) -> &Core {
        &self.core
    }

    fn restart(&mut self) -> f64 {
        self.history.forget();
        self.newton.forget();
        AFRESH
    }

    fn attempt<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<Trial, EvalError> {
        self.history.begin(&self.core.x0, &self.core.f0, h);
        self.formula = self.history.formula(h);
        let te = self.core.clamp_time(t);
        self.core.set_tolerances(sys, te, opts);
        self.set_tolerances(opts);
        loop {
            let fresh = self.newton.wants_jacobian();
            if fresh {
                if !self.history.is_new() {
                    let n = self.core.n;
                    Core::checked_rhs(sys, te, &self.core.x0[..n], &mut self.core.f0, stats)?;
                }
                self.core.linearise_states(sys, te, opts, stats)?;
                self.core.set_weights(opts);
            }
            let lead = self.formula.lead / h;
            if self.newton.wants_factors(lead, fresh) {
                stats.lu += 1;
                if !self.matrix.factor(&self.core, sys, lead) {
                    return Ok(Trial::Retry(0.5));
                }
            }
            if self.correct(sys, t + h, h, stats)? {
                let m = self.core.m;
                self.core.x1.copy_from_slice(&self.x.as_flattened()[..m]);
                self.judge();
                return Ok(Trial::Done { error: self.formula.error * self.errors.size });
            }
            if fresh {
                return Ok(Trial::Retry(0.25));
            }
        }
    }

    fn accept(&mut self, h: f64, _: f64) -> f64 {
        self.newton.age();
        let k = self.formula.order;
        if self.history.is_starting() && self.errors.order == k && k < self.highest {
            self.history.take(&self.formula, &self.x, &self.correction, h, k + 1);
            return DOUBLED;
        }
        let (order, estimate) = self.best();
        self.history.take(&self.formula, &self.x, &self.correction, h, order);
        // Steps of one size are worth more than the last percents of it.
        let admitted = BIAS * estimate + LEAST_ERROR;
        if admitted <= 1.0 && admitted * LEAST_GROWTH.powi(order as i32 + 1) > 1.0 {
            return 1.0;
        }
        let factor = elementary::powf(admitted, -1.0 / (order + 1) as f64);
        if factor < 1.0 { factor.clamp(0.5, 0.9) } else { factor }
    }

    fn reject(&mut self) -> Option<f64> {
        let order = self.history.failed(self.errors.order);
        let factor =
            CAUTION * elementary::powf(BIAS * self.errors.estimate + LEAST_ERROR, -1.0 / (order + 1) as f64);
        Some(factor.clamp(0.25, 0.9))
    }
}

impl Interpolant for Bdf {
    /// A polynomial of degree 4 through the ends of the step and three points between, on the polynomial of the formula.
    fn coefficients(&self, h: f64, c: &mut [Vec<f64>; 3]) {
        let (x0, x1) = (&self.core.x0, &self.core.x1);
        for (c, theta) in c.iter_mut().zip([0.25, 0.5, 0.75]) {
            c.resize(x0.len(), 0.0);
            self.history.value((theta - 1.0) * h, c);
            for ((c, x0), x1) in c.iter_mut().zip(x0).zip(x1) {
                *c = (*c - x0 - theta * (x1 - x0)) / (theta * (1.0 - theta));
            }
        }
        let [a, b, d] = c;
        for ((a, b), d) in a.iter_mut().zip(b).zip(d) {
            let second = 8.0 * (*a - 2.0 * *b + *d);
            let first = 2.0 * (*d - *a) - second;
            (*a, *b, *d) = (*b - 0.5 * first - 0.25 * second, first, second);
        }
    }
}

impl<S: OdeSystem + ?Sized> Integrator<S> for Bdf {
    fn integrate(
        &mut self,
        sys: &mut S,
        interval: (f64, f64),
        breakpoints: &[f64],
        y: &mut [f64],
        q: &mut [f64],
        options: &Options,
        stats: &mut Stats,
        observer: &mut dyn FnMut(&mut S, &dyn StepView) -> Flow,
    ) -> Result<f64, IntegrateError> {
        drive(self, sys, interval, breakpoints, y, q, options, stats, observer)
    }
}
