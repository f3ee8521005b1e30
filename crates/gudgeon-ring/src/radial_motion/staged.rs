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

use super::search::{Search, soft};

/// Longest step of a trial in `ln h`.
const REACH: f64 = 1.0;

/// Film thicknesses \[m\] between which trials stay: no groove is deeper, and nothing is thinner.
const THICKNESSES: std::ops::Range<f64> = 1e-26..0.1;

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
    /// Derivative of the balance by `x`, of the last stage.
    pub slope: f64,
}

/// What a thickness leads to.
pub struct Trial {
    /// The balance, over the tension, and its derivative by `x` through the velocity alone.
    pub lacks: f64,
    pub slope: f64,
    pub response: RadialResponse,
    pub film: FaceForces,
}

/// Answer of a stage.
pub struct Answer {
    pub response: RadialResponse,
    pub film: FaceForces,
    pub slope: f64,
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
        let found = self.limited(stage, *x, loads)?;
        // Nor is what was found below the floor within the accuracy.
        *x = if lowest > 0.0 { found.x.max(elementary::ln(lowest)) } else { found.x };
        loads.set_thickness(thickness(*x)?)?;
        let response = self.search.rate(loads)?;
        let film = response.film.map_or_else(|| loads.film(response.hdot), Ok)?;
        Ok(Answer { response, film, slope: 0.0 })
    }

    /// The stage without limits; none where one would act.
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
        let balance =
            |x: f64| -> Result<f64, EvalError> { Ok(last.insert(self.trial(stage, x, loads)?).lacks) };
        let known =
            Known { from: stage.base[0], guess: *x, slope: self.slope, reach: REACH, tol: stage.accuracy[0] };
        let found = match first_root(balance, known) {
            Ok(found) => found,
            Err(RootError::Function(e)) if !e.is_recoverable() => return Err(e),
            Err(_) => return Ok(None),
        };
        let Some(Trial { response, film, .. }) = last else { return Ok(None) };
        if self.is_limited(loads.state(), response.hdot, film.load) {
            return Ok(None);
        }
        *x = found.x;
        Ok(Some(Answer { response, film, slope: found.slope }))
    }

    /// A trial at `x` without limits.
    pub fn trial(&self, stage: &Stage<'_>, x: f64, loads: &mut dyn RadialTrials) -> Result<Trial, EvalError> {
        let per = stage.step * self.per;
        let cap = self.search.limits.radial_speed;
        let h = thickness(x)?;
        loads.set_thickness(h)?;
        let hdot = h * (x - stage.base[0]) / per;
        // The velocity that the cap on it turns into this one.
        let free = hdot / (1.0 - (hdot / cap).powi(2)).max(1e-12).sqrt();
        let film = loads.film(free)?;
        let at = loads.state();
        let drag = if free > 0.0 { self.search.contact_drag(at) } else { 0.0 };
        let (friction, slope) = loads.friction(free);
        let needed = at.load - at.contact - at.dry + friction + drag * free;
        let carried = soft(needed, self.search.limits.min_load * at.tension);
        let mut limited = Limited::default();
        (limited.lifted, limited.contact_drag) = (carried - needed, drag * free);
        Ok(Trial {
            lacks: (carried - film.load) / at.tension,
            slope: (film.squeeze_damping + slope + drag) * h / (per * at.tension),
            response: RadialResponse::new(hdot, Some(film), limited),
            film,
        })
    }

    /// Whether a drag or an end of the way would change the velocity.
    pub fn is_limited(&self, at: &RadialState, hdot: f64, load: f64) -> bool {
        let near_an_end = if hdot > 0.0 {
            at.furthest - at.thickness < self.search.limits.retreat_band * at.furthest
        } else {
            let (lowest, band) = at.lowest;
            lowest > 0.0 && at.thickness - lowest < band * lowest
        };
        near_an_end
            || at.thickness <= at.lowest.0
            || self.search.drag(at, hdot, load.abs().max(at.load.abs())) > 0.0
    }

    /// The stage with limits.
    fn limited(
        &mut self,
        stage: &Stage<'_>,
        guess: f64,
        loads: &mut dyn RadialTrials,
    ) -> Result<Found, EvalError> {
        let per = stage.step * self.per;
        let balance = |x: f64| -> Result<f64, EvalError> {
            let h = thickness(x)?;
            loads.set_thickness(h)?;
            Ok(x - stage.base[0] - per * self.search.rate(loads)?.hdot / h)
        };
        let known = Known { from: stage.base[0], guess, slope: 1.0, reach: REACH, tol: stage.accuracy[0] };
        first_root(balance, known).map_err(|e| match e {
            RootError::Function(e) => e,
            e => EvalError::recoverable("radial_motion", e.to_string()),
        })
    }
}
