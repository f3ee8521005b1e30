//! One step of the backward Euler method.

use gudgeon_core::EvalError;

use super::equation::{Equation, Momentum};
use super::forces::Piston;
use super::newton::EULER_CLOSED;
use crate::body::Instant;
use crate::side::Slopes;

/// Newton steps of a step of the backward Euler method before the same.
const EULER_PATIENCE: usize = 15;

impl Piston {
    /// One step of the backward Euler method from the coordinates `from`, over `dt` \[s\] to the instant `now`; with inertia where `momentum` gives
    /// it. `w` holds a guess of the rates and takes them; the coordinates are then `from + dt w`, into `x`.
    ///
    /// # Errors
    /// A film that cannot be solved, no convergence.
    pub fn euler_step(
        &mut self,
        now: &Instant,
        from: &[f64],
        momentum: Option<Momentum>,
        dt: f64,
        w: &mut [f64],
        x: &mut [f64],
    ) -> Result<(), EvalError> {
        let mut equation = Equation::Step { from, momentum, dt, x };
        let outcome = match self.euler_newton(now, &mut equation, w) {
            Ok(false) => self.follow(now, &mut equation, w, 0),
            other => other.map(|_| ()),
        };
        self.inertia = [0.0; 2];
        outcome
    }

    /// Newton's method for a step. Whether it ends in time; if not, the rates are those of the smallest forces left over.
    fn euler_newton(
        &mut self,
        now: &Instant,
        equation: &mut Equation<'_>,
        w: &mut [f64],
    ) -> Result<bool, EvalError> {
        let (mut before, mut least) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..EULER_PATIENCE {
            self.forces(now, equation, w)?;
            let left = self.size(0);
            if left <= self.admitted(now, EULER_CLOSED)? {
                return Ok(true);
            }
            if left < least {
                (least, _) = (left, self.best.copy_from_slice(w));
            }
            // The Jacobian serves as long as the forces fall tenfold.
            if left > 0.1 * before || before.is_infinite() {
                self.forces_slope(now, equation, w, Slopes::Film)?;
            }
            before = left;
            if !self.newton(0) {
                break;
            }
            w.iter_mut().zip(&self.step).for_each(|(w, s)| *w += s);
        }
        w.copy_from_slice(&self.best);
        Ok(false)
    }
}
