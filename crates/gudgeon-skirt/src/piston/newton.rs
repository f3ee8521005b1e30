//! Newton's step towards a balance, and when forces are in balance.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::{lu_factor, lu_solve};

use super::MODEL;
use super::forces::Piston;
use crate::body::Instant;
use crate::side::Side;

/// Part of the forces that a balance leaves: what the films leave of theirs.
pub(super) const CLOSED: f64 = 1e-11;
/// The same of a step of the backward Euler method.
pub(super) const EULER_CLOSED: f64 = 1e-8;
/// The same of films with cavities that are found by iteration.
const CLOSED_CAVITIES: f64 = 1e-7;

pub(super) fn no_resistance() -> EvalError {
    let what = "nothing resists the motion of the piston, as in a gap that is not full: `full_inertia` is the motion that needs nothing that does";
    EvalError::recoverable(MODEL, what)
}

impl Piston {
    /// Part of the forces that a balance leaves.
    pub(super) fn closed(&self) -> f64 {
        if self.sides.iter().all(Side::is_superposed) { CLOSED } else { CLOSED_CAVITIES }
    }

    /// Size of the forces left over that are none \[N\].
    pub(super) fn admitted(&self, now: &Instant, part: f64) -> Result<f64, EvalError> {
        if self.r.iter().all(|r| r.is_finite()) {
            Ok(part * self.force_scale(now))
        } else {
            Err(EvalError::recoverable(MODEL, "the forces are not finite"))
        }
    }

    /// Size of the forces left over from coordinate `first` on \[N\].
    pub(super) fn size(&self, first: usize) -> f64 {
        self.r[first..].iter().map(|r| r * r).sum::<f64>().sqrt()
    }

    /// Forces left over, along the step.
    pub(super) fn along_step(&self, first: usize) -> f64 {
        self.r[first..].iter().zip(&self.step).map(|(r, s)| r * s).sum()
    }

    /// Newton's step for the forces left over from coordinate `first` on, into `step`. Whether there is one.
    pub(super) fn newton(&mut self, first: usize) -> bool {
        let (n, m) = (self.n, self.n - first);
        self.newton_steps += 1;
        for i in 0..m {
            self.step[i] = -self.r[first + i];
            for j in 0..m {
                self.lu[i * m + j] = self.slope[(first + i) * n + first + j];
            }
        }
        if lu_factor(&mut self.lu[..m * m], m, &mut self.piv[..m]).is_err() {
            return false;
        }
        lu_solve(&self.lu[..m * m], m, &self.piv[..m], &mut self.step[..m]);
        self.step[..m].iter().all(|s| s.is_finite())
    }
}
