//! A cycle in two halves: gas with the rings in their grooves, then films, each at steps of its own.
//!
//! The two sides of a pack ask little of each other. Films need pressures; gas and grooves need how thick the films are and what force they put on the
//! rings along the liner. So the cycle is integrated twice, each time one side alone, while what the other side did over its last cycle stands in for it
//! (waveform relaxation, lelarasmee1982). Each side takes the steps that it needs itself, and its stages are smaller problems. What the sides do not agree on
//! shrinks by some six times a cycle, beside the search of the periodic state, and the end of both is the solution of the whole pack.

use gudgeon_core::EvalError;
use gudgeon_core::states::Stage;
use gudgeon_numerics::ode::{
    Flow, IntegrateError, Integrator, LinearInvariant, OdeSystem, Options, Stats, StepView,
};
use gudgeon_numerics::sdirk::{self, Sdirk};

use super::films_between::FilmsBetween;
use super::implicit::{Follower, lend};
use super::layout::Layout;
use super::pack::Pack;
use super::staged::Staging;

mod acting;
mod grid;
mod guess;
mod joint;
mod repeat;
mod ring_stage;
mod rings;
mod span;
mod track;

pub use grid::moved;
pub use rings::RingSteps;
pub use span::MOST_STATES;

use grid::{Grid, Rule};
use guess::Guess;
use joint::{Joint, Part};
use repeat::{Repeat, Serves};
use track::Track;

/// What is integrated together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Gas, the motion of the rings in their grooves, and the oil on the flanks.
    Grooves,
    /// Films, the oil under them and their temperatures.
    Films,
}

impl Side {
    /// Its states, in their order.
    fn states(self, layout: &Layout) -> Vec<usize> {
        let flat = |all: &[std::ops::Range<usize>]| all.iter().cloned().flatten().collect::<Vec<_>>();
        match self {
            Self::Grooves => {
                layout.gas.clone().chain(flat(&layout.motion)).chain(flat(&layout.flank)).collect()
            }
            Self::Films => {
                let films = flat(&layout.radial).into_iter();
                films.chain(layout.oil.clone()).chain(layout.temperature.clone()).collect()
            }
        }
    }

    /// Its quadratures: friction is that of the films, all others are of gas and flanks.
    fn quads(self, layout: &Layout) -> Vec<usize> {
        let friction = layout.friction_quads();
        (0..layout.quads()).filter(|k| friction.contains(k) == (self == Self::Films)).collect()
    }
}

/// One side over a cycle.
struct Half {
    part: Part,
    method: Sdirk,
    /// States and quadratures of the last cycle.
    wave: Track,
    /// The linear invariants of the pack that lie within this side, by its rows.
    invariants: Vec<LinearInvariant>,
    /// Its steps.
    grid: Grid,
}

impl Half {
    fn new(side: Side, pack: &Pack) -> Self {
        Self::with(Part::new(side.states(&pack.layout), Vec::new()), pack, &[])
    }

    fn with(part: Part, pack: &Pack, balance: &[LinearInvariant]) -> Self {
        let n = pack.layout.n;
        let row = |r: usize| part.row(r, n);
        let own = |v: &LinearInvariant| {
            let terms: Option<Vec<_>> = v.terms.iter().map(|(r, c)| Some((row(*r)?, *c))).collect();
            Some(LinearInvariant { pivot: row(v.pivot)?, terms: terms? })
        };
        Self {
            method: Sdirk::new(part.states.len(), part.quads.len()),
            wave: Track::new(part.width(), &track::THIRDS),
            invariants: balance.iter().filter_map(own).collect(),
            grid: Grid::default(),
            part,
        }
    }
}

/// Change of the films, over the accuracy, of which gas and grooves need not know while the periodic state is searched.
const ALIKE: f64 = 5.0;

/// Cycle from which on the halves are compared, without oil on the liner and with it, and how far they may be apart if they come no nearer from one cycle to the next:
/// of 54 packs of three rings those that come to agree are within 0.05 after four cycles, and those that do not are beyond 0.2 after five. With six rings they agree from 0.13 on.
/// With oil they may part for a while as it spreads, and for a cycle after a step of the search: of 21 packs those that agree are within 0.1 in one cycle of two from the
/// eighth on, and the two that do not are beyond 0.17 in the six from there.
const COMPARED: [usize; 2] = [3, 8];
const APART: [f64; 2] = [0.1, 0.15];

/// Error of a step of gas and grooves over the accuracy up to which it stays while the periodic state is searched without oil on the liner: a sixth fewer are tried again, and of
/// 400 packs the search takes 2 % fewer steps and as many cycles (with 2.5 more). No accuracy is lost, for the recorded cycle tries them again.
const SEARCHED: f64 = 1.7;

/// Both sides of a pack over a cycle.
pub struct Waveform {
    grooves: Half,
    films: Half,
    staging: Staging,
    /// Forces \[N\] of the films on the rings along the liner over the last cycle.
    forces: Track,
    /// What the films did that gas and grooves saw last, and how these began and ended then.
    before: [Track; 2],
    seen: Option<Seen>,
    /// Whether both sides took the steps of the cycle before in the last one.
    repeats: [bool; 2],
    /// Cycles so far; how far the halves are apart after the last one, where that is known, and whether they part.
    cycles: usize,
    apart: Option<f64>,
    parts: bool,
    /// Whether a ring left the liner in the first cycle.
    retreats: bool,
    /// Whether gas and grooves stand as an integration of the whole pack found them, and all states at an instant of that.
    held: bool,
    between: Vec<f64>,
}

/// Gas and grooves over the cycle in which they were integrated last, while the periodic state is searched: no quadratures are told then.
struct Seen {
    start: Vec<f64>,
    end: Vec<f64>,
}

/// What a cycle is integrated with.
pub struct Setting<'a> {
    /// Where steps end.
    pub breakpoints: &'a [f64],
    /// Accuracy and limits, for all states.
    pub options: &'a Options,
    pub stats: &'a mut Stats,
}

impl Waveform {
    /// For a pack, without quadratures.
    pub fn new(pack: &Pack) -> Self {
        let films = Half::new(Side::Films, pack);
        let forces = Track::new(pack.n_rings(), &sdirk::PLACES);
        Self {
            grooves: Half::new(Side::Grooves, pack),
            before: [films.wave.clone(), forces.clone()],
            seen: None,
            repeats: [false; 2],
            cycles: 0,
            apart: None,
            parts: false,
            retreats: false,
            held: false,
            between: Vec::new(),
            films,
            staging: Staging::with_ring_steps(pack),
            forces,
        }
    }

    /// Cycles tell the quadratures of the pack, whose balances are `balance`, from now on.
    pub fn tell_quadratures(&mut self, pack: &Pack, balance: &[LinearInvariant]) {
        for (half, side) in [(&mut self.grooves, Side::Grooves), (&mut self.films, Side::Films)] {
            let part = Part::new(side.states(&pack.layout), side.quads(&pack.layout));
            let told = Half::with(part, pack, balance);
            let Half { wave, grid, .. } = std::mem::replace(half, told);
            // What has no states is not integrated: its quadratures stand still beside the other half, in a wave that has room for them.
            if !half.part.states.is_empty() {
                (half.wave, half.grid) = (wave, grid);
            }
        }
    }

    /// Integrates a cycle from `y`; `q` are the quadratures over it.
    pub fn cycle(
        &mut self,
        pack: &mut Pack,
        y: &mut [f64],
        q: &mut [f64],
        setting: &mut Setting<'_>,
        mut follower: Option<&mut dyn Follower>,
    ) -> Result<(), IntegrateError> {
        if self.films.wave.is_empty() {
            self.stand_still(pack.period(), y);
        }
        let begin = y.to_vec();
        self.staging.restart();
        let start = |pack: &mut Pack, follower: &mut Option<&mut dyn Follower>| {
            let begun = lend(follower).map_or(Ok(()), |f| f.begin(pack, 0.0, &begin));
            begun.map_err(|source| IntegrateError::Eval { t: 0.0, source })
        };
        let rtol = setting.options.rtol;
        // A cycle is looked at in its second half, where both are known. Without films there is none.
        match self
            .seen
            .take()
            .filter(|seen| self.held || follower.is_none() && self.stand(seen, pack, y, rtol))
        {
            Some(seen) => {
                let part = &self.grooves.part;
                part.put(&seen.end, y);
                self.seen = Some(seen);
            }
            None => self.grooves(pack, y, q, setting, follower.is_some())?,
        }
        start(pack, &mut follower)?;
        if !self.films.part.states.is_empty() {
            return self.films(pack, y, q, setting, follower);
        }
        let mut joint = Joint::new(&self.films.wave, [&self.films.part, &self.grooves.part], pack);
        if let Some(f) = follower {
            for step in self.grooves.wave.steps(self.grooves.part.states.len()) {
                if joint.pieces(&step, |piece| f.step(pack, piece)) == Flow::Stop {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Whether gas and grooves would do again what they did, to `rtol`: they begin as they did and see much the same films. Without oil on the liner the periodic state is found sooner than
    /// that would pay.
    fn stand(&self, seen: &Seen, pack: &Pack, y: &[f64], rtol: f64) -> bool {
        pack.oil_pack.is_some()
            && moved(pack, self.grooves.part.states.iter().copied(), &seen.start, y) <= rtol
            && self.disagreement(pack) <= ALIKE * rtol
    }

    /// Gas and grooves stand from now on as they are in an integration of the whole pack that begins, whose steps [`Self::see`] is told.
    pub fn begin_beside(&mut self) {
        self.grooves.wave.begin(0.0, self.grooves.part.width());
        (self.held, self.seen, self.apart, self.parts) = (true, None, None, false);
    }

    /// A step of the whole pack.
    pub fn see(&mut self, v: &dyn StepView) {
        let Self { grooves: Half { wave, part, .. }, between, .. } = self;
        let (t0, t1) = (v.t0(), v.t1());
        between.resize(v.y0().len(), 0.0);
        wave.add(t1, |x, values| {
            let all = if x == 0.0 {
                v.y0()
            } else if x == 1.0 {
                v.y1()
            } else {
                v.interpolate(t0 + x * (t1 - t0), between);
                &**between
            };
            part.take(all, values);
        });
    }

    /// The integration of the whole pack ended at `y`; where it began does not matter to what stands.
    pub fn end_beside(&mut self, y: &[f64]) {
        self.seen = Some(Seen { start: Vec::new(), end: of(y, &self.grooves.part.states) });
    }

    /// Has gas and grooves integrated in the next cycle, whatever they see.
    pub fn look_again(&mut self) {
        self.seen = None;
    }

    /// Before anything is known of the films they stay as they begin, without a force.
    fn stand_still(&mut self, period: f64, y: &[f64]) {
        self.films.wave.hold(period, self.films.part.states.iter().map(|&k| y[k]));
        self.forces.hold(period, std::iter::empty());
    }

    fn grooves(
        &mut self,
        pack: &mut Pack,
        y: &mut [f64],
        q: &mut [f64],
        setting: &mut Setting<'_>,
        recorded: bool,
    ) -> Result<(), IntegrateError> {
        let rule = self.again(Side::Grooves, pack, y, setting.options.rtol, recorded);
        let half = &mut self.grooves;
        let start = of(y, &half.part.states);
        self.before[0].clone_from(&self.films.wave);
        self.before[1].clone_from(&self.forces);
        half.wave.begin(0.0, half.part.width());
        let (wave, part, mut ends) = (&mut half.wave, &half.part, Vec::new());
        half.grid.repeat.begin(if rule.is_some() { Serves::Rates } else { Serves::Nothing });
        if let Some(rings) = &mut self.staging.rings {
            rings.set_accuracy(setting.options);
        }
        // Quadratures need the flows of the gas that was found.
        self.staging.gas.foresee(part.quads.is_empty());
        let mut system = OneSide::new(Side::Grooves, pack, &mut self.staging, part, &half.invariants).beside(
            &self.films.part,
            &self.films.wave,
            Some(&self.forces),
        );
        let rows = system.judged.clone();
        system.repeat = Some(&mut half.grid.repeat);
        let mut observe = |s: &mut OneSide<'_>, v: &dyn StepView| {
            ends.push(v.t1());
            match &s.staging.rings {
                Some(rings) if recorded => rings.record(v, &rows, wave),
                _ => wave.step(v),
            }
            Flow::Continue
        };
        integrate(
            &mut half.method,
            &mut system,
            setting,
            rule.map(|r| (r, &half.grid.ends[..])),
            (y, q),
            &mut observe,
        )?;
        half.grid.ends = ends;
        if rule.is_none() {
            half.grid.choose(start.clone(), None, setting.options.rtol);
        }
        self.seen = Some(Seen { start, end: of(y, &half.part.states) });
        Ok(())
    }

    fn films(
        &mut self,
        pack: &mut Pack,
        y: &mut [f64],
        q: &mut [f64],
        setting: &mut Setting<'_>,
        mut follower: Option<&mut dyn Follower>,
    ) -> Result<(), IntegrateError> {
        let rtol = setting.options.rtol;
        let rule = self.again(Side::Films, pack, y, rtol, follower.is_some());
        let start = of(y, &self.films.part.states);
        // With oil on the liner films are to be where that is now.
        let looked_at = follower.is_some() && pack.oil_pack.is_none();
        pack.between = looked_at.then(|| FilmsBetween::new(pack.n_rings()));
        let half = &mut self.films;
        half.wave.begin(0.0, half.part.width());
        self.forces.begin(0.0, pack.n_rings());
        let (wave, forces, beside) = (&mut half.wave, &mut self.forces, &self.grooves);
        let part = &half.part;
        let mut system = OneSide::new(Side::Films, pack, &mut self.staging, part, &half.invariants).beside(
            &beside.part,
            &beside.wave,
            None,
        );
        half.grid.repeat.begin(match rule {
            Some(_) => Serves::Rates,
            // With oil on the liner cycles take a tenth fewer films, but the search is as many cycles longer.
            None if system.pack.oil_pack.is_some() => Serves::Nothing,
            None => Serves::Trend,
        });
        system.repeat = Some(&mut half.grid.repeat);
        let mut joint = Joint::new(&beside.wave, [&beside.part, part], system.pack);
        let (first, retreats) = (self.cycles == 0 && !self.held, &mut self.retreats);
        let mut observe = |s: &mut OneSide<'_>, v: &dyn StepView| {
            wave.step(v);
            forces.push(v.t1(), &s.axial);
            s.pack.between.iter_mut().for_each(|films| films.took(v.t0(), v.t1()));
            let flow = lend(&mut follower)
                .map_or(Flow::Continue, |f| joint.pieces(v, |piece| f.step(s.pack, piece)));
            s.next();
            s.book(v);
            *retreats |= first && s.pack.retreats(&s.y);
            if let Some(f) = lend(&mut follower) {
                f.booked(s.pack, v.t1());
            }
            flow
        };
        let done = integrate(
            &mut half.method,
            &mut system,
            setting,
            rule.map(|r| (r, &half.grid.ends[..])),
            (y, q),
            &mut observe,
        );
        pack.between = None;
        done?;
        half.grid.ends = half.wave.ends().to_vec();
        if rule.is_none() {
            half.grid.choose(start, pack.oil_pack.as_ref().map(|_| half.wave.clone()), rtol);
        }
        Ok(())
    }

    /// The rule by which a side takes the steps of the last cycle again from `y`, if it does.
    fn again(&mut self, side: Side, pack: &Pack, y: &[f64], rtol: f64, recorded: bool) -> Option<Rule> {
        let half = if side == Side::Grooves { &self.grooves } else { &self.films };
        let films = &self.films.wave;
        let rule = Rule::of(side, pack, recorded)
            .filter(|rule| half.grid.serves(*rule, pack, &half.part, (y, films), rtol));
        self.repeats[side as usize] = rule.is_some();
        rule
    }

    /// Whether the last cycle took the steps of the one before.
    pub fn repeats(&self) -> bool {
        self.repeats == [true; 2]
    }

    /// Compares the halves after a cycle, from the one on in which they must have come nearer if they do at all.
    pub fn compare(&mut self, pack: &Pack) {
        if self.held {
            return;
        }
        self.cycles += 1;
        let (before, oil) = (self.apart.take(), pack.oil_pack.is_some());
        let most = APART[usize::from(oil)];
        if self.cycles >= COMPARED[usize::from(oil)] {
            let apart = self.disagreement(pack);
            self.parts = apart > most
                && before.is_some_and(|before| if oil { before > most } else { apart >= before });
            self.apart = Some(apart);
        }
    }

    /// Whether a ring left the liner in the first cycle.
    ///
    /// Such a ring lets gas past, of which the other half knows a cycle later: halves then take many cycles, or come to another periodic state than the pack does from the same start.
    /// Of 150 packs the rings either stay within 21 um of the liner in that cycle or go beyond 270.
    pub const fn ring_leaves(&self) -> bool {
        self.retreats
    }

    /// Whether the halves come apart, or are not worth another cycle.
    pub const fn come_apart(&self) -> bool {
        self.parts || self.retreats
    }

    /// How much the films of the last cycle differ from those that gas and grooves of that cycle saw: the mean of the change of thickness over itself, and that
    /// of their forces over their size, whichever is larger.
    pub fn disagreement(&self, pack: &Pack) -> f64 {
        if let Some(apart) = self.apart {
            return apart;
        }
        let period = pack.period();
        let films = pack.films();
        if films == 0 || self.held {
            return 0.0;
        }
        let thickness = self.films.wave.mean_change(&self.before[0], period, films).change;
        let force = self.forces.mean_change(&self.before[1], period, self.forces.width());
        thickness.max(force.change / force.size.max(f64::MIN_POSITIVE))
    }
}

/// Values at some places.
fn of(all: &[f64], places: &[usize]) -> Vec<f64> {
    places.iter().map(|&k| all[k]).collect()
}

/// Integrates one side over a cycle.
fn integrate(
    method: &mut Sdirk,
    system: &mut OneSide<'_>,
    setting: &mut Setting<'_>,
    again: Option<(Rule, &[f64])>,
    (y, q): (&mut [f64], &mut [f64]),
    observe: &mut dyn FnMut(&mut OneSide<'_>, &dyn StepView) -> Flow,
) -> Result<(), IntegrateError> {
    let part = system.part;
    let mut options = setting.options.clone();
    if let Some((rule, ends)) = again {
        (options.ends, options.slack) = (ends.to_vec(), rule.slack);
    } else if system.side == Side::Grooves && system.pack.oil_pack.is_none() && part.quads.is_empty() {
        options.slack = SEARCHED;
    }
    options.atol = of(&options.atol, &part.states);
    options.absolute = part.states.iter().map(|&k| setting.options.absolute[k]).collect();
    let (mut states, mut quads) = (of(y, &part.states), vec![0.0; part.quads.len()]);
    let span = (0.0, system.pack.period());
    let st = &mut *setting.stats;
    method.integrate(system, span, setting.breakpoints, &mut states, &mut quads, &options, st, observe)?;
    part.put(&states, y);
    part.quads.iter().zip(&quads).for_each(|(&k, v)| q[k] = *v);
    Ok(())
}

/// One side as an initial-value problem, the other as it was over its last cycle.
struct OneSide<'a> {
    side: Side,
    pack: &'a mut Pack,
    staging: &'a mut Staging,
    part: &'a Part,
    invariants: &'a [LinearInvariant],
    other: Option<(&'a Part, &'a Track)>,
    forces: Option<&'a Track>,
    /// All states at an instant.
    y: Vec<f64>,
    /// What the other side is then.
    beside: Vec<f64>,
    /// Forces of the films: those given, or those found at the start and at the stages of the step, one instant after the other.
    axial: Vec<f64>,
    /// Base, and accuracy, of a stage for all states.
    base: Vec<f64>,
    accuracy: Vec<f64>,
    quads: Vec<f64>,
    /// States whose errors the steps of the rings judge, by their rows.
    judged: Vec<usize>,
    guess: Guess,
    /// The same stages of the cycle before, where they are known.
    repeat: Option<&'a mut Repeat>,
}

impl<'a> OneSide<'a> {
    fn new(
        side: Side,
        pack: &'a mut Pack,
        staging: &'a mut Staging,
        part: &'a Part,
        invariants: &'a [LinearInvariant],
    ) -> Self {
        let n = pack.layout.n;
        let instants = if side == Side::Films { sdirk::PLACES.len() } else { 1 };
        let rings = staging.rings.iter().filter(|_| side == Side::Grooves);
        let judged = rings.flat_map(RingSteps::judged).filter_map(|k| part.row(k, n)).collect();
        Self {
            side,
            staging,
            part,
            invariants,
            other: None,
            forces: None,
            y: vec![0.0; n],
            beside: Vec::new(),
            axial: vec![0.0; instants * pack.n_rings()],
            base: vec![0.0; n],
            accuracy: vec![1.0; n],
            quads: vec![0.0; pack.layout.quads()],
            judged,
            guess: Guess::default(),
            repeat: None,
            pack,
        }
    }

    fn beside(mut self, part: &'a Part, wave: &'a Track, forces: Option<&'a Track>) -> Self {
        self.beside = vec![0.0; part.states.len()];
        self.other = Some((part, wave));
        self.forces = forces;
        self
    }

    /// All states for those of this side.
    fn fill(&mut self, t: f64, y: &[f64]) {
        self.part.put(y, &mut self.y);
        if let Some((part, wave)) = self.other {
            wave.eval(t, 0, &mut self.beside);
            part.put(&self.beside, &mut self.y);
        }
        if let Some(forces) = self.forces {
            forces.eval(t, 0, &mut self.axial);
        }
    }

    fn evaluate(&mut self, t: f64, y: &[f64]) -> Result<(), EvalError> {
        self.fill(t, y);
        self.pack.evaluate_of(self.side, t, &self.y, &self.axial)?;
        self.keep_forces(0)
    }

    /// Keeps the forces of the films at an instant of the step.
    fn keep_forces(&mut self, instant: usize) -> Result<(), EvalError> {
        if self.side != Side::Films {
            return Ok(());
        }
        let n = self.pack.n_rings();
        let kept = self.axial[instant * n..].iter_mut();
        kept.zip(&self.pack.at.rings).for_each(|(f, r)| *f = r.axial.film);
        if self.pack.between.is_some() {
            (0..n).try_for_each(|i| self.pack.film_peak(i))?;
        }
        let Pack { at, between, .. } = &mut *self.pack;
        between.iter_mut().for_each(|films| films.keep(instant, &at.rings));
        Ok(())
    }

    /// The end of the step is the start of the next.
    fn next(&mut self) {
        let n = self.pack.n_rings();
        let last = self.axial.len() - n;
        self.axial.copy_within(last.., 0);
        self.pack.between.iter_mut().for_each(FilmsBetween::go_on);
    }

    /// Books the oil of an accepted step of the films.
    fn book(&mut self, v: &dyn StepView) {
        self.part.put(v.y0(), &mut self.base);
        self.part.put(v.y1(), &mut self.y);
        self.pack.book_oil((v.t0(), &self.base), (v.t1(), &self.y));
    }

    /// The rows of the states that are guessed, and what drives them where the pressure in the cylinder is `p` \[Pa\]: gas and the oil under faces, for
    /// rings and films are found by brackets.
    fn guessed(&self, p: f64) -> (std::ops::Range<usize>, Option<f64>) {
        let layout = &self.pack.layout;
        if self.side == Side::Grooves {
            return (0..layout.gas.len(), Some(p));
        }
        let films = self.pack.films();
        // Without oil films are found by brackets.
        let first = if layout.oil.is_empty() { films } else { 0 };
        (first..films + layout.oil.len(), None)
    }

    fn quadratures(&mut self, q: &mut [f64]) {
        if q.is_empty() {
            return;
        }
        self.pack.quadratures(&mut self.quads);
        q.iter_mut().zip(&self.part.quads).for_each(|(q, &k)| *q = self.quads[k]);
    }
}

impl OdeSystem for OneSide<'_> {
    fn dim(&self) -> usize {
        self.part.states.len()
    }
    fn quad_dim(&self) -> usize {
        self.part.quads.len()
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.evaluate(t, y)?;
        if let (Side::Grooves, Some(rings)) = (self.side, &mut self.staging.rings) {
            rings.begin(self.pack);
        }
        let n = self.part.states.len();
        for (f, &k) in f.iter_mut().zip(&self.part.states) {
            *f = self.pack.rate(k);
        }
        self.quadratures(&mut f[n..]);
        Ok(())
    }
    /// Stages come in their order, the second after the first.
    fn stage(&mut self, t: f64, stage: &Stage<'_>, y: &mut [f64], g: &mut [f64]) -> Result<(), EvalError> {
        let p = self.pack.cylinder.pressure(t);
        let (guessed, drive) = self.guessed(p);
        let part = Stage { base: &stage.base[guessed.clone()], ..*stage };
        self.guess.apply(t, &part, drive, &mut y[guessed.clone()]);
        if let Some(repeat) = &mut self.repeat {
            repeat.apply(t, stage, y);
        }
        self.fill(t, y);
        self.part.put(stage.base, &mut self.base);
        self.part.put(stage.accuracy, &mut self.accuracy);
        let whole = Stage { base: &self.base, accuracy: &self.accuracy, ..*stage };
        self.pack.stage_of(self.side, (t, p), &whole, &mut self.y, &self.axial, self.staging)?;
        self.part.take(&self.y, y);
        self.guess.learn(t, &part, &y[guessed]);
        if let Some(repeat) = &mut self.repeat {
            repeat.learn(t, stage, y);
        }
        self.keep_forces(stage.number)?;
        self.quadratures(g);
        Ok(())
    }
    fn invariants(&self) -> &[LinearInvariant] {
        self.invariants
    }
    fn tolerances(&mut self, t: f64, y: &[f64], atol: &mut [f64]) {
        let known =
            self.pack.at.theta == t && self.part.states.iter().zip(y).all(|(&k, v)| self.pack.state[k] == *v);
        if !known && self.evaluate(t, y).is_err() {
            return;
        }
        if self.side == Side::Grooves {
            // Gas comes first, and the steps of the rings judge the rest.
            self.pack.gas.ease(&mut atol[..self.pack.layout.gas.len()]);
            self.judged.iter().for_each(|&row| atol[row] = f64::INFINITY);
            return;
        }
        self.part.put(atol, &mut self.base);
        self.pack.ease_films(&mut self.base);
        self.part.take(&self.base, atol);
    }
}
