//! Radau IIA of order 5: three stages, L-stable, stiffly accurate, fully implicit (hairer1996, section IV.8).
//!
//! The stage increments `Z_i ≈ y(t + c_i h) - y(t)` solve the collocation equations
//!
//! ```text
//! Z_i = h Σ_j a_ij f(t + c_j h, y + Z_j),    c = ((4 - √6)/10, (4 + √6)/10, 1)
//! ```
//!
//! by simplified Newton iteration. In `W = T⁻¹ Z`, which turns `A⁻¹` into a real and a complex eigenvalue, one iteration costs
//! one real and one complex solve of size `dim`. Because `c_3 = 1` the step ends on its last stage: `y' = y + Z_3`.
//!
//! Quadratures are rows of the same collocation equations without columns: `q' = q + h Σ_j a_3j g(t + c_j h, y + Z_j)`. They take
//! part in the iteration by substitution, so a linear invariant over states and quadratures holds for every iterate, not
//! only in the limit.
//!
//! The error estimate belongs to a formula of order 3 and overestimates the error of the solution more and more as the
//! tolerance shrinks. As in hairer1996 the step is controlled with `rtol' = 0.1 rtol^(2/3)` in the place of `rtol`, which
//! brings the error of the solution near `rtol`; absolute tolerances keep their ratio to it.
//!
//! Where [`crate::rodas`] linearises once a step, this method solves nonlinear equations to well below the tolerance: dearer at
//! 1e-3, better from about 1e-7 on, and the reference the other is measured against.

#![allow(
    clippy::excessive_precision,
    clippy::needless_range_loop,
    reason = "coefficients as published; small fixed index ranges over several arrays"
)]

use crate::EvalError;

use crate::linalg::{lu_factor, lu_solve};
use crate::ode::{
    ColumnGroups, Flow, IntegrateError, Integrator, OdeSystem, Options, Stats, StepView, difference,
};

const SQRT_6: f64 = 2.449_489_742_783_178;
const C: [f64; 3] = [(4.0 - SQRT_6) / 10.0, (4.0 + SQRT_6) / 10.0, 1.0];
/// Real eigenvalue of `A⁻¹`, `30/(6 + 81^(1/3) - 9^(1/3))`.
const REAL: f64 = 3.637_834_252_744_496;
/// Complex eigenvalue of `A⁻¹`.
const RE: f64 = 2.681_082_873_627_752;
const IM: f64 = 3.050_430_199_247_41;
/// Columns: the real eigenvector of `A⁻¹`, real and imaginary part of the complex one.
const T: [[f64; 3]; 3] = [
    [0.091_232_394_870_892_94, -0.141_255_295_020_954_2, -0.030_029_194_105_147_424],
    [0.241_717_932_707_107_02, 0.204_129_352_293_799_94, 0.382_942_112_757_261_94],
    [0.966_048_182_615_092_9, 1.0, 0.0],
];
const T_INV: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_87, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_45],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605_4, -0.596_039_204_828_224_9],
];
/// Weights of the stages in the error estimate.
const E: [f64; 3] = [-(13.0 + 7.0 * SQRT_6) / 3.0, (-13.0 + 7.0 * SQRT_6) / 3.0, -1.0 / 3.0];

/// Iterations before a step is given up.
const ITERATIONS: usize = 10;
/// Rate of convergence below which the Jacobian serves another step.
const KEEP_JACOBIAN: f64 = 1e-3;
/// Growth of the step below which the factors serve another step.
const KEEP_STEP: f64 = 1.2;
/// Error left by the iteration, in units of the tolerance asked for. It is not controlled by the error estimate, adds up over the
/// steps and is amplified where a small component drives a large one: at ten times this, van der Pol's equation (mu = 1000)
/// at 1e-9 is wrong by ten tolerances instead of less than one, for a seventh fewer right-hand sides.
const NEWTON: f64 = 1e-4;
/// Increment, in units of the iteration's tolerance, below which an iteration that no longer contracts counts as stopped by the
/// rounding of the right-hand side.
const STALLED: f64 = 1e3;

/// The integrator with its work arrays. Allocates only when made.
///
/// In [`Stats`] a real and a complex factorisation, always done together, count as one, and so do the solves of an iteration.
#[derive(Debug)]
pub struct Radau5 {
    n: usize,
    rows: usize,
    groups: Option<ColumnGroups>,
    jac: Vec<f64>,
    lu: Vec<f64>,
    pivot: Vec<usize>,
    complex: ComplexLu,
    f0: Vec<f64>,
    /// Stages in the original and in transformed coordinates, rates and increments: three blocks of `rows` each.
    z: Vec<f64>,
    w: Vec<f64>,
    f: Vec<f64>,
    /// Divided differences of the collocation polynomial of the last accepted step, three blocks of `rows`.
    dense: Vec<f64>,
    error: Vec<f64>,
    scale: Vec<f64>,
    stage: Vec<f64>,
    moved: Vec<f64>,
    y0: Vec<f64>,
    y1: Vec<f64>,
    /// Factor on the tolerance of the Newton iteration.
    newton: f64,
}

/// How an attempted step went.
enum Attempt {
    /// Solved: the error norm and the iterations it took.
    Solved { error: f64, iterations: usize },
    /// The iteration would need a step smaller by this factor.
    NotConverged { factor: f64 },
}

/// Where a step lies, and what its evaluations may look at.
struct Span {
    t: f64,
    h: f64,
    /// Arguments of the right-hand side stay between these, so that a jump at an end is seen from inside.
    low: f64,
    high: f64,
}

impl Span {
    fn at(&self, c: f64) -> f64 {
        (self.t + c * self.h).clamp(self.low, self.high)
    }
}

impl Radau5 {
    /// For `dim` states and `quad_dim` quadratures.
    #[must_use]
    pub fn new(dim: usize, quad_dim: usize, groups: Option<ColumnGroups>) -> Self {
        let rows = dim + quad_dim;
        Self {
            n: dim,
            rows,
            groups,
            jac: vec![0.0; rows * dim],
            lu: vec![0.0; dim * dim],
            pivot: vec![0; dim],
            complex: ComplexLu::new(dim),
            f0: vec![0.0; rows],
            z: vec![0.0; 3 * rows],
            w: vec![0.0; 3 * rows],
            f: vec![0.0; 3 * rows],
            dense: vec![0.0; 3 * rows],
            error: vec![0.0; dim],
            scale: vec![0.0; dim],
            stage: vec![0.0; dim],
            moved: vec![0.0; dim],
            y0: vec![0.0; dim],
            y1: vec![0.0; dim],
            newton: 1.0,
        }
    }

    /// Multiplies the tolerance of the Newton iteration by `factor` (above 0; 1 unless called). Smaller factors carry the iteration closer
    /// to the solution of the collocation equations, down to the rounding of the right-hand side: a step is then that of the exact method
    /// whatever [`Options::rtol`] is.
    #[must_use]
    pub fn with_newton_factor(mut self, factor: f64) -> Self {
        self.newton = factor;
        self
    }

    /// Factors `λ/h - J` for the real and the complex eigenvalue.
    fn factor(&mut self, h: f64, stats: &mut Stats) -> Result<(), EvalError> {
        let n = self.n;
        for (l, j) in self.lu.iter_mut().zip(&self.jac) {
            *l = -j;
        }
        for i in 0..n {
            self.lu[i * n + i] += REAL / h;
        }
        stats.lu += 1;
        let real = lu_factor(&mut self.lu, n, &mut self.pivot).is_ok();
        if real && self.complex.factor(&self.jac, RE / h, IM / h) {
            Ok(())
        } else {
            Err(EvalError::recoverable("radau5", "singular iteration matrix"))
        }
    }

    /// First guess of the stages: the last step's polynomial continued, or no change at all.
    fn guess(&mut self, ratio: Option<f64>) {
        let rows = self.rows;
        let Some(ratio) = ratio else {
            self.z.fill(0.0);
            self.w.fill(0.0);
            return;
        };
        for i in 0..3 {
            let s = C[i] * ratio;
            for k in 0..rows {
                self.z[i * rows + k] =
                    newton_form(s, [self.dense[k], self.dense[rows + k], self.dense[2 * rows + k]]);
            }
        }
        for k in 0..rows {
            let z = [self.z[k], self.z[rows + k], self.z[2 * rows + k]];
            for i in 0..3 {
                self.w[i * rows + k] = T_INV[i][0] * z[0] + T_INV[i][1] * z[1] + T_INV[i][2] * z[2];
            }
        }
    }

    /// Rates at the three stages.
    fn rates<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        span: &Span,
        y: &[f64],
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let (n, rows) = (self.n, self.rows);
        for i in 0..3 {
            for ((s, y), z) in self.stage.iter_mut().zip(y).zip(&self.z[i * rows..i * rows + n]) {
                *s = y + z;
            }
            stats.rhs += 1;
            sys.rhs(span.at(C[i]), &self.stage, &mut self.f[i * rows..(i + 1) * rows])?;
        }
        Ok(())
    }

    /// One simplified Newton iteration from the rates in `f`; returns the largest scaled increment of a state.
    fn iterate(&mut self, h: f64, stats: &mut Stats) -> f64 {
        let (n, rows) = (self.n, self.rows);
        let (real, re, im) = (REAL / h, RE / h, IM / h);
        let (f1, rest) = self.f.split_at_mut(rows);
        let (f2, f3) = rest.split_at_mut(rows);
        let (w1, rest) = self.w.split_at_mut(rows);
        let (w2, w3) = rest.split_at_mut(rows);
        for k in 0..rows {
            let f = [f1[k], f2[k], f3[k]];
            let g = |i: usize| T_INV[i][0] * f[0] + T_INV[i][1] * f[1] + T_INV[i][2] * f[2];
            f1[k] = g(0) - real * w1[k];
            f2[k] = g(1) - (re * w2[k] - im * w3[k]);
            f3[k] = g(2) - (re * w3[k] + im * w2[k]);
        }
        lu_solve(&self.lu, n, &self.pivot, &mut f1[..n]);
        self.complex.solve(&mut f2[..n], &mut f3[..n]);
        stats.solves += 1;
        // Rows of quadratures have no column of their own: the same equations by substitution.
        let square = re * re + im * im;
        for k in n..rows {
            let row = &self.jac[k * n..(k + 1) * n];
            let through = |x: &[f64]| row.iter().zip(x).map(|(j, x)| j * x).sum::<f64>();
            f1[k] = (f1[k] + through(f1)) / real;
            let (a, b) = (f2[k] + through(f2), f3[k] + through(f3));
            f2[k] = (a * re + b * im) / square;
            f3[k] = (b * re - a * im) / square;
        }
        let mut largest: f64 = 0.0;
        for d in [&*f1, &*f2, &*f3] {
            largest = larger(largest, scaled_norm(&d[..n], &self.scale));
        }
        let (z1, rest) = self.z.split_at_mut(rows);
        let (z2, z3) = rest.split_at_mut(rows);
        for k in 0..rows {
            w1[k] += f1[k];
            w2[k] += f2[k];
            w3[k] += f3[k];
            let w = [w1[k], w2[k], w3[k]];
            let z = |i: usize| T[i][0] * w[0] + T[i][1] * w[1] + T[i][2] * w[2];
            (z1[k], z2[k], z3[k]) = (z(0), z(1), z(2));
        }
        largest
    }

    /// Solves for the stages of one step and estimates its error; the new state is left in `y1`.
    #[allow(clippy::too_many_arguments, reason = "the memory of the iteration lives in the step loop")]
    fn attempt<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        span: &Span,
        y: &[f64],
        tolerance: &Tolerance<'_>,
        memory: &mut Memory,
        again: bool,
        stats: &mut Stats,
    ) -> Result<Attempt, EvalError> {
        let (n, rows) = (self.n, self.rows);
        let h = span.h;
        let kappa = tolerance.newton * self.newton;
        for k in 0..n {
            self.scale[k] = tolerance.of(k, y[k].abs());
        }
        memory.contraction = memory.contraction.max(f64::EPSILON).powf(0.8);
        memory.rate = KEEP_JACOBIAN;
        let (mut before, mut ratio_before) = (0.0_f64, 0.0_f64);
        let mut iterations = 0;
        loop {
            iterations += 1;
            self.rates(sys, span, y, stats)?;
            let size = self.iterate(h, stats);
            if !size.is_finite() {
                return Ok(Attempt::NotConverged { factor: 0.25 });
            }
            if iterations > 1 {
                let ratio = size / before;
                memory.rate = if iterations == 2 { ratio } else { (ratio * ratio_before).sqrt() };
                ratio_before = ratio;
                if memory.rate < 0.99 {
                    memory.contraction = memory.rate / (1.0 - memory.rate);
                    let left = (ITERATIONS - iterations) as i32;
                    // Error to be expected when the iterations run out, in units of what is allowed.
                    let expected = memory.contraction * size * memory.rate.powi(left) / kappa;
                    if expected >= 1.0 && memory.contraction * size > STALLED * kappa {
                        let factor = 0.8 * expected.clamp(1e-4, 20.0).powf(-1.0 / (4.0 + f64::from(left)));
                        return Ok(Attempt::NotConverged { factor });
                    }
                    if expected >= 1.0 {
                        break;
                    }
                } else if size <= STALLED * kappa {
                    // Rounding of the right-hand side moves the iterates, not the error.
                    break;
                } else {
                    return Ok(Attempt::NotConverged { factor: 0.5 });
                }
            }
            before = size.max(f64::MIN_POSITIVE);
            if memory.contraction * size <= kappa {
                break;
            }
            if iterations == ITERATIONS {
                return Ok(Attempt::NotConverged { factor: 0.5 });
            }
        }
        for k in 0..n {
            self.y1[k] = y[k] + self.z[2 * rows + k];
            self.scale[k] = tolerance.of(k, y[k].abs().max(self.y1[k].abs()));
        }
        // (λ/h - J)⁻¹ (f(t, y) + Σ e_i Z_i / h): difference to an embedded formula, filtered so that it stays bounded for stiff modes.
        for k in 0..n {
            let stages = (E[0] * self.z[k] + E[1] * self.z[rows + k] + E[2] * self.z[2 * rows + k]) / h;
            self.moved[k] = stages;
            self.error[k] = stages + self.f0[k];
        }
        lu_solve(&self.lu, n, &self.pivot, &mut self.error);
        stats.solves += 1;
        let mut error = scaled_norm(&self.error, &self.scale);
        if error >= 1.0 && error.is_finite() && again {
            // At the first step and after a rejection the filter is applied once more: the estimate then vanishes for stiff modes.
            for ((s, y), e) in self.stage.iter_mut().zip(y).zip(&self.error) {
                *s = y + e;
            }
            stats.rhs += 1;
            match sys.rhs(span.low, &self.stage, &mut self.f[..rows]) {
                Ok(()) => {
                    for ((e, f), stages) in self.error.iter_mut().zip(&self.f[..n]).zip(&self.moved) {
                        *e = f + stages;
                    }
                    lu_solve(&self.lu, n, &self.pivot, &mut self.error);
                    stats.solves += 1;
                    error = scaled_norm(&self.error, &self.scale);
                }
                // The first estimate stands, and rejects the step.
                Err(e) if e.is_recoverable() => {}
                Err(e) => return Err(e),
            }
        }
        Ok(Attempt::Solved { error, iterations })
    }

    /// Divided differences of the collocation polynomial over the nodes 0, c_2 - 1, c_1 - 1, -1 counted from the end of the step.
    fn prepare_dense(&mut self) {
        let rows = self.rows;
        for k in 0..rows {
            let (z1, z2, z3) = (self.z[k], self.z[rows + k], self.z[2 * rows + k]);
            let first = (z2 - z3) / (C[1] - 1.0);
            let inner = (z1 - z2) / (C[0] - C[1]);
            let second = (inner - first) / (C[0] - 1.0);
            let third = second - (inner - z1 / C[0]) / C[1];
            self.dense[k] = first;
            self.dense[rows + k] = second;
            self.dense[2 * rows + k] = third;
        }
    }
}

/// Tolerances the step is controlled with.
struct Tolerance<'a> {
    relative: f64,
    /// Ratio to the tolerance asked for.
    ratio: f64,
    options: &'a Options,
    /// Tolerance of the Newton iteration in units of these.
    newton: f64,
}

impl<'a> Tolerance<'a> {
    fn new(options: &'a Options) -> Self {
        let relative = 0.1 * options.rtol.powf(2.0 / 3.0);
        let ratio = if options.rtol > 0.0 { relative / options.rtol } else { 1.0 };
        // Not below what the rounding of the stages allows.
        let newton = (NEWTON / ratio).max(10.0 * f64::EPSILON / relative);
        Self { relative, ratio, options, newton }
    }

    fn of(&self, k: usize, size: f64) -> f64 {
        let relative = if self.options.is_absolute(k) { 0.0 } else { self.relative };
        self.options.atol[k] * self.ratio + relative * size
    }
}

/// What the Newton iteration remembers from step to step.
struct Memory {
    /// θ/(1 - θ): error after an iteration per increment of it.
    contraction: f64,
    /// Rate of convergence θ of the last iteration.
    rate: f64,
}

/// The larger of two norms; NaN counts as infinite, it must not compare as small.
fn larger(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

fn scaled_norm(x: &[f64], scale: &[f64]) -> f64 {
    x.iter().zip(scale).fold(0.0, |m, (x, s)| larger(m, (x / s).abs()))
}

/// The collocation polynomial at `s` (-1: start of the step, 0: end), less its value at the end.
fn newton_form(s: f64, d: [f64; 3]) -> f64 {
    s * (d[0] + (s - (C[1] - 1.0)) * (d[1] + (s - (C[0] - 1.0)) * d[2]))
}

struct View<'a> {
    t0: f64,
    t1: f64,
    y0: &'a [f64],
    y1: &'a [f64],
    dense: &'a [f64],
}

impl StepView for View<'_> {
    fn t0(&self) -> f64 {
        self.t0
    }
    fn t1(&self) -> f64 {
        self.t1
    }
    fn y0(&self) -> &[f64] {
        self.y0
    }
    fn y1(&self) -> &[f64] {
        self.y1
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        let rows = self.dense.len() / 3;
        let s = (t - self.t1) / (self.t1 - self.t0);
        for (k, y) in y.iter_mut().enumerate().take(self.y1.len()) {
            *y = self.y1[k] + newton_form(s, [self.dense[k], self.dense[rows + k], self.dense[2 * rows + k]]);
        }
    }
}

impl<S: OdeSystem + ?Sized> Integrator<S> for Radau5 {
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
        if sys.n_events() > 0 {
            return Err(IntegrateError::Input {
                what: "Radau5 locates no events; use Rodas for this system",
            });
        }
        let (mut t, end) = interval;
        let whole = end - t;
        let mut next_break = breakpoints.partition_point(|b| *b <= t + 1e-12 * whole.abs());
        let tolerance = Tolerance::new(options);
        let mut h = if options.h_init > 0.0 { options.h_init } else { 1e-4 * whole }.min(options.h_max);
        let mut memory = Memory { contraction: 1.0, rate: 1.0 };
        let mut trial = 0;
        let mut refusal: Option<EvalError> = None;
        // Gustafsson's predictor needs the step and the error before.
        let mut previous: Option<(f64, f64)> = None;
        let mut rejected_before = false;
        // The step whose polynomial continues smoothly into the next one.
        let mut polynomial: Option<f64> = None;
        let mut guess_failed = false;
        // At the start and behind a breakpoint nothing is known of what follows.
        let mut edge = true;
        let (mut rates_known, mut jacobian_usable, mut jacobian_here) = (false, false, false);
        let mut factored: Option<f64> = None;
        let fail = |t: f64, source: EvalError| IntegrateError::Eval { t, source };
        while t < end {
            let stop = breakpoints.get(next_break).copied().filter(|b| *b < end).unwrap_or(end);
            let left = stop - t;
            // Land on the stop exactly, and never leave a sliver before it.
            let (step, t1) = if h >= left {
                (left, stop)
            } else if 2.0 * h > left {
                (0.5 * left, t + 0.5 * left)
            } else {
                (h, t + h)
            };
            let cut = step < h;
            let inside = (8.0 * f64::EPSILON * t.abs().max(stop.abs())).min(1e-3 * step);
            let span = Span {
                t,
                h: step,
                low: if edge { t + inside } else { t },
                high: if t1 == stop { t1 - inside } else { t1 },
            };
            if !rates_known {
                stats.rhs += 1;
                // The state itself is accepted: nothing smaller can help.
                sys.rhs(span.low, y, &mut self.f0).map_err(|e| fail(t, e))?;
                rates_known = true;
            }
            if !jacobian_usable {
                stats.jacobians += 1;
                let rows = self.rows;
                let given = sys.jacobian(span.low, y, &self.f0, &mut self.jac).map_err(|e| fail(t, e))?;
                if !given {
                    let (work, groups) = (&mut self.f[..rows], self.groups.as_ref());
                    difference(
                        sys,
                        groups,
                        span.low,
                        y,
                        &self.f0,
                        options,
                        &mut self.jac,
                        work,
                        &mut self.moved,
                        stats,
                    )
                    .map_err(|e| fail(t, e))?;
                }
                (jacobian_here, factored) = (true, None);
            }
            trial += 1;
            if trial > options.max_steps {
                return Err(IntegrateError::TooManySteps { t, max: options.max_steps });
            }
            let mut outcome = Ok(());
            if factored != Some(step) {
                factored = None;
                outcome = self.factor(step, stats);
                if outcome.is_ok() {
                    factored = Some(step);
                }
            }
            let outcome = match outcome {
                Ok(()) => {
                    self.guess(polynomial.filter(|_| !guess_failed).map(|before| step / before));
                    self.attempt(sys, &span, y, &tolerance, &mut memory, edge || rejected_before, stats)
                }
                Err(e) => Err(e),
            };
            let shrink = match outcome {
                Ok(Attempt::Solved { error, iterations }) if error <= 1.0 => {
                    self.prepare_dense();
                    self.y0.copy_from_slice(y);
                    y.copy_from_slice(&self.y1);
                    for (q, z) in q.iter_mut().zip(&self.z[2 * self.rows + self.n..]) {
                        *q += z;
                    }
                    stats.steps += 1;
                    refusal = None;
                    let view = View { t0: t, t1, y0: &self.y0, y1: &self.y1, dense: &self.dense };
                    let flow = observer(sys, &view);
                    let error = error.max(1e-10);
                    let mut factor = safety(iterations) * error.powf(-0.25);
                    if let Some((h_old, e_old)) = previous {
                        factor = factor.min(0.9 * (step / h_old) * (e_old / (error * error)).powf(0.25));
                    }
                    factor = factor.clamp(0.2, 8.0);
                    if rejected_before {
                        factor = factor.min(1.0);
                    }
                    (rejected_before, guess_failed, edge) = (false, false, false);
                    previous = Some((step, error.max(1e-2)));
                    polynomial = Some(step);
                    (rates_known, jacobian_here) = (false, false);
                    jacobian_usable = memory.rate <= KEEP_JACOBIAN;
                    if jacobian_usable && (1.0..=KEEP_STEP).contains(&factor) {
                        // A factorisation saved is worth more than so little growth.
                        factor = 1.0;
                    }
                    // A step cut short by a stop says little about the next one.
                    h = if cut { h.max(step * factor) } else { step * factor }.min(options.h_max);
                    t = t1;
                    if t >= stop && stop < end {
                        next_break += 1;
                        (previous, polynomial) = (None, None);
                        (edge, jacobian_usable) = (true, false);
                    }
                    if flow == Flow::Stop {
                        return Ok(h);
                    }
                    continue;
                }
                Ok(Attempt::Solved { error, iterations }) if error.is_finite() => {
                    (safety(iterations) * error.powf(-0.25)).clamp(0.1, 0.9)
                }
                Ok(Attempt::Solved { .. }) => 0.25,
                // A Jacobian from elsewhere is the first suspect, the step the second.
                Ok(Attempt::NotConverged { .. }) if !jacobian_here => 1.0,
                Ok(Attempt::NotConverged { factor }) => {
                    guess_failed = true;
                    factor
                }
                Err(e) if e.is_recoverable() => {
                    refusal = Some(e);
                    guess_failed = true;
                    0.25
                }
                Err(e) => return Err(fail(t, e)),
            };
            stats.rejected += 1;
            rejected_before = true;
            memory.contraction = 1.0;
            jacobian_usable = jacobian_here;
            h = step * shrink;
            if h <= options.h_min.max(4.0 * f64::EPSILON * t.abs().max(whole * 1e-6)) {
                return Err(IntegrateError::StepTooSmall { t, h, last: refusal });
            }
        }
        Ok(h)
    }
}

/// Safety factor of the next step: a step that took many iterations should not grow much.
fn safety(iterations: usize) -> f64 {
    let most = 2.0 * ITERATIONS as f64;
    0.9 * ((most + 1.0) / (most + iterations as f64)).min(1.0)
}

/// LU factors of the complex matrix `(re + i im) I - J` with partial pivoting; real and imaginary parts in arrays of their
/// own, which keeps the inner loops free of shuffles.
#[derive(Debug)]
struct ComplexLu {
    n: usize,
    re: Vec<f64>,
    im: Vec<f64>,
    pivot: Vec<usize>,
}

impl ComplexLu {
    fn new(n: usize) -> Self {
        Self { n, re: vec![0.0; n * n], im: vec![0.0; n * n], pivot: vec![0; n] }
    }

    /// Answers whether every column had a usable pivot. Rows of `jac` beyond the first `n` are ignored.
    fn factor(&mut self, jac: &[f64], re: f64, im: f64) -> bool {
        let n = self.n;
        for (l, j) in self.re.iter_mut().zip(jac) {
            *l = -j;
        }
        self.im.fill(0.0);
        for i in 0..n {
            self.re[i * n + i] += re;
            self.im[i * n + i] += im;
        }
        for k in 0..n {
            let (mut best, mut size) = (k, -1.0);
            for i in k..n {
                // Within √2 of the modulus: enough to choose a pivot.
                let candidate = self.re[i * n + k].abs() + self.im[i * n + k].abs();
                if candidate > size {
                    (best, size) = (i, candidate);
                }
            }
            if !(size > 0.0 && size < f64::INFINITY) {
                return false;
            }
            self.pivot[k] = best;
            if best != k {
                for j in 0..n {
                    self.re.swap(k * n + j, best * n + j);
                    self.im.swap(k * n + j, best * n + j);
                }
            }
            let (inv_re, inv_im) = reciprocal(self.re[k * n + k], self.im[k * n + k]);
            let (top_re, low_re) = self.re.split_at_mut((k + 1) * n);
            let (top_im, low_im) = self.im.split_at_mut((k + 1) * n);
            let (pivot_re, pivot_im) = (&top_re[k * n + k + 1..], &top_im[k * n + k + 1..]);
            for (row_re, row_im) in low_re.chunks_exact_mut(n).zip(low_im.chunks_exact_mut(n)) {
                let (a, b) = (row_re[k], row_im[k]);
                if a == 0.0 && b == 0.0 {
                    continue;
                }
                let (l, m) = (a * inv_re - b * inv_im, a * inv_im + b * inv_re);
                (row_re[k], row_im[k]) = (l, m);
                let target = row_re[k + 1..].iter_mut().zip(row_im[k + 1..].iter_mut());
                for ((x, y), (p, q)) in target.zip(pivot_re.iter().zip(pivot_im)) {
                    *x -= l * p - m * q;
                    *y -= l * q + m * p;
                }
            }
        }
        true
    }

    /// Solves in place.
    fn solve(&self, x: &mut [f64], y: &mut [f64]) {
        let n = self.n;
        for k in 0..n {
            x.swap(k, self.pivot[k]);
            y.swap(k, self.pivot[k]);
        }
        let product = |i: usize, from: usize, to: usize, x: &[f64], y: &[f64]| {
            let (mut s, mut u) = (0.0, 0.0);
            let row = self.re[i * n + from..i * n + to].iter().zip(&self.im[i * n + from..i * n + to]);
            for ((a, b), (x, y)) in row.zip(x[from..to].iter().zip(&y[from..to])) {
                s += a * x - b * y;
                u += a * y + b * x;
            }
            (s, u)
        };
        for i in 1..n {
            let (s, u) = product(i, 0, i, x, y);
            x[i] -= s;
            y[i] -= u;
        }
        for i in (0..n).rev() {
            let (s, u) = product(i, i + 1, n, x, y);
            let (a, b) = (x[i] - s, y[i] - u);
            let (p, q) = reciprocal(self.re[i * n + i], self.im[i * n + i]);
            (x[i], y[i]) = (a * p - b * q, a * q + b * p);
        }
    }
}

/// `1/(a + i b)` by Smith's division, which overflows only with its result.
fn reciprocal(a: f64, b: f64) -> (f64, f64) {
    if a.abs() >= b.abs() {
        let r = b / a;
        let d = a + b * r;
        (1.0 / d, -r / d)
    } else {
        let r = a / b;
        let d = a * r + b;
        (r / d, -1.0 / d)
    }
}
