//! From a start to the periodic motion, by an adaptive implicit integrator or in equal steps of the backward Euler method.

use std::time::Instant as Clock;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::Lateral;
use gudgeon_core::result::Note;
use gudgeon_numerics::ode::{Flow, IntegrateError, Integrator, OdeSystem, Options, Stats, StepView};
use gudgeon_numerics::orbit::{CycleMap, OrbitOptions, periodic_orbit};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::{Formula, Rodas};

use super::assemble::Assembly;
use super::case::{Method, PistonSecondaryCase};
use super::trajectory::{Between, Trajectory};
use gudgeon_scene::{IntegratorName, RunError};

/// A motion over one cycle.
pub struct Found {
    /// The cycle; without steps when it was not wanted.
    pub trajectory: Trajectory,
    /// Coordinates \[m\], then velocities with inertia \[m/s\], at the start of the cycle.
    pub start: Vec<f64>,
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

/// The motion across the bore as an initial-value problem in crank angle. Coordinates count in clearances, velocities in clearances per
/// radian.
struct Problem<'a> {
    a: &'a mut Assembly,
    inertial: bool,
    x: &'a mut [f64],
    v: &'a mut [f64; 2],
    /// Rates found last: the guess for the next ones.
    w: &'a mut [f64],
    acceleration: [f64; 2],
}

impl Problem<'_> {
    fn look_at(&mut self, t: f64, y: &[f64]) -> Result<gudgeon_skirt::Instant, EvalError> {
        self.a.go_on()?;
        let (c, n) = (self.a.clearance, self.x.len());
        let speed = c * self.a.omega();
        for (x, y) in self.x.iter_mut().zip(y) {
            *x = c * y;
        }
        let now = self.a.instant(t);
        if self.inertial {
            *self.v = [y[n] * speed, y[n + 1] * speed];
        }
        let v = if self.inertial { Some(&self.v[..]) } else { None };
        self.a.piston.rates(&now, self.x, v, self.w, &mut self.acceleration)?;
        Ok(now)
    }
}

impl OdeSystem for Problem<'_> {
    fn dim(&self) -> usize {
        self.x.len() + if self.inertial { 2 } else { 0 }
    }
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.look_at(t, y)?;
        let (n, omega) = (self.x.len(), self.a.omega());
        let speed = self.a.clearance * omega;
        for (f, w) in f.iter_mut().zip(&*self.w) {
            *f = w / speed;
        }
        if self.inertial {
            for k in 0..2 {
                f[n + k] = self.acceleration[k] / (speed * omega);
            }
        }
        Ok(())
    }
    fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        let now = self.look_at(t, y)?;
        self.a.piston.derivatives(&now, self.x, self.inertial, self.w, Some(jac), None)?;
        let (n, states, omega) = (self.x.len(), y.len(), self.a.omega());
        for row in 0..states {
            for column in 0..states {
                // Rates by coordinates are per second, by velocities pure numbers; accelerations have one second more.
                let per_second = i32::from(row >= n) + i32::from(column < n);
                jac[row * states + column] /= omega.powi(per_second);
            }
        }
        Ok(true)
    }
    fn time_derivative(&mut self, t: f64, y: &[f64], _: &[f64], dfdt: &mut [f64]) -> Result<bool, EvalError> {
        let now = self.look_at(t, y)?;
        let later = self.a.instant(t + LATER);
        self.a.piston.derivatives(&now, self.x, self.inertial, self.w, None, Some((&later, LATER, dfdt)))?;
        let (n, omega) = (self.x.len(), self.a.omega());
        let speed = self.a.clearance * omega;
        for (k, d) in dfdt.iter_mut().enumerate() {
            *d /= if k < n { speed } else { speed * omega };
        }
        Ok(true)
    }
    fn tolerances(&mut self, t: f64, y: &[f64], atol: &mut [f64]) {
        if self.look_at(t, y).is_err() {
            return;
        }
        // Forces go with the cube of the gap: a position matters by its distance from the wall.
        let part = (self.a.piston.smallest_gap() / self.a.clearance).clamp(LEAST_GAP, 1.0);
        for a in &mut atol[..self.x.len()] {
            *a *= part;
        }
    }
}

/// Time of a difference quotient \[rad\].
const LATER: f64 = 1e-6;
/// Gap, in clearances, below which tolerances shrink no further.
const LEAST_GAP: f64 = 0.02;
/// First step of a cycle \[rad\].
const FIRST_STEP: f64 = 1e-2;
/// Largest step \[rad\]: no pulse of the pressure is passed over.
const LARGEST_STEP: f64 = 0.2;
/// Velocity that counts as one in the error norm, in clearances per radian.
const VELOCITY_SCALE: f64 = 1.0;
/// Most steps of a cycle.
const MOST_STEPS: u64 = 200_000;
/// Halvings of a step of the backward Euler method.
const HALVINGS: u32 = 12;

enum Engine {
    Rodas(Box<Rodas>),
    Radau(Box<Radau5>),
    Euler { steps: usize },
}

struct Cycle<'a> {
    a: &'a mut Assembly,
    engine: Engine,
    inertial: bool,
    x: Vec<f64>,
    v: [f64; 2],
    w: Vec<f64>,
    tolerance: f64,
    stats: Stats,
    /// A state: coordinates, and with inertia the velocities of both edges.
    y: Vec<f64>,
    failure: Option<RunError>,
    progress: &'a mut dyn FnMut(f64),
    done: f64,
}

impl Cycle<'_> {
    fn states(&self) -> usize {
        self.x.len() + if self.inertial { 2 } else { 0 }
    }

    /// One cycle from `y`, into `trajectory`.
    fn integrate(
        &mut self,
        y: &mut [f64],
        tolerance: f64,
        trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        self.w.fill(0.0);
        let outcome = match self.engine {
            Engine::Euler { steps } => self.euler(y, steps, trajectory),
            _ => self.adaptive(y, tolerance, trajectory),
        };
        self.done += 1.0;
        (self.progress)(1.0 - 0.75f64.powf(self.done));
        outcome
    }

    fn adaptive(
        &mut self,
        y: &mut [f64],
        tolerance: f64,
        mut trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        let (n, states, period) = (self.x.len(), self.states(), self.a.period);
        let mut scale = vec![1.0; states];
        scale[n..].fill(VELOCITY_SCALE);
        let mut options = Options::new(tolerance, &scale);
        options.absolute = vec![true; states];
        options.absolute[n..].fill(false);
        (options.h_init, options.h_max, options.max_steps) = (FIRST_STEP, LARGEST_STEP, MOST_STEPS);
        options.event_samples = 0;
        let breakpoints = std::mem::take(&mut self.a.breakpoints);
        let mut problem = Problem {
            a: self.a,
            inertial: self.inertial,
            x: &mut self.x,
            v: &mut self.v,
            w: &mut self.w,
            acceleration: [0.0; 2],
        };
        if let Some(t) = trajectory.as_deref_mut() {
            t.start(0.0, y);
        }
        let mut observe = |_: &mut Problem<'_>, view: &dyn StepView| {
            if let Some(t) = trajectory.as_deref_mut() {
                t.step(view);
            }
            Flow::Continue
        };
        let (span, st) = ((0.0, period), &mut self.stats);
        let outcome = match &mut self.engine {
            Engine::Rodas(m) => {
                m.integrate(&mut problem, span, &breakpoints, y, &mut [], &options, st, &mut observe)
            }
            Engine::Radau(m) => {
                m.integrate(&mut problem, span, &breakpoints, y, &mut [], &options, st, &mut observe)
            }
            Engine::Euler { .. } => Ok(0.0),
        };
        self.a.breakpoints = breakpoints;
        outcome.map(|_| ()).map_err(|e| match e {
            IntegrateError::Eval { t, source } => RunError::Eval { theta_deg: t.to_degrees(), source },
            other => RunError::Integrate(other),
        })
    }

    fn euler(
        &mut self,
        y: &mut [f64],
        steps: usize,
        mut trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        let (c, n, period, omega) = (self.a.clearance, self.x.len(), self.a.period, self.a.omega());
        let speed = c * omega;
        let mut from: Vec<f64> = y[..n].iter().map(|y| c * y).collect();
        let mut v = if self.inertial { [y[n] * speed, y[n + 1] * speed] } else { [0.0; 2] };
        let eval = |t: f64| move |source| RunError::Eval { theta_deg: f64::to_degrees(t), source };
        // What stands at the end of a step: coordinates and rates, in clearances and clearances per radian.
        let mut shown = vec![0.0; 2 * n];
        let mut show = |x: &[f64], w: &[f64]| {
            for k in 0..n {
                (shown[k], shown[n + k]) = (x[k] / c, w[k] / speed);
            }
            shown.clone()
        };
        if let Some(t) = trajectory.as_deref_mut() {
            self.x.copy_from_slice(&from);
            let now = self.a.instant(0.0);
            if self.inertial {
                self.w[..2].copy_from_slice(&v);
            } else {
                self.a.piston.rates(&now, &self.x, None, &mut self.w, &mut [0.0; 2]).map_err(eval(0.0))?;
            }
            t.start(0.0, &show(&self.x, &self.w));
        }
        for k in 0..steps {
            let (mut t, end) = (period * k as f64 / steps as f64, period * (k + 1) as f64 / steps as f64);
            let mut h = end - t;
            let mut halved = 0;
            while t < end {
                self.a.go_on().map_err(eval(t))?;
                let now = self.a.instant(t + h);
                let given = self.inertial.then_some(v);
                match self.a.piston.euler_step(&now, &from, given, h / omega, &mut self.w, &mut self.x) {
                    Ok(()) => {
                        from.copy_from_slice(&self.x);
                        v = [self.w[0], self.w[1]];
                        t = if end - (t + h) < 1e-12 { end } else { t + h };
                        h = h.min(end - t);
                        self.stats.steps += 1;
                    }
                    Err(e) if e.is_recoverable() && halved < HALVINGS => {
                        h *= 0.5;
                        halved += 1;
                        self.stats.rejected += 1;
                        self.w[..2].copy_from_slice(&v);
                    }
                    Err(e) => return Err(eval(t)(e)),
                }
            }
            if let Some(t) = trajectory.as_deref_mut() {
                t.end(end, &show(&self.x, &self.w));
            }
        }
        for (y, x) in y.iter_mut().zip(&from) {
            *y = x / c;
        }
        if self.inertial {
            (y[n], y[n + 1]) = (v[0] / speed, v[1] / speed);
        }
        Ok(())
    }
}

impl Cycle<'_> {
    /// Takes coordinates as the start of a cycle. The velocities are those of a balance of forces, which the films come to within nanoseconds;
    /// where nothing balances them, the piston starts at rest.
    fn begin(&mut self, x: &[f64]) {
        let n = self.x.len();
        self.y[..n].copy_from_slice(x);
        if !self.inertial {
            return;
        }
        let (c, speed) = (self.a.clearance, self.a.clearance * self.a.omega());
        for (own, x) in self.x.iter_mut().zip(x) {
            *own = c * x;
        }
        let now = self.a.instant(0.0);
        self.w.fill(0.0);
        if self.a.piston.rates(&now, &self.x, None, &mut self.w, &mut [0.0; 2]).is_err() {
            self.w.fill(0.0);
        }
        (self.y[n], self.y[n + 1]) = (self.w[0] / speed, self.w[1] / speed);
    }
}

impl CycleMap for Cycle<'_> {
    fn dim(&self) -> usize {
        self.x.len()
    }
    fn map(&mut self, y0: &[f64], y1: &mut [f64], accuracy: f64) -> Result<f64, EvalError> {
        let before = self.a.piston.film_evaluations();
        self.begin(y0);
        let mut y = std::mem::take(&mut self.y);
        let outcome = self.integrate(&mut y, accuracy.max(self.tolerance), None);
        y1.copy_from_slice(&y[..y1.len()]);
        self.y = y;
        if let Err(e) = outcome {
            self.failure = Some(e);
            return Err(EvalError::fatal("piston_secondary", "the cycle could not be integrated"));
        }
        Ok((self.a.piston.film_evaluations() - before) as f64)
    }
    fn scale(&self, _: &[f64], s: &mut [f64]) {
        s.fill(1.0);
    }
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

/// Runs the case: the skirt as it is built, from `start` when one is known.
///
/// # Errors
/// What stopped it.
pub fn run(
    case: &PistonSecondaryCase,
    a: &mut Assembly,
    start: Option<&[f64]>,
    purpose: Purpose,
    progress: &mut dyn FnMut(f64),
) -> Result<Found, RunError> {
    let begin = Clock::now();
    let s = &case.solver;
    let n = a.piston.coordinates();
    let inertial = a.lateral == Lateral::Inertial;
    let states = if inertial { n + 2 } else { n };
    // Where another motion starts from this one, no closer than films of different grids are.
    let is_start = purpose != Purpose::Results;
    let periodicity = if is_start { s.periodicity.si().max(START) } else { s.periodicity.si() };
    if let Lateral::Held { e_top, e_bottom } = a.lateral {
        return Ok(held(a, [e_top, e_bottom], begin));
    }
    let integrator = match s.integrator {
        // Order five pays where the films are smooth; the switch is where both need the same films.
        IntegratorName::Rodas if s.tolerance.si() >= ORDER_FIVE => IntegratorName::Rodas3,
        IntegratorName::Rodas => IntegratorName::Rodas5p,
        other => other,
    };
    let rodas = |formula| Engine::Rodas(Box::new(Rodas::with(formula, states, 0, None)));
    let engine = match (s.method, integrator) {
        (Method::BackwardEuler, _) => {
            Engine::Euler { steps: (a.period / s.step.si()).round().max(1.0) as usize }
        }
        (_, IntegratorName::Rodas5p | IntegratorName::Rodas) => rodas(Formula::Rodas5P),
        (_, IntegratorName::Rodas3) => rodas(Formula::Rodas3),
        (_, IntegratorName::Radau5) => Engine::Radau(Box::new(Radau5::new(states, 0, None))),
    };
    let mut y = vec![0.0; states];
    match start {
        Some(x) => {
            let speed = a.clearance * a.omega();
            for (k, (y, x)) in y.iter_mut().zip(x).enumerate() {
                *y = x / if k < n { a.clearance } else { speed };
            }
        }
        None => {
            y[0] = s.start_top.si() / a.clearance;
            y[1] = s.start_bottom.si() / a.clearance;
        }
    }
    let mut cycle = Cycle {
        a,
        engine,
        inertial,
        x: vec![0.0; n],
        v: [0.0; 2],
        w: vec![0.0; n],
        tolerance: s.tolerance.si(),
        stats: Stats::default(),
        y: vec![0.0; states],
        failure: None,
        progress,
        done: 0.0,
    };
    if start.is_none() {
        cycle.begin(&y[..n]);
        y.copy_from_slice(&cycle.y);
    }
    let mut notes = Vec::new();
    let (cycles, error);
    if s.cycles > 0 {
        for _ in 1..s.cycles {
            cycle.integrate(&mut y, s.tolerance.si(), None)?;
        }
        (cycles, error) = (f64::from(s.cycles), None);
    } else {
        let options = OrbitOptions {
            tolerance: periodicity,
            accuracy: (ACCURACY * s.tolerance.si()).min(0.3 * periodicity),
            max_cycles: s.max_cycles as usize,
            finer: 0,
            accelerate: true,
        };
        let report = match periodic_orbit(&mut cycle, &mut y[..n], &options) {
            Ok(r) => r,
            Err(source) => return Err(cycle.failure.unwrap_or(RunError::Eval { theta_deg: 0.0, source })),
        };
        cycle.begin(&y[..n]);
        y.copy_from_slice(&cycle.y);
        if !report.converged {
            notes.push(not_periodic(report.cycles, report.error_estimate, periodicity));
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
            notes.push(Note::caution(
                "subharmonic",
                format!("the motion repeats only every {} cycles", report.period),
            ));
        }
        (cycles, error) = (report.cycle_equivalents, Some(report.error_estimate));
    }
    let searched = begin.elapsed().as_secs_f64();
    let first = y.clone();
    let mut trajectory = match cycle.engine {
        Engine::Euler { .. } => Trajectory::new(2 * n, Between::Nothing),
        _ => Trajectory::new(states, Between::Dense),
    };
    if purpose != Purpose::Start {
        cycle.integrate(&mut y, s.tolerance.si(), Some(&mut trajectory))?;
    }
    let stats = cycle.stats;
    // Of a given number of cycles the last one is that of the record.
    let seconds = if s.cycles > 0 { begin.elapsed().as_secs_f64() } else { searched };
    let change = first[..n].iter().zip(&y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let clearance = cycle.a.clearance;
    let speed = clearance * cycle.a.omega();
    let start = first.iter().enumerate().map(|(k, y)| y * if k < n { clearance } else { speed }).collect();
    Ok(Found {
        trajectory,
        start,
        cycles,
        periodicity_error: clearance * error.unwrap_or(change),
        notes,
        stats,
        seconds,
    })
}

/// What a motion that is not periodic says: a caution up to ten times the distance that is admitted, a failure beyond.
fn not_periodic(cycles: usize, error: f64, wanted: f64) -> Note {
    let topic = "not_periodic";
    let text = format!(
        "The motion is not periodic within {wanted:.0e} clearances after {cycles} cycles: the estimated distance is {error:.1e}. Raise `solver.max_cycles`, or look at the transient with `solver.cycles`."
    );
    let note =
        if error <= ADMITTED * wanted { Note::caution(topic, text) } else { Note::failure(topic, text) };
    note.amount("periodicity_error", error, "1").amount("wanted", wanted, "1")
}

/// Multiple of the distance wanted up to which a motion counts as periodic, with a caution.
const ADMITTED: f64 = 10.0;

/// Tolerance at which the method of order five needs no more films than that of order three.
const ORDER_FIVE: f64 = 2e-4;
/// Periodicity of a motion that is a start for another, in clearances.
const START: f64 = 1e-3;
/// How repeatable a cycle is, in tolerances.
const ACCURACY: f64 = 0.1;

/// Way between two looks at a skirt that stands still \[rad\].
const STILL: f64 = 0.05;

/// A skirt that stands still.
fn held(a: &mut Assembly, e: [f64; 2], begin: Clock) -> Found {
    let mut x = vec![0.0; a.piston.coordinates()];
    x[..2].copy_from_slice(&e);
    let mut ends = vec![0.0];
    let mut from = 0.0;
    for &to in a.breakpoints.iter().chain([&a.period]) {
        let parts = ((to - from) / STILL).ceil().max(1.0) as usize;
        ends.extend(
            (1..=parts).map(|k| if k == parts { to } else { from + (to - from) * k as f64 / parts as f64 }),
        );
        from = to;
    }
    ends.dedup_by(|b, a| *b - *a < 1e-9);
    let scaled: Vec<f64> = x.iter().map(|x| x / a.clearance).collect();
    Found {
        trajectory: Trajectory::still(ends, &scaled),
        start: x,
        cycles: 1.0,
        periodicity_error: 0.0,
        notes: Vec::new(),
        stats: Stats::default(),
        seconds: begin.elapsed().as_secs_f64(),
    }
}
