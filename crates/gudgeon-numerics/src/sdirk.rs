//! A singly diagonally implicit Runge–Kutta method of order 2, for systems that solve their stages themselves.
//!
//! ```text
//! y_1 = y + γ h k_1      y_2 = y + (1 - γ) h k_1 + γ h k_2 = y'      k_i = f(t + c_i h, y_i)      γ = 1 - 1/√2      c = (γ, 1)
//! ```

use crate::EvalError;
use crate::elementary;
use crate::ode::{
    Core, Flow, IntegrateError, Integrator, Interpolant, OdeSystem, Options, Scheme, Stage, Stats, StepView,
    Trial, all_finite, drive, larger, non_finite,
};

/// Alexander's method of order 2, and the work arrays for systems of one size.
///
/// L-stable and stiffly accurate: each stage is an implicit Euler step over a part of the step, so a system whose rates have corners or change by orders
/// of magnitude within a step can solve it by a method of its own ([`OdeSystem::stage`]), and no Jacobian of the integrator has to see them. The error
/// estimate is `C h³ y‴`, the third derivative by the divided difference of the rates over the step, those at its start included, and `C` the error
/// constant of the method on `y' = λ y`. On components that follow their equilibrium it is too large, of order two: the rates of their stages are means. Quadratures are integrated by the parabola through these rates and take no part in the error control; linear
/// invariants hold to rounding.
///
/// Dense output: cubic, with slopes limited so that nothing overshoots between the ends of a step.
///
/// References: `alexander1977`, `fritsch1980`.
#[derive(Debug, Clone)]
pub struct Sdirk {
    core: Core,
    /// Rates at the start of the step and at both stages, states and quadratures.
    k: [Vec<f64>; 3],
    /// The state that the rates at the start belong to.
    start: Vec<f64>,
    base: Vec<f64>,
    /// Errors admitted in the stages.
    accuracy: Vec<f64>,
    /// Quadratures that an invariant ties to states.
    tied: Vec<bool>,
    /// Whether tolerances are those of the start of the step.
    judged: bool,
}

/// `1 - 1/√2`.
pub const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// Places in a step, from 0 to 1, at which rates are known: its start, and the stages.
pub const PLACES: [f64; 3] = [0.0, GAMMA, 1.0];
/// Weights of the rates in the result.
const WEIGHTS: [f64; 3] = [0.0, 1.0 - GAMMA, GAMMA];
/// Weights of the divided difference of second order of the rates.
const SECOND: [f64; 3] = [1.0 / GAMMA, -1.0 / (GAMMA * (1.0 - GAMMA)), 1.0 / (1.0 - GAMMA)];
/// Error over `h³ y‴` on `y' = λ y`.
const CONSTANT: f64 = GAMMA * GAMMA * (3.0 - 2.0 * GAMMA) - 1.0 / 6.0;
/// Part of the error of a step that its stages may add.
const STAGES: f64 = 0.005;
/// Part of the step that the error estimate admits which is taken.
const SAFETY: f64 = 0.85;

impl Sdirk {
    /// Work arrays for `dim` states and `quad_dim` quadratures.
    #[must_use]
    pub fn new(dim: usize, quad_dim: usize) -> Self {
        let k = || vec![0.0; dim + quad_dim];
        Self {
            core: Core::new(dim, quad_dim, None, true),
            k: [k(), k(), k()],
            start: vec![f64::NAN; dim],
            base: vec![0.0; dim],
            accuracy: vec![0.0; dim],
            tied: vec![false; quad_dim],
            judged: false,
        }
    }

    /// Rates and accuracy at the start of a step.
    fn begin<S: OdeSystem + ?Sized>(&mut self, sys: &mut S, t: f64, opts: &Options) {
        let n = self.core.n;
        if self.start == self.core.x0[..n] {
            self.k.swap(0, 2);
        } else {
            self.k[0].copy_from_slice(&self.core.f0);
            self.start.copy_from_slice(&self.core.x0[..n]);
        }
        let te = self.core.clamp_time(t);
        self.core.set_tolerances(sys, te, opts);
        for (i, (atol, x0)) in self.core.atol.iter().zip(&self.core.x0).enumerate() {
            self.accuracy[i] = STAGES * (atol + opts.relative(i) * x0.abs());
        }
        self.tied.fill(false);
        for term in sys.invariants().iter().flat_map(|v| &v.terms).filter(|term| term.0 >= n) {
            self.tied[term.0 - n] = true;
        }
        self.judged = true;
    }

    /// Stage `i`, 1 or 2: its point in `y_tmp`, its rates in `k[i]`.
    fn stage<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        i: usize,
        t: f64,
        h: f64,
    ) -> Result<(), EvalError> {
        let n = self.core.n;
        let (done, rest) = self.k.split_at_mut(i);
        let k = &mut rest[0];
        self.base.copy_from_slice(&self.core.x0[..n]);
        if i == 2 {
            self.base.iter_mut().zip(&done[1]).for_each(|(b, k)| *b += h * (1.0 - GAMMA) * k);
        }
        let step = GAMMA * h;
        let te = self.core.clamp_time(t + PLACES[i] * h);
        let y = &mut self.core.y_tmp[..n];
        // The rates of the stage before go on as they are.
        y.iter_mut().zip(&self.base).zip(&done[i - 1]).for_each(|((y, b), k)| *y = b + step * k);
        let stage = Stage { number: i, base: &self.base, step, accuracy: &self.accuracy };
        sys.stage(te, &stage, y, &mut k[n..])?;
        k[..n].iter_mut().zip(y.iter()).zip(&self.base).for_each(|((k, y), b)| *k = (y - b) / step);
        for invariant in sys.invariants() {
            k[invariant.pivot] = invariant.pivot_value(|row| k[row]);
        }
        if all_finite(k) { Ok(()) } else { Err(non_finite()) }
    }

    /// The end of the step in `x1`, and the error norm.
    fn finish(&mut self, h: f64, opts: &Options) -> f64 {
        let n = self.core.n;
        self.core.x1[..n].copy_from_slice(&self.core.y_tmp[..n]);
        let rates = of_each(self.k.each_ref().map(|k| &k[n..]));
        let quadratures = self.core.x1[n..].iter_mut().zip(&self.core.x0[n..]).zip(&self.tied);
        for (((q1, q0), tied), rates) in quadratures.zip(rates) {
            // The parabola through the rates adds this to the sum by the weights of the method.
            let parabola = if *tied { 0.0 } else { sum(&SECOND, rates) * QUADRATURE };
            *q1 = q0 + h * (sum(&WEIGHTS, rates) + parabola);
        }
        let rates = of_each(self.k.each_ref().map(|k| &k[..n]));
        let errors = rates.enumerate().map(|(i, rates)| h * error(rates) / self.core.scale(opts, i));
        errors.fold(0.0, larger)
    }
}

/// The rates of each component.
fn of_each([a, b, c]: [&[f64]; 3]) -> impl Iterator<Item = [f64; 3]> {
    a.iter().zip(b).zip(c).map(|((a, b), c)| [*a, *b, *c])
}

/// What the weights of the method lack of an integral, over the divided difference of second order.
const QUADRATURE: f64 = 1.0 / 3.0 - (1.0 - GAMMA) * GAMMA * GAMMA - GAMMA;

/// A weighted sum of the rates of a component.
const fn sum(w: &[f64; 3], rates: [f64; 3]) -> f64 {
    w[0] * rates[0] + w[1] * rates[1] + w[2] * rates[2]
}

impl Interpolant for Sdirk {
    fn coefficients(&self, h: f64, c: &mut [Vec<f64>; 3]) {
        let ([first, _, last], [c0, c1, c2]) = (&self.k, c);
        c2.clear();
        for c in [&mut *c0, &mut *c1, c2] {
            c.resize(self.core.m, 0.0);
        }
        let ends = self.core.x0.iter().zip(&self.core.x1).zip(first.iter().zip(last));
        for ((c0, c1), ((x0, x1), (first, last))) in c0.iter_mut().zip(c1).zip(ends) {
            let d = x1 - x0;
            let (a, b) = (limited(h * first, d), limited(h * last, d));
            (*c0, *c1) = (a - d, 2.0 * d - a - b);
        }
    }
}

/// Error of a step over its length, for the rates at its [`PLACES`].
#[inline]
#[must_use]
pub fn error(rates: [f64; 3]) -> f64 {
    2.0 * CONSTANT * sum(&SECOND, rates)
}

/// Dense output at the part `x` of a step `h` between the values `y` with the rates `f` at its ends.
#[inline]
#[must_use]
pub fn between([y0, y1]: [f64; 2], f: [f64; 2], h: f64, x: f64) -> f64 {
    let d = y1 - y0;
    let [a, b] = f.map(|f| limited(h * f, d));
    y0 + x * d + x * (1.0 - x) * ((1.0 - x) * (a - d) + x * (d - b))
}

/// A slope that makes no cubic overshoot between two values that differ by `d`.
#[inline]
fn limited(slope: f64, d: f64) -> f64 {
    if d > 0.0 { slope.clamp(0.0, 3.0 * d) } else { slope.clamp(3.0 * d, 0.0) }
}

impl Scheme for Sdirk {
    const GROWTH: f64 = 2.0;
    const RATES: bool = false;
    const JUDGES_QUADRATURES: bool = false;

    fn exponent(&self) -> f64 {
        1.0 / 3.0
    }

    fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    fn tried(&self) -> &Core {
        &self.core
    }

    fn restart(&mut self) -> f64 {
        self.judged = false;
        1.0
    }

    fn accept(&mut self, _h: f64, error: f64) -> f64 {
        self.judged = false;
        // The power of the exponent.
        SAFETY / elementary::cbrt(error.max(1e-10))
    }

    fn attempt<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<Trial, EvalError> {
        if !self.judged {
            self.begin(sys, t, opts);
        }
        for i in 1..PLACES.len() {
            stats.stages += 1;
            self.stage(sys, i, t, h)?;
        }
        let error = self.finish(h, opts);
        if error <= opts.slack {
            self.start.copy_from_slice(&self.core.x1[..self.core.n]);
        }
        Ok(Trial::Done { error })
    }
}

impl<S: OdeSystem + ?Sized> Integrator<S> for Sdirk {
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
        self.start.fill(f64::NAN);
        drive(self, sys, interval, breakpoints, y, q, options, stats, observer)
    }
}
