//! Backward differentiation formulas of orders 1 to 5, variable in step and order.

use crate::EvalError;
use crate::elementary;
use crate::linalg::dot;
use crate::ode::{
    ColumnGroups, Core, End, Flow, IntegrateError, Integrator, Interpolant, OdeSystem, Options, Scheme,
    Stats, StepMatrix, StepView, Trial, drive,
};

mod blocks;
mod history;
mod lane;
mod newton;

use blocks::{Block, Norm, Sum, WIDTH, zeros};
use history::{Formula, History, MAX_ORDER};
use lane::Lane;
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
    /// Point of the step just tried and its rates, states first, then quadratures; and what else is known of them.
    x: Vec<Block>,
    f: Vec<Block>,
    lanes: Vec<Lane>,
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
            history: History::new(),
            newton: Newton::default(),
            formula: Formula::default(),
            highest: MAX_ORDER,
            x: zeros(m),
            f: zeros(m),
            lanes: vec![Lane::new(); m.div_ceil(WIDTH)],
            errors: Errors::default(),
        }
    }

    /// Takes orders up to `order` alone, from 1 to 5. Order 5 is stable in the smallest part of the left half plane; for errors of 1e-8 order 4 takes a tenth to twice as long.
    #[must_use]
    pub fn up_to_order(self, order: usize) -> Self {
        Self { highest: order.clamp(1, MAX_ORDER), ..self }
    }

    /// Sets the errors that are admitted from the start of the step on.
    fn set_tolerances(&mut self, opts: &Options) {
        let (n, m) = (self.core.n, self.core.m);
        for (lane, atol) in self.lanes.iter_mut().zip(self.core.atol.chunks(WIDTH)) {
            lane.atol[..atol.len()].copy_from_slice(atol);
        }
        if self.history.is_new() {
            for i in 0..m {
                let lane = &mut self.lanes[i / WIDTH];
                lane.rtol[i % WIDTH] = opts.relative(i);
                if i >= n {
                    lane.atol[i % WIDTH] = opts.atol_quad[i - n];
                }
            }
        }
    }

    /// Begins the past at the start of the step, where there is none.
    fn begin(&mut self, h: f64) {
        if self.history.is_new() {
            let start = self.core.x0.chunks(WIDTH).zip(self.core.f0.chunks(WIDTH));
            self.lanes.iter_mut().zip(start).for_each(|(lane, (x, f))| lane.begin(x, f, h));
        }
    }

    /// The rates at the point of the step.
    fn rates<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t1: f64,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let (n, m) = (self.core.n, self.core.m);
        let f = &mut self.f.as_flattened_mut()[..m];
        Core::checked_rhs(sys, t1, &self.x.as_flattened()[..n], f, stats)
    }

    /// The Jacobian at the point of the step, where the rates are known.
    fn linearise<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t1: f64,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let m = self.core.m;
        self.core.x1.copy_from_slice(&self.x.as_flattened()[..m]);
        self.core.f1.copy_from_slice(&self.f.as_flattened()[..m]);
        self.core.linearise_states(sys, t1, End::Trial, opts, stats)?;
        self.core.set_weights(opts);
        Ok(())
    }

    /// Solves for the end of the step, from the predicted one and its rates: `true` when Newton's method has converged, with `x` and the corrections.
    fn correct<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t1: f64,
        lead: f64,
        stats: &mut Stats,
    ) -> Result<bool, EvalError> {
        self.newton.begin();
        loop {
            self.lanes.iter().zip(&mut self.f).for_each(|(lane, f)| lane.residual(f));
            self.solve(sys, lead);
            stats.solves += 1;
            let change = self.step(lead);
            if let Some(converged) = self.newton.judge(change) {
                return Ok(converged);
            }
            self.rates(sys, t1, stats)?;
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

    /// Takes the step in `f`: its norm, NaN where a number of it is.
    fn step(&mut self, lead: f64) -> f64 {
        let (mut norm, mut sum) = (Norm::ZERO, Sum::ZERO);
        for ((lane, x), step) in self.lanes.iter_mut().zip(&mut self.x).zip(&self.f) {
            lane.go(x, step, lead, &mut norm, &mut sum);
        }
        if sum.value().is_nan() { f64::NAN } else { norm.value() }
    }

    /// Errors at the order of the step and below, and which of these orders is best.
    fn judge(&mut self) {
        let k = self.formula.order;
        let sigma = &self.formula.sigma;
        let (mut at, mut under) = (Norm::ZERO, Norm::ZERO);
        self.lanes.iter().for_each(|lane| lane.errors(&self.formula, &mut at, &mut under));
        let size = at.value();
        let own = sigma[k] * size;
        let mut found = Errors { size, own, below: f64::INFINITY, order: k, estimate: own };
        if k > 1 {
            let below = sigma[k - 1] * under.value();
            found.below = below;
            if self.is_lower(below, own) {
                (found.order, found.estimate) = (k - 1, below);
            }
        }
        self.errors = found;
    }

    /// Whether the terms of the expansion fall from the order of the step to those below.
    fn is_lower(&self, below: f64, own: f64) -> bool {
        let k = self.formula.order;
        if k == 2 {
            return terms(1, below) <= 0.5 * terms(2, own);
        }
        let most = terms(k, own);
        terms(k - 1, below) <= most && {
            let mut norm = Norm::ZERO;
            self.lanes.iter().for_each(|lane| lane.error_two_below(&self.formula, &mut norm));
            terms(k - 2, self.formula.sigma[k - 2] * norm.value()) <= most
        }
    }

    /// Takes the step just tried; the next is of order `next`.
    fn take(&mut self, next: usize) {
        self.lanes.iter_mut().zip(&self.x).for_each(|(lane, x)| lane.take(&self.formula, x));
        self.history.take(&self.formula, next);
    }

    /// The order of the next step and the error that an equal step would have then: that above is weighed too, where it is known.
    fn best(&mut self) -> (usize, f64) {
        let (k, errors) = (self.formula.order, self.errors);
        let same = (errors.order, errors.estimate);
        if errors.order < k || k >= self.highest || !self.formula.is_steady() {
            return same;
        }
        let mut norm = Norm::ZERO;
        self.lanes.iter().for_each(|lane| lane.error_above(&self.formula, &mut norm));
        let above = norm.value() / (k + 2) as f64;
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

/// Growth of the step, when it grows.
const DOUBLED: f64 = 2.0;
/// Part of the step after an event or a breakpoint: order 1 allows less.
const AFRESH: f64 = 0.1;
/// What an estimated error counts for the next step: the constants of its expansion are those of equal steps.
const BIAS: f64 = 3.0;
/// Part of the step that the estimate of a failed one admits which is tried next: the estimate misses most where a step fails.
const CAUTION: f64 = 0.8;

impl Scheme for Bdf {
    const GROWTH: f64 = DOUBLED;
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
        self.history = History::new();
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
        self.begin(h);
        self.history.formulate(h, &mut self.formula);
        let (t0, t1) = (self.core.clamp_time(t), self.core.clamp_time(t + h));
        self.core.set_tolerances(sys, t0, opts);
        self.set_tolerances(opts);
        let lead = self.formula.lead / h;
        loop {
            self.lanes.iter_mut().zip(&mut self.x).for_each(|(lane, x)| *x = lane.predict(&self.formula));
            self.rates(sys, t1, stats)?;
            let fresh = self.newton.wants_jacobian();
            if fresh {
                self.linearise(sys, t1, opts, stats)?;
            }
            if self.newton.wants_factors(lead, fresh) {
                stats.lu += 1;
                if !self.matrix.factor(&self.core, sys, lead) {
                    return Ok(Trial::Retry(0.5));
                }
            }
            if self.correct(sys, t1, lead, stats)? {
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

    fn accept(&mut self, _: f64, _: f64) -> f64 {
        self.newton.age();
        let k = self.formula.order;
        if self.history.is_starting() && self.errors.order == k && k < self.highest {
            self.take(k + 1);
            return DOUBLED;
        }
        let (order, estimate) = self.best();
        self.take(order);
        let admitted = BIAS * estimate;
        if admitted * DOUBLED.powi(order as i32 + 1) <= 1.0 {
            DOUBLED
        } else if admitted <= 1.0 {
            // A change costs a factorisation, and errors of formulas for steps of other sizes.
            1.0
        } else {
            elementary::powf(admitted, -1.0 / (order + 1) as f64).clamp(0.5, 0.9)
        }
    }

    fn reject(&mut self) -> Option<f64> {
        let order = self.history.failed(self.errors.order);
        let factor = CAUTION * elementary::powf(BIAS * self.errors.estimate, -1.0 / (order + 1) as f64);
        Some(factor.clamp(0.25, 0.9))
    }
}

impl Interpolant for Bdf {
    /// A polynomial of degree 4 through the ends of the step and three points between, on the polynomial of the formula.
    fn coefficients(&self, h: f64, c: &mut [Vec<f64>; 3]) {
        let (x0, x1) = (&self.core.x0, &self.core.x1);
        for (c, theta) in c.iter_mut().zip([0.25, 0.5, 0.75]) {
            c.resize(x0.len(), 0.0);
            let (weights, used) = self.history.weights((theta - 1.0) * h);
            let lanes = self.lanes.iter().zip(c.chunks_mut(WIDTH));
            lanes.for_each(|(lane, c)| lane.sum(&weights[..used], c));
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
