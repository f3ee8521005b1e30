//! Rings in their grooves at steps of their own within a step of the gas.
//!
//! A stage of the gas asks where a ring stands at its instant. The ring comes there from the instant before, the start of the step or its first stage, by
//! the step of the gas or by as many as its own accuracy asks for ([`super::span`]): a multirate method. While the gas is solved a ring goes on at the rates that it had, where
//! that was all that the gas saw of it in the stage before; elsewhere it responds linearly to the force of the gas: how, its last two integrations tell (a secant a ring), or what was learnt in
//! the step before. Gas and rings alternate until every ring stands where the gas saw it.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::GasPartials;
use gudgeon_core::states::Stage;
use gudgeon_numerics::ode::{Options, StepView};
use gudgeon_numerics::stages::Ended;

use super::super::pack::Pack;
use super::super::staged::{Staging, Together};
use super::acting::Acting;
use super::ring_stage::ease;
use super::span::{MOST_STATES, Node, States, Steps, Target};
use super::track::Track;

/// Error over the tolerance up to which steps chosen for other pressures are kept.
const KEPT: f64 = 2.0;
/// Difference, over the tolerance, between where a ring comes to and where the gas saw it, in clearances and open shares of gaps.
const SEEN: f64 = 0.1;
/// Change of the force on a ring, over the tolerance and the sum of all forces, for which it is not integrated again.
const NEARLY: f64 = 0.05;
/// Least change of the force on a ring \[N\] from which its response is learnt.
const LEAST_FORCE: f64 = 1e-9;
/// Looks at the gas in a pass up to which its Jacobian is good for the next stage.
const KEPT_LOOKS: usize = 3;
/// Most solutions of the gas in a stage.
const PASSES: usize = 10;
/// Ends of steps that are one within this \[rad\].
const SLACK: f64 = 1e-9;
/// Most stages for which it is taken for granted how a ring responded.
const STALE: usize = 8;

/// How a ring responded in a stage, by the force of the gas.
#[derive(Debug, Clone, Copy, Default)]
struct Learnt {
    /// Derivatives of the states \[1/N\], and the span that led there \[rad\].
    slope: States,
    span: f64,
    /// Stages since.
    age: usize,
}

/// How a ring responds to the gas in a stage.
#[derive(Debug, Clone, Default)]
struct Response {
    /// Whether the ring was integrated in this stage.
    known: bool,
    /// Force of the gas \[N\], the states that it led to, and their derivatives by it.
    force: f64,
    y: States,
    slope: States,
    /// What the gas saw the ring do in the last first and in the last second stage.
    before: [Option<Learnt>; 2],
    /// Whether the ring went on there as it did before, for all that the gas saw.
    quiet: [bool; 2],
}

impl Response {
    /// Whether it is known that the ring responds at all.
    fn is_known(&self) -> bool {
        self.slope != [0.0; MOST_STATES]
    }

    /// State `j` under a force \[N\].
    fn at(&self, j: usize, force: f64) -> f64 {
        self.y[j] + self.slope[j] * (force - self.force)
    }

    /// The first integration in stage `number`, over a span \[rad\], led to `y`.
    fn begin(&mut self, (number, span): (usize, f64), force: f64, y: &States) {
        (self.known, self.force, self.y, self.slope) = (true, force, *y, [0.0; MOST_STATES]);
        if let Some(l) = self.before[number - 1].as_mut().filter(|l| l.age < STALE) {
            l.age += 1;
            self.slope = l.slope.map(|s| s * (span / l.span));
        }
    }

    /// A further one led to `y`; the gas sees the difference, or not.
    fn learn(&mut self, (number, span): (usize, f64), force: f64, y: &States, seen: bool) {
        let change = force - self.force;
        if change.abs() > LEAST_FORCE {
            self.slope = std::array::from_fn(|j| (y[j] - self.y[j]) / change);
        }
        (self.force, self.y) = (force, *y);
        self.before[number - 1] = seen.then_some(Learnt { slope: self.slope, span, age: 0 });
        self.quiet[number - 1] = !seen;
    }
}

/// All rings over a step of the gas.
#[derive(Debug, Clone, Default)]
pub struct RingSteps {
    rings: Vec<Steps>,
    responses: Vec<Response>,
    partials: GasPartials,
    /// Looks at the gas in the first pass of the last stage.
    looks: usize,
    /// First step of a cycle \[rad\], and relative error of a step.
    first: f64,
    tolerance: f64,
}

impl RingSteps {
    /// For the rings of a pack.
    pub fn new(pack: &Pack) -> Self {
        let own = |i: usize| Steps::new(motion(pack, i), pack.layout.flank[i].clone());
        let rings: Vec<_> = (0..pack.n_rings()).map(own).collect();
        let responses = vec![Response::default(); rings.len()];
        Self { rings, responses, ..Self::default() }
    }

    /// Sets accuracy and first step, for all states of the pack.
    pub fn set_accuracy(&mut self, options: &Options) {
        (self.first, self.tolerance) = (options.h_init, options.rtol);
        for ring in &mut self.rings {
            let both = ring.atol.iter_mut().zip(&mut ring.relative);
            for ((atol, relative), &k) in both.zip(&ring.places[..ring.n]) {
                *atol = options.atol[k];
                *relative = if options.absolute[k] { 0.0 } else { options.rtol };
            }
        }
    }

    /// The states whose error is judged here.
    pub fn judged(&self) -> Vec<usize> {
        self.rings.iter().flat_map(|ring| &ring.places[..ring.n]).copied().collect()
    }

    /// Begins at the instant of the pack, whose rates are known.
    pub fn begin(&mut self, pack: &Pack) {
        for (i, ring) in self.rings.iter_mut().enumerate() {
            let (y, rates) = (ring.of(&pack.state), ring.of(&pack.dy));
            if ring.is_known() && y == ring.spans[1].end.y {
                // Its stages know the rates better than an evaluation.
                ring.start = ring.spans[1].end;
            } else {
                let mut atol = ring.atol;
                ease(&pack.rings[i], (ring.motion, ring.n), &mut atol);
                ring.start = Node { y, rates, atol, h: self.first, ..Node::default() };
            }
            // There may be a kink.
            (ring.start.acting, ring.start.trend) = (Acting::of(pack, i), Default::default());
            ring.spans[1].end.acting.t = f64::NAN;
        }
    }

    /// A stage of a step of the gas that begins at `t0` is about to be solved.
    fn begin_stage(&mut self, number: usize, t0: f64) {
        if number > 1 {
            return;
        }
        for ring in &mut self.rings {
            let end = &ring.spans[1].end;
            if (t0 - end.acting.t).abs() < (t0 - ring.start.acting.t).abs() {
                // The step before was taken.
                ring.start = *end;
            }
        }
    }

    /// Forgets what is kept from stage to stage.
    pub fn restart(&mut self) {
        self.rings.iter_mut().for_each(Steps::forget);
        self.responses.fill(Response::default());
        self.looks = usize::MAX;
    }

    /// Adds an accepted step of the gas to `wave`, whose rows `rows` are the states of the rings, in pieces that their steps ask for.
    pub fn record(&self, v: &dyn StepView, rows: &[usize], wave: &mut Track) {
        let mut ends: Vec<f64> = self.rings.iter().flat_map(Steps::ends).collect();
        ends.retain(|t| *t < v.t1() - SLACK && *t > v.t0() + SLACK);
        ends.push(v.t1());
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|a, b| *a - *b < SLACK);
        let n = v.y0().len();
        let (mut from, mut end) = (v.t0(), Vec::new());
        for to in ends {
            wave.add(to, |x, values| {
                let (y, q) = values.split_at_mut(n);
                // A piece begins where the one before ends.
                let known = match x {
                    0.0 if from == v.t0() => Some((v.y0(), v.q0())),
                    0.0 => Some(end.split_at(n)),
                    1.0 if to == v.t1() => Some((v.y1(), v.q1())),
                    _ => None,
                };
                if let Some((states, quads)) = known {
                    y.copy_from_slice(states);
                    q.copy_from_slice(quads);
                    return;
                }
                let t = if x == 1.0 { to } else { from + x * (to - from) };
                v.interpolate(t, y);
                v.interpolate_quad(t, q);
                let mut rows = rows.iter();
                for ring in self.rings.iter().filter(|r| r.n > 0) {
                    let own = ring.at(t);
                    own[..ring.n].iter().zip(rows.by_ref()).for_each(|(v, k)| y[*k] = *v);
                }
                if x == 1.0 {
                    end.clear();
                    end.extend_from_slice(values);
                }
            });
            from = to;
        }
    }
}

/// The states of the motion of ring `i` where it moves.
fn motion(pack: &Pack, i: usize) -> std::ops::Range<usize> {
    if pack.plan.axial { pack.layout.motion[i].clone() } else { 0..0 }
}

impl Pack {
    /// Gas, with the rings in their grooves following at steps of their own.
    pub(in super::super) fn grooves_by_steps(
        &mut self,
        stage: &Stage<'_>,
        y: &mut [f64],
        p: f64,
        w: &mut Staging,
    ) -> Result<(), EvalError> {
        let Staging { gas, rings: Some(rings), .. } = w else {
            return Err(EvalError::fatal("ring_pack", "no steps of rings"));
        };
        rings.begin_stage(stage.number, self.at.theta - stage.step);
        self.gas_pressures(p)?;
        for i in 0..self.n_rings() {
            if rings.responses[i].quiet[stage.number - 1] && rings.rings[i].is_whole() {
                self.go_on(i, stage, y, rings);
            } else {
                self.begin_response(i, stage, y, rings)?;
            }
        }
        if rings.looks > KEPT_LOOKS {
            self.gas_jacobian(p, gas, rings)?;
        }
        for pass in 0..=PASSES {
            let moving = rings.responses.iter().any(Response::is_known);
            let (mut standing, mut looks) = (false, 0);
            let ended = gas.solve(stage, y, &mut |y, _, r| {
                looks += 1;
                self.set_gas(y)?;
                if moving {
                    self.responses(p, rings, y)?;
                } else if standing {
                    self.gas_standing(p)?;
                } else {
                    self.gas(Some(p))?;
                    standing = true;
                }
                self.gas_lacks(stage, y, r);
                Ok(())
            })?;
            if pass == 0 {
                rings.looks = looks;
            }
            if ended == Ended::Foreseen {
                self.set_gas(y)?;
                self.gas_pressures(p)?;
            }
            let mut settled = true;
            for i in 0..self.n_rings() {
                settled &= self.has_settled(i, stage, y, rings)?;
            }
            if settled {
                return Ok(());
            }
        }
        Err(EvalError::recoverable("ring_pack", "gas and rings do not settle"))
    }

    /// Gives the solver of the gas its Jacobian while the rings stand, where the gas knows it.
    fn gas_jacobian(&mut self, p: f64, gas: &mut Together, w: &mut RingSteps) -> Result<(), EvalError> {
        let m = self.layout.gas.len();
        if w.partials.d_state.len() != m * m {
            w.partials = GasPartials::new(self.n_rings(), m);
        }
        if m > 0 && self.gas_partials(p, &mut w.partials)? {
            let (scale, omega) = (&self.gas_scale, self.omega);
            gas.set_jacobian(|r, k| w.partials.d_state[r * m + k] * scale[k] / (scale[r] * omega));
        }
        Ok(())
    }

    /// Puts the rings where they respond to, and has the gas flow.
    fn responses(&mut self, p: f64, w: &RingSteps, y: &mut [f64]) -> Result<(), EvalError> {
        self.gas_pressures(p)?;
        let both = w.rings.iter().zip(&w.responses).enumerate();
        both.for_each(|(i, (steps, respond))| self.respond(i, steps, respond, y));
        self.gas(Some(p))
    }

    /// Puts ring `i` where its response to the gas leads.
    fn respond(&mut self, i: usize, steps: &Steps, respond: &Response, y: &mut [f64]) {
        if steps.motion == 0 || !respond.is_known() {
            return;
        }
        self.external_forces(i);
        let force = self.at.rings[i].axial.gas;
        steps.put(y, &std::array::from_fn(|j| respond.at(j, force)));
        self.put(i, y);
    }

    /// Puts ring `i` where its states say.
    fn put(&mut self, i: usize, y: &[f64]) {
        let own = motion(self, i);
        let (ring, place) = (&self.rings[i], &mut self.at.places[i]);
        if !own.is_empty() {
            let pose = ring.motion.pose(&y[own], place.clearance);
            (place.s, place.v, place.lift_fraction) = (pose.s, pose.v, pose.lift_fraction);
        }
        place.flank = ring.flank.oil(&y[self.layout.flank[i].clone()], place);
    }

    /// Integrates ring `i` under the gas of the instant, by steps that are chosen now.
    fn begin_response(
        &mut self,
        i: usize,
        stage: &Stage<'_>,
        y: &mut [f64],
        w: &mut RingSteps,
    ) -> Result<(), EvalError> {
        let force = self.integrate(i, stage, y, w, true)?;
        let end = &w.rings[i].spans[stage.number - 1].end;
        w.responses[i].begin((stage.number, end.trend.1), force, &end.y);
        Ok(())
    }

    /// Puts ring `i` where it comes to at the rates that it had.
    fn go_on(&mut self, i: usize, stage: &Stage<'_>, y: &mut [f64], w: &mut RingSteps) {
        let steps = &w.rings[i];
        steps.put(y, &steps.ahead(stage.number, self.at.theta));
        self.put(i, y);
        (w.responses[i].known, w.responses[i].slope) = (false, [0.0; MOST_STATES]);
    }

    /// Integrates ring `i`, again or for the first time, under the gas that was found; whether it comes to where the gas saw it.
    fn has_settled(
        &mut self,
        i: usize,
        stage: &Stage<'_>,
        y: &mut [f64],
        w: &mut RingSteps,
    ) -> Result<bool, EvalError> {
        let (number, seen, least) = (stage.number, self.at.places[i], SEEN * w.tolerance);
        if !w.responses[i].known {
            self.begin_response(i, stage, y, w)?;
            let quiet = apart(&seen, &self.at.places[i]) <= least;
            w.responses[i].quiet[number - 1] = quiet;
            return Ok(quiet);
        }
        if self.is_unchanged(i, y, (number, w)) {
            return Ok(true);
        }
        let before = w.rings[i].spans[number - 1].place;
        let force = self.integrate(i, stage, y, w, false)?;
        let span = &w.rings[i].spans[number - 1];
        let moved = apart(&before, &span.place) > least;
        w.responses[i].learn((number, span.end.trend.1), force, &span.end.y, moved);
        if span.error <= KEPT {
            return Ok(apart(&seen, &self.at.places[i]) <= least);
        }
        self.begin_response(i, stage, y, w)?;
        Ok(false)
    }

    /// Whether the gas that was found acts on ring `i` nearly as that under which it was integrated.
    fn is_unchanged(&mut self, i: usize, y: &mut [f64], (number, w): (usize, &RingSteps)) -> bool {
        if w.rings[i].motion == 0 {
            return w.rings[i].n == 0;
        }
        self.external_forces(i);
        let a = &self.at.rings[i].axial;
        let change = (a.gas - w.responses[i].force).abs();
        let near =
            change <= NEARLY * w.tolerance * (a.gas + a.inertia + a.gravity + a.film + a.expander).abs();
        if near {
            w.rings[i].put(y, &w.rings[i].spans[number - 1].end.y);
        }
        near
    }

    /// Integrates ring `i` in its groove from the instant before, by steps that are chosen now or by those chosen before; the force of the gas \[N\] at the
    /// end.
    fn integrate(
        &mut self,
        i: usize,
        stage: &Stage<'_>,
        y: &mut [f64],
        w: &mut RingSteps,
        chooses: bool,
    ) -> Result<f64, EvalError> {
        let steps = &mut w.rings[i];
        let moves = steps.motion > 0;
        if moves {
            self.external_forces(i);
        }
        if steps.n == 0 {
            return Ok(0.0);
        }
        let acting = Acting::of(self, i);
        let to = Target { number: stage.number, acting, place: &self.at.places[i], chooses };
        steps.integrate(&mut self.rings[i], &to)?;
        steps.tell_lost(stage);
        let span = &steps.spans[stage.number - 1];
        steps.put(y, &span.end.y);
        self.at.places[i] = span.place;
        let r = &mut self.at.rings[i];
        if moves {
            (r.axial.damping, r.reaction) = (span.response.damping, span.response.reaction);
        }
        r.flank.lost = steps.lost[stage.number - 1];
        Ok(acting.gas_force())
    }
}

/// How far two places of a ring are apart for the gas, in clearances and open shares of gaps.
fn apart(a: &RingPlace, b: &RingPlace) -> f64 {
    let lift = |p: &RingPlace| p.s.clamp(0.0, p.clearance) / p.clearance;
    let lifts = if a.clearance > 0.0 { (lift(a) - lift(b)).abs() } else { 0.0 };
    let open = a.flank.open.iter().zip(&b.flank.open).map(|(a, b)| (a - b).abs());
    open.fold(lifts, f64::max)
}
