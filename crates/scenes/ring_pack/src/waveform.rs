//! A cycle in two halves: gas with the rings in their grooves, then films, each at steps of its own.
//!
//! The two sides of a pack ask little of each other. Films need pressures; gas and grooves need how thick the films are and what force they put on the
//! rings along the liner. So the cycle is integrated twice, each time one side alone, while what the other side did over its last cycle stands in for it
//! (waveform relaxation, lelarasmee1982). Each side takes the steps that it needs itself, and its stages are smaller problems. What the sides do not agree on
//! shrinks by some six times a cycle, beside the search of the periodic state, and the end of both is the solution of the whole pack.

use gudgeon_numerics::ode::{Flow, IntegrateError, LinearInvariant, StepView};
use gudgeon_numerics::sdirk;

use super::implicit::Follower;
use super::pack::Pack;

mod acting;
mod at_once;
mod grid;
mod growing;
mod guess;
mod half;
mod joint;
mod one_side;
mod repeat;
mod ring_stage;
mod rings;
mod span;
mod track;

pub use grid::moved;
pub use half::{Setting, Side};
pub use rings::RingSteps;
pub use span::MOST_STATES;

use grid::Rule;
use growing::Growing;
use half::{Done, Half, of};
use joint::Joint;
use track::Track;

/// Change of the films, over the accuracy, of which gas and grooves need not know while the periodic state is searched.
const ALIKE: f64 = 5.0;

/// Cycle from which on the halves are compared, without oil on the liner and with it, and how far they may be apart if they come no nearer from one cycle to the next:
/// of 54 packs of three rings those that come to agree are within 0.05 after four cycles, and those that do not are beyond 0.2 after five. With six rings they agree from 0.13 on.
/// With oil they may part for a while as it spreads, and for a cycle after a step of the search: of 21 packs those that agree are within 0.1 in one cycle of two from the
/// eighth on, and the two that do not are beyond 0.17 in the six from there.
const COMPARED: [usize; 2] = [3, 8];
const APART: [f64; 2] = [0.1, 0.15];

/// Both sides of a pack over a cycle.
pub struct Waveform {
    grooves: Half,
    films: Half,
    /// Forces \[N\] of the films on the rings along the liner over the last cycle.
    forces: Track,
    /// Gas and grooves over the cycle that is integrated in two threads.
    beside: Track,
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
            beside: Track::default(),
            forces,
        }
    }

    /// Cycles tell the quadratures of the pack, whose balances are `balance`, from now on.
    pub fn tell_quadratures(&mut self, pack: &Pack, balance: &[LinearInvariant]) {
        self.grooves.tell_quadratures(Side::Grooves, pack, balance);
        self.films.tell_quadratures(Side::Films, pack, balance);
    }

    /// Integrates a cycle from `y`; `q` are the quadratures over it.
    pub fn cycle(
        &mut self,
        pack: &mut Pack,
        y: &mut [f64],
        q: &mut [f64],
        setting: &mut Setting<'_>,
        follower: Option<&mut dyn Follower>,
    ) -> Result<(), IntegrateError> {
        if self.films.wave.is_empty() {
            self.stand_still(pack.period(), y);
        }
        let begin = y.to_vec();
        self.grooves.staging.restart();
        self.films.staging.restart();
        let rtol = setting.options.rtol;
        // A cycle is looked at in its second half, where both are known. Without films there is none.
        let seen = self.seen.take();
        if let Some(seen) =
            seen.filter(|seen| self.held || follower.is_none() && self.stand(seen, pack, y, rtol))
        {
            self.grooves.part.put(&seen.end, y);
            self.seen = Some(seen);
            return self.films(pack, (&begin, y, q), setting, follower);
        }
        let rule = self.again(Side::Grooves, pack, y, rtol, follower.is_some());
        self.before[0].clone_from(&self.films.wave);
        self.before[1].clone_from(&self.forces);
        if !self.films.part.states.is_empty()
            && let Some(twin) = pack.twin.take()
        {
            return self.at_once((pack, twin), (y, q), rule, setting, follower);
        }
        let seen = (&*self.films.part, &self.before);
        let rule = (rule, follower.is_some());
        let done = self.grooves.grooves(pack, &begin, rule, seen, setting, None)?;
        self.took(&done, y, q);
        self.films(pack, (&begin, y, q), setting, follower)
    }

    /// Gas and grooves came to where they are.
    fn took(&mut self, done: &Done, y: &mut [f64], q: &mut [f64]) {
        let start = of(y, &self.grooves.part.states);
        done.put(&self.grooves.part, y, q);
        self.seen = Some(Seen { start, end: done.states.clone() });
    }

    /// Whether no cycle of both halves was integrated yet.
    const fn is_first(&self) -> bool {
        self.cycles == 0 && !self.held
    }

    /// Films through a cycle whose gas and grooves are known.
    fn films(
        &mut self,
        pack: &mut Pack,
        (begin, y, q): (&[f64], &mut [f64], &mut [f64]),
        setting: &mut Setting<'_>,
        follower: Option<&mut dyn Follower>,
    ) -> Result<(), IntegrateError> {
        if self.films.part.states.is_empty() {
            return self.look(pack, begin, follower);
        }
        let rule = self.again(Side::Films, pack, begin, setting.options.rtol, follower.is_some());
        let wave = std::mem::take(&mut self.grooves.wave);
        let wave = Growing::whole(wave);
        let first = self.is_first();
        let told = (&mut self.forces, first.then_some(&mut self.retreats));
        let beside = (&*self.grooves.part, &wave);
        let done = self.films.films(pack, (begin, rule), beside, setting, told, follower);
        self.grooves.wave = wave.into_wave();
        done?.put(&self.films.part, y, q);
        Ok(())
    }

    /// Has a cycle of gas and grooves looked at, beside which there are no films.
    fn look(
        &mut self,
        pack: &mut Pack,
        begin: &[f64],
        follower: Option<&mut dyn Follower>,
    ) -> Result<(), IntegrateError> {
        let Some(follower) = follower else { return Ok(()) };
        let begun = follower.begin(pack, 0.0, begin);
        begun.map_err(|source| IntegrateError::Eval { t: 0.0, source })?;
        let films = Growing::whole(std::mem::take(&mut self.films.wave));
        let mut joint = Joint::new(&films, [&self.films.part, &self.grooves.part], pack);
        for step in self.grooves.wave.steps(self.grooves.part.states.len()) {
            if joint.pieces(&step, |piece| follower.step(pack, piece)) == Flow::Stop {
                break;
            }
        }
        self.films.wave = films.into_wave();
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
