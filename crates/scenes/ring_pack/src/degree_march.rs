//! The scheme of tomanik1993: degree by degree, three seats, gas explicit in sub-steps.
//!
//! At each whole degree the seats follow from the axial balance with the pressures and the film force known there; the
//! gas network is marched explicitly over the degree with that geometry; then the film of each ring is found at the end
//! of the degree between the floor and `solver.limits.thickest_film`, 60 µm in the source, with `dh/dt = (h - h_old)/Δt`. Cycles repeat until the state
//! does, or for the number asked.

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

/// The scheme of tomanik1993.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DegreeMarch {
    /// Cycles to run; 0: until periodic.
    #[schemars(range(max = 200))]
    pub cycles: u32,
    /// Cycles after which the search of a periodic one is given up.
    #[schemars(range(max = 1000))]
    pub max_cycles: u32,
    /// Marching steps per crank degree; 0 takes the source's number (1).
    #[schemars(range(max = 1_000_000), extend("x-refine" = { "group": "crank-angle step", "factor": 2 }))]
    pub steps_per_degree: u32,
    /// Gas steps per marching step; 0 takes the source's number (10).
    #[schemars(range(max = 1_000_000))]
    pub gas_steps: u32,
    /// Relative change of the state over a cycle below which the cycle is periodic.
    pub periodicity: PosRatio,
}

impl Default for DegreeMarch {
    fn default() -> Self {
        Self { cycles: 0, max_cycles: 120, steps_per_degree: 0, gas_steps: 0, periodicity: quantity(1e-4) }
    }
}

/// Steps of the source.
const OWN: Steps = (1, 10);

#[register_model(
    name = "degree_march",
    summary = "the published scheme: seats decided once per degree, explicit gas steps, films from their balance at its end",
    equations = "m' = m + dt_gas dm/dt;  W_film(h, (h - h_old)/dt) + W_contact(h) = W between the floor and `limits.thickest_film`",
    validity = "Rings whose seats are decided in steps, or that rest; flooded films. First order in the step.",
    references = ["tomanik1993"],
    example = "steps_per_degree = 1\ngas_steps = 10\n",
)]
impl RingPackSolverSpec for DegreeMarch {
    fn refuses(&self, pack: &Pack) -> Vec<BuildError> {
        let mut errors = refuses(pack, (self.steps_per_degree, self.gas_steps), OWN);
        if self.max_cycles == 0 {
            errors.push(BuildError::at("solver.max_cycles", "at least one cycle is needed"));
        }
        if let Some(ring) = pack.rings.iter().find(|r| r.is_integrated()) {
            let what = format!(
                "`degree_march` decides seats by the degree, and `ring_motion` `{}` has to be integrated",
                ring.motion_name
            );
            errors.push(BuildError::at("solver.method", what).help(
                "use `method = \"implicit\"` or `method = \"substep_march\"`, or `ring_motion` `three_seat` or `seated`",
            ));
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
        let (steps, gas_steps) = steps((self.steps_per_degree, self.gas_steps), OWN);
        let tolerance = self.periodicity.si();
        let set = Settings { cycles: self.cycles, max_cycles: self.max_cycles, steps, gas_steps, tolerance };
        let mut books = Books::open(pack, wanted);
        let ended = run(pack, set, start, &mut books, progress);
        let advice = if self.cycles > 0 { "cycles" } else { "max_cycles" };
        books.close(pack, ended, |e| {
            let change = e.totals.periodicity_error;
            if e.period == 0 { unsettled(change, tolerance, e.cycles, start, advice) } else { None }
        })
    }

    fn resolve(&self, _: usize, table: &mut Value) {
        if self.steps_per_degree == 0 {
            table["steps_per_degree"] = OWN.0.into();
        }
    }

    fn settings(&self, _: &Pack, own: Option<&Value>) -> Vec<MethodSetting> {
        refined("degree_march", OWN.0, own, &["solver.cycles=8"])
    }
}

/// The numbers of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Settings {
    /// Cycles; 0 until periodic.
    cycles: u32,
    max_cycles: u32,
    steps: u32,
    gas_steps: u32,
    tolerance: f64,
}

/// Interval in which a film is known to lie \[m\].
const RESOLUTION: f64 = 1e-13;

/// Runs the scheme; calls `progress` with the fraction done.
fn run(
    pack: &mut Pack,
    set: Settings,
    start: f64,
    books: &mut Books,
    progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
) -> Result<Ended, EvalError> {
    let mut march = March::new(pack, set, start, books);
    let limit = if set.cycles > 0 { set.cycles } else { set.max_cycles };
    let mut out = Ended { totals: Totals::default(), steps: 0, cycles: 0, period: 0 };
    // States at the starts of the last cycles, to see when one comes back.
    let mut history: Vec<Vec<f64>> = Vec::new();
    let mut recording = set.cycles == 1;
    for cycle in 1..=limit {
        let mut totals = march.cycle(recording)?;
        let state = march.state();
        let change = |a: &[f64]| {
            a.iter().zip(&state).map(|(a, b)| (a - b).abs() / b.abs().max(0.1)).fold(0.0, f64::max)
        };
        totals.periodicity_error = history.last().map_or(1.0, |h| change(h));
        let back = history.iter().rev().position(|h| change(h) <= set.tolerance).map(|p| p as u32 + 1);
        history.push(state);
        let steps = out.steps + u64::from(march.per_cycle);
        out = Ended { totals, steps, cycles: cycle, period: back.unwrap_or(0) };
        progress(f64::from(cycle) / f64::from(limit))?;
        if recording {
            break;
        }
        // The recorded cycle comes last: when the state repeats, or when the number of cycles is reached.
        recording = if set.cycles > 0 {
            cycle + 1 == set.cycles
        } else {
            (cycle >= 3 && back.is_some()) || cycle + 1 >= limit
        };
    }
    Ok(out)
}

/// A march under way.
struct March<'a> {
    pack: &'a mut Pack,
    books: &'a mut Books,
    gas_steps: u32,
    /// Film thicknesses \[m\].
    h: Vec<f64>,
    /// Intervals of a cycle, and their length \[rad\].
    per_cycle: u32,
    step: f64,
}

impl<'a> March<'a> {
    fn new(pack: &'a mut Pack, set: Settings, start: f64, books: &'a mut Books) -> Self {
        let mut y = vec![0.0; pack.layout.n];
        pack.initial(start, &mut y);
        let h = pack.at.places.iter().map(|p| p.h).collect();
        let per_cycle = (pack.period().to_degrees().round() as u32) * set.steps;
        let step = pack.period() / f64::from(per_cycle);
        Self { pack, books, gas_steps: set.gas_steps, h, per_cycle, step }
    }

    /// One cycle.
    fn cycle(&mut self, recording: bool) -> Result<Totals, EvalError> {
        if recording {
            self.books.begin_recorded(self.pack);
        }
        let mut totals = Totals::begun(self.pack);
        let before = self.pack.gas_mass();
        for k in 0..self.per_cycle {
            let theta = f64::from(k) * self.step;
            self.seats(theta)?;
            if recording {
                self.record(theta, &totals)?;
            }
            self.gas(theta, &mut totals)?;
            self.films(theta + self.step, &mut totals)?;
            if recording {
                self.books.watch.look(self.pack, self.step);
            }
        }
        if recording {
            self.record(self.pack.period(), &totals)?;
        }
        let stored = self.pack.gas_mass() - before;
        let through = totals.flow_in[0].abs().max(totals.blow_by.abs()).max(f64::MIN_POSITIVE);
        totals.balance.gas_mass = Some(((totals.flow_in[0] - totals.blow_by) - stored).abs() / through);
        Ok(totals)
    }

    /// Decides the seats of an interval at its start.
    fn seats(&mut self, theta: f64) -> Result<(), EvalError> {
        instant(self.pack, theta, &self.h);
        self.pack.gas_pressures(self.pack.cylinder.pressure(theta))?;
        self.pack.decide_seats();
        instant(self.pack, theta, &self.h);
        Ok(())
    }

    fn record(&mut self, theta: f64, totals: &Totals) -> Result<(), EvalError> {
        self.pack.gas(None)?;
        self.books.record.push(theta, self.pack, &totals.flow_in, totals.blow_by);
        self.books.measures.march(theta, self.pack, totals.passed());
        Ok(())
    }

    /// Steps of the gas over an interval, rings and films at rest.
    fn gas(&mut self, theta: f64, totals: &mut Totals) -> Result<(), EvalError> {
        let pack = &mut *self.pack;
        let dt = self.step / pack.omega / f64::from(self.gas_steps);
        for g in 0..self.gas_steps {
            let middle = self.step * (f64::from(g) + 0.5) / f64::from(self.gas_steps);
            pack.gas_step(pack.cylinder.pressure(theta + middle), g == 0)?;
            for (m, dm) in pack.gas_state.iter_mut().zip(&pack.at.dm) {
                *m += dm * dt;
            }
            totals.march(pack, dt);
        }
        Ok(())
    }

    /// Films at the end of an interval, each from the balance of its ring.
    fn films(&mut self, end: f64, totals: &mut Totals) -> Result<(), EvalError> {
        let pack = &mut *self.pack;
        instant(pack, end, &self.h);
        pack.gas_pressures(pack.cylinder.pressure(end))?;
        if !pack.plan.film {
            return Ok(());
        }
        let dt = self.step / pack.omega;
        for (i, h) in self.h.iter_mut().enumerate() {
            let old = *h;
            *h = film_of_balance(pack, i, old, dt)?;
            pack.set_place(i, *h, None);
            pack.friction_at(i, (*h - old) / dt)?;
            totals.friction_work[i] += pack.at.rings[i].power * dt;
            totals.boundary_work[i] += pack.at.rings[i].boundary_power * dt;
            // Held at the end of the interval against what presses it further off.
            if *h >= pack.limits.thickest_film - 2.0 * RESOLUTION {
                let r = &mut pack.at.rings[i];
                r.limited.thickest = (r.film.load + r.contact - r.load).max(0.0);
            }
        }
        Ok(())
    }

    /// What comes back when the march is periodic: gas over that at 1 bar, films in micrometres, seats.
    fn state(&self) -> Vec<f64> {
        let gas = self.pack.gas_state.iter().zip(&self.pack.gas_scale).map(|(m, s)| m / s);
        let seats = self.pack.rings.iter().flat_map(|r| r.motion.decided().iter().copied());
        gas.chain(self.h.iter().map(|h| h / 1e-6)).chain(seats).collect()
    }
}

fn instant(pack: &mut Pack, theta: f64, h: &[f64]) {
    pack.at.theta = theta;
    pack.at.piston = pack.kinematics.motion(theta);
    pack.counters.instants += 1;
    for (i, h) in h.iter().enumerate() {
        pack.refresh_ring(i, *h, None);
    }
}

/// The film of ring `i` whose load is that of the ring.
fn film_of_balance(pack: &mut Pack, i: usize, old: f64, dt: f64) -> Result<f64, EvalError> {
    let ends = (pack.lowest(i).max(RESOLUTION), pack.limits.thickest_film);
    let needed = pack.radial_load(i);
    let excess = |p: &mut Pack, h: f64| -> Result<f64, EvalError> {
        p.set_place(i, h, None);
        let solid = p.rings[i].contact.load(h);
        Ok(p.film(i, (h - old) / dt)?.load + solid - needed)
    };
    closing_film(|h| excess(pack, h), ends, old, RESOLUTION)
}
