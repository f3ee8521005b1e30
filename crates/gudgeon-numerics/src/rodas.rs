//! Rodas5P and Rodas3: adaptive linearly implicit Rosenbrock methods of orders 5(4) and 3(2).
//!
//! ```text
//! (I/(hγ) - J) u_i = f(t + α_i h, y + Σ_{j<i} a_ij u_j) + Σ_{j<i} C_ij u_j / h + d_i h ∂f/∂t
//! y' = y + Σ m_j u_j,    error estimate: the last u
//! ```

use crate::EvalError;

use crate::linalg::dot;
use crate::ode::{
    ColumnGroups, Core, Flow, IntegrateError, Integrator, Interpolant, OdeSystem, Options, Scheme, Stats,
    StepMatrix, StepView, Trial, add_all, drive, larger,
};

mod tableau;

use tableau::Tableau;

/// A method of the family.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Formula {
    /// Rodas5P: 8 stages, order 5(4).
    #[default]
    Rodas5P,
    /// Rodas3: 4 stages on 3 right-hand sides, order 3(2); cheaper than the other at an error of a thousandth.
    Rodas3,
}

/// A Rosenbrock method, see [`Formula`], and the work arrays for systems of one size.
///
/// One factorisation of `I/(γh) - J` a step and no Newton iteration; L-stable and stiffly accurate. Rodas5P: eight stages, order 5 with
/// an embedded result of order 4, dense output of order 4. Rodas3: four stages, order 3 with one of order 2, dense output of order 2.
/// The Jacobian is evaluated anew in every step, as the order requires.
///
/// Quadratures do not enter the factorisation: with the stages `u_i` of the states, `Δq = h Σ b_i (g_i + J_q u_i + h d_i ∂g/∂t)` is
/// one product with the rows `J_q = ∂g/∂y`, and identical to what the method would give for the whole system.
///
/// Cost of an accepted step: 8 right-hand sides (Rodas3: 3), the Jacobian (one more for each of its column groups, if it is not
/// analytic), one for `∂f/∂t` unless the system gives it, one factorisation and 8 solves (4).
///
/// Order reduction: on `y' = -λ (y - φ(t)) + φ'(t)` with λ from 1e3 to 1e7 and λh ≫ 1 the observed order of Rodas5P is 3.1 to 3.6 (difference
/// quotients in state and time), where classical Rosenbrock methods of this order drop to 2.
///
/// References: `steinebach2023`, `sandu1997`, `hairer1996`.
#[derive(Debug, Clone)]
pub struct Rodas {
    tableau: &'static Tableau,
    core: Core,
    matrix: StepMatrix,
    /// Stages of the states, one after the other.
    u: Vec<f64>,
    /// Rates of the quadratures at the stages, one stage after the other.
    g: Vec<f64>,
    /// Rates at one stage.
    f: Vec<f64>,
    /// A weighted sum of the stages, and quadratures.
    w: Vec<f64>,
    q: Vec<f64>,
}

impl Rodas {
    /// Work arrays for `dim` states and `quad_dim` quadratures. `groups`: columns of a difference Jacobian that share a
    /// right-hand side; `None`: one each.
    #[must_use]
    pub fn new(dim: usize, quad_dim: usize, groups: Option<ColumnGroups>) -> Self {
        Self::with(Formula::default(), dim, quad_dim, groups)
    }

    /// [`Rodas::new`] with a formula of choice.
    #[must_use]
    pub fn with(formula: Formula, dim: usize, quad_dim: usize, groups: Option<ColumnGroups>) -> Self {
        Self::build(formula, dim, quad_dim, groups, false)
    }

    /// For a system of `dim` states without quadratures that solves its linear systems itself ([`OdeSystem::linearise`],
    /// [`OdeSystem::factor`], [`OdeSystem::solve`]): no matrix is kept.
    #[must_use]
    pub fn structured(formula: Formula, dim: usize) -> Self {
        Self::build(formula, dim, 0, None, true)
    }

    fn build(
        formula: Formula,
        dim: usize,
        quad_dim: usize,
        groups: Option<ColumnGroups>,
        structured: bool,
    ) -> Self {
        let tableau = match formula {
            Formula::Rodas5P => &tableau::RODAS5P,
            Formula::Rodas3 => &tableau::RODAS3,
        };
        let stages = tableau.alpha.len();
        Self {
            tableau,
            core: Core::new(dim, quad_dim, groups, structured),
            matrix: StepMatrix::new(if structured { 0 } else { dim }),
            u: vec![0.0; stages * dim],
            g: vec![0.0; stages * quad_dim],
            f: vec![0.0; dim + quad_dim],
            w: vec![0.0; dim],
            q: vec![0.0; quad_dim],
        }
    }

    /// Stage `i` of a step of size `h` from `t`; its point is left in `y_tmp`.
    fn stage<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        i: usize,
        t: f64,
        h: f64,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let (n, nq) = (self.core.n, self.core.m - self.core.n);
        let tableau = self.tableau;
        let (done, rest) = self.u.split_at_mut(i * n);
        let ui = &mut rest[..n];
        if tableau.a[i].iter().all(|a| *a == 0.0) {
            // The start itself.
            ui.copy_from_slice(&self.core.f0[..n]);
            self.g[i * nq..i * nq + nq].copy_from_slice(&self.core.f0[n..]);
        } else {
            let y = &mut self.core.y_tmp[..n];
            if i < tableau.chained {
                y.copy_from_slice(&self.core.x0[..n]);
                add_all(y, 1.0, tableau.a[i], done);
            } else {
                // The point of the stage before, plus that stage.
                for (y, u) in y.iter_mut().zip(&done[(i - 1) * n..i * n]) {
                    *y += u;
                }
            }
            let te = self.core.clamp_time(t + tableau.alpha[i] * h);
            Core::checked_rhs(sys, te, &self.core.y_tmp[..n], &mut self.f, stats)?;
            ui.copy_from_slice(&self.f[..n]);
            self.g[i * nq..i * nq + nq].copy_from_slice(&self.f[n..]);
        }
        add_all(ui, 1.0 / h, tableau.c[i], done);
        let d = tableau.d[i] * h;
        if d != 0.0 {
            ui.iter_mut().zip(&self.core.dfdt).for_each(|(u, f)| *u += d * f);
        }
        self.matrix.solve(&self.core, sys, ui);
        Ok(())
    }

    /// The end of the step in `x1` from its stages, and the error norm.
    fn finish(&mut self, h: f64, opts: &Options) -> f64 {
        let (n, nq) = (self.core.n, self.core.m - self.core.n);
        let tableau = self.tableau;
        // y_tmp is the point of the last stage; adding its stage gives the result.
        let last = (tableau.alpha.len() - 1) * n;
        let mut error = 0.0_f64;
        for i in 0..n {
            self.core.x1[i] = self.core.y_tmp[i] + self.u[last + i];
        }
        for i in 0..n {
            error = larger(error, self.u[last + i] / self.core.scale(opts, i));
        }
        if nq > 0 {
            let (mut w, mut q) = (std::mem::take(&mut self.w), std::mem::take(&mut self.q));
            self.quadratures(tableau.weights, h, &mut w, &mut q);
            for (r, q) in q.iter().enumerate() {
                self.core.x1[n + r] = self.core.x0[n + r] + q;
            }
            if !opts.atol_quad.is_empty() {
                self.quadratures(tableau.weights_error, h, &mut w, &mut q);
                for (r, e) in q.iter().enumerate() {
                    error = larger(error, e / self.core.scale(opts, n + r));
                }
            }
            (self.w, self.q) = (w, q);
        }
        error
    }

    /// `h Σ_i b_i (g_i + J_q u_i + h d_i ∂g/∂t)` of all quadratures for weights `b` of the stage rates; `w` is scratch for `Σ_i b_i u_i`.
    fn quadratures(&self, b: &[f64], h: f64, w: &mut [f64], out: &mut [f64]) {
        let (n, tableau) = (self.core.n, self.tableau);
        w.fill(0.0);
        add_all(w, 1.0, b, &self.u);
        out.fill(0.0);
        add_all(out, 1.0, b, &self.g);
        let time = h * dot(b, tableau.d);
        let rows = self.core.jac[n * n..].chunks_exact(n.max(1)).zip(&self.core.dfdt[n..]);
        for (q, (row, by_time)) in out.iter_mut().zip(rows) {
            *q = h * (*q + dot(row, w) + time * by_time);
        }
    }
}

impl Interpolant for Rodas {
    fn coefficients(&self, h: f64, c: &mut [Vec<f64>; 3]) {
        let (n, tableau) = (self.core.n, self.tableau);
        for (p, c) in c.iter_mut().enumerate() {
            c.resize(self.core.m, 0.0);
            let (states, quads) = c.split_at_mut(n);
            if !quads.is_empty() {
                self.quadratures(tableau.weights_dense[p], h, states, quads);
            }
            states.fill(0.0);
            add_all(states, 1.0, tableau.dense[p], &self.u);
        }
    }
}

impl Scheme for Rodas {
    const GROWTH: f64 = 6.0;
    const RATES: bool = true;
    const JUDGES_QUADRATURES: bool = false;

    fn exponent(&self) -> f64 {
        self.tableau.exponent
    }

    fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    fn tried(&self) -> &Core {
        &self.core
    }

    fn restart(&mut self) -> f64 {
        self.core.jac_current = false;
        1.0
    }

    fn attempt<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<Trial, EvalError> {
        if !self.core.jac_current {
            self.core.linearise(sys, t, h, opts, stats)?;
            self.core.set_weights(opts);
            self.core.jac_current = true;
        }
        stats.lu += 1;
        if !self.matrix.factor(&self.core, sys, 1.0 / (h * self.tableau.gamma)) {
            return Ok(Trial::Retry(0.5));
        }
        for i in 0..self.tableau.alpha.len() {
            self.stage(sys, i, t, h, stats)?;
            stats.solves += 1;
        }
        Ok(Trial::Done { error: self.finish(h, opts) })
    }
}

impl<S: OdeSystem + ?Sized> Integrator<S> for Rodas {
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
