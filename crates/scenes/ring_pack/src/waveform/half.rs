//! One side of a pack over a cycle.

use std::sync::Arc;
use std::sync::mpsc::Sender;

use gudgeon_numerics::ode::{Flow, IntegrateError, Integrator, LinearInvariant, Options, Stats, StepView};
use gudgeon_numerics::sdirk::Sdirk;

use super::super::films_between::FilmsBetween;
use super::super::implicit::{Follower, lend};
use super::super::layout::Layout;
use super::super::pack::Pack;
use super::super::staged::Staging;
use super::grid::{Grid, Rule};
use super::growing::{Bundle, Growing, Growth};
use super::joint::{Joint, Part};
use super::one_side::{OneSide, Other};
use super::repeat::Serves;
use super::track::{THIRDS, Track};

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

/// Error of a step of gas and grooves over the accuracy up to which it stays while the periodic state is searched without oil on the liner: a sixth fewer are tried again, and of
/// 400 packs the search takes 2 % fewer steps and as many cycles (with 2.5 more). No accuracy is lost, for the recorded cycle tries them again.
const SEARCHED: f64 = 1.7;

/// What a cycle is integrated with.
pub struct Setting<'a> {
    /// Where steps end.
    pub breakpoints: &'a [f64],
    /// Accuracy and limits, for all states.
    pub options: &'a Options,
    pub stats: &'a mut Stats,
}

/// Where a side came to.
pub struct Done {
    pub states: Vec<f64>,
    quads: Vec<f64>,
}

impl Done {
    /// Puts it where the pack has it.
    pub fn put(&self, part: &Part, y: &mut [f64], q: &mut [f64]) {
        part.put(&self.states, y);
        part.quads.iter().zip(&self.quads).for_each(|(&k, v)| q[k] = *v);
    }
}

/// One side over a cycle.
pub struct Half {
    pub part: Arc<Part>,
    method: Sdirk,
    pub staging: Staging,
    /// States and quadratures of the last cycle.
    pub wave: Track,
    /// The linear invariants of the pack that lie within this side, by its rows.
    invariants: Vec<LinearInvariant>,
    /// Its steps.
    pub grid: Grid,
}

/// Of no states.
impl Default for Half {
    fn default() -> Self {
        let part = Arc::new(Part::new(Vec::new(), Vec::new()));
        Self {
            part,
            method: Sdirk::new(0, 0),
            staging: Staging::default(),
            wave: Track::default(),
            invariants: Vec::new(),
            grid: Grid::default(),
        }
    }
}

impl Half {
    pub fn new(side: Side, pack: &Pack) -> Self {
        let staging = match side {
            Side::Grooves => Staging::with_ring_steps(pack),
            Side::Films => Staging::new(pack),
        };
        Self::with(Part::new(side.states(&pack.layout), Vec::new()), staging, pack, &[])
    }

    fn with(part: Part, staging: Staging, pack: &Pack, balance: &[LinearInvariant]) -> Self {
        let n = pack.layout.n;
        let row = |r: usize| part.row(r, n);
        let own = |v: &LinearInvariant| {
            let terms: Option<Vec<_>> = v.terms.iter().map(|(r, c)| Some((row(*r)?, *c))).collect();
            Some(LinearInvariant { pivot: row(v.pivot)?, terms: terms? })
        };
        Self {
            method: Sdirk::new(part.states.len(), part.quads.len()),
            staging,
            wave: Track::new(part.width(), &THIRDS),
            invariants: balance.iter().filter_map(own).collect(),
            grid: Grid::default(),
            part: Arc::new(part),
        }
    }

    /// Tells the quadratures of `side` from now on, whose balances are among `balance`.
    pub fn tell_quadratures(&mut self, side: Side, pack: &Pack, balance: &[LinearInvariant]) {
        let part = Part::new(side.states(&pack.layout), side.quads(&pack.layout));
        let told = Self::with(part, std::mem::take(&mut self.staging), pack, balance);
        let Self { wave, grid, .. } = std::mem::replace(self, told);
        // What has no states is not integrated: its quadratures stand still beside the other half, in a wave that has room for them.
        if !self.part.states.is_empty() {
            (self.wave, self.grid) = (wave, grid);
        }
    }

    /// Integrates gas and grooves from `y`, beside films as they were in the last cycle: their part, wave and forces on the rings. Where `to` is given the steps are sent there, and the wave is not
    /// kept.
    pub fn grooves(
        &mut self,
        pack: &mut Pack,
        y: &[f64],
        (rule, recorded): (Option<Rule>, bool),
        (films, [wave, forces]): (&Part, &[Track; 2]),
        setting: &mut Setting<'_>,
        to: Option<Sender<Bundle>>,
    ) -> Result<Done, IntegrateError> {
        let Self { part, method, staging, invariants, grid, .. } = self;
        let (mut growth, mut ends) = (Growth::begin(&mut self.wave, part.width(), to), Vec::new());
        grid.repeat.begin(if rule.is_some() { Serves::Rates } else { Serves::Nothing });
        if let Some(rings) = &mut staging.rings {
            rings.set_accuracy(setting.options);
        }
        // Quadratures need the flows of the gas that was found.
        staging.gas.foresee(part.quads.is_empty());
        let beside = (films, Other::Was { wave, forces });
        let mut system = OneSide::new(Side::Grooves, (pack, staging), (part, invariants), beside);
        let rows = system.judged.clone();
        system.repeat = Some(&mut grid.repeat);
        let mut observe = |s: &mut OneSide<'_>, v: &dyn StepView| {
            ends.push(v.t1());
            match &s.staging.rings {
                Some(rings) if recorded => rings.record(v, &rows, growth.steps),
                _ => growth.steps.step(v),
            }
            growth.added();
            Flow::Continue
        };
        let again = rule.map(|r| (r, &grid.ends[..]));
        let done = integrate(method, &mut system, setting, again, y, &mut observe)?;
        growth.end();
        grid.ends = ends;
        if rule.is_none() {
            grid.choose(of(y, &part.states), None, setting.options.rtol);
        }
        Ok(done)
    }

    /// Integrates films from `y` beside gas and grooves, their part and wave. They put `forces` on the rings, and tell in `leaves`, where it is given, whether a ring left the liner.
    pub fn films(
        &mut self,
        pack: &mut Pack,
        (y, rule): (&[f64], Option<Rule>),
        (grooves, beside): (&Part, &Growing),
        setting: &mut Setting<'_>,
        (forces, mut leaves): (&mut Track, Option<&mut bool>),
        mut follower: Option<&mut dyn Follower>,
    ) -> Result<Done, IntegrateError> {
        let rtol = setting.options.rtol;
        // With oil on the liner films are to be where that is now.
        let looked_at = follower.is_some() && pack.oil_pack.is_none();
        let Self { part, method, staging, wave, invariants, grid } = self;
        let begun = lend(&mut follower).map_or(Ok(()), |f| f.begin(pack, 0.0, y));
        begun.map_err(|source| IntegrateError::Eval { t: 0.0, source })?;
        pack.between = looked_at.then(|| FilmsBetween::new(pack.n_rings()));
        wave.begin(0.0, part.width());
        forces.begin(0.0, pack.n_rings());
        let mut system =
            OneSide::new(Side::Films, (pack, staging), (part, invariants), (grooves, Other::Is(beside)));
        grid.repeat.begin(match rule {
            Some(_) => Serves::Rates,
            // With oil on the liner cycles take a tenth fewer films, but the search is as many cycles longer.
            None if system.pack.oil_pack.is_some() => Serves::Nothing,
            None => Serves::Trend,
        });
        system.repeat = Some(&mut grid.repeat);
        let mut joint = Joint::new(beside, [grooves, part], system.pack);
        let mut observe = |s: &mut OneSide<'_>, v: &dyn StepView| {
            wave.step(v);
            forces.push(v.t1(), &s.axial);
            s.pack.between.iter_mut().for_each(|films| films.took(v.t0(), v.t1()));
            let flow = lend(&mut follower)
                .map_or(Flow::Continue, |f| joint.pieces(v, |piece| f.step(s.pack, piece)));
            s.next();
            s.book(v);
            if let Some(leaves) = &mut leaves {
                **leaves |= s.pack.retreats(&s.y);
            }
            if let Some(f) = lend(&mut follower) {
                f.booked(s.pack, v.t1());
            }
            flow
        };
        let again = rule.map(|r| (r, &grid.ends[..]));
        let done = integrate(method, &mut system, setting, again, y, &mut observe);
        pack.between = None;
        let done = done?;
        grid.ends = wave.ends().to_vec();
        if rule.is_none() {
            let films = pack.oil_pack.as_ref().map(|_| wave.clone());
            grid.choose(of(y, &part.states), films, rtol);
        }
        Ok(done)
    }
}

/// Values at some places.
pub fn of(all: &[f64], places: &[usize]) -> Vec<f64> {
    places.iter().map(|&k| all[k]).collect()
}

/// Integrates one side over a cycle from `y`.
fn integrate(
    method: &mut Sdirk,
    system: &mut OneSide<'_>,
    setting: &mut Setting<'_>,
    again: Option<(Rule, &[f64])>,
    y: &[f64],
    observe: &mut dyn FnMut(&mut OneSide<'_>, &dyn StepView) -> Flow,
) -> Result<Done, IntegrateError> {
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
    let (breaks, st) = (setting.breakpoints, &mut *setting.stats);
    method.integrate(system, span, breaks, &mut states, &mut quads, &options, st, observe)?;
    Ok(Done { states, quads })
}
