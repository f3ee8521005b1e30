//! From a start to the periodic motion: cycle after cycle until one ends as it began.

use gudgeon_core::result::Note;
use gudgeon_core::{EvalError, Stopwatch};
use gudgeon_numerics::elementary;
use gudgeon_numerics::ode::Stats;
use gudgeon_numerics::orbit::{Change, CycleMap, OrbitOptions, OrbitReport, periodic_orbit};

use super::assembly::Assembly;
use super::case::PistonSecondaryCase;
use super::equations::Work;
use super::solver::{Accuracy, Cycled, PistonSolver};
use super::trajectory::Trajectory;
use gudgeon_scene::{RunError, Stopped};

/// A motion over one cycle.
pub struct Found {
    /// The cycle; without steps when it was not wanted.
    pub trajectory: Trajectory,
    /// States at the start of the cycle.
    pub start: Vec<f64>,
    /// What the search learnt of the slope of a cycle.
    pub changes: Vec<Change>,
    /// Cycles it took, in units of the last one.
    pub cycles: f64,
    /// Estimated distance from the periodic motion \[m\]; the change over the cycle when it was not searched for.
    pub periodicity_error: f64,
    /// Notes for a person.
    pub notes: Vec<Note>,
    /// Steps, rejected steps, right-hand sides, Jacobians.
    pub stats: Stats,
    /// Wall time of the search \[s\].
    pub seconds: f64,
}

struct Cycle<'a> {
    a: &'a mut Assembly,
    solver: Box<dyn PistonSolver>,
    work: Work,
    repeatable_to: f64,
    /// What the search asks for before it asks for more.
    asked: f64,
    max_cycles: usize,
    stats: Stats,
    y: Vec<f64>,
    failure: Option<RunError>,
    progress: &'a mut dyn FnMut(f64) -> Result<(), Stopped>,
    done: f64,
    /// What is known of the slope of a cycle.
    known: &'a [Change],
    /// The last cycle of the search, when it is as accurate as the one that is told and nothing more than states belongs to it.
    last: Option<Trajectory>,
}

impl Cycle<'_> {
    /// One cycle from `y`, into `trajectory`, to the accuracy of the solver or another.
    fn integrate(
        &mut self,
        y: &mut [f64],
        accuracy: Accuracy,
        mut trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        self.work.w.fill(0.0);
        if let Some(oil) = &mut self.a.oil {
            oil.recording = trajectory.is_some();
        }
        let mut of = Cycled { a: self.a, work: &mut self.work, stats: &mut self.stats };
        let outcome = self.solver.cycle(&mut of, y, accuracy, trajectory.as_deref_mut());
        if let Some(t) = trajectory {
            t.oil = self.a.take_oil_cycle();
        }
        self.done += 1.0;
        outcome.and_then(|()| Ok((self.progress)(1.0 - elementary::powf(0.75f64, self.done))?))
    }

    /// The states that make up the periodic motion, and where the oil is that the skirt keeps.
    fn periodic(&self, y: &[f64], z: &mut [f64]) {
        let layout = &self.a.layout;
        let (states, oil) = z.split_at_mut(layout.periodic.len());
        states.iter_mut().zip(&layout.periodic).for_each(|(z, k)| *z = y[*k]);
        self.a.oil_state(oil);
    }

    /// Begins a cycle with the periodic states `z`: the motion completes them. Where films keep their oil, all states are among them.
    fn begin(&mut self, z: &[f64]) {
        let (states, oil) = z.split_at(self.a.layout.periodic.len());
        for (k, z) in self.a.layout.periodic.iter().zip(states) {
            self.y[*k] = *z;
        }
        self.a.set_oil_state(oil);
        if self.a.oil.is_some() {
            return;
        }
        let Work { x, w, .. } = &mut self.work;
        self.a.coordinates(&self.y, x);
        let now = self.a.instant(0.0);
        w.fill(0.0);
        let own = &mut self.y[self.a.layout.motion.clone()];
        self.a.piston.add(self.a.motion.added(own));
        self.a.motion.begin(own, &mut self.a.piston.ask(&now, x, w));
    }
}

impl CycleMap for Cycle<'_> {
    fn dim(&self) -> usize {
        self.a.layout.periodic.len() + self.a.oil_values()
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        let before = self.a.piston.film_evaluations();
        self.begin(y0);
        let mut y = std::mem::take(&mut self.y);
        let keeps = accuracy <= self.repeatable_to && self.a.oil.is_none();
        let mut last = keeps.then(|| self.solver.trajectory(self.a, &self.work));
        let wanted = Accuracy { error: accuracy, part: (accuracy / self.asked).min(1.0) };
        let outcome = self.integrate(&mut y, wanted, last.as_mut());
        self.last = last;
        self.periodic(&y, y1);
        self.y = y;
        if let Err(e) = outcome {
            self.failure = Some(e);
            return Err(EvalError::fatal("piston_secondary", "the cycle could not be integrated"));
        }
        Ok((self.a.piston.film_evaluations() - before) as f64)
    }
    fn noise(&self) -> f64 {
        self.solver.noise()
    }
    fn known(&self) -> &[Change] {
        self.known
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        for (s, k) in s.iter_mut().zip(&self.a.layout.periodic) {
            *s = self.a.layout.states[*k].cycle_scale;
            // What follows at once from the others where films carry is looked at less closely.
            *s *= if *k >= self.a.motion.n_periodic() && self.a.layout.motion.contains(k) {
                FOLLOWING
            } else {
                1.0
            };
        }
        s[self.a.layout.periodic.len()..].fill(NODE_SCALE);
    }
}

/// How many times the search may ask for a tenth of the error of a cycle: a slow mode gathers the noise of many.
const REFINEMENTS: usize = 2;

/// Film of one node that counts as one, in its unit: which nodes a step fills differs from cycle to cycle, and forces come from many of them.
const NODE_SCALE: f64 = 1000.0;

/// Scale of the states of the lateral motion that follow from its other ones where the films carry, in their own.
const FOLLOWING: f64 = 100.0;

/// Where a search begins.
#[derive(Debug, Clone, Copy, Default)]
pub struct Begin<'a> {
    /// States at the start of a cycle; none: those with which the models begin.
    pub states: Option<&'a [f64]>,
    /// What a search on another film learnt of the slope of a cycle.
    pub known: &'a [Change],
}

/// What a motion is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// To be told.
    Results,
    /// To start another one from, and to be looked at.
    Look,
    /// To start another one from.
    Start,
}

/// Runs the case: the skirt as it is built, from `from`.
///
/// # Errors
/// What stopped it.
pub fn run(
    case: &PistonSecondaryCase,
    a: &mut Assembly,
    from: Begin<'_>,
    purpose: Purpose,
    progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
) -> Result<Found, RunError> {
    let begin = Stopwatch::start();
    if a.layout.n == 0 {
        return still(case, a, begin);
    }
    let s = &case.solver;
    let mut cycle = Cycle::new(case, a, from.known, progress);
    let mut y = cycle.first(from.states)?;
    let (mut notes, mut changes) = (Vec::new(), Vec::new());
    let (cycles, mut error);
    let mut last = None;
    if s.cycles > 0 {
        for _ in 1..s.cycles {
            cycle.integrate(&mut y, Accuracy::OWN, None)?;
        }
        (cycles, error) = (f64::from(s.cycles), None);
    } else {
        // Where another motion starts from this one, no closer than films of different grids are.
        let wanted = s.periodicity.si();
        let wanted = if purpose == Purpose::Results { wanted } else { wanted.max(START) };
        let report = cycle.close(&mut y, wanted)?;
        notes.extend(told(&report, wanted, s.max_cycles as usize));
        (cycles, error) = (report.cycle_equivalents, Some(report.error_estimate));
        last = cycle.reusable(&y, &report, wanted);
        if last.is_some() && purpose != Purpose::Start {
            error = Some(report.began_at());
        }
        changes = report.changes;
    }
    let searched = begin.seconds();
    let start = y.clone();
    let known = last.is_some();
    let mut trajectory = last.unwrap_or_else(|| cycle.solver.trajectory(cycle.a, &cycle.work));
    if purpose != Purpose::Start && !known {
        cycle.integrate(&mut y, Accuracy::OWN, Some(&mut trajectory))?;
    }
    // Of a given number of cycles the last one is that of the record.
    let seconds = if s.cycles > 0 { begin.seconds() } else { searched };
    let periodic = cycle.a.layout.periodic.iter();
    let change = periodic.map(|&k| (start[k] - y[k]).abs()).fold(0.0, f64::max);
    Ok(Found {
        trajectory,
        start,
        changes,
        cycles,
        periodicity_error: cycle.a.clearance * error.unwrap_or(change),
        notes,
        stats: cycle.stats,
        seconds,
    })
}

impl<'a> Cycle<'a> {
    fn new(
        case: &PistonSecondaryCase,
        a: &'a mut Assembly,
        known: &'a [Change],
        progress: &'a mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Self {
        let s = &case.solver;
        let states = a.layout.n;
        let solver = s.method.build(a);
        let work = Work::new(a);
        Cycle {
            a,
            solver,
            work,
            repeatable_to: s.method.repeatable_to(),
            asked: s.method.repeatable_to(),
            max_cycles: s.max_cycles as usize,
            stats: Stats::default(),
            y: vec![0.0; states],
            failure: None,
            progress,
            done: 0.0,
            known,
            last: None,
        }
    }

    /// The last cycle of a search that ended in `y`, when it began as near to the periodic motion as is wanted.
    fn reusable(&mut self, y: &[f64], report: &OrbitReport, wanted: f64) -> Option<Trajectory> {
        let last = self.last.take().filter(|t| !t.ends().is_empty())?;
        let end = last.at_end(last.ends().len() - 1);
        let ends_there = self.a.layout.periodic.iter().all(|k| end[*k] == y[*k]);
        (ends_there && report.converged && report.period == 1 && report.began_at() <= wanted).then_some(last)
    }

    /// States of the first cycle: those given, or those with which the models begin.
    fn first(&mut self, start: Option<&[f64]>) -> Result<Vec<f64>, RunError> {
        let mut y = vec![0.0; self.a.layout.n];
        match start {
            Some(start) => y.copy_from_slice(start),
            None => self.a.initial(&mut y),
        }
        let stopped = |source| RunError::Eval { theta_deg: 0.0, source };
        self.a.first_oil(&y, &mut self.work.x).map_err(stopped)?;
        if start.is_none() {
            let mut z = vec![0.0; self.dim()];
            self.periodic(&y, &mut z);
            self.begin(&z);
            y.copy_from_slice(&self.y);
        }
        Ok(y)
    }

    /// Searches the periodic motion from `y`, until a cycle ends within `wanted` clearances of where it began.
    fn close(&mut self, y: &mut [f64], wanted: f64) -> Result<OrbitReport, RunError> {
        self.asked = self.repeatable_to.min(0.3 * wanted);
        let options = OrbitOptions {
            tolerance: wanted,
            accuracy: self.asked,
            max_cycles: self.max_cycles,
            refinements: REFINEMENTS,
            accelerate: true,
        };
        let mut z = vec![0.0; self.dim()];
        self.periodic(y, &mut z);
        let report = match periodic_orbit(self, &mut z, &options) {
            Ok(r) => r,
            Err(source) => {
                return Err(self.failure.take().unwrap_or(RunError::Eval { theta_deg: 0.0, source }));
            }
        };
        self.begin(&z);
        y.copy_from_slice(&self.y);
        Ok(report)
    }
}

/// What the search of the periodic motion found, for a person.
fn told(report: &OrbitReport, wanted: f64, most: usize) -> Vec<Note> {
    let mut notes = Vec::new();
    if !report.converged && report.error_estimate <= wanted && report.multiplier > 1.0 {
        notes.push(repels(report));
    } else if !report.converged {
        notes.push(not_periodic((report.cycles, most), report.error_estimate, wanted));
    }
    if report.multiplier > 0.9 {
        notes.push(Note::info(
            "slow_mode",
            format!(
                "a slow mode of the lateral position: {:.3} of a deviation is left after a cycle",
                report.multiplier
            ),
        ));
    }
    if report.period > 1 {
        let text = format!("the motion repeats only every {} cycles", report.period);
        notes.push(Note::caution("subharmonic", text).amount("period", f64::from(report.period), "1"));
    }
    notes
}

/// A periodic motion that was found, and that the piston does not make.
fn repels(report: &OrbitReport) -> Note {
    let text = format!(
        "The periodic motion that was found repels: a deviation of the lateral position grows to {:.3} of itself in a cycle, and no other motion was found within {} cycles. Raise `solver.max_cycles`, or look at the transient with `solver.cycles`.",
        report.multiplier, report.cycles
    );
    Note::failure("not_periodic", text).amount("multiplier", report.multiplier, "1")
}

/// What a motion that is not periodic says: a caution up to ten times the distance that is admitted, a failure beyond.
/// `cycles` are those that were searched, and the most.
fn not_periodic((cycles, most): (usize, usize), error: f64, wanted: f64) -> Note {
    let topic = "not_periodic";
    let advice = if cycles + EARLY < most {
        "The errors of the steps leave no less: tighten `solver.tolerance`"
    } else {
        "Raise `solver.max_cycles`, tighten `solver.tolerance`"
    };
    let found = if error <= wanted {
        // What the search did not come to confirm.
        format!(
            "not shown to be periodic within {wanted:.0e} clearances after {cycles} cycles: the last one says {error:.1e}, but not twice"
        )
    } else {
        format!(
            "not periodic within {wanted:.0e} clearances after {cycles} cycles: the estimated distance is {error:.1e}"
        )
    };
    let text = format!("The motion is {found}. {advice}, or look at the transient with `solver.cycles`.");
    let note =
        if error <= ADMITTED * wanted { Note::caution(topic, text) } else { Note::failure(topic, text) };
    note.amount("periodicity_error", error, "1").amount("wanted", wanted, "1")
}

/// Cycles before the most that may be, from which on a search that ended did so for another reason: a slope is not begun without all of its cycles.
const EARLY: usize = 6;
/// Multiple of the distance wanted up to which a motion counts as periodic, with a caution.
const ADMITTED: f64 = 10.0;

/// Periodicity of a motion that is a start for another, in clearances.
const START: f64 = 1e-3;

/// Way between two looks at a skirt that stands still \[rad\].
const STILL: f64 = 0.05;

/// A piston without states: it stands still, and its oil alone moves.
fn still(case: &PistonSecondaryCase, a: &mut Assembly, begin: Stopwatch) -> Result<Found, RunError> {
    let mut ends = vec![0.0];
    let mut from = 0.0;
    for &to in &a.bends() {
        let parts = ((to - from) / STILL).ceil().max(1.0) as usize;
        ends.extend(
            (1..=parts).map(|k| if k == parts { to } else { from + (to - from) * k as f64 / parts as f64 }),
        );
        from = to;
    }
    ends.dedup_by(|b, a| *b - *a < 1e-9);
    let mut trajectory = Trajectory::still(ends, &[]);
    let (cycles, notes) = still_oil(case, a, &mut trajectory)?;
    Ok(Found {
        trajectory,
        start: Vec::new(),
        changes: Vec::new(),
        cycles: f64::from(cycles),
        periodicity_error: 0.0,
        notes,
        stats: Stats::default(),
        seconds: begin.seconds(),
    })
}

/// Moves the oil of a piston that stands still until a cycle ends as it began. Returns the cycles it took.
fn still_oil(
    case: &PistonSecondaryCase,
    a: &mut Assembly,
    trajectory: &mut Trajectory,
) -> Result<(u32, Vec<Note>), RunError> {
    let (s, n) = (&case.solver, a.piston.coordinates());
    let Some(oil) = &mut a.oil else { return Ok((1, Vec::new())) };
    oil.recording = true;
    let (mut x, w) = (vec![0.0; n], vec![0.0; n]);
    let stopped = |t: f64| move |source| RunError::Eval { theta_deg: t.to_degrees(), source };
    a.first_oil(&[], &mut x).map_err(stopped(0.0))?;
    let (given, wanted) = (s.cycles > 0, s.periodicity.si());
    let most = if given { s.cycles } else { s.max_cycles };
    let mut before = vec![0.0; a.oil_values()];
    let mut after = before.clone();
    let mut cycles = 0;
    let change = loop {
        cycles += 1;
        a.oil_state(&mut before);
        a.begin_oil(&[], &w).map_err(stopped(0.0))?;
        for k in 0..a.oil_steps() {
            a.move_oil(k, &[], &w, &mut x).map_err(stopped(a.oil_angle(k + 1)))?;
        }
        a.oil_state(&mut after);
        let change = before.iter().zip(&after).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / NODE_SCALE;
        if cycles >= most || (change <= wanted && !given) {
            break change;
        }
    };
    trajectory.oil = a.take_oil_cycle();
    let late = (change > wanted && !given).then(|| not_periodic((cycles as usize, 0), change, wanted));
    Ok((cycles, late.into_iter().collect()))
}
