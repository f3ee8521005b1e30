//! A stage of an implicit step: film thickness and velocity at once.
//!
//! Within a stage the velocity follows from the thickness, `v = h (x - x_b)/(step · s)` with `x = ln h` and `s` seconds per radian, so the radial balance is one
//! equation in `x`. Film and contact carry less the further the ring is away and the faster it goes there: the balance rises with `x`, and every
//! trial costs one film. Where a limit acts, the velocity is searched for at every trial.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::{FaceForces, Limited, RadialResponse, RadialState, RadialTrials};
use gudgeon_core::states::Stage;
use gudgeon_numerics::elementary;
use gudgeon_numerics::roots::{Found, Known, RootError, first_root};

use super::search::{Needed, Resisted, Search};

/// Longest step of a trial in `ln h`.
const REACH: f64 = 1.0;

/// Film thicknesses \[m\] between which trials stay: no groove is deeper, and nothing is thinner.
const THICKNESSES: std::ops::Range<f64> = 1e-26..0.1;

/// Largest square of a velocity off the liner over its cap: what the cap leaves of a hundred times the cap.
const NEAR_CAP: f64 = 0.9999;

/// The film thickness \[m\] of a trial.
fn thickness(x: f64) -> Result<f64, EvalError> {
    let h = elementary::exp(x);
    if THICKNESSES.contains(&h) {
        Ok(h)
    } else {
        Err(EvalError::recoverable("radial_motion", "a trial left the range of films"))
    }
}

/// What a stage is solved with.
pub struct Staged<'a> {
    pub search: Search<'a>,
    /// Seconds per radian.
    pub per: f64,
    /// What is known from the last stage.
    pub before: Before,
}

/// What is known from the last stage.
#[derive(Debug, Clone, Copy, Default)]
pub struct Before {
    /// Derivative of the balance by `x` beyond that through the velocity.
    pub rest: Option<f64>,
    /// Whether the ring was off the liner, where its drag counts.
    pub off: bool,
}

/// What a thickness leads to.
pub struct Trial {
    /// The balance, over the tension, and its derivative by `x` through the velocity alone; off the liner the way in `x` beyond the one that the ring comes.
    pub lacks: f64,
    pub slope: f64,
    pub response: RadialResponse,
    pub film: FaceForces,
    /// Whether an end of the way would change the velocity, or a drag that is left out.
    pub is_limited: bool,
}

/// Answer of a stage.
pub struct Answer {
    pub response: RadialResponse,
    pub film: FaceForces,
    pub known: Before,
}

impl Staged<'_> {
    /// Solves the stage for `x`, which comes as a guess.
    pub fn solve(
        &mut self,
        stage: &Stage<'_>,
        x: &mut f64,
        loads: &mut dyn RadialTrials,
    ) -> Result<Answer, EvalError> {
        // What the stages before have sent below the floor stands on it.
        let lowest = loads.state().lowest.0;
        let base = if lowest > 0.0 { stage.base[0].max(elementary::ln(lowest)) } else { stage.base[0] };
        let stage = &Stage { base: &[base], ..*stage };
        if let Some(answer) = self.free(stage, x, loads)? {
            return Ok(answer);
        }
        if !self.before.off && self.search.is_off(loads.state()) {
            self.before = Before { off: true, rest: None };
            if let Some(answer) = self.free(stage, x, loads)? {
                return Ok(answer);
            }
        }
        let found = self.limited(stage, *x, loads)?;
        // Nor is what was found below the floor within the accuracy.
        *x = if lowest > 0.0 { found.x.max(elementary::ln(lowest)) } else { found.x };
        loads.set_thickness(thickness(*x)?)?;
        let response = self.search.rate(loads)?;
        let film = response.film.map_or_else(|| loads.film(response.hdot), Ok)?;
        let known = Before { rest: None, off: response.limited.drag > 0.0 };
        Ok(Answer { response, film, known })
    }

    /// The stage without limits but the drag of a ring off the liner, where that counts; none where another would act.
    fn free(
        &self,
        stage: &Stage<'_>,
        x: &mut f64,
        loads: &mut dyn RadialTrials,
    ) -> Result<Option<Answer>, EvalError> {
        if !loads.state().resists {
            return Ok(None);
        }
        let mut last = None;
        let balance = |x: f64| -> Result<(f64, f64), EvalError> {
            let trial = last.insert(self.trial(stage, x, loads)?);
            Ok((trial.lacks, trial.slope))
        };
        let known = Known {
            from: stage.base[0],
            guess: *x,
            rest: self.before.rest,
            reach: REACH,
            tol: stage.accuracy[0],
        };
        let found = match first_root(balance, known) {
            Ok(found) => found,
            Err(RootError::Function(e)) if !e.is_recoverable() => return Err(e),
            Err(_) => return Ok(None),
        };
        let Some(Trial { response, film, is_limited: false, .. }) = last else { return Ok(None) };
        *x = found.x;
        // It stays what it is until the ring is back: with a drag the balance has another slope.
        let off = self.before.off && self.search.is_off(loads.state());
        let rest = found.rest.filter(|_| off == self.before.off);
        let known = Before { rest, off };
        Ok(Some(Answer { response, film, known }))
    }

    /// A trial at `x` without limits but the drag of a ring off the liner.
    pub fn trial(&self, stage: &Stage<'_>, x: f64, loads: &mut dyn RadialTrials) -> Result<Trial, EvalError> {
        let per = stage.step * self.per;
        let h = thickness(x)?;
        loads.set_thickness(h)?;
        let way = x - stage.base[0];
        let hdot = h * way / per;
        // The velocity that the cap on it turns into this one.
        let most = if self.before.off { NEAR_CAP } else { 1.0 - 1e-12 };
        let part = (1.0 - (hdot / self.search.limits.radial_speed).powi(2).min(most)).sqrt();
        let free = hdot / part;
        let needed = Needed::of(loads.state(), self.search.limits.min_load);
        let film = loads.film(free)?;
        let off = if self.before.off { self.search.drag_at(loads, needed, (free, &film))? } else { 0.0 };
        let at = loads.state();
        let parting = if free > 0.0 { self.search.contact_drag(at) } else { 0.0 };
        let (friction, slope) = loads.friction(free);
        let resisted = Resisted { force: friction + (parting + off) * free, slope: slope + parting + off };
        let mut limited = Limited::default();
        (limited.lifted, limited.contact_drag) = (needed.lifted(&resisted), parting * free);
        if off > 0.0 {
            (limited.drag, limited.slowed) = (off * free.abs(), 1.0 - part);
        }
        let (lacks, slope) = if self.before.off {
            // A film that hardly resists balances at velocities that differ by orders: how far the ring comes by the one that follows from here.
            let follows = self.search.capped(needed.velocity(free, &film, &resisted));
            (way - per * follows / h, 0.0)
        } else {
            let slope = (film.squeeze_damping + resisted.slope) * h / (per * at.tension);
            (needed.lacks(film.load, &resisted) / at.tension, slope)
        };
        let left_out = !self.before.off && self.search.drag(at, free, needed.size()) > 0.0;
        let is_limited = left_out || self.is_near_an_end(at, hdot);
        Ok(Trial { lacks, slope, response: RadialResponse::new(hdot, Some(film), limited), film, is_limited })
    }

    /// Whether an end of the way would change the velocity.
    fn is_near_an_end(&self, at: &RadialState, hdot: f64) -> bool {
        let (lowest, band) = at.lowest;
        let near = if hdot > 0.0 {
            at.furthest - at.thickness < self.search.limits.retreat_band * at.furthest
        } else {
            lowest > 0.0 && at.thickness - lowest < band * lowest
        };
        near || at.thickness <= lowest
    }

    /// The stage with limits.
    fn limited(
        &mut self,
        stage: &Stage<'_>,
        guess: f64,
        loads: &mut dyn RadialTrials,
    ) -> Result<Found, EvalError> {
        let per = stage.step * self.per;
        let balance = |x: f64| -> Result<(f64, f64), EvalError> {
            let h = thickness(x)?;
            loads.set_thickness(h)?;
            Ok((x - stage.base[0] - per * self.search.rate(loads)?.hdot / h, 1.0))
        };
        let known =
            Known { from: stage.base[0], guess, rest: Some(0.0), reach: REACH, tol: stage.accuracy[0] };
        first_root(balance, known).map_err(|e| match e {
            RootError::Function(e) => e,
            e => EvalError::recoverable("radial_motion", e.to_string()),
        })
    }
}
