//! The scheme of zottin1992: mechanics in sub-steps of a crank degree, gas explicit inside them.
//!
//! Per sub-step: kinematics, cylinder pressure (linear between whole degrees), areas and volumes from the positions so
//! far; `gas_steps` explicit Euler steps of the gas masses, the first with the flows of the pressures so far, which do not know the new
//! volumes; then ring by ring the film thickness from the
//! radial balance with `dh/dt = (h - h_old)/Δt`, and the axial position with the groove damping taken implicitly and
//! the rings clamped, inelastically, at the flanks. `passes` one-degree passes make a cycle: the listing runs 721.
//!
//! The sub-models are those of the case: with the published ones this is the published program, and with finer steps
//! it tends to the solution of the same equations as the implicit solver.

use std::f64::consts::PI;

use gudgeon_core::quantity::{PosRatio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_scene::{MethodSetting, RunError, Stopped};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::closing_film::closing_film;
use super::marching::{Books, Ended, Steps, refined, refuses, steps, unsettled};
use super::pack::Pack;
use super::record::Totals;
use super::solver::{RingPackSolverSpec, Solution, Wanted};

/// The scheme of zottin1992.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SubstepMarch {
    /// Cycles to run; 0 takes the source's number (2).
    #[schemars(range(max = 200))]
    pub cycles: u32,
    /// Steps of mechanics per crank degree; 0 takes the source's number (rings + 1).
    #[schemars(range(max = 1_000_000), extend("x-refine" = { "group": "crank-angle step", "factor": 2 }))]
    pub steps_per_degree: u32,
    /// Gas sub-steps per step of mechanics; 0 takes the source's number (2^(rings+1)).
    #[schemars(range(max = 1_000_000))]
    pub gas_steps: u32,
    /// One-degree passes per cycle: 721 as in the source's listing, or 720.
    #[schemars(range(max = 7200))]
    pub passes: u32,
    /// What becomes of a ring's velocity at a flank.
    pub clamp: Clamp,
    /// Relative change of the stored gas over the last cycle below which the cycle counts as periodic.
    pub periodicity: PosRatio,
}

impl Default for SubstepMarch {
    fn default() -> Self {
        Self {
            cycles: 0,
            steps_per_degree: 0,
            gas_steps: 0,
            passes: 721,
            clamp: Clamp::Stop,
            periodicity: quantity(1e-4),
        }
    }
}

/// Velocity of a ring that reaches a flank.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Clamp {
    /// Zero (zottin1992 as far as its listing can be read). In a keystone groove the flank moves with the film, a ring
    /// clamped so sticks to it the longer the smaller the steps are, and the scheme has no limit.
    #[default]
    Stop,
    /// Only motion into the flank is stopped: converges as the steps shrink.
    Inward,
}

/// Cycles of the source.
const CYCLES: u32 = 2;

impl SubstepMarch {
    /// Steps of the source.
    fn own(rings: usize) -> Steps {
        (rings as u32 + 1, 1 << (rings + 1).min(20))
    }
}

#[register_model(
    name = "substep_march",
    summary = "the published scheme: mechanics in sub-steps of a crank degree, explicit gas steps inside them",
    equations = "m' = m + dt_gas dm/dt;  W_film(h, (h - h_old)/dt) + W_contact(h) = W;  m a = F + F_damping(s + v dt + a dt^2/2, v + a dt), \
                clamped at the flanks",
    validity = "Rings that are seated or move as masses between rigid flanks; flooded films. First order in the step; converges to the implicit solution \
               with `clamp = \"inward\"` and `passes = 720`.",
    references = ["zottin1992"],
    example = "cycles = 2\nsteps_per_degree = 4\n",
)]
impl RingPackSolverSpec for SubstepMarch {
    fn refuses(&self, pack: &Pack) -> Vec<BuildError> {
        let given = (self.steps_per_degree, self.gas_steps);
        let mut errors = refuses(pack, given, Self::own(pack.n_rings()));
        if pack.rings.iter().any(|r| r.motion.moves() && r.motion.second_order().is_none()) {
            let what = "`substep_march` integrates rings as masses between flanks, and this `ring_motion` is something else";
            errors.push(BuildError::at("solver.method", what).help(
                "use `method = \"implicit\"`, `method = \"degree_march\"` for seats that are decided in steps, or `ring_motion` `newton_groove` or `seated`",
            ));
        }
        if self.passes == 0 || self.passes > 7200 {
            let what = format!("{} one-degree passes do not make a cycle", self.passes);
            errors
                .push(BuildError::at("solver.passes", what).help("720, or 721 as the source's listing runs"));
        }
        errors
    }

    fn solve(
        &self,
        pack: &mut Pack,
        start: f64,
        wanted: &Wanted<'_>,
        progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Result<Solution, RunError> {
        let (steps, gas_steps) = steps((self.steps_per_degree, self.gas_steps), Self::own(pack.n_rings()));
        let cycles = if self.cycles == 0 { CYCLES } else { self.cycles };
        let set = Settings { cycles, steps, gas_steps, passes: self.passes, clamp: self.clamp };
        let mut books = Books::open(pack, wanted);
        let ended = run(pack, set, start, &mut books, progress).map(|(totals, steps)| Ended {
            totals,
            steps,
            cycles,
            period: 1,
        });
        let tolerance = self.periodicity.si();
        books
            .close(pack, ended, |e| unsettled(e.totals.periodicity_error, tolerance, cycles, start, "cycles"))
    }

    fn resolve(&self, rings: usize, table: &mut Value) {
        if self.steps_per_degree == 0 {
            table["steps_per_degree"] = Self::own(rings).0.into();
        }
    }

    /// The scheme as printed has no limit in a keystone groove; the variant of its flank rule that has one is refined.
    fn settings(&self, pack: &Pack, own: Option<&Value>) -> Vec<MethodSetting> {
        let more = ["solver.passes=720", "solver.clamp=inward", "solver.cycles=3"];
        refined("substep_march", Self::own(pack.n_rings()).0, own, &more)
    }
}

/// The numbers of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Settings {
    cycles: u32,
    steps: u32,
    gas_steps: u32,
    passes: u32,
    clamp: Clamp,
}

/// Interval in which a film is known to lie \[m\].
const RESOLUTION: f64 = 1e-14;

struct RingState {
    h: f64,
    s: f64,
    v: f64,
    a: f64,
}

/// The pack on its way through the cycles.
struct March<'a> {
    pack: &'a mut Pack,
    set: Settings,
    rings: Vec<RingState>,
    /// Cylinder pressure at whole degrees \[Pa\].
    p_table: Vec<f64>,
    /// Sub-step \[s\].
    dt: f64,
    totals: Totals,
    /// Volumes behind the rings that the last pressures belong to \[m³\].
    volumes: Vec<f64>,
}

/// One degree \[rad\].
const DEGREE: f64 = PI / 180.0;

impl<'a> March<'a> {
    fn new(pack: &'a mut Pack, set: Settings, start: f64) -> Self {
        pack.gas.unbound();
        let mut y = vec![0.0; pack.layout.n];
        pack.initial(start, &mut y);
        // The listing starts every film at 1 µm and every ring at rest on its lower flank.
        let film = |i: usize| if pack.plan.film { 1e-6 } else { pack.rings[i].nominal_film };
        let rings: Vec<RingState> =
            (0..pack.n_rings()).map(|i| RingState { h: film(i), s: 0.0, v: 0.0, a: 0.0 }).collect();
        // Whole-degree values, wrapped: the listing reads one beyond its table.
        let p_table = (0..=set.passes).map(|k| pack.cylinder.pressure(f64::from(k) * DEGREE)).collect();
        let dt = DEGREE / pack.omega / f64::from(set.steps);
        let volumes = Vec::with_capacity(rings.len());
        Self { pack, set, rings, p_table, dt, totals: Totals::default(), volumes }
    }

    /// Motion of the piston and place of the rings at sub-step `sub` of a pass; crank angle \[rad\] and cylinder pressure \[Pa\].
    fn look(&mut self, pass: u32, sub: u32) -> (f64, f64) {
        let f = f64::from(sub) / f64::from(self.set.steps);
        let theta = (f64::from(pass) + f) * DEGREE;
        let pack = &mut *self.pack;
        pack.at.theta = theta;
        pack.at.piston = pack.kinematics.motion(theta);
        let k = pass as usize;
        let p_cyl = self.p_table[k] + (self.p_table[k + 1] - self.p_table[k]) * f;
        pack.counters.instants += 1;
        for (i, r) in self.rings.iter().enumerate() {
            pack.refresh_ring(i, r.h, moving(pack, i).then_some((r.s, r.v)));
        }
        (theta, p_cyl)
    }

    /// Fills all volumes to `start` \[Pa\].
    fn fill(&mut self, start: f64, p_cyl: f64) {
        self.pack.fill_gas(start, p_cyl);
        self.volumes.clear();
        self.volumes.extend(self.pack.at.places.iter().map(|p| p.back_volume));
    }

    fn stored(&self) -> f64 {
        self.pack.gas_mass()
    }

    /// The explicit steps of the gas in a sub-step.
    fn gas(&mut self, p_cyl: f64) -> Result<(), EvalError> {
        let (pack, totals) = (&mut *self.pack, &mut self.totals);
        let dt = self.dt / f64::from(self.set.gas_steps);
        for g in 0..self.set.gas_steps {
            if g == 0 {
                // The listing computes pressures after the masses: its first flows are those of the pressures so far.
                swap_volumes(pack, &mut self.volumes);
            }
            // Volumes move before the first step and after it.
            pack.gas_step(p_cyl, g < 2)?;
            if g == 0 {
                swap_volumes(pack, &mut self.volumes);
            }
            for (m, dm) in pack.gas_state.iter_mut().zip(&pack.at.dm) {
                *m += dm * dt;
            }
            totals.march(pack, dt);
        }
        for (v, p) in self.volumes.iter_mut().zip(&pack.at.places) {
            *v = p.back_volume;
        }
        pack.gas_pressures(p_cyl)
    }

    /// The radial balance and the friction of each ring.
    fn films(&mut self) -> Result<(), EvalError> {
        let (pack, dt) = (&mut *self.pack, self.dt);
        if !pack.plan.film {
            return Ok(());
        }
        for (i, r) in self.rings.iter_mut().enumerate() {
            let old = r.h;
            r.h = film_of_balance(pack, i, old, dt, (r.s, r.v))?;
            pack.set_place(i, r.h, moving(pack, i).then_some((r.s, r.v)));
            pack.friction_at(i, (r.h - old) / dt)?;
            self.totals.friction_work[i] += pack.at.rings[i].power * dt;
            self.totals.boundary_work[i] += pack.at.rings[i].boundary_power * dt;
        }
        Ok(())
    }

    fn grooves(&mut self) {
        for (i, r) in self.rings.iter_mut().enumerate() {
            if moving(self.pack, i) {
                axial(self.pack, i, r, self.dt, self.set.clamp);
            }
        }
    }

    /// What a sub-step of the last cycle leaves in the books.
    fn note(&self, books: &mut Books, pass: u32, sub: u32, theta: f64) {
        books.watch.look(self.pack, self.dt * self.pack.omega);
        if pass == 0 && sub == 1 {
            // The state before the first step is as nearly as the scheme knows it that after it.
            books.measures.march(0.0, self.pack, std::iter::empty());
        }
        books.measures.march(theta, self.pack, self.totals.passed());
    }

    /// The row of the series at the end of a pass of the last cycle.
    fn row(&self, books: &mut Books, pass: u32) {
        if pass == 0 {
            // Row 0 repeats the state before the first pass as nearly as the scheme knows it.
            books.record.push(0.0, self.pack, &vec![0.0; self.rings.len()], 0.0);
        }
        let whole = f64::from(pass + 1) * DEGREE;
        books.record.push(whole, self.pack, &self.totals.flow_in, self.totals.blow_by);
    }

    /// Ends a cycle that began with `before` \[kg\] of gas; `known`: that it began where the one before ended.
    fn balance(&mut self, before: f64, known: bool) {
        let after = self.stored();
        let t = &mut self.totals;
        let through = t.flow_in[0].abs().max(t.blow_by.abs()).max(f64::MIN_POSITIVE);
        t.balance.gas_mass = known.then(|| ((t.flow_in[0] - t.blow_by) - (after - before)).abs() / through);
        // Change of the stored gas over the cycle: how far the state is from repeating.
        t.periodicity_error = ((after - before) / through).abs();
    }
}

/// Passes of a whole cycle; the listing's further ones are not shown.
const WHOLE: u32 = 720;

/// Runs the scheme; calls `progress` with the fraction done.
fn run(
    pack: &mut Pack,
    set: Settings,
    start: f64,
    books: &mut Books,
    progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
) -> Result<(Totals, u64), EvalError> {
    let mut march = March::new(pack, set, start);
    let mut steps = 0;
    for cycle in 1..=set.cycles {
        if cycle == set.cycles {
            books.begin_recorded(march.pack);
        }
        march.totals = Totals::begun(march.pack);
        let mut before = march.stored();
        for pass in 0..set.passes {
            let shown = cycle == set.cycles && pass < WHOLE;
            for sub in 1..=set.steps {
                let (theta, p_cyl) = march.look(pass, sub);
                if steps == 0 {
                    march.fill(start, p_cyl);
                    before = march.stored();
                }
                march.gas(p_cyl)?;
                march.films()?;
                march.grooves();
                steps += 1;
                if shown {
                    march.note(books, pass, sub, theta);
                }
            }
            if shown {
                march.row(books, pass);
            }
            let done = f64::from(cycle - 1) + f64::from(pass) / f64::from(set.passes);
            progress(done / f64::from(set.cycles))?;
        }
        march.balance(before, cycle > 1);
    }
    Ok((march.totals, steps))
}

fn swap_volumes(pack: &mut Pack, volumes: &mut [f64]) {
    for (place, v) in pack.at.places.iter_mut().zip(volumes) {
        std::mem::swap(&mut place.back_volume, v);
    }
}

fn moving(pack: &Pack, i: usize) -> bool {
    pack.rings[i].motion.second_order().is_some()
}

/// The film of ring `i` whose load is that of the ring.
fn film_of_balance(pack: &mut Pack, i: usize, old: f64, dt: f64, s: (f64, f64)) -> Result<f64, EvalError> {
    let moving = moving(pack, i);
    let ends = (pack.lowest(i).max(RESOLUTION), pack.furthest(i));
    let excess = |h: f64| -> Result<f64, EvalError> {
        let hdot = (h - old) / dt;
        pack.set_place(i, h, moving.then_some(s));
        let load = pack.radial_load(i) + pack.radial_friction(i, hdot) - pack.rings[i].contact.load(h);
        Ok(pack.film(i, hdot)?.load - load)
    };
    closing_film(excess, ends, old, RESOLUTION)
}

/// One step of `m a = F`, damping at the new velocity and position: `v' = v + a Δt`, `s' = s + v Δt + a Δt²/2`.
fn axial(pack: &mut Pack, i: usize, r: &mut RingState, dt: f64, clamp: Clamp) {
    pack.external_forces(i);
    let Some(law) = pack.rings[i].motion.second_order() else { return };
    let mass = pack.geo.rings[i].mass;
    let place = pack.at.places[i];
    let (v0, s0, area, c) = (r.v, r.s, place.flank_area(), place.clearance);
    let mut f = pack.at.rings[i].axial;
    f.damping = law.damping(&place.flank, place.s, place.v, c, area);
    let rest = f.sum() - f.damping;
    let trial = |a: f64| (s0 + v0 * dt + 0.5 * a * dt * dt, v0 + a * dt);
    let residual = |a: f64| {
        let (s, v) = trial(a);
        mass * a - rest - law.damping(&place.flank, s.clamp(0.0, c), v, c, area)
    };
    // Damping opposes the motion, so the root lies between free flight and standing still.
    let (mut lo, mut hi) = (rest / mass, -v0 / dt);
    if lo > hi {
        std::mem::swap(&mut lo, &mut hi);
    }
    let mut a = r.a.clamp(lo, hi);
    for _ in 0..200 {
        let f = residual(a);
        if f.abs() <= 1e-12 * (rest.abs() + (mass * a).abs()) {
            break;
        }
        if f > 0.0 {
            hi = a
        } else {
            lo = a
        }
        let step = 1e-7 * (hi - lo).abs().max(1e-9 * a.abs());
        let slope = (residual(a + step) - f) / step;
        let newton = a - f / slope;
        let next = if newton > lo && newton < hi { newton } else { 0.5 * (lo + hi) };
        if next == a || hi - lo <= 1e-15 * hi.abs().max(lo.abs()) {
            break;
        }
        a = next;
    }
    let (s, v) = trial(a);
    r.a = a;
    (r.s, r.v) = if s <= 0.0 {
        (0.0, if clamp == Clamp::Stop { 0.0 } else { v.max(0.0) })
    } else if s >= c {
        (c, if clamp == Clamp::Stop { 0.0 } else { v.min(0.0) })
    } else {
        (s, v)
    };
    let damping = law.damping(&place.flank, r.s, r.v, c, area);
    pack.set_place(i, r.h, Some((r.s, r.v)));
    let ring = &mut pack.at.rings[i];
    ring.axial.damping = damping;
    ring.reaction = 0.0;
}
