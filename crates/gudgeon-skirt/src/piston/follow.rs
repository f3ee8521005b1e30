//! The motion towards a balance, followed to its rest.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::lu_factor;

use super::MODEL;
use super::equation::Equation;
use super::follow_work::FollowWork;
use super::forces::Piston;
use super::newton::{CLOSED, EULER_CLOSED, no_resistance};
use crate::body::Instant;
use crate::side::Slopes;

/// Steps of that motion before the balance is given up.
const MAX_STEPS: usize = 400;
/// Part of the forces that is left of a balance which cavities let come slowly.
const SLOW: f64 = 1e-6;
/// The same where cavities are found by iteration: of balances that no shorter step improved, nine in ten stood below 2e-5.
const SLOW_CAVITIES: f64 = 1e-4;
/// First step of the motion towards the balance, in times in which full films resist. A step that is too long is told by its error and shortened.
const FIRST_PACE: f64 = 1e3;
/// Part of the forces by which a step of that motion may err.
const ERROR: f64 = 0.5;
/// Steps that are shorter change the forces by less than the films err: they cannot lead further.
const LEAST_PACE: f64 = 1e-3;
/// Factors between one step of it and the next.
const PACES: [f64; 2] = [0.05, 10.0];
/// Factor of a step that is repeated, at most.
const REPEATED: f64 = 0.5;

impl Piston {
    /// Follows the motion `-B dw/dt = r(w)` to its rest, where the forces left over `r` are in balance; `B`, their derivatives for full films,
    /// is what resists. Every step `(r' + B/pace) s = -r` is an implicit one of length `pace`, as long as its linear forecast of `r` errs by
    /// no more than half of it: pseudo-transient continuation (kelley1998), whose long steps are Newton's.
    ///
    /// A film that is cut off, or whose cavities conserve oil, is not the slope of a potential: Newton's method may circle round a balance, and
    /// no sum of squares need fall on the way to it. But the films take power from every motion, so that this one stays bounded.
    pub(super) fn follow(
        &mut self,
        now: &Instant,
        equation: &mut Equation<'_>,
        w: &mut [f64],
        first: usize,
    ) -> Result<(), EvalError> {
        let mut work = std::mem::take(&mut self.follow);
        let outcome = self.follow_with(&mut work, now, equation, w, first);
        self.follow = work;
        outcome
    }

    fn follow_with(
        &mut self,
        work: &mut FollowWork,
        now: &Instant,
        equation: &mut Equation<'_>,
        w: &mut [f64],
        first: usize,
    ) -> Result<(), EvalError> {
        let (n, m) = (self.n, self.n - first);
        let part = match equation {
            Equation::Rates { .. } => self.closed(),
            Equation::Step { .. } => self.closed().max(EULER_CLOSED),
        };
        self.forces(now, equation, w)?;
        self.forces_slope(now, equation, w, Slopes::Full)?;
        work.full.copy_from_slice(&self.slope);
        for k in 0..m * m {
            work.lu[k] = work.full[(first + k / m) * n + first + k % m];
        }
        lu_factor(&mut work.lu[..m * m], m, &mut work.piv[..m]).map_err(|_| no_resistance())?;
        let FollowWork { full, lu, piv, error, solved } = work;
        let mut motion = |r: &[f64]| FollowWork::motion(&lu[..m * m], &piv[..m], &mut solved[..m], r);
        let (mut pace, mut here) = (FIRST_PACE, motion(&self.r[first..]));
        for _ in 0..MAX_STEPS {
            if self.size(first) <= self.admitted(now, part)? {
                return Ok(());
            }
            self.best[first..].copy_from_slice(&w[first..]);
            self.forces_slope(now, equation, w, Slopes::Film)?;
            self.slope.iter_mut().zip(&*full).for_each(|(s, f)| *s += f / pace);
            if !self.newton(first) {
                return Err(no_resistance());
            }
            w[first..].iter_mut().zip(&self.step).for_each(|(w, s)| *w += s);
            let ratio = match self.forces(now, equation, w) {
                Ok(()) => {
                    for i in 0..m {
                        let row = &full[(first + i) * n + first..(first + i + 1) * n];
                        let foretold = -row.iter().zip(&self.step).map(|(f, s)| f * s).sum::<f64>() / pace;
                        error[i] = self.r[first + i] - foretold;
                    }
                    // The error of a short step goes with the square of its length.
                    (ERROR * (here / motion(&error[..m])).sqrt()).sqrt()
                }
                // A step into the liner, or to where no film can be solved.
                Err(e) if e.is_recoverable() => 0.0,
                Err(e) => return Err(e),
            };
            if ratio >= 1.0 {
                here = motion(&self.r[first..]);
                pace *= ratio.min(PACES[1]);
            } else {
                w[first..].copy_from_slice(&self.best[first..]);
                self.forces(now, equation, w)?;
                // What is not a number counts as the largest error.
                pace *= if ratio.is_nan() { PACES[0] } else { ratio.clamp(PACES[0], REPEATED) };
                if pace < LEAST_PACE {
                    break;
                }
            }
        }
        let rest = if part > CLOSED { SLOW_CAVITIES } else { SLOW };
        if self.size(first) <= self.admitted(now, rest)? {
            return Ok(());
        }
        Err(EvalError::recoverable(MODEL, "no velocity was found at which the forces are in balance"))
    }
}
