//! Rings in their grooves at steps of their own within a step of the gas.
//!
//! A stage of the gas asks where a ring stands at its instant. The ring comes there from the instant before, the start of the step or its first stage, by
//! as many steps as its own accuracy asks for ([`super::span`]): a multirate method. While the gas is solved a ring responds linearly to the force of the gas; how, its
//! last two integrations tell (a secant a ring). Gas and rings alternate until every ring stands where the gas saw it.

use gudgeon_core::EvalError;
use gudgeon_core::geometry::RingPlace;
use gudgeon_core::kinds::GasPartials;
use gudgeon_core::states::Stage;
use gudgeon_numerics::ode::{Options, StepView};
use gudgeon_numerics::sdirk::GAMMA;

use super::super::pack::Pack;
use super::super::staged::{Staging, Together};
use super::acting::Acting;
use super::span::{MOST_STATES, Node, Span, States, Steps, ease};
use super::track::Track;

/// Error over the tolerance up to which steps chosen for other pressures are kept.
const KEPT: f64 = 2.0;
/// Difference, over the tolerance, between where a ring comes to and where the gas saw it, in clearances and open shares of gaps.
const SEEN: f64 = 3e-3;
/// Change of the force on a ring, over the tolerance and the sum of all forces, for which it is not integrated again.
const NEARLY: f64 = 0.03;
/// Least change of the force on a ring \[N\] from which its response is learnt.
const LEAST_FORCE: f64 = 1e-9;
/// Most solutions of the gas in a stage.
const PASSES: usize = 10;
/// Ends of steps that are one within this \[rad\].
const SLACK: f64 = 1e-9;

/// How a ring responds to the gas in a stage.
#[derive(Debug, Clone, Default)]
struct Response {
    /// Force of the gas \[N\], the states that it led to, and their derivatives by it.
    force: f64,
    y: States,
    slope: States,
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

    /// The first integration in a stage led to `y`.
    fn begin(&mut self, force: f64, y: &States) {
        *self = Self { force, y: *y, slope: [0.0; MOST_STATES] };
    }

    /// A further one led to `y`.
    fn learn(&mut self, force: f64, y: &States) {
        let change = force - self.force;
        if change.abs() > LEAST_FORCE {
            self.slope = std::array::from_fn(|j| (y[j] - self.y[j]) / change);
        }
        (self.force, self.y) = (force, *y);
    }
}

/// All rings over a step of the gas.
#[derive(Debug, Clone, Default)]
pub struct RingSteps {
    rings: Vec<Steps>,
    responses: Vec<Response>,
    partials: GasPartials,
    /// First step of a cycle \[rad\], and relative error of a step.
    first: f64,
    tolerance: f64,
}

impl RingSteps {
    /// For the rings of a pack.
    pub fn new(pack: &Pack) -> Self {
        let both = (0..pack.n_rings()).map(|i| (motion(pack, i).len(), pack.layout.flank[i].len()));
        let rings: Vec<_> = both.map(|(motion, flank)| Steps::new(motion, flank)).collect();
        let responses = vec![Response::default(); rings.len()];
        Self { rings, responses, ..Self::default() }
    }

    /// Sets accuracy and first step, for all states of the pack.
    pub fn set_accuracy(&mut self, pack: &Pack, options: &Options) {
        (self.first, self.tolerance) = (options.h_init, options.rtol);
        for (i, ring) in self.rings.iter_mut().enumerate() {
            for (j, k) in states(pack, i).enumerate() {
                ring.atol[j] = options.atol[k];
                ring.relative[j] = if options.absolute[k] { 0.0 } else { options.rtol };
            }
        }
    }

    /// The states whose error is judged here.
    pub fn judged(&self, pack: &Pack) -> Vec<usize> {
        (0..self.rings.len()).flat_map(|i| states(pack, i)).collect()
    }

    /// Begins at the instant of the pack, whose rates are known.
    pub fn begin(&mut self, pack: &Pack) {
        for (i, ring) in self.rings.iter_mut().enumerate() {
            let (mut y, mut rates) = ([0.0; MOST_STATES], [0.0; MOST_STATES]);
            for (j, k) in states(pack, i).enumerate() {
                (y[j], rates[j]) = (pack.state[k], pack.dy[k]);
            }
            if ring.spans[1].is_known() && y == ring.spans[1].end.y {
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

    /// Oil that left the flanks of ring `i` \[m²/s\], as a rate at stage `number` of a step over `h`.
    fn lost(&self, i: usize, number: usize, h: f64) -> f64 {
        let [first, second] = &self.rings[i].spans;
        let early = first.lost / (GAMMA * h);
        if number == 1 { early } else { ((first.lost + second.lost) / h - (1.0 - GAMMA) * early) / GAMMA }
    }

    /// Forgets what is kept from stage to stage.
    pub fn restart(&mut self) {
        self.rings.iter_mut().for_each(Steps::forget);
    }

    /// Adds an accepted step of the gas to `wave`, whose rows `rows` are the states of the rings, in pieces that their steps ask for.
    pub fn record(&self, v: &dyn StepView, rows: &[usize], wave: &mut Track) {
        let spans = self.rings.iter().flat_map(|r| &r.spans);
        let mut ends: Vec<f64> = spans.flat_map(Span::ends).collect();
        ends.retain(|t| *t < v.t1() - SLACK && *t > v.t0() + SLACK);
        ends.push(v.t1());
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|a, b| *a - *b < SLACK);
        let n = v.y0().len();
        let mut from = v.t0();
        for to in ends {
            wave.add(to, |x, values| {
                let t = if x == 1.0 { to } else { from + x * (to - from) };
                let (y, q) = values.split_at_mut(n);
                v.interpolate(t, y);
                v.interpolate_quad(t, q);
                let mut rows = rows.iter();
                for ring in self.rings.iter().filter(|r| r.n > 0) {
                    let own = ring.at(t);
                    own[..ring.n].iter().zip(rows.by_ref()).for_each(|(v, k)| y[*k] = *v);
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

/// The states of ring `i` in its groove: motion, and oil on the flanks.
fn states(pack: &Pack, i: usize) -> impl Iterator<Item = usize> + Clone {
    motion(pack, i).chain(pack.layout.flank[i].clone())
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
        let Staging { gas, radii, rings: Some(rings), .. } = w else {
            return Err(EvalError::fatal("ring_pack", "no steps of rings"));
        };
        rings.begin_stage(stage.number, self.at.theta - stage.step);
        self.gas_pressures(p)?;
        for (i, radius) in radii.iter().enumerate() {
            self.at.places[i] = self.place(i, *radius, y);
            let force = self.integrate(i, stage, y, rings, true)?;
            rings.responses[i].begin(force, &rings.rings[i].spans[stage.number - 1].end.y);
        }
        self.gas_jacobian(p, gas, rings)?;
        for _ in 0..=PASSES {
            let moving = rings.responses.iter().any(Response::is_known);
            let mut standing = false;
            gas.solve(stage, y, &mut |y, _, r| {
                self.set_gas(y)?;
                if moving {
                    self.responses(p, &rings.responses, y)?;
                } else if standing {
                    self.gas_standing(p)?;
                } else {
                    self.gas(Some(p))?;
                    standing = true;
                }
                self.gas_lacks(stage, y, r);
                Ok(())
            })?;
            let mut settled = true;
            for i in 0..radii.len() {
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
    fn responses(&mut self, p: f64, responses: &[Response], y: &mut [f64]) -> Result<(), EvalError> {
        self.gas_pressures(p)?;
        responses.iter().enumerate().for_each(|(i, respond)| self.respond(i, respond, y));
        self.gas(Some(p))
    }

    /// Puts ring `i` where its response to the gas leads.
    fn respond(&mut self, i: usize, respond: &Response, y: &mut [f64]) {
        let own = motion(self, i);
        if own.is_empty() || !respond.is_known() {
            return;
        }
        self.external_forces(i);
        let force = self.at.rings[i].axial.gas;
        states(self, i).enumerate().for_each(|(j, k)| y[k] = respond.at(j, force));
        let (ring, place) = (&self.rings[i], &mut self.at.places[i]);
        let pose = ring.motion.pose(&y[own], place.clearance);
        (place.s, place.v, place.lift_fraction) = (pose.s, pose.v, pose.lift_fraction);
        place.flank = ring.flank.oil(&y[self.layout.flank[i].clone()], place);
    }

    /// Integrates ring `i` again under the gas that was found; whether it comes to where the gas saw it.
    fn has_settled(
        &mut self,
        i: usize,
        stage: &Stage<'_>,
        y: &mut [f64],
        w: &mut RingSteps,
    ) -> Result<bool, EvalError> {
        let (number, seen) = (stage.number, self.at.places[i]);
        if self.is_unchanged(i, y, (number, w)) {
            return Ok(true);
        }
        let force = self.integrate(i, stage, y, w, false)?;
        let span = &w.rings[i].spans[number - 1];
        w.responses[i].learn(force, &span.end.y);
        if span.error <= KEPT {
            return Ok(apart(&seen, &self.at.places[i]) <= SEEN * w.tolerance);
        }
        let force = self.integrate(i, stage, y, w, true)?;
        w.responses[i].begin(force, &w.rings[i].spans[number - 1].end.y);
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
            states(self, i).zip(&w.rings[i].spans[number - 1].end.y).for_each(|(k, v)| y[k] = *v);
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
        let moves = !motion(self, i).is_empty();
        if moves {
            self.external_forces(i);
        }
        let steps = &mut w.rings[i];
        if steps.n == 0 {
            return Ok(0.0);
        }
        let (acting, place) = (Acting::of(self, i), self.at.places[i]);
        steps.integrate(&mut self.rings[i], stage.number, acting, &place, chooses)?;
        let span = &steps.spans[stage.number - 1];
        states(self, i).zip(&span.end.y).for_each(|(k, v)| y[k] = *v);
        self.at.places[i] = span.place;
        let r = &mut self.at.rings[i];
        if moves {
            (r.axial.damping, r.reaction) = (span.response.damping, span.response.reaction);
        }
        r.flank.lost = w.lost(i, stage.number, stage.step / GAMMA);
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
