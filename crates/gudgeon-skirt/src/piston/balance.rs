//! Rates at which the forces on a piston are in balance.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::{lu_factor, lu_solve};

use super::{MODEL, Piston};
use crate::body::Instant;
use crate::side::{Side, Slopes};

/// Newton steps before the motion towards the balance is followed instead: where films are full, or cavities keep their size, five are enough.
const PATIENCE: usize = 12;
/// Steps of that motion before the balance is given up.
const MOST_STEPS: usize = 400;
/// Places along a step that are looked at.
const LINE_STEPS: usize = 20;
/// Newton steps of a step of the backward Euler method before the same.
const EULER_PATIENCE: usize = 15;
/// Part of the forces that it leaves.
const EULER_CLOSED: f64 = 1e-8;
/// Part of the forces that a balance leaves: what the films leave of theirs.
const CLOSED: f64 = 1e-11;
/// The same of films with cavities that are found by iteration.
const CLOSED_CAVITIES: f64 = 1e-7;
/// Part of the forces that is left of a balance which cavities let come slowly.
const SLOW: f64 = 1e-6;
/// The same where cavities are found by iteration: of balances that no shorter step improved, nine in ten stood below 2e-5.
const SLOW_CAVITIES: f64 = 1e-4;
/// Multiple of [`CLOSED`] at which a balance that no step improves is one.
const ROUNDED: f64 = 1e3;
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

/// What [`Piston::follow`] works with.
#[derive(Default)]
pub(super) struct Follow {
    /// Derivatives of the forces of full films.
    full: Vec<f64>,
    lu: Vec<f64>,
    piv: Vec<usize>,
    error: Vec<f64>,
    solved: Vec<f64>,
}

impl Follow {
    pub(super) fn new(n: usize) -> Self {
        let v = |n: usize| vec![0.0; n];
        Self { full: v(n * n), lu: v(n * n), piv: vec![0; n], error: v(n), solved: v(n) }
    }

    /// Sum of the squares of the rates `B^-1 r` that forces `r` on the coordinates from `first` on give to full films.
    fn motion(lu: &[f64], piv: &[usize], solved: &mut [f64], r: &[f64]) -> f64 {
        solved.copy_from_slice(r);
        lu_solve(lu, r.len(), piv, solved);
        solved.iter().map(|s| s * s).sum::<f64>()
    }
}

/// What is wanted of the rates `w`.
enum Equation<'a> {
    /// Forces in balance at the place `x`.
    Rates { x: &'a [f64] },
    /// Forces in balance, with inertia where there are velocities `v` to begin with, at `x = from + dt w`.
    Step { from: &'a [f64], v: Option<[f64; 2]>, dt: f64, x: &'a mut [f64] },
}

fn no_resistance() -> EvalError {
    EvalError::recoverable(MODEL, "nothing resists the motion of the piston")
}

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
            self.tangent(now, w, Slopes::Film)?;
            if !self.newton(first) || self.along_step(first) <= 0.0 {
                // Where cavities leave nothing that resists, full films tell the way.
                self.tangent(now, w, Slopes::Full)?;
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

    /// Whether the films, full and between centred surfaces, resist every motion that is not given: those of the edges too without inertia, and
    /// then the elastic shapes.
    ///
    /// # Errors
    /// A film that cannot be solved there.
    pub fn resists(&mut self, now: &Instant, inertial: bool) -> Result<bool, EvalError> {
        let (x, w) = (vec![0.0; self.n], vec![0.0; self.n]);
        self.place(now, &x)?;
        self.residual(now, &x, &w, Slopes::Full)?;
        Ok(if inertial { self.slope[..2].iter().any(|s| *s != 0.0) } else { self.newton(0) })
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

    /// One step of the backward Euler method from the coordinates `from`, over `dt` \[s\] to the instant `now`; with inertia, from the
    /// velocities `v` of both edges. `w` holds a guess of the rates and takes them; the coordinates are then `from + dt w`, into `x`.
    ///
    /// # Errors
    /// A film that cannot be solved, no convergence.
    pub fn euler_step(
        &mut self,
        now: &Instant,
        from: &[f64],
        v: Option<[f64; 2]>,
        dt: f64,
        w: &mut [f64],
        x: &mut [f64],
    ) -> Result<(), EvalError> {
        let mut equation = Equation::Step { from, v, dt, x };
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

    /// Forces left over at the rates `w`.
    fn forces(&mut self, now: &Instant, equation: &mut Equation<'_>, w: &[f64]) -> Result<(), EvalError> {
        match equation {
            Equation::Rates { x } => self.residual(now, x, w, Slopes::None),
            Equation::Step { from, v, dt, x } => {
                for (k, x) in x.iter_mut().enumerate() {
                    *x = from[k] + *dt * w[k];
                }
                if let Some(v) = v {
                    let mass = self.body.matrix();
                    let a = [(w[0] - v[0]) / *dt, (w[1] - v[1]) / *dt];
                    self.inertia = [0, 1].map(|k| mass[k][0] * a[0] + mass[k][1] * a[1]);
                }
                self.place(now, x)?;
                self.residual(now, x, w, Slopes::None)
            }
        }
    }

    /// Derivatives of the forces that [`Piston::forces`] just found with respect to the rates; of full films those at a place that stays.
    fn forces_slope(
        &mut self,
        now: &Instant,
        equation: &Equation<'_>,
        w: &[f64],
        slopes: Slopes,
    ) -> Result<(), EvalError> {
        self.tangent(now, w, slopes)?;
        let Equation::Step { v, dt, x, .. } = equation else { return Ok(()) };
        let n = self.n;
        if slopes == Slopes::Film {
            self.look_beside(now, x, w)?;
            let mut work = std::mem::take(&mut self.work);
            work.base.copy_from_slice(&self.r);
            for column in 0..n {
                self.change_beside(now, x, w, column, &work.base, &mut work.dr);
                for k in 0..n {
                    self.slope[k * n + column] += dt * work.dr[k];
                }
            }
            self.work = work;
        }
        if v.is_some() {
            let mass = self.body.matrix();
            for (k, row) in mass.iter().enumerate() {
                for (column, m) in row.iter().enumerate() {
                    self.slope[k * n + column] -= m / dt;
                }
            }
        }
        Ok(())
    }

    /// Follows the motion `-B dw/dt = r(w)` to its rest, where the forces left over `r` are in balance; `B`, their derivatives for full films,
    /// is what resists. Every step `(r' + B/pace) s = -r` is an implicit one of length `pace`, as long as its linear forecast of `r` errs by
    /// no more than half of it: pseudo-transient continuation (kelley1998), whose long steps are Newton's.
    ///
    /// A film that is cut off, or whose cavities conserve oil, is not the slope of a potential: Newton's method may circle round a balance, and
    /// no sum of squares need fall on the way to it. But the films take power from every motion, so that this one stays bounded.
    fn follow(
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
        work: &mut Follow,
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
        let Follow { full, lu, piv, error, solved } = work;
        let mut motion = |r: &[f64]| Follow::motion(&lu[..m * m], &piv[..m], &mut solved[..m], r);
        let (mut pace, mut here) = (FIRST_PACE, motion(&self.r[first..]));
        for _ in 0..MOST_STEPS {
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

    /// Part of the forces that a balance leaves.
    fn closed(&self) -> f64 {
        if self.sides.iter().all(Side::is_superposed) { CLOSED } else { CLOSED_CAVITIES }
    }

    /// Size of the forces left over that are none \[N\].
    fn admitted(&self, now: &Instant, part: f64) -> Result<f64, EvalError> {
        if self.r.iter().all(|r| r.is_finite()) {
            Ok(part * self.force_scale(now))
        } else {
            Err(EvalError::recoverable(MODEL, "the forces are not finite"))
        }
    }

    /// Size of the forces left over from coordinate `first` on \[N\].
    fn size(&self, first: usize) -> f64 {
        self.r[first..].iter().map(|r| r * r).sum::<f64>().sqrt()
    }

    /// Forces left over, along the step.
    fn along_step(&self, first: usize) -> f64 {
        self.r[first..].iter().zip(&self.step).map(|(r, s)| r * s).sum()
    }

    /// Newton's step for the forces left over from coordinate `first` on, into `step`. Whether there is one.
    fn newton(&mut self, first: usize) -> bool {
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
