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

mod coefficients;
mod method;
mod newton;
mod run;
mod tolerance;

use crate::ode::{
    ColumnGroups, Flow, IntegrateError, Integrator, OdeSystem, Options, Shape, Stats, StepView, check,
};
pub(crate) use coefficients::{C, SQRT_6};
use method::Method;
use run::Run;

/// The integrator with its work arrays. Allocates only when made.
///
/// In [`Stats`] a real and a complex factorisation, always done together, count as one, and so do the solves of an iteration.
#[derive(Debug)]
pub struct Radau5(Method);

impl Radau5 {
    /// For `dim` states and `quad_dim` quadratures. `groups`: columns of a difference Jacobian that share a right-hand side; `None`: one
    /// each.
    #[must_use]
    pub fn new(dim: usize, quad_dim: usize, groups: Option<ColumnGroups>) -> Self {
        Self(Method::new(dim, quad_dim, groups))
    }

    /// Multiplies the tolerance of the Newton iteration by `factor` (above 0; 1 unless called). Smaller factors carry the iteration closer
    /// to the solution of the collocation equations, down to the rounding of the right-hand side: a step is then that of the exact method
    /// whatever [`Options::rtol`] is.
    #[must_use]
    pub fn with_newton_factor(mut self, factor: f64) -> Self {
        self.0.newton = factor;
        self
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
        let method = &mut self.0;
        let (n, quad) = (method.n, method.rows - method.n);
        check(&Shape { n, quad, groups: method.groups.as_ref() }, sys, interval, breakpoints, y, q, options)?;
        Run::new(method, sys, interval, breakpoints, y, q, options, stats).finish(observer)
    }
}
