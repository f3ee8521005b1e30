//! Stages of implicit steps, solved by the pack itself.
//!
//! ```text
//! y = b + s f(θ, y)
//! ```
//!
//! The motion of a ring, in its groove and towards the liner, is solved by its own model in one unknown: its laws have corners, and the force of a film
//! goes with a power of its thickness. What is left is solved by Newton's method: the gas with the rings following, the oil on the flanks of a ring where it stands,
//! the oil under its faces with its film following. The Jacobians of that are kept from stage to stage. What oil on flanks and films do to the rest
//! within a stage is little, and is iterated on.

use std::ops::Range;

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::{RingForces, RingTrials};
use gudgeon_core::states::Stage;
use gudgeon_numerics::stages::{Ended, StageNewton};

use super::pack::Pack;
use super::ring::Ring;
use super::waveform::{MOST_STATES, RingSteps, Side};

/// Unknowns that are solved together, and what is kept of them from stage to stage.
#[derive(Debug, Clone, Default)]
pub(super) struct Together {
    /// Their places in the state vector.
    states: Vec<usize>,
    /// Their accuracy over what is asked, before the last step.
    tight: f64,
    newton: StageNewton,
    x: Vec<f64>,
    accuracy: Vec<f64>,
    /// What they were before.
    before: Vec<f64>,
}

/// What [`Pack::stage`] works with.
#[derive(Debug, Clone, Default)]
pub struct Staging {
    pub(super) gas: Together,
    /// Oil on the flanks of each ring.
    flank: Vec<Together>,
    /// Oil under the faces of each ring, its film following, and both together.
    oil: Vec<Together>,
    wet: Vec<Together>,
    /// Radii of the liner at the rings.
    pub(super) radii: Vec<f64>,
    /// Steps of the rings in their grooves, where these have steps of their own.
    pub(super) rings: Option<RingSteps>,
}

/// Most passes over films and gas.
const PASSES: usize = 10;
/// Accuracy over what is asked, before the last step of Newton's method: of gas, whose balance is closed by what comes in; of the oil on flanks, where what a stage lacks comes
/// from nowhere; of the oil under faces, where it stays with the face.
const GAS: f64 = 2.0;
const FLANKS: f64 = 2e-2;
const FACES: f64 = 1.0;
/// Share of the load that contact carries from which on surfaces touch.
const TOUCH: f64 = 0.05;
/// Change of the oil on flanks over its accuracy that gas and rings need not know of.
const SETTLED: f64 = 5.0;

/// Tells what unknowns lack in a stage: for the states, and the places of the unknowns in them, into a slice as long as there are unknowns.
type Missing<'a> = dyn FnMut(&mut [f64], &[usize], &mut [f64]) -> Result<(), EvalError> + 'a;

impl Together {
    fn new(states: Vec<usize>, tight: f64) -> Self {
        let n = states.len();
        Self {
            states,
            tight,
            newton: StageNewton::new(n),
            x: vec![0.0; n],
            accuracy: vec![0.0; n],
            before: vec![0.0; n],
        }
    }

    /// Sets the Jacobian of the rates where the next stage is guessed: for a rate and an unknown, by their numbers.
    pub(super) fn set_jacobian(&mut self, by: impl Fn(usize, usize) -> f64) {
        self.newton.set_jacobian(by);
    }

    /// Whether a solution may be foreseen; what its last look saw is then not that near.
    pub(super) fn foresee(&mut self, may: bool) {
        self.newton.foresee(may);
    }

    /// Solves a stage for these unknowns.
    pub(super) fn solve(
        &mut self,
        stage: &Stage<'_>,
        y: &mut [f64],
        missing: &mut Missing<'_>,
    ) -> Result<Ended, EvalError> {
        let (states, tight) = (&self.states, self.tight);
        for ((x, a), &k) in self.x.iter_mut().zip(&mut self.accuracy).zip(states) {
            (*x, *a) = (y[k], tight * stage.accuracy[k]);
        }
        let ended = self.newton.solve(&mut self.x, stage.step, &self.accuracy, &mut |x, r| {
            states.iter().zip(x).for_each(|(&k, x)| y[k] = *x);
            missing(y, states, r)
        })?;
        states.iter().zip(&self.x).for_each(|(&k, x)| y[k] = *x);
        Ok(ended)
    }
}

impl Staging {
    /// For a pack.
    pub fn new(pack: &Pack) -> Self {
        let layout = &pack.layout;
        let under = |i: usize| {
            let of = |k: &usize| pack.oil_pack.as_ref().is_some_and(|o| o.ring_of(k - layout.oil.start) == i);
            Together::new(layout.oil.clone().filter(of).collect(), FACES)
        };
        let both = |i: usize| {
            let film = layout.radial[i].clone();
            Together::new(film.chain(under(i).states).collect(), FACES)
        };
        Self {
            gas: Together::new(layout.gas.clone().collect(), GAS),
            flank: layout.flank.iter().map(|own| Together::new(own.clone().collect(), FLANKS)).collect(),
            oil: (0..pack.n_rings()).map(under).collect(),
            wet: (0..pack.n_rings()).map(both).collect(),
            ..Self::default()
        }
    }

    /// For a pack whose rings have steps of their own.
    pub fn with_ring_steps(pack: &Pack) -> Self {
        Self { rings: Some(RingSteps::new(pack)), ..Self::new(pack) }
    }

    /// Forgets what is kept from stage to stage.
    pub fn restart(&mut self) {
        self.gas.newton.forget();
        self.rings.iter_mut().for_each(RingSteps::restart);
        self.flank.iter_mut().chain(&mut self.oil).chain(&mut self.wet).for_each(|o| o.newton.forget());
    }
}

impl Pack {
    /// Whether the models can solve stages.
    #[must_use]
    pub fn solves_stages(&self) -> bool {
        self.refuses_stages().is_none()
    }

    /// Why the pack cannot solve stages.
    #[must_use]
    pub fn refuses_stages(&self) -> Option<String> {
        let own = |what: String| format!("{what} does not solve stages of implicit steps");
        let in_groove = |r: &Ring| r.is_decided() || !r.motion.solves_stages();
        if let Some(i) = self.rings.iter().position(in_groove) {
            return Some(own(format!("`{}`, the motion of ring {},", self.rings[i].motion_name, i + 1)));
        }
        if self.plan.film && self.rings.iter().any(|r| !r.radial.solves_stages()) {
            return Some(own("the radial motion of a ring".into()));
        }
        let mut both = self.layout.motion.iter().zip(&self.layout.flank);
        if let Some(i) = both.position(|(motion, flank)| motion.len() + flank.len() > MOST_STATES) {
            return Some(own(format!("ring {} with more than {MOST_STATES} states in its groove", i + 1)));
        }
        if self.layout.twists.iter().any(|t| *t) {
            return Some(own("a ring that twists".into()));
        }
        (!self.layout.temperature.is_empty()).then(|| own("a film temperature that is integrated".into()))
    }

    /// Solves a stage; `self.at` is left at its answer, and `g` holds the rates of the quadratures.
    ///
    /// # Errors
    /// What a sub-model refuses; no answer.
    pub fn stage(
        &mut self,
        theta: f64,
        stage: &Stage<'_>,
        y: &mut [f64],
        g: &mut [f64],
        w: &mut Staging,
    ) -> Result<(), EvalError> {
        let p = self.cylinder.pressure(theta);
        self.set_places(theta, y);
        self.begin_stage(y, w)?;
        self.gas_pressures(p)?;
        self.films_of_stage(stage, y, w)?;
        for pass in 0.. {
            self.grooves_of_stage(stage, y, p, w)?;
            if !self.plan.film || self.films_of_stage(stage, y, w)? <= 1.0 {
                break;
            }
            if pass == PASSES {
                return Err(EvalError::recoverable("ring_pack", "films and gas do not settle"));
            }
        }
        self.quadratures(g);
        self.state.copy_from_slice(y);
        Ok(())
    }

    /// Solves a stage at `theta` for one side of the pack, the other standing as `y` has it; `p` is the pressure in the cylinder \[Pa\], `axial` are the
    /// forces \[N\] of the films along the liner, which the films know themselves.
    ///
    /// # Errors
    /// What a sub-model refuses; no answer.
    pub(super) fn stage_of(
        &mut self,
        side: Side,
        (theta, p): (f64, f64),
        stage: &Stage<'_>,
        y: &mut [f64],
        axial: &[f64],
        w: &mut Staging,
    ) -> Result<(), EvalError> {
        match side {
            Side::Grooves => {
                self.locate_by(theta, |pack, i, radius| pack.place_before_steps(i, radius, y));
                self.begin_stage(y, w)?;
                self.set_film_forces(axial);
                self.grooves_by_steps(stage, y, p, w)?;
            }
            Side::Films => {
                self.set_places(theta, y);
                self.begin_stage(y, w)?;
                self.gas_pressures(p)?;
                self.films_of_stage(stage, y, w)?;
            }
        }
        self.state.copy_from_slice(y);
        Ok(())
    }

    /// Sets what no stage changes, at the places of the instant.
    fn begin_stage(&mut self, y: &[f64], w: &mut Staging) -> Result<(), EvalError> {
        self.state.fill(f64::NAN);
        self.complete = false;
        w.radii.clear();
        w.radii.extend(self.at.places.iter().map(|p| p.liner_radius));
        self.set_gas(y)
    }

    pub(super) fn set_gas(&mut self, y: &[f64]) -> Result<(), EvalError> {
        for (k, m) in self.gas_state.iter_mut().enumerate() {
            *m = y[k] * self.gas_scale[k];
        }
        if self.gas_state.iter().all(|m| *m > 0.0) {
            Ok(())
        } else {
            Err(EvalError::recoverable("ring_pack", "a space without gas"))
        }
    }

    /// Gas, with the rings in their grooves following, and the oil on flanks, in turns.
    fn grooves_of_stage(
        &mut self,
        stage: &Stage<'_>,
        y: &mut [f64],
        p: f64,
        w: &mut Staging,
    ) -> Result<(), EvalError> {
        for _ in 0..=PASSES {
            let Staging { gas, radii, .. } = w;
            gas.solve(stage, y, &mut |y, _, r| self.follow(stage, (p, radii), y, r))?;
            if self.flanks_of_stage(stage, y, w)? <= SETTLED {
                return Ok(());
            }
        }
        Err(EvalError::recoverable("ring_pack", "gas and the oil on flanks do not settle"))
    }

    /// The oil on the flanks of all rings where these stand; its largest change over its accuracy.
    fn flanks_of_stage(
        &mut self,
        stage: &Stage<'_>,
        y: &mut [f64],
        w: &mut Staging,
    ) -> Result<f64, EvalError> {
        let mut change = 0.0_f64;
        for (i, flank) in w.flank.iter_mut().enumerate() {
            let own = self.layout.flank[i].clone();
            if own.is_empty() {
                continue;
            }
            flank.before.clear();
            flank.before.extend_from_slice(&y[own.clone()]);
            flank.solve(stage, y, &mut |y, states, r| self.flank_lacks(i, (stage, states), y, r))?;
            for (k, before) in own.zip(&flank.before) {
                change = change.max((y[k] - before).abs() / stage.accuracy[k]);
            }
        }
        Ok(change)
    }

    /// What the oil on the flanks of ring `i` lacks in its stage.
    fn flank_lacks(
        &mut self,
        i: usize,
        (stage, states): (&Stage<'_>, &[usize]),
        y: &[f64],
        r: &mut [f64],
    ) -> Result<(), EvalError> {
        let own = &y[self.layout.flank[i].clone()];
        self.at.places[i].flank = self.rings[i].flank.oil(own, &self.at.places[i]);
        self.flank_rates(i, y)?;
        for (r, &k) in r.iter_mut().zip(states) {
            *r = y[k] - stage.base[k] - stage.step * self.dy[k];
        }
        Ok(())
    }

    /// Films of all rings, with the oil under them; the largest change of a film over its accuracy.
    fn films_of_stage(
        &mut self,
        stage: &Stage<'_>,
        y: &mut [f64],
        w: &mut Staging,
    ) -> Result<f64, EvalError> {
        let mut change = 0.0_f64;
        if !self.plan.film {
            return Ok(change);
        }
        let (n, down) = (self.n_rings(), self.at.piston.v < 0.0);
        // A ring takes up what the one before it leaves in the same step.
        for i in (0..n).map(|k| if down { n - 1 - k } else { k }) {
            let film = self.layout.radial[i].start;
            let before = y[film];
            let oil = &mut w.oil[i];
            if oil.states.is_empty() {
                self.film_of_stage(i, stage, y)?;
            } else if !self.film_with_oil(i, stage, y, &mut w.wet[i])? {
                oil.solve(stage, y, &mut |y, states, r| self.oil_under((i, states), stage, y, r))?;
            }
            change = change.max((y[film] - before).abs() / stage.accuracy[film]);
            self.place_on_film(i, w.radii[i], y);
            self.friction(i)?;
        }
        Ok(change)
    }

    /// The film of ring `i` and the oil under it, all together; whether they were found so.
    fn film_with_oil(
        &mut self,
        i: usize,
        stage: &Stage<'_>,
        y: &mut [f64],
        both: &mut Together,
    ) -> Result<bool, EvalError> {
        // Surfaces that touch resist an approach a thousand times more than a parting: there is a corner where they stand.
        let r = &self.at.rings[i];
        if r.contact > TOUCH * r.load {
            return Ok(false);
        }
        both.before.clear();
        both.before.extend(both.states.iter().map(|&k| y[k]));
        let before = std::mem::take(&mut both.before);
        let found = both.solve(stage, y, &mut |y, states, r| self.film_and_oil((i, states), stage, y, r));
        if found.is_err() {
            both.states.iter().zip(&before).for_each(|(&k, v)| y[k] = *v);
        }
        both.before = before;
        match found {
            Ok(_) => Ok(true),
            Err(e) if e.is_recoverable() => Ok(false),
            Err(e) => Err(e),
        }
    }

    /// What the film of ring `i` and the oil under it lack, where no limit acts.
    fn film_and_oil(
        &mut self,
        (i, states): (usize, &[usize]),
        stage: &Stage<'_>,
        y: &[f64],
        r: &mut [f64],
    ) -> Result<(), EvalError> {
        if let Some(oil) = &mut self.oil_pack {
            oil.place(&y[self.layout.oil.clone()], self.at.piston.y);
        }
        let own = self.layout.radial[i].clone();
        let (mut loads, radial) = self.trials(i);
        let found = radial.try_stage(&part(stage, own.clone()), &y[own.clone()], &mut loads, r)?;
        let found = found.map(|(response, film)| loads.found(&response, film));
        self.at.rings[i] =
            found.ok_or_else(|| EvalError::recoverable("ring_pack", "a limit acts on a film"))?;
        self.at.places[i].h = self.rings[i].radial.thickness(&y[own]);
        self.oil_rates(i);
        let films = self.layout.radial[i].len();
        for (r, &k) in r.iter_mut().zip(states).skip(films) {
            *r = y[k] - stage.base[k] - stage.step * self.dy[k];
        }
        Ok(())
    }

    /// What the oil under the faces of ring `i` lacks, its film following.
    fn oil_under(
        &mut self,
        (i, states): (usize, &[usize]),
        stage: &Stage<'_>,
        y: &mut [f64],
        r: &mut [f64],
    ) -> Result<(), EvalError> {
        if let Some(oil) = &mut self.oil_pack {
            oil.place(&y[self.layout.oil.clone()], self.at.piston.y);
        }
        self.film_of_stage(i, stage, y)?;
        self.at.places[i].h = self.rings[i].radial.thickness(&y[self.layout.radial[i].clone()]);
        self.oil_rates(i);
        for (r, &k) in r.iter_mut().zip(states) {
            *r = y[k] - stage.base[k] - stage.step * self.dy[k];
        }
        Ok(())
    }

    fn film_of_stage(&mut self, i: usize, stage: &Stage<'_>, y: &mut [f64]) -> Result<(), EvalError> {
        let own = self.layout.radial[i].clone();
        let part = part(stage, own.clone());
        let (mut loads, radial) = self.trials(i);
        let (response, film) = radial.stage(&part, &mut y[own], &mut loads)?;
        self.at.rings[i] = loads.found(&response, film);
        Ok(())
    }

    /// What the gas lacks in its stage, the rings following it; `p` is the pressure in the cylinder.
    fn follow(
        &mut self,
        stage: &Stage<'_>,
        (p, radii): (f64, &[f64]),
        y: &mut [f64],
        r: &mut [f64],
    ) -> Result<(), EvalError> {
        self.set_gas(y)?;
        self.gas_pressures(p)?;
        for (i, radius) in radii.iter().enumerate() {
            self.groove_of_stage(i, stage, y, *radius)?;
        }
        self.gas(Some(p))?;
        self.gas_lacks(stage, y, r);
        Ok(())
    }

    /// What the gas of the instant lacks in its stage.
    pub(super) fn gas_lacks(&self, stage: &Stage<'_>, y: &[f64], r: &mut [f64]) {
        for (r, k) in r.iter_mut().zip(self.layout.gas.clone()) {
            *r = y[k] - stage.base[k] - stage.step * self.rate(k);
        }
    }

    /// The motion of ring `i` in its groove.
    fn groove_of_stage(
        &mut self,
        i: usize,
        stage: &Stage<'_>,
        y: &mut [f64],
        radius: f64,
    ) -> Result<(), EvalError> {
        let (own, oil) = (self.layout.motion[i].clone(), self.layout.flank[i].clone());
        let at = self.place(i, radius, y);
        self.at.places[i] = at;
        if !self.plan.axial || own.is_empty() {
            return Ok(());
        }
        self.external_forces(i);
        let mut forces = RingForces::new(at, self.at.rings[i].axial);
        let (before, after) = y.split_at_mut(own.end);
        let ring = &mut self.rings[i];
        let (flank, oil) = (&ring.flank, &after[oil.start - own.end..oil.end - own.end]);
        let part = part(stage, own.clone());
        let mut reach = |place: &RingPlace| flank.oil(oil, place);
        let mut trials = RingTrials::new(&mut forces, &mut reach);
        let response = ring.motion.stage(&part, &mut before[own], &mut trials)?;
        self.at.places[i] = forces.place;
        let r = &mut self.at.rings[i];
        (r.axial.damping, r.reaction) = (response.damping, response.reaction);
        Ok(())
    }
}

/// The part of a stage that belongs to a model.
fn part<'a>(stage: &Stage<'a>, own: Range<usize>) -> Stage<'a> {
    Stage { base: &stage.base[own.clone()], accuracy: &stage.accuracy[own], ..*stage }
}
