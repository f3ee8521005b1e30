//! Newton's method for small implicit stages, `x = b + s f(x)`, with a Jacobian that is kept from stage to stage.

use crate::EvalError;
use crate::linalg::dot;
use crate::square::{add_outer, invert, times, transposed_times};

/// Most steps of a solution.
const STEPS: usize = 25;
/// A step that is not shorter than this part of the one before asks for a new Jacobian.
const SLOW: f64 = 0.7;
/// Increment of differences, relative.
const INCREMENT: f64 = 1e-5;
/// A shortened step, and the shortest.
const SHORTER: f64 = 0.4;
const SHORTEST: f64 = 1e-2;
/// A step is taken if what remains is smaller than before by this part of it.
const GAIN: f64 = 0.1;
/// Most steps of a solution that led nowhere and are learnt from before the Jacobian is taken anew.
const CHORDS: usize = 6;
/// Part of a change of the residual that the matrix must keep in an update.
const LEAST_TURN: f64 = 0.1;

/// Where a solution is foreseen: what may remain of the accuracy, the longest step over the accuracy after which it is trusted, and in how many solutions in turn a contraction
/// serves. The gas of 800 packs takes 0.88 looks for one; where contractions served on and on, or after any step, rings and gas drifted apart and
/// steps became up to eight times as many.
const REMAINS: f64 = 0.3;
const TRUSTED: f64 = 10.0;
const SERVES: usize = 2;

/// How a solution ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// By a step within the accuracy: the residual was evaluated that near.
    Seen,
    /// By a longer step, after which what remains is foreseen to be within the accuracy.
    Foreseen,
}

/// How much shorter a step was than the one before, and in how many more solutions that serves.
#[derive(Debug, Clone, Copy, Default)]
struct Contraction {
    ratio: f64,
    serves: usize,
}

/// What became of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Taken {
    /// It was taken, in part or as a whole.
    Yes,
    /// It led nowhere, and the matrix has learnt why.
    Learnt,
    /// It led nowhere, and the Jacobian is an old one.
    No,
}

/// The residual of a stage, `x - b - s f(x)`, into the second slice.
pub type Residual<'a> = dyn FnMut(&[f64], &mut [f64]) -> Result<(), EvalError> + 'a;

/// Solves stages of one system by Newton's method with Broyden's updates.
///
/// The matrix `I - s F` is made from the Jacobian `F` of the rates, which outlives changes of the step `s`. It is taken by differences where none is known
/// or where steps do not shrink, and updated from every step (broyden1965, in units of the accuracy): across a root of a flow that goes with the
/// root of a pressure difference, the chord leads back between. Steps that lead nowhere after that are shortened.
#[derive(Debug, Clone, Default)]
pub struct StageNewton {
    /// Jacobian of the rates, row-major.
    by: Vec<f64>,
    /// Whether it is known, whether it was taken at the present point, and whether it was given for the next guess.
    known: bool,
    fresh: bool,
    given: bool,
    /// Whether solutions may be foreseen, and the contraction that was seen last.
    foresees: bool,
    contraction: Contraction,
    /// Step whose matrix is inverted; NaN where the Jacobian is a newer one.
    inverted: f64,
    pivots: Vec<usize>,
    inverse: Vec<f64>,
    /// Residual, that before it, Newton's step; residual of a trial, and the step that would follow it.
    r: Vec<f64>,
    last: Vec<f64>,
    step: Vec<f64>,
    moved: Vec<f64>,
    next: Vec<f64>,
    trial: Vec<f64>,
    /// Work arrays of an inversion and an update.
    row: Vec<f64>,
    way: Vec<f64>,
    surplus: Vec<f64>,
    short: Vec<f64>,
}

impl StageNewton {
    /// Work arrays for `n` unknowns.
    #[must_use]
    pub fn new(n: usize) -> Self {
        let v = || vec![0.0; n];
        let m = || vec![0.0; n * n];
        Self {
            by: m(),
            known: false,
            fresh: false,
            given: false,
            foresees: false,
            contraction: Contraction::default(),
            inverted: f64::NAN,
            pivots: vec![0; n],
            inverse: m(),
            r: v(),
            last: v(),
            step: v(),
            moved: v(),
            next: v(),
            trial: v(),
            row: v(),
            way: v(),
            surplus: v(),
            short: v(),
        }
    }

    /// Forgets the Jacobian, and how solutions contracted.
    pub fn forget(&mut self) {
        self.known = false;
        self.contraction = Contraction::default();
    }

    /// Whether a solution may end a step earlier where the contraction of those before foresees that the next step would be within the accuracy
    /// ([`Ended::Foreseen`]). At first it may not.
    pub fn foresee(&mut self, may: bool) {
        self.foresees = may;
    }

    /// Sets the Jacobian of the rates at the guess of the next stage, for a row and a column.
    pub fn set_jacobian(&mut self, by: impl Fn(usize, usize) -> f64) {
        let n = self.r.len();
        self.by.iter_mut().enumerate().for_each(|(k, entry)| *entry = by(k / n, k % n));
        (self.known, self.given, self.inverted) = (true, true, f64::NAN);
    }

    /// Solves a stage of step `s` for `x`, which comes as a guess, until the next step is smaller than `accuracy` in every unknown. That step is still
    /// taken; the residual was evaluated before it last. How it ended tells how near that was.
    ///
    /// # Errors
    /// Recoverable where no solution is found nearby; those of the residual at the guess.
    pub fn solve(
        &mut self,
        x: &mut [f64],
        s: f64,
        accuracy: &[f64],
        residual: &mut Residual<'_>,
    ) -> Result<Ended, EvalError> {
        residual(x, &mut self.r)?;
        self.fresh = false;
        if self.known {
            self.invert(s)?;
        }
        self.last.fill(0.0);
        let (mut before, mut part, mut taken) = (f64::INFINITY, 1.0, std::mem::take(&mut self.given));
        let mut chords = 0;
        for _ in 0..STEPS {
            if !self.known {
                self.differences(x, s, accuracy, residual)?;
                self.invert(s)?;
                taken = true;
            }
            times(&self.inverse, &self.r, &mut self.step);
            let size = size(&self.step, accuracy);
            let ended = if size <= 1.0 && !self.fresh && (taken || self.is_seen(accuracy)) {
                Some(Ended::Seen)
            } else {
                self.is_foreseen(size).then_some(Ended::Foreseen)
            };
            if let Some(ended) = ended {
                x.iter_mut().zip(&self.step).for_each(|(x, d)| *x -= d);
                return Ok(ended);
            }
            if before.is_finite() && (size > SLOW * before || size <= 1.0) && !self.fresh {
                (self.known, before) = (false, f64::INFINITY);
                continue;
            }
            before = size;
            match self.take(x, size, &mut part, (s, accuracy), chords < CHORDS, residual)? {
                Taken::Yes => {}
                Taken::Learnt => (chords, before) = (chords + 1, f64::INFINITY),
                // The direction may be wrong, not its length.
                Taken::No => (self.known, before) = (false, f64::INFINITY),
            }
        }
        Err(EvalError::recoverable("stage", "Newton's method does not settle"))
    }

    /// Whether every residual is small, or was halved by the last step: a Jacobian of stiffer rates that are gone makes a step look small that is none.
    fn is_seen(&self, accuracy: &[f64]) -> bool {
        let mut all = self.r.iter().zip(&self.last).zip(accuracy);
        all.all(|((r, last), a)| r.abs() <= a.max(0.5 * last.abs()))
    }

    /// Whether the step that follows one of a size over the accuracy is foreseen to be within it.
    fn is_foreseen(&mut self, size: f64) -> bool {
        let Contraction { ratio, serves } = &mut self.contraction;
        let known = self.foresees && !self.fresh && *serves > 0;
        let foreseen = known && (1.0..TRUSTED).contains(&size) && *ratio * size <= REMAINS;
        *serves -= usize::from(foreseen);
        foreseen
    }

    /// Takes a step, or as much of it as leads anywhere.
    fn take(
        &mut self,
        x: &mut [f64],
        size_now: f64,
        part: &mut f64,
        (s, accuracy): (f64, &[f64]),
        learns: bool,
        residual: &mut Residual<'_>,
    ) -> Result<Taken, EvalError> {
        loop {
            let (mut seen, mut ratio) = (false, f64::NAN);
            for ((t, x), d) in self.trial.iter_mut().zip(&*x).zip(&self.step) {
                *t = x - *part * d;
            }
            let better = match residual(&self.trial, &mut self.moved) {
                Ok(()) => {
                    seen = true;
                    times(&self.inverse, &self.moved, &mut self.next);
                    let next = size(&self.next, accuracy);
                    ratio = next / size_now;
                    size_now <= 1.0 || next <= (1.0 - GAIN * *part) * size_now
                }
                Err(e) if e.is_recoverable() => false,
                Err(e) => return Err(e),
            };
            if better {
                self.contraction = Contraction { ratio, serves: if *part == 1.0 { SERVES } else { 0 } };
                self.update(*part, s, accuracy);
                x.copy_from_slice(&self.trial);
                self.last.copy_from_slice(&self.r);
                std::mem::swap(&mut self.r, &mut self.moved);
                *part = (2.0 * *part).min(1.0);
                self.fresh = false;
                return Ok(Taken::Yes);
            }
            if seen && learns {
                self.update(*part, s, accuracy);
                self.fresh = false;
                return Ok(Taken::Learnt);
            }
            if !self.fresh {
                return Ok(Taken::No);
            }
            *part *= SHORTER;
            if *part < SHORTEST {
                return Err(EvalError::recoverable("stage", "there is no solution nearby"));
            }
        }
    }

    /// The Jacobian of the rates at `x`, by differences.
    fn differences(
        &mut self,
        x: &[f64],
        s: f64,
        accuracy: &[f64],
        residual: &mut Residual<'_>,
    ) -> Result<(), EvalError> {
        let n = x.len();
        self.trial.copy_from_slice(x);
        for column in 0..n {
            let d = INCREMENT * x[column].abs() + accuracy[column];
            self.trial[column] = x[column] + d;
            residual(&self.trial, &mut self.moved)?;
            self.trial[column] = x[column];
            for row in 0..n {
                let unit = f64::from(u8::from(row == column));
                self.by[row * n + column] = (unit - (self.moved[row] - self.r[row]) / d) / s;
            }
        }
        (self.known, self.fresh, self.inverted) = (true, true, f64::NAN);
        Ok(())
    }

    /// Inverts the matrix, by Gauss and Jordan's elimination in place, unless it is inverted: both stages of a step have the same, and updates keep it so.
    fn invert(&mut self, s: f64) -> Result<(), EvalError> {
        if self.inverted == s {
            return Ok(());
        }
        let n = self.r.len();
        for (k, (m, by)) in self.inverse.iter_mut().zip(&self.by).enumerate() {
            *m = f64::from(u8::from(k.is_multiple_of(n + 1))) - s * by;
        }
        if invert(&mut self.inverse, &mut self.pivots, &mut self.row) {
            self.inverted = s;
            return Ok(());
        }
        (self.known, self.inverted) = (false, f64::NAN);
        Err(EvalError::recoverable("stage", "the matrix of a stage is singular"))
    }

    /// Broyden's update of inverse and Jacobian after the part `part` of the step was taken, in units of the accuracy.
    fn update(&mut self, part: f64, s: f64, accuracy: &[f64]) {
        let n = self.r.len();
        let way = &mut self.way;
        way.iter_mut().zip(&self.step).zip(accuracy).for_each(|((w, d), a)| *w = -part * d / (a * a));
        let all = -part * dot(&self.step, way);
        let along = dot(way, &self.next) - dot(way, &self.step);
        if !(all > 0.0 && all.is_finite() && along > LEAST_TURN * all) {
            return;
        }
        transposed_times(&self.inverse, way, &mut self.row);
        for k in 0..n {
            self.surplus[k] = -(self.moved[k] - (1.0 - part) * self.r[k]) / (all * s);
            self.short[k] = ((1.0 - part) * self.step[k] - self.next[k]) / along;
        }
        add_outer(&mut self.by, &self.surplus, way);
        add_outer(&mut self.inverse, &self.short, &self.row);
    }
}

/// Largest component over its accuracy.
fn size(step: &[f64], accuracy: &[f64]) -> f64 {
    step.iter()
        .zip(accuracy)
        .map(|(d, a)| (d / a).abs())
        .fold(0.0, |a, b| if b.is_nan() { b } else { a.max(b) })
}
