//! Rodas5P: adaptive linearly implicit Rosenbrock method of order 5(4).
//!
//! ```text
//! (I/(hγ) - J) u_i = f(t + α_i h, y + Σ_{j<i} a_ij u_j) + Σ_{j<i} C_ij u_j / h + d_i h ∂f/∂t
//! y' = y + Σ m_j u_j,    error estimate u_8
//! ```

use gudgeon_core::EvalError;

use crate::linalg::{dot, lu_factor_weighted, lu_solve};
use crate::ode::{
    ColumnGroups, Core, Flow, IntegrateError, Integrator, OdeSystem, Options, Scheme, Stats, StepView, Trial,
    drive,
};

mod tableau;

const STAGES: usize = 8;

/// The Rosenbrock method Rodas5P of Steinebach (2023), and the work arrays for systems of one size.
///
/// Eight stages with one factorisation of `I/(γh) - J` and no Newton iteration; order 5 with an embedded result of order 4; L-stable and
/// stiffly accurate; dense output of order 4. The Jacobian is evaluated anew in every step, as the order requires.
///
/// Quadratures do not enter the factorisation: with the stages `u_i` of the states, `Δq = h Σ b_i (g_i + J_q u_i + h d_i ∂g/∂t)` is
/// one product with the rows `J_q = ∂g/∂y`, and identical to what the method would give for the whole system.
///
/// Cost of an accepted step: 8 right-hand sides, the Jacobian (one more for each of its column groups, if it is not
/// analytic), one for `∂f/∂t` unless the system gives it, one factorisation and 8 solves.
///
/// Order reduction: on `y' = -λ (y - φ(t)) + φ'(t)` with λ from 1e3 to 1e7 and λh ≫ 1 the observed order is 3.1 to 3.6 (difference
/// quotients in state and time), where classical Rosenbrock methods of this order drop to 2.
///
/// References: `steinebach2023`, `hairer1996`.
#[derive(Debug, Clone)]
pub struct Rodas {
    core: Core,
    lu: Vec<f64>,
    piv: Vec<usize>,
    /// Stages of the states, `STAGES` × n.
    u: Vec<f64>,
    /// Rates of the quadratures at the stages, `STAGES` × quad_dim.
    g: Vec<f64>,
    /// Rates at one stage.
    f: Vec<f64>,
    /// A weighted sum of the stages.
    w: Vec<f64>,
    weight: Vec<f64>,
}

impl Rodas {
    /// Work arrays for `dim` states and `quad_dim` quadratures. `groups`: columns of a difference Jacobian that share a
    /// right-hand side; `None`: one each.
    #[must_use]
    pub fn new(dim: usize, quad_dim: usize, groups: Option<ColumnGroups>) -> Self {
        Self {
            core: Core::new(dim, quad_dim, groups),
            lu: vec![0.0; dim * dim],
            piv: vec![0; dim],
            u: vec![0.0; STAGES * dim],
            g: vec![0.0; STAGES * quad_dim],
            f: vec![0.0; dim + quad_dim],
            w: vec![0.0; dim],
            weight: vec![1.0; dim],
        }
    }

    /// Adds `h Σ_i b_i (g_i + J_q u_i + h d_i ∂g/∂t)` for quadrature `r` and slope weights `b`; `w` holds `Σ_i b_i u_i`.
    fn quadrature(&self, r: usize, b: &[f64; STAGES], h: f64) -> f64 {
        let (n, nq) = (self.core.n, self.core.m - self.core.n);
        let mut s = 0.0;
        let mut time = 0.0;
        for (i, (b, d)) in b.iter().zip(&tableau::D).enumerate() {
            s += b * self.g[i * nq + r];
            time += b * d;
        }
        let row = (n + r) * n;
        h * (s + dot(&self.core.jac[row..row + n], &self.w) + h * time * self.core.dfdt[n + r])
    }

    /// `w = Σ_i b_i u_i`.
    fn combine(&mut self, b: &[f64; STAGES]) {
        let n = self.core.n;
        self.w.fill(0.0);
        for (i, &b) in b.iter().enumerate() {
            for (w, u) in self.w.iter_mut().zip(&self.u[i * n..i * n + n]) {
                *w += b * u;
            }
        }
    }
}

impl Scheme for Rodas {
    const EXPONENT: f64 = 0.2;
    const GROWTH: f64 = 6.0;

    fn core(&mut self) -> &mut Core {
        &mut self.core
    }

    fn restart(&mut self) {
        self.core.jac_current = false;
    }

    fn attempt<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options,
        stats: &mut Stats,
    ) -> Result<Trial, EvalError> {
        let (n, m) = (self.core.n, self.core.m);
        let nq = m - n;
        if !self.core.jac_current {
            self.core.linearise(sys, t, h, opts, true, stats)?;
            self.core.set_weights(opts);
            self.core.jac_current = true;
        }
        for (w, j) in self.lu.iter_mut().zip(&self.core.jac) {
            *w = -j;
        }
        let diagonal = 1.0 / (h * tableau::GAMMA);
        for i in 0..n {
            self.lu[i * n + i] += diagonal;
        }
        stats.lu += 1;
        self.weight.copy_from_slice(&self.core.weight);
        if lu_factor_weighted(&mut self.lu, n, &mut self.piv, Some(&mut self.weight)).is_err() {
            return Ok(Trial::Retry(0.5));
        }
        let inv_h = 1.0 / h;
        for i in 0..STAGES {
            let (done, rest) = self.u.split_at_mut(i * n);
            let ui = &mut rest[..n];
            if i == 0 {
                ui.copy_from_slice(&self.core.f0[..n]);
                self.g[..nq].copy_from_slice(&self.core.f0[n..]);
            } else {
                let y = &mut self.core.y_tmp[..n];
                if i < 6 {
                    y.copy_from_slice(&self.core.x0[..n]);
                    for (j, &a) in tableau::A[i][..i].iter().enumerate() {
                        for (y, u) in y.iter_mut().zip(&done[j * n..j * n + n]) {
                            *y += a * u;
                        }
                    }
                } else {
                    // Stages 7 and 8 start from the point of the stage before, plus that stage: stiff accuracy.
                    for (y, u) in y.iter_mut().zip(&done[(i - 1) * n..i * n]) {
                        *y += u;
                    }
                }
                let te = self.core.clamp_time(t + tableau::ALPHA[i] * h);
                Core::checked_rhs(sys, te, &self.core.y_tmp[..n], &mut self.f, stats)?;
                ui.copy_from_slice(&self.f[..n]);
                self.g[i * nq..i * nq + nq].copy_from_slice(&self.f[n..]);
                for (j, &c) in tableau::C[i][..i].iter().enumerate() {
                    let c = c * inv_h;
                    for (x, u) in ui.iter_mut().zip(&done[j * n..j * n + n]) {
                        *x += c * u;
                    }
                }
            }
            let d = tableau::D[i] * h;
            if d != 0.0 {
                for (x, ft) in ui.iter_mut().zip(&self.core.dfdt) {
                    *x += d * ft;
                }
            }
            lu_solve(&self.lu, n, &self.piv, ui);
            stats.solves += 1;
        }
        // y_tmp is the point of stage 8; adding its stage gives the result.
        let last = (STAGES - 1) * n;
        let mut error = 0.0_f64;
        for i in 0..n {
            self.core.x1[i] = self.core.y_tmp[i] + self.u[last + i];
        }
        for i in 0..n {
            error = worst(error, self.u[last + i] / self.core.scale(opts, i));
        }
        if nq > 0 {
            self.combine(&tableau::B);
            for r in 0..nq {
                self.core.x1[n + r] = self.core.x0[n + r] + self.quadrature(r, &tableau::B, h);
            }
            if !opts.atol_quad.is_empty() {
                self.combine(&tableau::E);
                for r in 0..nq {
                    let e = self.quadrature(r, &tableau::E, h);
                    error = worst(error, e / self.core.scale(opts, n + r));
                }
            }
        }
        Ok(Trial::Done { error, safety: 0.9 })
    }

    fn dense(&mut self, h: f64) {
        let (n, nq) = (self.core.n, self.core.m - self.core.n);
        for p in 0..3 {
            let mut out = std::mem::take(&mut self.core.cont[p]);
            out[..n].fill(0.0);
            for (i, &w) in tableau::H[p].iter().enumerate() {
                for (c, u) in out[..n].iter_mut().zip(&self.u[i * n..i * n + n]) {
                    *c += w * u;
                }
            }
            if nq > 0 {
                self.combine(&tableau::HK[p]);
                for r in 0..nq {
                    out[n + r] = self.quadrature(r, &tableau::HK[p], h);
                }
            }
            self.core.cont[p] = out;
        }
    }

    fn accepted(&mut self, _h: f64) -> bool {
        false
    }
}

/// Largest magnitude; a NaN wins.
pub(crate) fn worst(a: f64, b: f64) -> f64 {
    let b = b.abs();
    if b > a || b.is_nan() { b } else { a }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// y' = -y² sin-forced and coupled: smooth, nonlinear, non-autonomous, with a known solution.
    struct Smooth;
    impl OdeSystem for Smooth {
        fn dim(&self) -> usize {
            2
        }
        fn quad_dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            // Solution y0 = e^{sin t}, y1 = cos t + 2.
            f[0] = (y[1] - 2.0) * y[0];
            f[1] = -t.sin() + (y[0] - t.sin().exp());
            f[2] = y[0];
            Ok(())
        }
    }

    fn solve(h: f64, t: f64, dense: Option<f64>) -> [f64; 2] {
        // A huge tolerance and a fixed largest step: constant steps.
        let mut o = Options::new(1e3, &[1.0, 1.0]);
        (o.h_max, o.h_init) = (h, h);
        let (mut y, mut q) = ([1.0, 3.0], [0.0]);
        let mut r = Rodas::new(2, 1, None);
        let mut worst: f64 = 0.0;
        let mut out = [0.0; 2];
        let result = r.integrate(
            &mut Smooth,
            (0.0, t),
            &[],
            &mut y,
            &mut q,
            &o,
            &mut Stats::default(),
            &mut |_, v| {
                if let Some(x) = dense {
                    let t = v.t0() + x * (v.t1() - v.t0());
                    v.interpolate(t, &mut out);
                    worst = worst.max((out[0] - t.sin().exp()).abs());
                }
                Flow::Continue
            },
        );
        assert!(result.is_ok());
        [(y[0] - t.sin().exp()).abs(), worst]
    }

    #[test]
    fn order_five_and_dense_order_four() {
        let (a, b) = (solve(0.1, 2.0, None)[0], solve(0.05, 2.0, None)[0]);
        let order = (a / b).log2();
        // Order 5; the difference Jacobian and the next error term move the observed value by a few tenths.
        assert!((4.6..5.7).contains(&order), "{order}");
        let (a, b) = (solve(0.1, 2.0, Some(0.37))[1], solve(0.05, 2.0, Some(0.37))[1]);
        // Global order 4 of the interpolant.
        assert!((3.7..5.5).contains(&(a / b).log2()), "{}", (a / b).log2());
    }

    /// A stiff exchange between two vessels, one of them tiny, and the outside: a linear invariant of states and quadratures.
    struct Vessels {
        exact: bool,
    }
    impl OdeSystem for Vessels {
        fn dim(&self) -> usize {
            2
        }
        fn quad_dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            let a = 1e6 * (y[0] - 1e4 * y[1]) * (1.0 + (3.0 * t).sin().abs());
            let b = y[0] * y[0].abs();
            (f[0], f[1], f[2]) = (-a - b, a, b);
            Ok(())
        }
        fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
            let r = 1e6 * (1.0 + (3.0 * t).sin().abs());
            let b = 2.0 * y[0].abs();
            jac.copy_from_slice(&[-r - b, 1e4 * r, r, -1e4 * r, b, 0.0]);
            Ok(self.exact)
        }
    }

    #[test]
    fn linear_invariants_hold_at_a_loose_tolerance() {
        // With an exact Jacobian the defect is round-off amplified by the solves (condition number about 1e4). A difference
        // Jacobian satisfies the invariant only to eps |f| / increment, 1e-16 * 1e6 / 1e-12 of entries of 1e10.
        for (exact, bound) in [(true, 1e-12), (false, 1e-9)] {
            let (mut y, mut q) = ([1.0, 2e-4], [0.0]);
            let o = Options::new(1e-2, &[1.0, 1e-4]);
            let mut stats = Stats::default();
            let r = Rodas::new(2, 1, None).integrate(
                &mut Vessels { exact },
                (0.0, 10.0),
                &[],
                &mut y,
                &mut q,
                &o,
                &mut stats,
                &mut |_, _| Flow::Continue,
            );
            assert!(r.is_ok());
            let defect = (y[0] + y[1] + q[0] - 1.0002).abs();
            assert!(defect < bound, "{defect:e}");
            // An L-stable method does not follow the fast exchange.
            assert!(stats.steps < 200, "{stats:?}");
        }
    }

    struct Robertson;
    impl OdeSystem for Robertson {
        fn dim(&self) -> usize {
            3
        }
        fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            let (a, b, c) = (0.04 * y[0], 1e4 * y[1] * y[2], 3e7 * y[1] * y[1]);
            (f[0], f[1], f[2]) = (-a + b, a - b - c, c);
            Ok(())
        }
    }

    #[test]
    fn robertson_at_40() {
        let mut y = [1.0, 0.0, 0.0];
        let o = Options::new(1e-7, &[1.0, 1e-5, 1.0]);
        let r = Rodas::new(3, 0, None).integrate(
            &mut Robertson,
            (0.0, 40.0),
            &[],
            &mut y,
            &mut [],
            &o,
            &mut Stats::default(),
            &mut |_, _| Flow::Continue,
        );
        assert!(r.is_ok());
        // Independent 18-digit solution; the global error may exceed the tolerance per step by the number of steps' share.
        for (y, exact) in
            y.iter().zip([0.715_827_068_719_405, 9.185_534_764_557_764e-6, 0.284_163_745_745_830_36])
        {
            assert!((y / exact - 1.0).abs() < 1e-6, "{y} {exact}");
        }
    }

    /// Refuses negative states, which a large first step produces.
    struct Refusing;
    impl OdeSystem for Refusing {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
            if y[0] < 0.0 {
                return Err(EvalError::recoverable("test", "negative"));
            }
            if t > 2.0 {
                return Err(EvalError::fatal("test", "beyond 2"));
            }
            f[0] = -50.0 * y[0].sqrt();
            Ok(())
        }
    }

    #[test]
    fn refusals_shrink_the_step_and_fatal_ones_stop() {
        let mut o = Options::new(1e-3, &[1.0]);
        o.h_init = 0.3;
        let mut stats = Stats::default();
        let mut y = [100.0];
        let mut r = Rodas::new(1, 0, None);
        let ok =
            r.integrate(&mut Refusing, (0.0, 0.35), &[], &mut y, &mut [], &o, &mut stats, &mut |_, _| {
                Flow::Continue
            });
        // sqrt(y) falls linearly: y(0.35) = (10 - 25 * 0.35)².
        assert!(ok.is_ok() && (y[0] - 1.5625).abs() < 1e-2, "{ok:?} {y:?}");
        let mut y = [1e6];
        let end =
            r.integrate(&mut Refusing, (0.0, 3.0), &[], &mut y, &mut [], &o, &mut stats, &mut |_, _| {
                Flow::Continue
            });
        assert!(matches!(end, Err(IntegrateError::Eval { .. })), "{end:?}");
    }

    #[test]
    fn stops_exactly_at_breakpoints() {
        let mut seen = Vec::new();
        let (mut y, mut q) = ([1.0, 3.0], [0.0]);
        let o = Options::new(1e-3, &[1.0, 1.0]);
        let r = Rodas::new(2, 1, None).integrate(
            &mut Smooth,
            (0.0, 2.0),
            &[0.0, 0.5, 1.25, 2.0],
            &mut y,
            &mut q,
            &o,
            &mut Stats::default(),
            &mut |_, v| {
                seen.push(v.t1());
                Flow::Continue
            },
        );
        assert!(r.is_ok());
        assert!([0.5, 1.25, 2.0].iter().all(|b| seen.contains(b)), "{seen:?}");
    }
}
