//! What every integrator offers: steps with dense output, handed to an observer.

use super::options::{IntegrateError, Options, Stats};
use super::system::OdeSystem;

/// An accepted step (or a piece of one between two events) with its dense output.
pub trait StepView {
    /// Start of the step.
    fn t0(&self) -> f64;
    /// End of the step.
    fn t1(&self) -> f64;
    /// State at the start.
    fn y0(&self) -> &[f64];
    /// State at the end, before an event changes it.
    fn y1(&self) -> &[f64];
    /// State at `t` inside the step.
    fn interpolate(&self, t: f64, y: &mut [f64]);
    /// Quadratures at the start; empty when there are none.
    fn q0(&self) -> &[f64] {
        &[]
    }
    /// Quadratures at the end; empty when there are none.
    fn q1(&self) -> &[f64] {
        &[]
    }
    /// The first quadratures at `t` inside the step, as many as `q` holds, as accurate as the states; the default joins the ends by a straight line.
    fn interpolate_quad(&self, t: f64, q: &mut [f64]) {
        let x = (t - self.t0()) / (self.t1() - self.t0());
        for ((q, a), b) in q.iter_mut().zip(self.q0()).zip(self.q1()) {
            *q = a + x * (b - a);
        }
    }
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
    #[allow(
        clippy::too_many_arguments,
        reason = "an interval, a state, its quadratures and the settings belong together"
    )]
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

    /// [`Integrator::integrate`] of a system without quadratures, without breakpoints and without an observer. Returns the work.
    ///
    /// # Errors
    /// [`IntegrateError`]; `y` then holds the last accepted state.
    fn solve(
        &mut self,
        sys: &mut S,
        interval: (f64, f64),
        y: &mut [f64],
        options: &Options,
    ) -> Result<Stats, IntegrateError> {
        let mut stats = Stats::default();
        self.integrate(sys, interval, &[], y, &mut [], options, &mut stats, &mut |_, _| Flow::Continue)?;
        Ok(stats)
    }
}
