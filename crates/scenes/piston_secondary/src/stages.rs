//! Integration by implicit stages that find places and rates together.

pub mod formula;
pub mod passed;

use gudgeon_core::EvalError;
use gudgeon_core::kinds::LateralLoads;
use gudgeon_numerics::elementary;
use gudgeon_numerics::ode::{Again, IntegrateError};
use gudgeon_scene::RunError;

use super::assembly::Assembly;
use super::equations::{LEAST_GAP, Work};
use super::implicit::{FIRST_STEP, LARGEST_STEP, MAX_STEPS, away};
use super::solver::{Accuracy, Cycled, PistonSolver};
use super::trajectory::{Between, Trajectory};
use formula::{ESDIRK3, Formula};
use passed::Passed;

/// One over the order of the error of a step.
const EXPONENT: f64 = 1.0 / 3.0;
/// Part of the tolerance to which a stage is solved. What it leaves adds up over the cycles of a slow mode: with 4e-3, cycles are no longer repeatable to the
/// tenth of the tolerance that the search of the periodic motion counts on.
const CLOSE: f64 = 1e-3;
/// Part of the step that the error admits which is taken, and bounds of the factor between two steps.
const SAFETY: f64 = 0.9;
const FACTORS: [f64; 2] = [0.2, 6.0];
/// Factor of a step that could not be solved.
const REFUSED: f64 = 0.25;
/// Shortest step \[rad\].
const LEAST_STEP: f64 = 1e-9;
/// Distance kept from kinks by what is asked \[rad\].
const ASIDE: f64 = 1e-9;
/// Change of the gas force across a kink, as part of it, that is no jump.
const NO_JUMP: f64 = 1e-6;

/// Integration by a stiffly accurate, L-stable method with an explicit first stage.
///
/// What is solved is the balance of forces, `0 = r(t, x, dx/dt)`, at the place of every stage, and not rates at a place that is given. Elastic amplitudes have no
/// mass: under a film they follow from its resistance, and under one that is cut off from their stiffness alone, as algebra. As rates, these are a
/// thousandfold faster than those, and every corner between the two would have to be found by the steps.
pub(super) struct Staged {
    formula: &'static Formula,
    tolerance: f64,
    /// Rates of all coordinates at the stages \[m/s\], and the coordinates there \[m\].
    rates: Vec<Vec<f64>>,
    places: Vec<Vec<f64>>,
    from: Vec<f64>,
    /// Change of the rates at the end of the last step \[m/s²\].
    slope: Vec<f64>,
    error: Vec<f64>,
    /// Size wanted of the next step \[rad\], steps tried in the cycle, and whether the last one was rejected.
    h: f64,
    tried: u64,
    rejected: bool,
    /// Ends of the steps of the cycle before where they are taken again, those that are passed taken off; the last one first.
    ends: Vec<f64>,
    again: Again,
}

impl Staged {
    /// For the coordinates of `a`.
    pub(super) fn new(a: &Assembly, tolerance: f64) -> Self {
        let formula = &ESDIRK3;
        let v = || vec![0.0; a.piston.coordinates()];
        let all = || formula.c.iter().map(|_| v()).collect();
        Self {
            formula,
            tolerance,
            rates: all(),
            places: all(),
            from: v(),
            slope: v(),
            error: v(),
            h: FIRST_STEP,
            tried: 0,
            rejected: false,
            ends: Vec::new(),
            again: Again::default(),
        }
    }

    /// Whether `a` is integrated this way: its skirt yields, its motion is a law of the displacements of both edges alone, without inertia, and its films keep no
    /// oil. A rigid skirt has no amplitudes to gain from, and drifts less by a Rosenbrock method of the same order.
    pub(super) fn suits(a: &Assembly) -> bool {
        a.elastic && a.motion.edge_law().is_some_and(|law| law.mass().is_none()) && a.oil.is_none()
    }

    /// From `t` to `end`, between which nothing bends.
    fn stretch(
        &mut self,
        of: &mut Cycled<'_>,
        (mut t, end): (f64, f64),
        tolerance: f64,
        mut trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        let aside = ASIDE.min(0.5 * (end - t));
        let window = (t + aside, end - aside);
        self.begin(of, window.0).map_err(stopped(t))?;
        while t < end {
            let to = self.known_end(t).map_or(end, |known| known.min(end));
            let (h, last) = self.propose(t, to)?;
            let error = match self.attempt(of, (t, h), window, tolerance) {
                Ok(error) => error,
                Err(e) if e.is_recoverable() => {
                    self.reject(of, t, REFUSED * h, Some(e))?;
                    continue;
                }
                Err(e) => return Err(stopped(t)(e)),
            };
            // What is not a number counts as the largest error.
            let error = if error.is_nan() { f64::INFINITY } else { error };
            let factor = (SAFETY * elementary::powf(error, -EXPONENT)).clamp(FACTORS[0], FACTORS[1]);
            if error > 1.0 {
                self.reject(of, t, factor.min(SAFETY) * h, None)?;
                continue;
            }
            of.stats.steps += 1;
            let t1 = if last { to } else { t + h };
            self.again.step(t1);
            if let Some(trajectory) = trajectory.as_deref_mut() {
                trajectory.step(&self.passed(of.a, t, t1));
            }
            self.accept(h, h / of.a.omega(), factor);
            t = t1;
        }
        Ok(())
    }

    /// Rates at the place where a stretch begins, at `t`: those of the end of the one before, unless something jumps.
    fn begin(&mut self, of: &mut Cycled<'_>, t: f64) -> Result<(), EvalError> {
        let (before, now) = (of.a.instant(t - 2.0 * ASIDE), of.a.instant(t));
        let turned = (before.speed < 0.0) != (now.speed < 0.0);
        let jumped = (now.gas - before.gas).abs() > NO_JUMP * now.gas.abs().max(before.gas.abs());
        if self.tried > 0 && !turned && !jumped {
            return Ok(());
        }
        self.slope.fill(0.0);
        of.stats.rhs += 1;
        of.a.piston.ask(&now, &self.places[0], &mut self.rates[0]).balance().map(|_| ())
    }

    /// Where the step ends that was taken from `t` before.
    fn known_end(&mut self, t: f64) -> Option<f64> {
        while self.ends.pop_if(|end| *end <= t).is_some() {}
        self.ends.last().copied()
    }

    /// The step to try next, and whether it is the last one before `end`.
    fn propose(&mut self, t: f64, end: f64) -> Result<(f64, bool), RunError> {
        self.tried += 1;
        if self.tried > MAX_STEPS {
            return Err(IntegrateError::TooManySteps { t, max: MAX_STEPS }.into());
        }
        self.h = self.h.min(LARGEST_STEP);
        let rest = end - t;
        if self.h >= rest * (1.0 - 1e-9) {
            return Ok((rest, true));
        }
        // Two equal steps rather than a whole one and a crumb.
        Ok((if 2.0 * self.h > rest { 0.5 * rest } else { self.h }, false))
    }

    /// Goes back to `t`, to try a step of `h`.
    fn reject(
        &mut self,
        of: &mut Cycled<'_>,
        t: f64,
        h: f64,
        last: Option<EvalError>,
    ) -> Result<(), RunError> {
        of.stats.rejected += 1;
        (self.h, self.rejected) = (h, true);
        if h < LEAST_STEP { Err(IntegrateError::StepTooSmall { t, h, last }.into()) } else { Ok(()) }
    }

    /// Takes the step of `h`, or of `time` \[s\], whose error admits `factor` times as long a one.
    fn accept(&mut self, h: f64, time: f64, factor: f64) {
        let (end, middle) = (self.rates.len() - 1, self.formula.middle);
        let way = time * (1.0 - self.formula.c[middle]);
        let ends = self.rates[end].iter().zip(&self.rates[middle]);
        self.slope.iter_mut().zip(ends).for_each(|(slope, (b, a))| *slope = (b - a) / way);
        self.places.swap(0, end);
        self.rates.swap(0, end);
        let wanted = h * if self.rejected { factor.min(1.0) } else { factor };
        self.h = if !self.ends.is_empty() {
            f64::INFINITY
        } else if h < self.h {
            self.h.max(wanted)
        } else {
            wanted
        };
        self.rejected = false;
    }

    /// Tries a step from `t` of `h`, asking between the ends of `window` alone; its error in tolerances.
    fn attempt(
        &mut self,
        of: &mut Cycled<'_>,
        (t, h): (f64, f64),
        window: (f64, f64),
        tolerance: f64,
    ) -> Result<f64, EvalError> {
        of.a.go_on()?;
        let (formula, time) = (self.formula, h / of.a.omega());
        // Forces go with the cube of the gap: a position matters by its distance from the wall.
        let part = (of.a.piston.smallest_gap() / of.a.clearance).clamp(LEAST_GAP, 1.0);
        let admitted = tolerance * of.a.clearance * part;
        for i in 1..formula.c.len() {
            let (before, rest) = self.rates.split_at_mut(i);
            formula.foresee(before, &self.slope, time, &mut rest[0]);
            self.from.copy_from_slice(&self.places[0]);
            for (a, rates) in formula.a[i].iter().zip(&*before) {
                self.from.iter_mut().zip(rates).for_each(|(x, w)| *x += time * a * w);
            }
            let now = of.a.instant((t + formula.c[i] * h).clamp(window.0, window.1));
            let (own, close) = (formula.diagonal * time, CLOSE * admitted);
            of.a.piston.stage(&now, &self.from, own, close, &mut rest[0], &mut self.places[i])?;
            of.stats.rhs += 1;
        }
        self.error.fill(0.0);
        for (j, rates) in self.rates.iter().enumerate() {
            let weight = time * formula.difference(j);
            self.error.iter_mut().zip(rates).for_each(|(e, w)| *e += weight * w);
        }
        of.a.piston.let_through(formula.diagonal * time, &mut self.error)?;
        Ok(self.error.iter().fold(0.0_f64, |m, e| if *e <= m && -*e <= m { m } else { e.abs() }) / admitted)
    }

    /// The step from `t0` to `t1` whose end was found.
    fn passed(&self, a: &Assembly, t0: f64, t1: f64) -> Passed {
        let (end, middle) = (self.rates.len() - 1, self.formula.middle);
        let of = |x: &[f64]| {
            let mut y = vec![0.0; a.layout.n];
            states(a, x, &mut y);
            y
        };
        let time = (t1 - t0) / a.omega();
        let ahead: Vec<f64> =
            self.places[end].iter().zip(&self.rates[end]).map(|(x, w)| x + time * w).collect();
        let y1 = of(&self.places[end]);
        let change = of(&ahead).iter().zip(&y1).map(|(ahead, y)| ahead - y).collect();
        Passed {
            span: (t0, t1),
            middle: self.formula.c[middle],
            y: [of(&self.places[0]), of(&self.places[middle]), y1, change],
        }
    }
}

fn stopped(t: f64) -> impl Fn(EvalError) -> RunError {
    move |source| RunError::Eval { theta_deg: t.to_degrees(), source }
}

/// The states at the coordinates `x`, into `y`.
fn states(a: &Assembly, x: &[f64], y: &mut [f64]) {
    if let Some(law) = a.motion.edge_law() {
        law.states_at([x[0], x[1]], [0.0; 2], &mut y[a.layout.motion.clone()]);
    }
    y[a.layout.shapes.clone()].iter_mut().zip(&x[2..]).for_each(|(y, x)| *y = x / a.clearance);
}

impl PistonSolver for Staged {
    fn cycle(
        &mut self,
        of: &mut Cycled<'_>,
        y: &mut [f64],
        accuracy: Accuracy,
        mut trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        if let Some(t) = trajectory.as_deref_mut() {
            t.start(0.0, y);
        }
        of.a.coordinates(y, &mut self.places[0]);
        self.rates[0].fill(0.0);
        of.a.piston.forget_stages();
        (self.h, self.tried, self.rejected) = (FIRST_STEP, 0, false);
        let tolerance = accuracy.tolerance(self.tolerance);
        self.ends = self.again.begin(y, tolerance, |start| away(of.a, start, y));
        if !self.ends.is_empty() {
            self.h = f64::INFINITY;
        }
        self.ends.reverse();
        let mut from = 0.0;
        for end in of.a.bends() {
            if end > from {
                let outcome = self.stretch(of, (from, end), tolerance, trajectory.as_deref_mut());
                if outcome.is_err() {
                    self.again = Again::default();
                }
                outcome?;
                from = end;
            }
        }
        states(of.a, &self.places[0], y);
        of.work.w.copy_from_slice(&self.rates[0]);
        Ok(())
    }

    fn noise(&self) -> f64 {
        self.again.noise()
    }

    fn trajectory(&self, a: &Assembly, _: &Work) -> Trajectory {
        Trajectory::new(a.layout.n, Between::Dense)
    }
}
