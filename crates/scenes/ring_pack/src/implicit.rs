//! The default solver: the whole scene at once, adaptive, with an L-stable integrator; the cycle closed by a
//! periodic-orbit solver.

use std::f64::consts::PI;

use gudgeon_core::content::{self, Content};
use gudgeon_core::quantity::{PosRatio, quantity};
use gudgeon_core::result::{Balance, Gradients};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use gudgeon_numerics::ode::{
    Again, Direction, EventAction, Flow, IntegrateError, Integrator, LinearInvariant, OdeSystem, Options,
    Stage, Stats, StepView,
};
use gudgeon_numerics::orbit::{Bend, Change, CycleMap, Led, OrbitOptions, OrbitReport, periodic_orbit};
use gudgeon_numerics::panel::{LOBATTO, SIMPSON};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::{Formula, Rodas};
use gudgeon_numerics::sdirk::Sdirk;

use super::around::Around;
use super::jacobian::Base;
use super::layout::Layout;
use super::modes::EventOf;
use super::pack::Pack;
use super::solver::{RingPackSolverSpec, Solution, Wanted};
use super::staged::Staging;
use super::waveform::{Setting, Waveform, moved};
use gudgeon_scene::{Asked, GradientError, MethodSetting, RunError, Stopped};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

mod approach;
mod films_alone;
mod gradients;
mod integrator;
mod sampler;
mod search;

pub use integrator::RingIntegrator;

use approach::leads;
use films_alone::FilmsAlone;
use sampler::Sampler;
use search::{oil_least, oil_noise, orbit_options, stopped};

/// The whole scene at once, adaptive and error-controlled; the cycle closed by a periodic-orbit solver.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Implicit {
    /// Relative error per step.
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub tolerance: PosRatio,
    /// Time integrator.
    pub integrator: RingIntegrator,
    /// True relative error of the periodic state; not below `tolerance`, with oil on the liner not below twenty times that up to 1e-2, or with
    /// `waveform` ten times up to 1e-3.
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub periodicity: PosRatio,
    /// Most cycles, all phases of the search together, before the run is called unconverged. The search begins with cycles in halves, at most half of all, where
    /// the pack can be halved (`waveform`); those of films alone, at most 31 after one of the whole pack, are not counted. Half of the others, but at least 60, are accelerated; the rest, and those of models with decided seats, repeat plainly.
    #[schemars(range(max = 1000))]
    pub max_cycles: u32,
}

impl Default for Implicit {
    fn default() -> Self {
        Self {
            tolerance: quantity(1e-4),
            integrator: RingIntegrator::Rodas,
            periodicity: quantity(1e-4),
            max_cycles: 120,
        }
    }
}

#[register_model(
    name = "implicit",
    summary = "the whole scene as one stiff system, adaptive, the cycle closed by a periodic-orbit solver",
    equations = "dy/dtheta = f(theta, y) by Rosenbrock methods of order 3 or 5, a singly diagonally implicit one of order 2, or Radau IIA;  y(theta + cycle) = y(theta) by Anderson acceleration, with oil on the liner by vector extrapolation in cycles, from where halves of the pack end",
    validity = "Every pack. Errors are controlled: results differ from those of the equations by about the tolerance.",
    references = ["sandu1997", "steinebach2023", "hairer1996", "alexander1977", "lelarasmee1982", "walker2011", "sidi2017", "stetter1978"],
    example = "tolerance = 1e-4\n",
)]
impl RingPackSolverSpec for Implicit {
    fn refuses(&self, pack: &Pack) -> Vec<BuildError> {
        let mut errors = Vec::new();
        if self.max_cycles == 0 {
            errors.push(BuildError::at("solver.max_cycles", "at least one cycle is needed"));
        }
        if self.integrator.has_stages() {
            errors.extend(pack.refuses_stages().map(|what| {
                BuildError::at("solver.integrator", what).help("use `rodas`, which every pack can")
            }));
        }
        if self.tolerance.si() > 0.1 || self.tolerance.si() < 1e-12 {
            errors.push(BuildError::at("solver.tolerance", "the tolerance must be between 1e-12 and 0.1"));
        }
        errors
    }

    /// Cycles in halves can be: gas with the motion in the grooves, and films.
    fn works_at_once(&self, pack: &Pack) -> bool {
        let halves = self.integrator == RingIntegrator::Waveform || leads(self, pack);
        halves && pack.films() > 0
    }

    fn solve(
        &self,
        pack: &mut Pack,
        start: f64,
        wanted: &Wanted<'_>,
        progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Result<Solution, RunError> {
        search::run(self, pack, start, wanted, progress)
    }

    fn gradients(
        &self,
        pack: &mut Pack,
        start: f64,
        wanted: &Wanted<'_>,
        around: Around<'_>,
        progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Result<Gradients, GradientError> {
        gradients::gradients(self, pack, start, wanted, around, progress)
    }

    /// Both orders at the tolerances that they are made for.
    fn settings(&self, pack: &Pack, own: Option<&Value>) -> Vec<MethodSetting> {
        let given = own.and_then(|v| content::read::<Self>(&Content::from(v)).ok());
        let default = given.as_ref().unwrap_or(self);
        let tolerance = default.tolerance.si();
        let orders: [(&str, &str, RingIntegrator, &[f64]); 4] = [
            ("implicit, order 3", "rodas3", RingIntegrator::Rodas3, &[1e-2, 3e-3, 1e-3, 3e-4, 1e-4]),
            ("implicit, order 5", "rodas5p", RingIntegrator::Rodas5p, &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6]),
            ("implicit, order 2", "sdirk2", RingIntegrator::Sdirk2, &[2e-2, 1e-2, 3e-3, 1e-3]),
            ("implicit, in halves", "waveform", RingIntegrator::Waveform, &[2e-2, 1e-2, 3e-3, 1e-3]),
        ];
        let orders = orders.into_iter().filter(|o| !o.2.has_stages() || pack.solves_stages());
        let setting = |(method, name, integrator, t): (&str, &str, RingIntegrator, f64)| MethodSetting {
            method: method.into(),
            setting: format!("tolerance {t:.0e}"),
            is_default: given.is_some()
                && (t / tolerance - 1.0).abs() < 1e-9
                && default.integrator.at(tolerance) == integrator,
            set: vec![
                "solver.method=implicit".into(),
                format!("solver.integrator={name}"),
                format!("solver.tolerance={t:e}"),
                format!("solver.periodicity={t:e}"),
            ],
            asked: Some(Asked { tolerance: t, ..Asked::default() }),
        };
        let all = orders.flat_map(|(m, n, i, all)| all.iter().map(move |t| (m, n, i, *t)));
        all.map(setting).collect()
    }
}

/// The pack as an initial-value problem in crank angle.
struct Problem<'a> {
    pack: &'a mut Pack,
    base: &'a mut Base,
    staging: &'a mut Staging,
    scale: &'a [f64],
    balance: &'a [LinearInvariant],
    events: &'a [EventOf],
    again: &'a mut Again,
}

impl Problem<'_> {
    /// Has the instant evaluated that the integrator asks about, which it usually just did.
    fn look_at(&mut self, t: f64, y: &[f64]) -> Result<(), EvalError> {
        if self.pack.at.theta == t && self.pack.state == y { Ok(()) } else { self.pack.evaluate(t, y) }
    }
}

impl OdeSystem for Problem<'_> {
    fn dim(&self) -> usize {
        self.pack.layout.n
    }
    fn quad_dim(&self) -> usize {
        self.pack.layout.quads()
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.pack.rates(t, y, f)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        self.look_at(t, y)?;
        let scale = self.scale;
        self.pack.jacobian(y, |k| increment(ROUNDING, y[k], scale[k]), jac, self.base)?;
        Ok(true)
    }
    fn stage(&mut self, t: f64, stage: &Stage<'_>, y: &mut [f64], g: &mut [f64]) -> Result<(), EvalError> {
        self.pack.stage(t, stage, y, g, self.staging)
    }
    fn invariants(&self) -> &[LinearInvariant] {
        self.balance
    }
    fn tolerances(&mut self, t: f64, y: &[f64], atol: &mut [f64]) {
        // Where the instant cannot be evaluated the step will say so.
        if self.look_at(t, y).is_err() {
            return;
        }
        self.pack.ease(atol);
    }
    fn n_events(&self) -> usize {
        self.events.len()
    }
    fn events(&mut self, t: f64, y: &[f64], g: &mut [f64]) -> Result<(), EvalError> {
        self.look_at(t, y)?;
        for (g, e) in g.iter_mut().zip(self.events) {
            *g = self.pack.block(e.block).event(e.event);
        }
        Ok(())
    }
    fn event_direction(&self, _: usize) -> Direction {
        Direction::Rising
    }
    fn event_located(&self, k: usize) -> bool {
        let e = self.events[k];
        self.pack.block(e.block).event_is_located(e.event)
    }
    fn on_event(&mut self, k: usize, t: f64, y: &mut [f64]) -> Result<EventAction, EvalError> {
        self.look_at(t, y)?;
        let e = self.events[k];
        let own = self.pack.range(e.block);
        self.pack.block_mut(e.block).switch(e.event, &mut y[own]);
        // The instant belongs to the other mode.
        self.pack.state.fill(f64::NAN);
        self.again.cut_off(t);
        Ok(EventAction::Restart)
    }
}

/// Square root of the rounding error.
const ROUNDING: f64 = 1.5e-8;

/// Increment of a difference in the state `y`: a part of its magnitude.
fn increment(part: f64, y: f64, scale: f64) -> f64 {
    (y + part * y.abs().max(1e-3 * scale)) - y
}

/// What follows a cycle step by step while it is integrated.
pub(super) trait Follower {
    /// The cycle begins at `theta` with the states `y`.
    fn begin(&mut self, pack: &mut Pack, theta: f64, y: &[f64]) -> Result<(), EvalError>;
    /// A step, or a piece of one between two events.
    fn step(&mut self, pack: &mut Pack, v: &dyn StepView) -> Flow;
    /// The oil of the step that ends at `theta` is booked.
    fn booked(&mut self, _pack: &Pack, _theta: f64) {}
}

/// The follower for one call.
pub(super) fn lend<'f>(follower: &'f mut Option<&mut dyn Follower>) -> Option<&'f mut dyn Follower> {
    match follower {
        Some(f) => Some(&mut **f),
        None => None,
    }
}

/// First step of a cycle \[rad\], and of one in halves: their stages are solved from farther away.
const FIRST_STEP: f64 = 1e-3;
const FIRST_OF_HALVES: f64 = 1e-2;

enum Method {
    Rodas(Box<Rodas>),
    Radau(Box<Radau5>),
    Sdirk(Box<Sdirk>),
    Waveform(Box<Waveform>),
}

impl Method {
    fn new(s: &Implicit, pack: &Pack) -> Self {
        let (dim, quads) = (pack.layout.n, pack.layout.quads());
        let rosenbrock = |formula| Self::Rodas(Box::new(Rodas::with(formula, dim, quads, None)));
        match s.integrator.at(s.tolerance.si()) {
            RingIntegrator::Rodas3 => rosenbrock(Formula::Rodas3),
            RingIntegrator::Rodas | RingIntegrator::Rodas5p => rosenbrock(Formula::Rodas5P),
            RingIntegrator::Sdirk2 => Self::Sdirk(Box::new(Sdirk::new(dim, quads))),
            RingIntegrator::Waveform => Self::Waveform(Box::new(Waveform::new(pack))),
            RingIntegrator::Radau5 => Self::Radau(Box::new(Radau5::new(dim, quads, None))),
        }
    }
}

/// A recorded cycle, and what its balances lack.
struct Taken {
    sampler: Sampler,
    balance: Balance,
}

/// The map from the state at the start of a cycle to that at its end.
struct Cycle<'a> {
    spec: &'a Implicit,
    wanted: Wanted<'a>,
    /// Whether the next cycle will probably be the last of the search, and is recorded; and what the last cycle left, if it was.
    expects: bool,
    taken: Option<Taken>,
    /// Whether another search begins where this one ends: none of its cycles is recorded.
    leads_on: bool,
    /// What is known of the slope of the map before the first cycle.
    known: Vec<Change>,
    /// How far from the orbit the search begins where it begins near it, infinite where nobody knows; and the cycles in halves that led there.
    near: Option<f64>,
    coarse: usize,
    /// Films that go through cycles by themselves, and how many these were.
    films: Option<FilmsAlone>,
    films_cycles: usize,
    /// The steps of the cycle before.
    again: Again,
    /// What is added to the end of each cycle; nothing where it is empty.
    moved: Vec<f64>,
    /// Whether cycles tell what passes through each passage of the gas.
    follows: bool,
    pack: &'a mut Pack,
    method: Method,
    breakpoints: Vec<f64>,
    scale: Vec<f64>,
    /// States that follow the others at once at the start of the last cycle or at its end.
    followers: Vec<bool>,
    absolute: Vec<bool>,
    balance: Vec<LinearInvariant>,
    events: Vec<EventOf>,
    base: Base,
    staging: Staging,
    h: f64,
    /// Relative error of a step that the case asks for, and what is asked of the periodic state.
    tolerance: f64,
    periodicity: f64,
    stats: Stats,
    q: Vec<f64>,
    /// Longest step \[rad\]: none may jump over a pressure pulse.
    longest_step: f64,
    /// Most steps of a cycle.
    max_steps: u64,
    failure: Option<IntegrateError>,
    /// Steps of a cycle at full accuracy, when known: the unit of cost.
    progress: &'a mut dyn FnMut(f64) -> Result<(), Stopped>,
    done: f64,
}

impl Cycle<'_> {
    /// Integrates one cycle from `y`.
    fn integrate(
        &mut self,
        y: &mut [f64],
        rtol: f64,
        mut follower: Option<&mut dyn Follower>,
    ) -> Result<(), IntegrateError> {
        let mut options = self.options(rtol);
        // The reference integrates every ring with its inertia.
        let accuracy = if matches!(self.method, Method::Rodas(_)) { rtol } else { 0.0 };
        self.pack.set_accuracy(accuracy);
        self.pack.events(&mut self.events);
        // Every cycle starts with the same step: the map must depend on nothing but the state.
        self.h = if matches!(self.method, Method::Waveform(_)) { FIRST_OF_HALVES } else { FIRST_STEP };
        self.staging.restart();
        self.q.fill(0.0);
        let period = self.pack.period();
        let interval = self.pack.decision_interval();
        if let Method::Waveform(w) = &mut self.method {
            options.h_init = self.h;
            let mut setting =
                Setting { breakpoints: &self.breakpoints, options: &options, stats: &mut self.stats };
            w.cycle(self.pack, y, &mut self.q, &mut setting, follower)?;
            w.compare(self.pack);
            return self.integrated();
        }
        let pieces = interval.map_or(1, |i| (period / i).round().max(1.0) as usize);
        let mut outcome = Ok(());
        options.ends = self.again.begin(y, rtol, |start| moved(self.pack, 0..y.len(), start, y));
        if let Some(films) = &mut self.films {
            films.waveform.begin_beside();
        }
        for piece in 0..pieces {
            let span = (period * piece as f64 / pieces as f64, period * (piece + 1) as f64 / pieces as f64);
            let first = if piece == 0 { lend(&mut follower) } else { None };
            let begun = self.begin_piece(span.0, y, interval.is_some(), first);
            outcome = begun.map_err(|source| IntegrateError::Eval { t: span.0, source });
            options.h_init = self.h;
            outcome = outcome.and_then(|()| self.piece(span, y, &options, lend(&mut follower)));
            if outcome.is_err() {
                break;
            }
        }
        if outcome.is_err() {
            // Steps of a part of a cycle say nothing of the rest.
            self.again = Again::default();
        }
        if let Some(films) = &mut self.films {
            films.waveform.end_beside(y);
        }
        outcome.and_then(|()| self.integrated())
    }

    /// Part of the search that is told to be done.
    fn progress_told(&self) -> f64 {
        1.0 - elementary::powf(0.8f64, self.done)
    }

    /// A cycle is done.
    fn integrated(&mut self) -> Result<(), IntegrateError> {
        self.done += 1.0;
        let told = self.progress_told();
        (self.progress)(told).map_err(|e| IntegrateError::Eval { t: self.pack.period(), source: e.into() })
    }

    fn options(&self, rtol: f64) -> Options {
        let mut options = Options::new(rtol, &self.scale);
        options.absolute.clone_from(&self.absolute);
        options.h_max = self.longest_step;
        options.max_steps = self.max_steps;
        if let Some(oil) = &self.pack.oil_pack
            && !matches!(self.method, Method::Waveform(_))
        {
            // A face takes up what the one before it left in earlier steps, which the Jacobian does not know.
            let speed = 1.1 * 0.5 * self.pack.kinematics.stroke() * self.pack.omega;
            options.h_max = options.h_max.min(oil.longest_way() * self.pack.omega / speed);
        }
        // Rings turn slowly beside the steps that their motion allows.
        options.event_samples = 0;
        options
    }

    /// Prepares the pack for the piece of the cycle from `theta` on; `first` follows the first piece.
    fn begin_piece(
        &mut self,
        theta: f64,
        y: &mut [f64],
        decides: bool,
        first: Option<&mut dyn Follower>,
    ) -> Result<(), EvalError> {
        if decides {
            self.pack.evaluate(theta, y)?;
            self.pack.decide_seats();
        }
        self.pack.start_modes(theta, y)?;
        first.map_or(Ok(()), |f| f.begin(self.pack, theta, y))
    }

    /// Integrates a piece of the cycle.
    fn piece(
        &mut self,
        span: (f64, f64),
        y: &mut [f64],
        options: &Options,
        mut follower: Option<&mut dyn Follower>,
    ) -> Result<(), IntegrateError> {
        let mut problem = Problem {
            pack: self.pack,
            base: &mut self.base,
            staging: &mut self.staging,
            scale: &self.scale,
            balance: &self.balance,
            events: &self.events,
            again: &mut self.again,
        };
        let (progress, done) = (&mut self.progress, 1.0 - elementary::powf(0.8f64, self.done));
        let films = &mut self.films;
        let (mut steps, mut stopped) = (0_u32, None);
        let mut observe = |p: &mut Problem<'_>, v: &dyn StepView| {
            steps += 1;
            p.again.step(v.t1());
            if steps.is_multiple_of(ASKED_EVERY)
                && let Err(e) = progress(done)
            {
                stopped = Some((v.t1(), e));
                return Flow::Stop;
            }
            if let Some(films) = films.as_mut() {
                films.waveform.see(v);
            }
            let flow = lend(&mut follower).map_or(Flow::Continue, |f| f.step(p.pack, v));
            p.pack.book_oil((v.t0(), v.y0()), (v.t1(), v.y1()));
            if let Some(f) = lend(&mut follower) {
                f.booked(p.pack, v.t1());
            }
            flow
        };
        let (b, q, st) = (&self.breakpoints, &mut self.q, &mut self.stats);
        self.h = match &mut self.method {
            Method::Rodas(m) => m.integrate(&mut problem, span, b, y, q, options, st, &mut observe),
            Method::Radau(m) => m.integrate(&mut problem, span, b, y, q, options, st, &mut observe),
            Method::Sdirk(m) => m.integrate(&mut problem, span, b, y, q, options, st, &mut observe),
            Method::Waveform(_) => Err(IntegrateError::Input { what: "a cycle in two halves has no pieces" }),
        }?;
        stopped.map_or(Ok(()), |(t, e)| Err(IntegrateError::Eval { t, source: e.into() }))
    }
}

impl Cycle<'_> {
    /// Takes the film on the liner from behind the states and begins a cycle with it.
    fn begin(&mut self, y: &[f64]) {
        let (n, pin) = (self.pack.layout.n, self.pack.kinematics.motion(0.0).y);
        if let Some(oil) = &mut self.pack.oil_pack {
            oil.begin_cycle(&y[self.pack.layout.oil.clone()], &y[n..], pin);
        }
    }

    /// Adds to the end of a cycle what is to be added: films and masses stay what they can be.
    fn move_on(&self, y: &mut [f64]) {
        y.iter_mut().zip(&self.moved).for_each(|(y, d)| *y += d);
        if !self.moved.is_empty() {
            let (states, carried) = y.split_at_mut(self.pack.layout.n);
            states.iter_mut().zip(&self.pack.layout.states).for_each(|(y, s)| *y = y.max(s.cycle_min));
            carried.iter_mut().for_each(|film| *film = film.max(0.0));
        }
    }

    /// Whether films go through a cycle of the whole pack by themselves: what they do otherwise than that is added to its end.
    fn films_go_alone(&self) -> bool {
        !self.moved.is_empty()
    }

    /// Whether a cycle of the whole pack from `y` can be quiet enough to be the last: in steps of its own it is as noisy as it is accurate.
    fn can_be_last(&self, y: &[f64], rtol: f64) -> bool {
        let away = |start: &[f64]| moved(self.pack, 0..start.len(), start, y);
        let again = self.again.serves(rtol, away);
        let noise = if again { Again::NOISE } else { 1.0 };
        matches!(self.method, Method::Waveform(_)) || noise * rtol < self.periodicity
    }

    /// Puts the film on the liner behind the states, and what the faces took up into them.
    fn end(&mut self, y: &mut [f64]) {
        let n = self.pack.layout.n;
        if let Some(oil) = &mut self.pack.oil_pack {
            let (states, field) = y.split_at_mut(n);
            oil.end_cycle(&mut states[self.pack.layout.oil.clone()], field);
        }
    }
}

/// By how much less a state counts between cycles that follows the others at once.
const FOLLOWS: f64 = 1e3;
/// Steps after which a long cycle asks whether to go on: some tenths of a second.
const ASKED_EVERY: u32 = 1000;

/// Tightest tolerance of a cycle: a hundred times the rounding of its states.
const FINEST: f64 = 1e-13;
/// What counts as one in the distance between the ends of a cycle of films alone, over that in one of the whole pack: of the oil that faces hold, and of the film on the liner. They
/// take the same steps again, and it is by such amounts that ring 1 runs dry at its upper turning point over a hundred cycles: a tenth of a micrometre on the liner, and a hundredth of the friction.
const FINER: (f64, f64) = (0.1, 0.02);
/// Part by which halves come nearer in a cycle at least: to a sixth usually.
const CLOSER: f64 = 3.0;
/// The same, as it usually is.
const SIXTH: f64 = 6.0;
/// How far halves may be apart, over what is asked of the periodic state, in the cycle of its search that is taken for the results.
const LIKE: f64 = 0.5;
/// How strongly oil on the liner bends the map of a cycle: what a face takes up goes by a meniscus whose place is a root of the volume, and a wave before an
/// edge is full at a corner. Volumes grow a hundredfold on the way, fivefold at most in a step. A cycle
/// differs from the next by as much as it is accurate: where secants are trusted nearer than that, the search of 36 packs takes an eighth more cycles. A residual is taken to be a third
/// of an error at most: where that is left to the secants, the friction of 24 packs is up to 4.1e-3 off at 3e-3 in place of 2.4e-3.
const OIL_BEND: Bend =
    Bend { fresh: 0.2, stride: 40.0, reach: 4.0, rough: 0.03, settles: (2, 1), noise: 1.0, slow: 3.0 };
/// Cycles of films alone that are not looked at: they are cheap, and shall find the slowest modes. With as few as of halves friction of fluttering packs is 2.5e-3 off at most, with these 1.1e-3.
const FILMS_SETTLE: (usize, usize) = (4, 2);
/// Least error over a residual of theirs where nothing is known. What lacks of the oil falls by a hundredth to a tenth a cycle: with 3, as of halves, two searches of 41 with rings that flutter ended after 28 and 34
/// cycles in place of 89 and 93, and their friction was 9e-3 and 7e-3 off; of the others three take up to six cycles more or less.
const FILMS_SLOW: f64 = 20.0;

impl CycleMap for Cycle<'_> {
    fn dim(&self) -> usize {
        self.pack.layout.n + self.pack.layout.carried
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        y1.copy_from_slice(y0);
        for (y, s) in y1.iter_mut().zip(&self.pack.layout.states) {
            *y = y.max(s.cycle_min);
        }
        let rtol = accuracy.max(FINEST);
        let n = self.pack.layout.n;
        (self.failure, self.taken) = (None, None);
        let done = if std::mem::take(&mut self.expects) && self.can_be_last(y1, rtol) {
            self.record(y1, rtol).map(|taken| self.taken = Some(taken))
        } else {
            self.begin(y1);
            self.integrate(&mut y1[..n], rtol, None)
        };
        if let Err(e) = done {
            let given_up = matches!(&e, IntegrateError::Eval { source: EvalError::Stopped, .. });
            self.failure = Some(e);
            let what = "the cycle could not be integrated";
            return Err(if given_up {
                EvalError::fatal("ring_pack", what)
            } else {
                EvalError::recoverable("ring_pack", what)
            });
        }
        // The velocity of a ring that could be held says nothing, at the start of the cycle or at its end.
        self.followers.fill(false);
        self.pack.add_followers(&mut self.followers);
        self.pack.start_modes(self.pack.period(), &mut y1[..n])?;
        self.pack.add_followers(&mut self.followers);
        self.end(y1);
        self.move_on(y1);
        Ok(1.0)
    }
    fn scale(&self, y: &[f64], s: &mut [f64]) {
        for ((s, y), info) in s.iter_mut().zip(y).zip(&self.pack.layout.states) {
            *s = if info.cycle_relative { y.abs().max(info.cycle_scale) } else { info.cycle_scale };
        }
        for (s, _) in s.iter_mut().zip(&self.followers).filter(|(_, follows)| **follows) {
            *s *= FOLLOWS;
        }
        let Some(oil) = &self.pack.oil_pack else { return };
        let Layout { n, oil: faces, .. } = &self.pack.layout;
        s[*n..].fill(oil.carried_scale());
        if self.films_go_alone() {
            for k in faces.clone() {
                s[k] = y[k].abs().max(FINER.0 * self.pack.layout.states[k].cycle_scale);
            }
            s[*n..].iter_mut().for_each(|s| *s *= FINER.1);
        }
    }
    fn admit(&self, reached: &[f64], y: &mut [f64]) {
        for ((y, r), info) in y.iter_mut().zip(reached).zip(&self.pack.layout.states) {
            let (least, largest) = info.cycle_range;
            *y = y.clamp(least.min(*r), largest.max(*r));
        }
    }
    fn noise(&self) -> f64 {
        match &self.method {
            // With oil that is said by how the map bends.
            Method::Waveform(w) if w.repeats() && self.pack.oil_pack.is_none() => Again::NOISE,
            Method::Waveform(_) => 1.0,
            _ => self.again.noise(),
        }
    }
    fn expect_last(&mut self) {
        // Halves that would still be too far apart then go on.
        self.expects = !self.leads_on && self.halves_apart() <= SIXTH * LIKE * self.periodicity;
    }
    fn gives_up(&self) -> bool {
        // Cycles of halves on the way count as well.
        let all = self.coarse + self.done as usize;
        let too_many = self.coarse > 0 && all >= self.spec.max_cycles as usize;
        too_many || matches!(&self.method, Method::Waveform(w) if w.come_apart())
    }
    fn known(&self) -> &[Change] {
        &self.known
    }
    fn begins_near(&self) -> Option<f64> {
        self.near
    }
    fn lead(&mut self, y: &[f64], end: &[f64], tolerance: f64) -> Result<Option<Led>, EvalError> {
        self.led_by_films((y, end), tolerance)
    }
    fn stays(&self) -> bool {
        // Oil evaporates, is scraped off or passes: of more than there is room for nothing stays.
        self.films_go_alone()
    }
    fn bend(&self) -> Option<Bend> {
        let noise = if matches!(self.method, Method::Waveform(_)) {
            oil_noise(self.tolerance) / self.tolerance
        } else {
            OIL_BEND.noise
        };
        let alone = self.films_go_alone();
        let (settles, slow) =
            if alone { (FILMS_SETTLE, FILMS_SLOW) } else { (OIL_BEND.settles, OIL_BEND.slow) };
        self.pack.oil_pack.is_some().then_some(Bend { noise, settles, slow, ..OIL_BEND })
    }
}

/// Crank angles where a right-hand side has a kink: those of the pressure, and the dead centres, where the sliding speed changes its sign.
fn breakpoints(pack: &Pack) -> Vec<f64> {
    let mut all: Vec<f64> = pack.cylinder.kinks().to_vec();
    all.extend((1..(pack.period() / PI).round() as usize).map(|k| k as f64 * PI));
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    all
}

/// What comes in, less what goes out, is stored: of the gas, and of the oil on the flanks of each ring. What goes out of the gas follows from the rest, or
/// what comes in where stages are solved to an accuracy: near equal pressures a flow goes with the root of what a stage lacks, and gas comes in by wide
/// passages.
fn balances(pack: &Pack, in_stages: bool) -> Vec<LinearInvariant> {
    let masses = pack.gas.n_masses();
    let mut all = Vec::new();
    if masses > 0 {
        let (first, last) = (pack.layout.n, pack.layout.n + pack.n_rings());
        let mut terms = vec![(first, -1.0), (last, 1.0)];
        terms.extend(pack.gas_scale[..masses].iter().copied().enumerate());
        all.push(LinearInvariant { pivot: if in_stages { first } else { last }, terms });
    }
    all.extend((0..pack.n_rings()).filter_map(|i| flank_balance(pack, i)));
    all
}

/// That of the oil on the flanks of ring `i`, where it is followed.
fn flank_balance(pack: &Pack, i: usize) -> Option<LinearInvariant> {
    let own = pack.layout.flank[i].clone();
    let fed = pack.layout.n + pack.layout.flank_quad(i).filter(|_| !own.is_empty())?;
    let mut terms = vec![(fed, -1.0), (fed + 1, 1.0)];
    for k in own.clone() {
        // The volume is linear in the states.
        let mut unit = vec![0.0; own.len()];
        unit[k - own.start] = 1.0;
        terms.push((k, pack.rings[i].flank.volume(&unit)));
    }
    Some(LinearInvariant { pivot: fed, terms })
}

impl<'a> Cycle<'a> {
    fn new(
        s: &'a Implicit,
        pack: &'a mut Pack,
        wanted: &Wanted<'a>,
        progress: &'a mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Self {
        let balance = balances(pack, s.integrator.has_stages());
        Cycle {
            spec: s,
            wanted: *wanted,
            expects: false,
            taken: None,
            leads_on: false,
            known: Vec::new(),
            near: None,
            coarse: 0,
            films: None,
            films_cycles: 0,
            moved: Vec::new(),
            follows: false,
            method: Method::new(s, pack),
            breakpoints: breakpoints(pack),
            scale: pack.layout.states.iter().map(|s| s.scale).collect(),
            followers: vec![false; pack.layout.n],
            absolute: pack.layout.states.iter().map(|s| !s.relative).collect(),
            balance,
            events: Vec::new(),
            base: Base::default(),
            again: Again::default(),
            staging: Staging::new(pack),
            h: FIRST_STEP,
            tolerance: s.tolerance.si(),
            periodicity: orbit_options(s, pack).tolerance,
            stats: Stats::default(),
            q: vec![0.0; pack.layout.quads()],
            longest_step: wanted.limits.longest_step.si(),
            max_steps: wanted.limits.steps_at(s.tolerance.si(), pack.omega),
            failure: None,
            progress,
            done: 0.0,
            pack,
        }
    }

    /// Cycles tell what passes through each passage of the gas from now on.
    fn follow_passages(&mut self) {
        if std::mem::replace(&mut self.follows, true) {
            return;
        }
        self.pack.follow_passages(true);
        match &mut self.method {
            Method::Waveform(w) => w.tell_quadratures(self.pack, &self.balance),
            method => *method = Method::new(self.spec, self.pack),
        }
        self.q = vec![0.0; self.pack.layout.quads()];
    }

    /// Searches the periodic state from `y`, and where the cycle is integrated in halves their agreement.
    fn close(&mut self, y: &mut [f64], options: &OrbitOptions) -> Result<OrbitReport, RunError> {
        self.periodic(y, options).map_err(|source| self.failed(source))
    }

    /// Why a search that could not go on failed: by its last cycle, or else by `source`.
    fn failed(&mut self, source: EvalError) -> RunError {
        let theta_deg = self.pack.at.theta.to_degrees();
        self.failure.take().map_or(RunError::Eval { theta_deg, source }, stopped)
    }

    fn periodic(&mut self, y: &mut [f64], options: &OrbitOptions) -> Result<OrbitReport, EvalError> {
        let mut report = periodic_orbit(self, y, options)?;
        // Where a search in halves with oil ends in the noise of its cycles it may be nearer than one of the whole pack is asked to come.
        report.converged |= self.pack.oil_pack.is_some()
            && matches!(&self.method, Method::Waveform(w) if !w.come_apart())
            && report.error_estimate <= oil_least(options.accuracy);
        if self.taken.is_some() {
            let apart = self.halves_apart();
            if report.converged && report.began_at() <= options.tolerance && apart <= LIKE * options.tolerance
            {
                report.error_estimate = report.began_at().max(apart);
                return Ok(report);
            }
            self.taken = None;
        }
        let (estimate, mut next) = (report.error_estimate, y.to_vec());
        while let Method::Waveform(w) = &mut self.method
            && report.converged
        {
            let apart = w.disagreement(self.pack);
            // The recorded cycle, in the same steps, brings both nearer once more.
            let left = if w.repeats() { apart / CLOSER } else { apart };
            report.error_estimate = estimate.max(left);
            if left <= options.tolerance {
                break;
            }
            report.converged = report.cycles < options.max_cycles && !w.come_apart();
            if !report.converged {
                break;
            }
            w.look_again();
            report.cycles += 1;
            report.cycle_equivalents += self.map(y, &mut next, options.accuracy)?;
            y.copy_from_slice(&next);
        }
        Ok(report)
    }

    /// How far the halves of the last cycle are apart, where there are any.
    fn halves_apart(&self) -> f64 {
        match &self.method {
            Method::Waveform(w) => w.disagreement(self.pack),
            _ => 0.0,
        }
    }

    /// Why a search in halves ended before its end.
    fn why_whole(&self) -> String {
        match &self.method {
            Method::Waveform(w) if w.ring_leaves() => {
                "a ring leaves the liner in the first cycle, from where halves may come to another periodic state".into()
            }
            _ => format!("films and the motion in the grooves did not come to agree in {} cycles", self.done),
        }
    }

    /// Judges how far the halves of the recorded cycle are apart, if it was integrated in the steps of the one before.
    fn judge(&self, report: &mut OrbitReport, tolerance: f64) {
        if let Method::Waveform(w) = &self.method
            && w.repeats()
        {
            let apart = w.disagreement(self.pack);
            report.error_estimate = report.error_estimate.max(apart);
            report.converged &= apart <= tolerance;
        }
    }

    /// The cycle from `y`, measured and kept row by row.
    fn record(&mut self, y: &mut [f64], tolerance: f64) -> Result<Taken, IntegrateError> {
        self.follow_passages();
        // Halves are looked at in pieces that are parts of the steps of both.
        let rule = if matches!(self.method, Method::Waveform(_)) { SIMPSON } else { LOBATTO };
        let mut sampler = Sampler::new(self.pack, &self.wanted, rule);
        let dim = self.pack.layout.n;
        let gas: Vec<f64> = y[..self.pack.gas.n_masses()].to_vec();
        self.begin(y);
        let oil_before = self.pack.oil_total(y);
        let flank_before = self.pack.flank_oil(y);
        if let Some(o) = &mut self.pack.oil_pack {
            // What the crankcase put on the liner before the first step was counted with the rest.
            o.clear_ledger();
        }
        self.integrate(&mut y[..dim], tolerance, Some(&mut sampler))?;
        if let Some(o) = &mut self.pack.oil_pack {
            o.settle();
        }
        if let Some(source) = sampler.failure.take() {
            return Err(IntegrateError::Eval { t: self.pack.at.theta, source });
        }
        let balance = self.balance_of(y, &gas, (oil_before, flank_before));
        Ok(Taken { sampler, balance })
    }

    /// What the balances of gas and oil lack over a cycle that ends at `y`, by what the pack held at its start.
    fn balance_of(&self, y: &[f64], gas: &[f64], (oil_before, flank_before): (f64, f64)) -> Balance {
        let oil_mass = self.pack.oil_pack.as_ref().map(|o| {
            let l = o.ledger();
            let stored = self.pack.oil_total(y) - oil_before;
            (l.gained() - stored).abs() / l.taken.max(f64::MIN_POSITIVE)
        });
        let (q, n) = (&self.q, self.pack.n_rings());
        let stored: f64 = gas.iter().zip(y).zip(&self.pack.gas_scale).map(|((a, b), m)| (b - a) * m).sum();
        // Packs without a pressure to drive them pass next to nothing: there what they hold is the measure.
        let held: f64 = y.iter().zip(&self.pack.gas_scale).take(gas.len()).map(|(m, scale)| m * scale).sum();
        let through = q[0].abs().max(q[n].abs()).max(held).max(f64::MIN_POSITIVE);
        let gas_mass = (q[0] - q[n] - stored).abs() / through;
        let flank_stored = self.pack.flank_oil(y) - flank_before;
        let flank_oil = self.pack.layout.flank_quad(0).map(|first| {
            let sum = |k: usize| q[first + k..first + 2 * n].iter().step_by(2).sum::<f64>();
            (sum(0) - sum(1) - flank_stored).abs() / sum(0).max(flank_before).max(f64::MIN_POSITIVE)
        });
        Balance { gas_mass: Some(gas_mass), oil_mass, flank_oil, ..Balance::default() }
    }
}
