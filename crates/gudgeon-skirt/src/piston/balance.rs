//! Rates at which the forces on a piston are in balance.

use gudgeon_core::EvalError;

use super::equation::Equation;
use super::forces::Piston;
use super::newton::no_resistance;
use crate::body::Instant;
use crate::side::Slopes;

/// Newton steps before the motion towards the balance is followed instead: where films are full, or cavities keep their size, five are enough.
const PATIENCE: usize = 12;
/// Places along a step that are looked at.
const LINE_STEPS: usize = 20;
/// Multiple of [`CLOSED`] at which a balance that no step improves is one.
const ROUNDED: f64 = 1e3;

impl Piston {
    /// Finds the rates at which all forces from coordinate `first` on are in balance, the rates before it being given. `w` holds a guess.
    ///
    /// The films resist motion the more the faster it is. Newton's method on forces that are linear in the rates but for what cavitates ends in a
    /// few steps; where cavities leave nothing that resists, the steps are those of full films. Where it circles, the motion towards the balance
    /// is followed instead.
    ///
    /// # Errors
    /// No balance.
    pub fn balance(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &mut [f64],
        first: usize,
    ) -> Result<(), EvalError> {
        if first == self.n {
            return Ok(());
        }
        self.residual(now, x, w, Slopes::None)?;
        for _ in 0..PATIENCE {
            let before = self.size(first);
            if before <= self.admitted(now, self.closed())? {
                return Ok(());
            }
            self.best[first..].copy_from_slice(&w[first..]);
            self.tangent(now, x, w, Slopes::Film)?;
            if !self.newton(first) || self.along_step(first) <= 0.0 {
                // Where cavities leave nothing that resists, full films tell the way.
                self.tangent(now, x, w, Slopes::Full)?;
                if !self.newton(first) {
                    return Err(no_resistance());
                }
            }
            self.search_line(now, x, w, first, before)?;
            if self.size(first) >= before && before <= ROUNDED * self.admitted(now, self.closed())? {
                // Rounding: no step leads further.
                w[first..].copy_from_slice(&self.best[first..]);
                return self.residual(now, x, w, Slopes::None);
            }
        }
        self.follow(now, &mut Equation::Rates { x }, w, first)
    }

    /// Whether the films, full and between centred surfaces, resist every motion that is not given: those of the edges too unless their velocities are `given`, and
    /// then the elastic shapes.
    ///
    /// # Errors
    /// A film that cannot be solved there.
    pub fn resists(&mut self, now: &Instant, given: bool) -> Result<bool, EvalError> {
        let (x, w) = (vec![0.0; self.n], vec![0.0; self.n]);
        self.place(now, &x)?;
        self.residual(now, &x, &w, Slopes::Full)?;
        Ok(if given { self.slope[..2].iter().any(|s| *s != 0.0) } else { self.newton(0) })
    }

    /// Goes along the step: the forces left over are nearly the slope of a convex potential of the rates, and its lowest place along the step lies
    /// where they no longer point along it.
    fn search_line(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &mut [f64],
        first: usize,
        before: f64,
    ) -> Result<(), EvalError> {
        let ahead = self.along_step(first);
        let (mut low, mut high) = ((0.0, ahead), (f64::INFINITY, 0.0));
        let mut part = 1.0;
        for _ in 0..LINE_STEPS {
            for (k, w) in w[first..].iter_mut().enumerate() {
                *w = self.best[first + k] + part * self.step[k];
            }
            self.residual(now, x, w, Slopes::None)?;
            let here = self.along_step(first);
            if here.abs() <= 0.5 * ahead || self.size(first) <= 0.5 * before {
                break;
            }
            if here > 0.0 {
                low = (part, here);
            } else {
                high = (part, here);
            }
            part = if high.0.is_finite() {
                let straight = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
                // A kink may hold one end where it is.
                straight.clamp(low.0 + 0.1 * (high.0 - low.0), high.0 - 0.1 * (high.0 - low.0))
            } else {
                3.0 * part
            };
        }
        Ok(())
    }
}
