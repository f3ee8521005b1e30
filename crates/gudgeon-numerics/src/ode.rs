//! What an initial-value problem is, and what every integrator of this crate shares.

use gudgeon_core::EvalError;

/// Columns of the Jacobian that one difference quotient can serve together: no row depends on two columns of a group.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ColumnGroups {
    /// Groups of columns.
    pub groups: Vec<Vec<usize>>,
    /// For every column the rows (states, then quadratures) it may touch.
    pub rows: Vec<Vec<usize>>,
}

/// An initial-value problem `y' = f(t, y)` with quadratures `q' = g(t, y)` that feed nothing back.
pub trait OdeSystem {
    /// Number of states.
    fn dim(&self) -> usize;

    /// Number of quadratures. They are integrated with the same method, so that every linear invariant over states and
    /// quadratures holds to round-off.
    fn quad_dim(&self) -> usize {
        0
    }

    /// Rates: `f[..dim]` of the states, `f[dim..]` of the quadratures.
    ///
    /// # Errors
    /// Recoverable: the integrator retries with a smaller step. Fatal: it stops.
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError>;

    /// Jacobian `∂f/∂y`, row-major `(dim + quad_dim) × dim`. `Ok(false)`: the integrator differences `rhs`.
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn jacobian(&mut self, _t: f64, _y: &[f64], _f: &[f64], _jac: &mut [f64]) -> Result<bool, EvalError> {
        Ok(false)
    }
}

/// Accuracy and limits of an integration.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Relative error per step.
    pub rtol: f64,
    /// Absolute error per step, one per state.
    pub atol: Vec<f64>,
    /// First step; 0 lets the integrator choose.
    pub h_init: f64,
    /// Largest step.
    pub h_max: f64,
    /// Smallest step.
    pub h_min: f64,
    /// Most steps, rejected ones included.
    pub max_steps: u64,
}

impl Options {
    /// Relative tolerance `rtol`, absolute `rtol * scale`.
    #[must_use]
    pub fn new(rtol: f64, scale: &[f64]) -> Self {
        Self {
            rtol,
            atol: scale.iter().map(|s| s * rtol).collect(),
            h_init: 0.0,
            h_max: f64::INFINITY,
            h_min: 0.0,
            max_steps: 2_000_000,
        }
    }
}

/// Work of an integration.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Stats {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Right-hand sides, those for Jacobians included.
    pub rhs: u64,
    /// Jacobians.
    pub jacobians: u64,
    /// Factorisations.
    pub lu: u64,
    /// Triangular solves.
    pub solves: u64,
}

impl Stats {
    /// Adds the work of another integration.
    pub fn add(&mut self, o: &Self) {
        self.steps += o.steps;
        self.rejected += o.rejected;
        self.rhs += o.rhs;
        self.jacobians += o.jacobians;
        self.lu += o.lu;
        self.solves += o.solves;
    }
}

/// Why an integration ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntegrateError {
    /// The right-hand side refused.
    #[error("at {t}: {source}")]
    Eval {
        /// Where.
        t: f64,
        /// What it said.
        source: EvalError,
    },
    /// The step would have to be smaller than allowed.
    #[error("at {t} the step would have to be smaller than {h:e}{}", .last.as_ref().map(|e| format!(" ({e})")).unwrap_or_default())]
    StepTooSmall {
        /// Where.
        t: f64,
        /// The step.
        h: f64,
        /// The last refusal of the right-hand side, when that was the cause.
        last: Option<EvalError>,
    },
    /// More steps than allowed.
    #[error("more than {max} steps, stopped at {t}")]
    TooManySteps {
        /// Where.
        t: f64,
        /// The limit.
        max: u64,
    },
}

/// An accepted step with its dense output.
pub trait StepView {
    /// Start of the step.
    fn t0(&self) -> f64;
    /// End of the step.
    fn t1(&self) -> f64;
    /// State at the start.
    fn y0(&self) -> &[f64];
    /// State at the end.
    fn y1(&self) -> &[f64];
    /// State at `t` inside the step.
    fn interpolate(&self, t: f64, y: &mut [f64]);
}

/// Whether to go on after a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop here.
    Stop,
}

/// An integrator with its work arrays.
pub trait Integrator<S: OdeSystem + ?Sized> {
    /// Integrates from `t0` to `t1`, stopping exactly at every one of `breakpoints` (ascending) where the right-hand side has a
    /// kink, and calls `observer` after every accepted step. `y` and `q` are advanced in place. Returns the last step size
    /// that was not cut by an end, a good first step for what follows.
    ///
    /// # Errors
    /// [`IntegrateError`]; `y` and `q` then hold the last accepted state.
    #[allow(clippy::too_many_arguments, reason = "an interval, a state, its quadratures and the settings belong together")]
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
    ) -> Result<f64, IntegrateError>;
}

/// Increment for a difference quotient in state `y` of absolute tolerance `atol` at relative tolerance `rtol`.
pub(crate) fn increment(y: f64, atol: f64, rtol: f64) -> f64 {
    let scale = y.abs().max(atol / rtol * 1e-3).max(1e-30);
    let d = 1.5e-8 * scale;
    // The difference that is actually applied, free of rounding.
    (y + d) - y
}

/// Jacobian by differences, in groups where these are given. `y` is perturbed and restored; `work` has room for one `f`,
/// `base` for one `y`.
#[allow(clippy::too_many_arguments, reason = "scratch is passed in so that nothing is allocated")]
pub(crate) fn difference<S: OdeSystem + ?Sized>(
    sys: &mut S,
    groups: Option<&ColumnGroups>,
    t: f64,
    y: &[f64],
    f: &[f64],
    options: &Options,
    jac: &mut [f64],
    work: &mut [f64],
    moved: &mut [f64],
    stats: &mut Stats,
) -> Result<(), EvalError> {
    let n = y.len();
    let step = |j: usize| increment(y[j], options.atol[j], options.rtol);
    moved.copy_from_slice(y);
    match groups {
        None => {
            for j in 0..n {
                let d = step(j);
                moved[j] = y[j] + d;
                stats.rhs += 1;
                sys.rhs(t, moved, work)?;
                moved[j] = y[j];
                for (i, (w, f)) in work.iter().zip(f).enumerate() {
                    jac[i * n + j] = (w - f) / d;
                }
            }
        }
        Some(c) => {
            jac.fill(0.0);
            for group in &c.groups {
                for &j in group {
                    moved[j] = y[j] + step(j);
                }
                stats.rhs += 1;
                sys.rhs(t, moved, work)?;
                for &j in group {
                    moved[j] = y[j];
                    let d = step(j);
                    for &i in &c.rows[j] {
                        jac[i * n + j] = (work[i] - f[i]) / d;
                    }
                }
            }
        }
    }
    Ok(())
}
