//! A ring in its groove, with the oil on its flanks, over a step of the gas.
//!
//! The method is that of the pack ([`sdirk`]). A ring takes the step of the gas where that is accurate enough for it, the stages of the gas being its own. Elsewhere
//! it takes steps of its own from each instant of the gas to the next, under what acts on it as a parabola between them.

use std::ops::Range;

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::RingResponse;
use gudgeon_core::states::Stage;
use gudgeon_numerics::elementary;
use gudgeon_numerics::sdirk::{self, GAMMA};

use super::super::ring::Ring;
use super::acting::{Acting, Values, Variation};
use super::ring_stage::{RingStage, Step};

/// Most steps between two instants, rejected ones included. A ring that needs more crosses its groove: gas that sees only where it ends would take the step back.
const MOST: usize = 5;
/// Part of the step that the error estimate admits which is taken, and the largest growth: of steps of the gas, and of steps within one.
const SAFETY: f64 = 0.85;
const GROWTH: f64 = 2.0;
const GROWTH_WITHIN: f64 = 4.0;

/// Most states of a ring in its groove.
pub const MOST_STATES: usize = 6;

/// States of a ring in its groove, motion first, or something of each; zero beyond them.
pub type States = [f64; MOST_STATES];

/// A ring at an instant of the gas.
#[derive(Debug, Clone, Copy, Default)]
pub struct Node {
    pub acting: Acting,
    pub y: States,
    pub rates: States,
    /// Errors admitted from here on, and the step that they allow.
    pub atol: States,
    pub h: f64,
    /// Mean rates of what acts over the span that led here, and its length \[rad\]; zero where nothing is known of it.
    pub trend: (Values, f64),
}

/// From one instant of the gas to the next.
#[derive(Debug, Clone, Default)]
pub struct Span {
    /// Steps of the ring from the one to the other; none where it takes the step of the gas.
    steps: Vec<Step>,
    pub end: Node,
    /// Largest error of a step over the tolerance.
    pub error: f64,
    /// Oil that left the flanks \[m² rad/s\].
    pub lost: f64,
    /// What the motion answered, and where the ring stands.
    pub response: RingResponse,
    pub place: RingPlace,
}

impl Span {
    /// Where the ring stands at the start of step `k`, and the rates there.
    fn before(&self, from: &Node, k: usize) -> (States, States) {
        if k == 0 { (from.y, from.rates) } else { (self.steps[k - 1].y[1], self.steps[k - 1].rates[1]) }
    }

    /// States at an instant.
    fn at(&self, from: &Node, t: f64) -> States {
        let k = self.steps.partition_point(|s| s.t <= t).max(1) - 1;
        let (y, rates) = self.before(from, k);
        within(&self.steps[k], (&y, &rates), t)
    }
}

/// States at an instant of a step from the states `y0` with the rates `k0`.
fn within(step: &Step, (y0, k0): (&States, &States), t: f64) -> States {
    let Step { t: t0, h, y, rates, .. } = step;
    let x = (t - t0) / h;
    std::array::from_fn(|j| sdirk::between([y0[j], y[1][j]], [k0[j], rates[1][j]], *h, x))
}

/// One ring over a step of the gas.
#[derive(Debug, Clone, Default)]
pub struct Steps {
    /// States of the motion, and all, and their places in the pack.
    pub motion: usize,
    pub n: usize,
    pub places: [usize; MOST_STATES],
    pub start: Node,
    /// To the first stage, and from there to the second.
    pub spans: [Span; 2],
    /// The step of the gas, and whether the ring takes it.
    whole: Step,
    is_whole: bool,
    /// Whether the step was solved to its end.
    known: bool,
    /// Oil that left the flanks \[m²/s\], as rates at both stages of the gas.
    pub lost: [f64; 2],
    /// Errors admitted before they are eased, and those by magnitude.
    pub atol: States,
    pub relative: States,
    /// How what the oil lacks grows with it.
    slope: States,
}

/// Where a ring is integrated to.
#[derive(Debug, Clone, Copy)]
pub struct Target<'a> {
    /// Stage of the gas.
    pub number: usize,
    /// What acts there.
    pub acting: Acting,
    /// The place there, clearance and pose apart.
    pub place: &'a RingPlace,
    /// Whether steps are chosen now, or are those that were chosen before.
    pub chooses: bool,
}

impl Steps {
    /// For the places of its states in the pack.
    pub fn new(motion: Range<usize>, flank: Range<usize>) -> Self {
        let mut places = [0; MOST_STATES];
        places.iter_mut().zip(motion.clone().chain(flank.clone())).for_each(|(place, k)| *place = k);
        let (n, ones) = (motion.len() + flank.len(), [1.0; MOST_STATES]);
        Self { motion: motion.len(), n, places, atol: ones, slope: ones, ..Self::default() }
    }

    /// Of all states of the pack, or something of each, those of the ring.
    pub fn of(&self, all: &[f64]) -> States {
        let mut own = [0.0; MOST_STATES];
        own.iter_mut().zip(&self.places[..self.n]).for_each(|(own, &k)| *own = all[k]);
        own
    }

    /// Puts the states of the ring among all of the pack.
    pub fn put(&self, all: &mut [f64], own: &States) {
        self.places[..self.n].iter().zip(own).for_each(|(&k, own)| all[k] = *own);
    }

    /// Forgets what is kept from stage to stage.
    pub fn forget(&mut self) {
        self.known = false;
        self.slope = [1.0; MOST_STATES];
    }

    /// Whether a step was solved to its end.
    pub const fn is_known(&self) -> bool {
        self.known
    }

    /// Whether the ring takes the step of the gas, or took the last one.
    pub const fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// States at the instant `t` of a stage of the gas, at the rates of the instant before.
    pub fn ahead(&self, number: usize, t: f64) -> States {
        let from = if number == 1 { &self.start } else { &self.spans[0].end };
        std::array::from_fn(|j| from.y[j] + (t - from.acting.t) * from.rates[j])
    }

    /// Integrates the ring to a stage of the gas.
    pub fn integrate(&mut self, ring: &mut Ring, to: &Target<'_>) -> Result<(), EvalError> {
        let from = if to.number == 1 { &self.start } else { &self.spans[0].end };
        let (t, length) = (to.acting.t, to.acting.t - from.acting.t);
        let trend = (to.acting.mean_rates(&from.acting), length);
        let end = &mut self.spans[to.number - 1].end;
        (end.acting, end.trend) = (to.acting, trend);
        if to.number == 1 {
            self.known = false;
            if to.chooses {
                self.is_whole = self.start.h * GAMMA >= length * (1.0 - 1e-9);
            }
        }
        if self.is_whole {
            self.take_step_of_gas(ring, to)?;
            let too_far = to.number == 2 && to.chooses && self.spans[1].error > 1.0;
            if too_far {
                // What the first stage saw is the stage of a step that was too long.
                self.is_whole = false;
                self.start.h = (t - self.start.acting.t) * change(self.spans[1].error, 0.1, 0.9);
                let place = self.spans[0].place;
                self.take_steps(
                    ring,
                    &Target { number: 1, acting: self.spans[0].end.acting, place: &place, ..*to },
                )?;
            }
        }
        if !self.is_whole {
            self.take_steps(ring, to)?;
        }
        self.known = to.number == 2;
        Ok(())
    }

    /// Tells the oil that left the flanks as a rate at a stage of the gas: both together, by the weights of the method, are all that left.
    pub fn tell_lost(&mut self, stage: &Stage<'_>) {
        let h = stage.step / GAMMA;
        let [first, second] = &self.spans;
        self.lost[stage.number - 1] = match stage.number {
            1 => first.lost / stage.step,
            _ => ((first.lost + second.lost) / h - (1.0 - GAMMA) * self.lost[0]) / GAMMA,
        };
    }

    /// Solves a stage of the gas as one of the ring.
    fn take_step_of_gas(&mut self, ring: &mut Ring, to: &Target<'_>) -> Result<(), EvalError> {
        let Self { start, spans, whole, .. } = self;
        let [first, second] = spans;
        let (t0, t) = (start.acting.t, to.acting.t);
        if to.number == 1 && to.chooses {
            *whole = Step::new(t0, (t - t0) / GAMMA, &start.y, &start.rates, start.atol);
        }
        if to.number == 2 && to.chooses {
            whole.go_on(&start.y);
        }
        let accuracy = whole.accuracy(&start.y, &self.relative);
        let mut stage = RingStage::new(ring, (self.motion, self.n), &mut self.slope, to.place);
        let lost = stage.solve(whole, (to.number, &start.y), &accuracy, &to.acting)?;
        let span = if to.number == 1 { &mut *first } else { &mut *second };
        (span.end.y, span.end.rates) = (whole.y[to.number - 1], whole.rates[to.number - 1]);
        (span.place, span.response) = (*stage.place(), stage.response);
        span.steps.clear();
        if to.number == 1 {
            (first.error, first.lost) = (0.0, GAMMA * whole.h * lost);
            return Ok(());
        }
        // The weights of the method are those of both stages, not of both spans.
        let early = first.lost / GAMMA;
        second.lost = early * (1.0 - GAMMA) + GAMMA * whole.h * lost - first.lost;
        second.error = error(whole, (&start.y, &start.rates), &self.relative);
        if to.chooses {
            let next = whole.h * change(second.error, 0.2, GROWTH);
            second.end.h = next.max(start.h);
            second.end.atol = self.atol;
            stage.ease(&mut second.end.atol);
        }
        Ok(())
    }

    /// Integrates the span to a stage of the gas by steps of the ring.
    fn take_steps(&mut self, ring: &mut Ring, to: &Target<'_>) -> Result<(), EvalError> {
        let (first, rest) = self.spans.split_at_mut(1);
        let (from, span) = match to.number {
            1 => (&self.start, &mut first[0]),
            _ => (&first[0].end, &mut rest[0]),
        };
        let variation = Variation::new(&from.acting, &to.acting, &from.trend);
        (span.error, span.lost) = (0.0, 0.0);
        let stage = RingStage::new(ring, (self.motion, self.n), &mut self.slope, to.place);
        let mut run = Integration { stage, from, span, variation, accuracy: (&self.atol, &self.relative) };
        if to.chooses {
            run.choose()?;
        } else {
            for k in 0..run.span.steps.len() {
                let error = run.step(k, false)?;
                run.span.error = run.span.error.max(error);
            }
        }
        (run.span.place, run.span.response) = (*run.stage.place(), run.stage.response);
        if let Some(last) = span.steps.last() {
            (span.end.y, span.end.rates) = (last.y[1], last.rates[1]);
        }
        Ok(())
    }

    /// States at an instant of the step of the gas.
    pub fn at(&self, t: f64) -> States {
        let [first, second] = &self.spans;
        if self.is_whole {
            within(&self.whole, (&self.start.y, &self.start.rates), t)
        } else if t <= first.end.acting.t {
            first.at(&self.start, t)
        } else {
            second.at(&first.end, t)
        }
    }

    /// Ends of its steps.
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        self.spans.iter().flat_map(|span| span.steps.iter().map(|s| s.t + s.h))
    }
}

/// Error of a step from the states `y0` with the rates `k0`, over the tolerance.
fn error(step: &Step, (y0, k0): (&States, &States), relative: &States) -> f64 {
    let Step { h, y: [_, y], rates: [first, second], atol, .. } = step;
    let each: States = std::array::from_fn(|j| {
        let scale = atol[j] + relative[j] * y0[j].abs().max(y[j].abs());
        (h * sdirk::error([k0[j], first[j], second[j]]) / scale).abs()
    });
    each.iter().fold(0.0, |a, b| if b.is_nan() { f64::INFINITY } else { b.max(a) })
}

/// The next step over one with an error over the tolerance, within limits.
fn change(error: f64, least: f64, most: f64) -> f64 {
    // Resting rings are at a limit most of the time, for which no root is needed.
    let at = |limit: f64| (SAFETY / limit) * (SAFETY / limit) * (SAFETY / limit);
    if error <= at(most) {
        most
    } else if error >= at(least) {
        least
    } else {
        SAFETY / elementary::cbrt(error)
    }
}

/// The integration of a span by steps of the ring.
struct Integration<'a> {
    stage: RingStage<'a>,
    from: &'a Node,
    span: &'a mut Span,
    variation: Variation,
    /// Errors admitted before they are eased, and those by magnitude.
    accuracy: (&'a States, &'a States),
}

impl Integration<'_> {
    /// Integrates by steps that are chosen now.
    fn choose(&mut self) -> Result<(), EvalError> {
        let (mut t, mut h, mut most) = (self.from.acting.t, self.from.h, GROWTH_WITHIN);
        let end = self.span.end.acting.t;
        self.span.end.atol = self.from.atol;
        self.span.steps.clear();
        for _ in 0..MOST {
            let rest = end - t;
            let last = h >= rest * (1.0 - 1e-9);
            let tried = match h {
                _ if last => rest,
                // Two equal steps rather than a whole one and a crumb.
                h if 2.0 * h > rest => 0.5 * rest,
                h => h,
            };
            let lost = self.span.lost;
            let error = match self.try_step(t, tried) {
                Err(e) if e.is_recoverable() => f64::INFINITY,
                error => error?,
            };
            if error > 1.0 {
                self.span.steps.pop();
                self.span.lost = lost;
                (h, most) = (tried * change(error, 0.1, 0.9), 1.0);
                continue;
            }
            let next = tried * change(error, 0.2, most);
            (h, most) = (if tried < h { h.max(next) } else { next }, GROWTH_WITHIN);
            self.span.error = self.span.error.max(error);
            self.span.end.atol = *self.accuracy.0;
            self.stage.ease(&mut self.span.end.atol);
            if last {
                self.span.end.h = h;
                return Ok(());
            }
            t += tried;
        }
        Err(EvalError::recoverable("ring_pack", "a ring needs too many steps within one of the gas"))
    }

    /// Adds a step; its error over the tolerance.
    fn try_step(&mut self, t: f64, h: f64) -> Result<f64, EvalError> {
        let k = self.span.steps.len();
        let (y, rates) = self.span.before(self.from, k);
        self.span.steps.push(Step::new(t, h, &y, &rates, self.span.end.atol));
        self.step(k, true)
    }

    /// Integrates step `k`, for the first time or again; its error over the tolerance.
    fn step(&mut self, k: usize, is_new: bool) -> Result<f64, EvalError> {
        let (y0, k0) = self.span.before(self.from, k);
        let (span, relative) = (&mut *self.span, self.accuracy.1);
        let step = &mut span.steps[k];
        let accuracy = step.accuracy(&y0, relative);
        let (begin, end) = (self.from.acting.t, &span.end.acting);
        for (number, weight) in [(1, 1.0 - GAMMA), (2, GAMMA)] {
            if is_new && number == 2 {
                step.go_on(&y0);
            }
            let at = self.variation.at((step.instant(number) - begin) / (end.t - begin), end);
            let lost = self.stage.solve(step, (number, &y0), &accuracy, &at)?;
            span.lost += step.h * lost * weight;
        }
        Ok(error(step, (&y0, &k0), relative))
    }
}
