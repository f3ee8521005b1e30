//! The radial motion without inertia: the squeeze velocity at which everything is in balance.

use gudgeon_core::kinds::{
    FaceForces, RadialLimits, RadialLoads, RadialMotion, RadialMotionCtx, RadialMotionSpec, RadialResponse,
    RadialTrials,
};
use gudgeon_core::states::{Signals, Stage, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::search::Search;
use super::staged::{Before, Staged};
use super::tangent::Tangent;

/// The film thickness follows from the radial balance of forces, the inertia of the ring left out:
///
/// ```text
/// W_film(h, dh/dt) + W_contact(h) = W_tension + W_gas(h, p) + W_friction(dh/dt)
/// ```
///
/// The load of the film falls with `dh/dt`, so there is one velocity at which it carries the rest, and `ln h` is integrated with it. A ring that
/// gas has pressed off the liner has a drag in the place of its inertia, without which its velocity would jump between limits; surfaces in contact
/// part against a drag of their own, because the film between them resists an approach and no parting. Both drags, the least load of a film
/// and the largest velocity are keys of `solver.limits`.
///
/// State: `ln h`, so that errors are relative and a film gets a thousand times thinner and never negative.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FilmBalance {}

#[register_model(
    name = "film_balance",
    summary = "the film thickness follows from the balance of film, contact, tension and gas, without inertia",
    equations = "W_film(h, dh/dt) + W_contact(h) = W_tension + W_gas + W_friction(dh/dt);  d(ln h)/dt = (dh/dt)/h",
    validity = "Rings on their films and in contact. A ring that leaves the liner has a drag in place of its inertia: when it leaves and comes back \
               is right, how far it goes is an estimate.",
    references = ["zottin1992"],
    example = "",
)]
impl RadialMotionSpec for FilmBalance {
    fn build(&self, ctx: &RadialMotionCtx) -> Result<Box<dyn RadialMotion>, BuildError> {
        Ok(Box::new(Runtime {
            states: [StateInfo::new(format!("film of ring{}", ctx.ring + 1)).changes(Signals::FILM_THICKNESS)],
            ring: ctx.ring,
            first: ctx.first_film,
            per: 1.0 / ctx.omega,
            limits: ctx.limits,
            hdot: 0.0,
            load: 0.0,
            balanced: false,
            film_known: false,
            dragged: false,
            differences: false,
            tangent: None,
            before: Before::default(),
        }))
    }
}

struct Runtime {
    states: [StateInfo; 1],
    ring: usize,
    first: f64,
    /// Seconds per radian.
    per: f64,
    limits: RadialLimits,
    /// Velocity of the last instant, where the next search starts.
    hdot: f64,
    /// Load of the last instant.
    load: f64,
    /// Whether `hdot` is a root of the balance that nothing else has changed.
    balanced: bool,
    film_known: bool,
    dragged: bool,
    differences: bool,
    tangent: Option<Tangent>,
    /// What is known from the last stage.
    before: Before,
}

impl Stateful for Runtime {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }

    fn reads(&self) -> Signals {
        Signals::FILM_THICKNESS | Signals::EXTENT | Signals::TEMPERATURE | Signals::PRESSURE
    }

    fn initial(&mut self, y: &mut [f64]) {
        y[0] = elementary::ln(self.first);
        self.hdot = 0.0;
    }
}

impl RadialMotion for Runtime {
    fn thickness(&self, y: &[f64]) -> f64 {
        elementary::exp(y[0])
    }

    fn rates(
        &mut self,
        _: &[f64],
        loads: &mut dyn RadialLoads,
        dy: &mut [f64],
    ) -> Result<RadialResponse, EvalError> {
        let h = loads.state().thickness;
        let mut search = Search { limits: &self.limits, ring: self.ring, hdot: self.hdot, balanced: false };
        let found = match &self.tangent {
            Some(tangent) if self.differences => tangent.follow(&search, loads, self.hdot)?,
            _ => {
                let outcome = search.rate(loads);
                if !self.differences {
                    self.hdot = search.hdot;
                }
                outcome?
            }
        };
        if !self.differences {
            self.load = loads.state().load;
            (self.hdot, self.balanced) = (found.hdot, search.balanced);
            (self.film_known, self.dragged) = (found.film.is_some(), found.limited.drag > 0.0);
        }
        dy[0] = found.hdot / h * self.per;
        Ok(found)
    }

    fn solves_stages(&self) -> bool {
        true
    }

    fn stage(
        &mut self,
        stage: &Stage<'_>,
        y: &mut [f64],
        loads: &mut dyn RadialTrials,
    ) -> Result<(RadialResponse, FaceForces), EvalError> {
        let search = Search { limits: &self.limits, ring: self.ring, hdot: self.hdot, balanced: false };
        let mut staged = Staged { search, per: self.per, before: self.before };
        let answer = staged.solve(stage, &mut y[0], loads)?;
        (self.before, self.hdot) = (answer.known, answer.response.hdot);
        Ok((answer.response, answer.film))
    }

    fn try_stage(
        &mut self,
        stage: &Stage<'_>,
        y: &[f64],
        loads: &mut dyn RadialTrials,
        r: &mut [f64],
    ) -> Result<Option<(RadialResponse, FaceForces)>, EvalError> {
        let lowest = loads.state().lowest.0;
        if !loads.state().resists || stage.base[0] < elementary::ln(lowest) {
            return Ok(None);
        }
        let search = Search { limits: &self.limits, ring: self.ring, hdot: self.hdot, balanced: false };
        let staged = Staged { search, per: self.per, before: self.before };
        let trial = staged.trial(stage, y[0], loads)?;
        r[0] = trial.lacks / (1.0 + trial.slope.max(0.0));
        self.hdot = trial.response.hdot;
        Ok((!trial.is_limited).then_some((trial.response, trial.film)))
    }

    /// The tangent is worth its film where a velocity was searched for; one that came with its film by a search is as cheap as one evaluation.
    fn begin_differences(
        &mut self,
        loads: &mut dyn RadialLoads,
        film: &FaceForces,
        on_floor: bool,
    ) -> Result<(), EvalError> {
        self.differences = true;
        self.tangent = None;
        let searched = self.balanced && !self.film_known && !self.dragged;
        let search = Search { limits: &self.limits, ring: self.ring, hdot: self.hdot, balanced: true };
        if searched
            && !on_floor
            && loads.state().thickness > loads.state().lowest.0
            && search.drag(loads.state(), self.hdot, self.load.abs().max(film.load.abs())) <= 0.0
        {
            self.tangent = Tangent::new(&search, loads, self.hdot, film)?;
        }
        Ok(())
    }

    fn end_differences(&mut self) {
        (self.differences, self.tangent) = (false, None);
    }
}
