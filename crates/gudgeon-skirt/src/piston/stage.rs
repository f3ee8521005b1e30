//! One implicit stage of a step: the coordinates at its end and their rates, found together.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::{lu_factor, lu_solve};

use super::equation::Equation;
use super::forces::Piston;
use super::newton::no_resistance;
use crate::body::Instant;
use crate::side::Slopes;

/// Newton steps of a stage before the motion towards the balance is followed instead.
const PATIENCE: usize = 10;
/// Fall of Newton's steps from one to the next, below which derivatives with respect to the place serve on.
const SERVES: f64 = 0.2;

/// Fall that is never expected to be quicker.
const LEAST_FALL: f64 = 0.02;

/// Derivatives of the forces left over in the stage solved last.
#[derive(Default)]
pub(super) struct StageWork {
    /// With respect to the coordinates, row after row \[N/m\], and whether they stand for the step under way.
    by_place: Vec<f64>,
    known: bool,
    /// Fall of Newton's steps seen last.
    fall: f64,
    /// With respect to the rates \[N s/m\].
    by_rate: Vec<f64>,
    lu: Vec<f64>,
}

impl StageWork {
    pub(super) fn new(n: usize) -> Self {
        let v = || vec![0.0; n * n];
        Self { by_place: v(), known: false, fall: 1.0, by_rate: v(), lu: v() }
    }
}

impl Piston {
    /// Solves `0 = r(t, x, w)` with `x = from + dt w` for the rates `w` at the instant `now`, to `close` \[m\] in every coordinate; `w` holds a guess, `dt`
    /// counts in seconds. Forces are asked at places and rates together, so a shape under a film that is cut off, which nothing but its own
    /// stiffness holds, is as well determined as one under a full film.
    ///
    /// # Errors
    /// A film that cannot be solved, no convergence.
    pub fn stage(
        &mut self,
        now: &Instant,
        from: &[f64],
        dt: f64,
        close: f64,
        w: &mut [f64],
        x: &mut [f64],
    ) -> Result<(), EvalError> {
        let mut work = std::mem::take(&mut self.stage);
        let found = self.stage_newton(&mut work, now, from, dt, close, w, x);
        self.stage = work;
        if found? {
            return Ok(());
        }
        self.stage.known = false;
        self.follow(now, &mut Equation::Step { from, momentum: None, dt, x }, w, 0)
    }

    /// Newton's method for a stage. Whether it ends in time.
    #[allow(clippy::too_many_arguments, reason = "a stage and its work")]
    fn stage_newton(
        &mut self,
        work: &mut StageWork,
        now: &Instant,
        from: &[f64],
        dt: f64,
        close: f64,
        w: &mut [f64],
        x: &mut [f64],
    ) -> Result<bool, EvalError> {
        let mut before = f64::INFINITY;
        for ((x, from), w) in x.iter_mut().zip(from).zip(&*w) {
            *x = from + dt * w;
        }
        for _ in 0..PATIENCE {
            if work.known {
                self.place_moving(now, x, w)?;
            } else {
                self.place(now, x)?;
            }
            self.residual(now, x, w, Slopes::Film)?;
            work.by_rate.copy_from_slice(&self.slope);
            if !work.known {
                self.by_place(now, x, w, &mut work.by_place)?;
                work.known = true;
            }
            self.slope.iter_mut().zip(&work.by_place).for_each(|(s, p)| *s += dt * p);
            if !self.newton(0) {
                return Ok(false);
            }
            let mut change = 0.0_f64;
            for ((w, x), (s, from)) in w.iter_mut().zip(&mut *x).zip(self.step.iter().zip(from)) {
                *w += s;
                *x = from + dt * *w;
                change = change.max((dt * s).abs());
            }
            let fall = change / before;
            // What is left, as the steps fall; of the first one nothing is known but its size.
            if before.is_finite() {
                work.fall = fall;
            }
            let expected = work.fall.clamp(LEAST_FALL, 1.0);
            if fall < 1.0 && change * expected <= close * (1.0 - expected) {
                return Ok(true);
            }
            work.known = fall < SERVES;
            before = change;
        }
        Ok(false)
    }

    /// Goes to the next step: what was found of the derivatives with respect to the place is forgotten.
    pub fn forget_stages(&mut self) {
        self.stage.known = false;
    }

    /// An error of the coordinates `e` \[m\] as the stage solved last, of the length `dt` \[s\], lets it through: `(R + dt K)⁻¹ R e`, `R` and `K` being the
    /// derivatives of the forces with respect to the rates and to the coordinates. What comes back to rest within `dt` takes no part.
    ///
    /// # Errors
    /// Nothing that resists.
    pub fn let_through(&mut self, dt: f64, e: &mut [f64]) -> Result<(), EvalError> {
        let n = self.n;
        let StageWork { by_place, by_rate, lu, .. } = &mut self.stage;
        for (k, lu) in lu.iter_mut().enumerate() {
            *lu = by_rate[k] + dt * by_place[k];
        }
        for (k, row) in by_rate.chunks_exact(n).enumerate() {
            self.step[k] = row.iter().zip(&*e).map(|(r, e)| r * e).sum();
        }
        lu_factor(lu, n, &mut self.piv).map_err(|_| no_resistance())?;
        lu_solve(lu, n, &self.piv, &mut self.step);
        e.copy_from_slice(&self.step);
        Ok(())
    }
}
