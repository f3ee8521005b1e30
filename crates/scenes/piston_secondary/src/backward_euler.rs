//! A cycle in equal steps of the backward Euler method.

use std::f64::consts::PI;

use gudgeon_core::kinds::LateralLoads;
use gudgeon_core::quantity::{PosAngle, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::ode::Stats;
use gudgeon_scene::{MethodSetting, RunError};
use gudgeon_skirt::Momentum;
use serde::{Deserialize, Serialize};

use super::assembly::Assembly;
use super::equations::Work;
use super::solver::{Accuracy, Cycled, PistonSolver, PistonSolverSpec, mesh};
use super::trajectory::{Between, Trajectory};

/// Equal steps of crank angle, cycle after cycle: the simplest scheme that stands the stiffness of the films.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BackwardEuler {
    /// Step.
    #[schemars(extend("x-refine" = { "group": "time step", "factor": 0.5 }))]
    pub step: PosAngle,
}

impl Default for BackwardEuler {
    fn default() -> Self {
        Self { step: quantity(0.5f64.to_radians()) }
    }
}

/// How repeatable a cycle is, in clearances: its steps are the same each time, and their equations are solved closer than that.
const REPEATABLE: f64 = 1e-4;

#[register_model(
    name = "backward_euler",
    summary = "equal steps of the backward Euler method",
    equations = "y(t + h) = y(t) + h f(t + h, y(t + h))",
    validity = "Lateral motions that are a law of the displacements of both edges alone.",
    references = ["hairer1996"],
    example = "",
)]
impl PistonSolverSpec for BackwardEuler {
    fn wrong(&self, series_step: f64) -> Vec<BuildError> {
        let mut errors = Vec::new();
        let steps = 4.0 * PI / self.step.si();
        if !(36.0..=1e6).contains(&steps) {
            let what = format!("a cycle of {steps:.0} steps is none: between 7e-4 and 20 degrees");
            errors.push(BuildError::at("solver.step", what));
        }
        let parts = series_step / self.step.si();
        if (parts - parts.round()).abs() > 1e-6 {
            let what = "rows of the series must be a whole number of `solver.step` apart";
            errors.push(BuildError::at("outputs.series_step", what));
        }
        errors
    }

    fn refuses(&self, a: &Assembly) -> Option<BuildError> {
        let possible = a.layout.n == 0 || a.motion.edge_law().is_some();
        if !possible {
            return Some(BuildError::at("solver.method", NO_LAW).help("use `implicit`"));
        }
        let (steps, oil) = (self.steps(a), a.oil_steps());
        let what = "the oil of the skirt is moved at ends of steps: its step must be a whole number of these";
        (!steps.is_multiple_of(oil)).then(|| BuildError::at("solver.step", what))
    }

    fn repeatable_to(&self) -> f64 {
        REPEATABLE
    }

    fn build(&self, a: &Assembly) -> Box<dyn PistonSolver> {
        Box::new(EqualSteps { steps: self.steps(a) })
    }

    fn settings(&self, _: Option<[u32; 2]>) -> Vec<MethodSetting> {
        let mut all = Vec::new();
        for (method, film, points) in [
            (
                "backward Euler",
                "{ model = \"direct\", cavitation = \"half_sommerfeld\" }",
                &[(2.0, 12, 10), (1.0, 16, 12), (0.5, 20, 16)][..],
            ),
            (
                "backward Euler, published film",
                "{ model = \"central_differences\" }",
                &[(0.5, 9, 9), (0.5, 13, 13)],
            ),
        ] {
            for &(step, along, across) in points {
                let mut set = vec![
                    "solver.method=backward_euler".into(),
                    format!("solver.step={step} deg"),
                    format!("models.film_2d={film}"),
                    "outputs.series_step=2 deg".into(),
                ];
                set.extend(mesh(along, across));
                all.push(MethodSetting {
                    method: method.into(),
                    setting: format!("steps of {step} deg, {along} x {across}"),
                    is_default: false,
                    set,
                    asked: None,
                });
            }
        }
        all
    }
}

impl BackwardEuler {
    /// Steps of a cycle.
    fn steps(&self, a: &Assembly) -> usize {
        (a.period / self.step.si()).round().max(1.0) as usize
    }
}

struct EqualSteps {
    steps: usize,
}

impl PistonSolver for EqualSteps {
    fn cycle(
        &mut self,
        of: &mut Cycled<'_>,
        y: &mut [f64],
        _: Accuracy,
        trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        Euler::new(of.a, of.work, of.stats, y)?.cycle(self.steps, trajectory, y)
    }

    fn trajectory(&self, a: &Assembly, work: &Work) -> Trajectory {
        Trajectory::new(a.layout.n + work.w.len(), Between::Nothing)
    }
}

/// Halvings of a step.
const HALVINGS: u32 = 12;

/// A piston whose lateral motion is a law of the displacements of both edges alone, stepped by the backward Euler method.
struct Euler<'a> {
    a: &'a mut Assembly,
    work: &'a mut Work,
    stats: &'a mut Stats,
    /// Mass matrix of both edges \[kg\], for a motion with inertia.
    mass: Option<[[f64; 2]; 2]>,
    /// Coordinates \[m\] and velocities of both edges \[m/s\] at the start of a step.
    from: Vec<f64>,
    v: [f64; 2],
}

fn stopped(t: f64) -> impl Fn(EvalError) -> RunError {
    move |source| RunError::Eval { theta_deg: t.to_degrees(), source }
}

impl<'a> Euler<'a> {
    /// Starts from the states `y`.
    ///
    /// # Errors
    /// A motion that is anything else than a law of the displacements of both edges.
    fn new(
        a: &'a mut Assembly,
        work: &'a mut Work,
        stats: &'a mut Stats,
        y: &[f64],
    ) -> Result<Self, RunError> {
        let Some(mass) = a.motion.edge_law().map(|law| law.mass()) else {
            return Err(stopped(0.0)(EvalError::fatal("piston_secondary", NO_LAW)));
        };
        let mut from = work.x.clone();
        a.coordinates(y, &mut from);
        let v = a.motion.pose(&y[a.layout.motion.clone()]).v.unwrap_or_default();
        Ok(Self { a, work, stats, mass, from, v })
    }

    /// One cycle in `steps` steps, into `trajectory`; the states at its end, into `y`.
    ///
    /// # Errors
    /// A step that cannot be solved.
    fn cycle(
        mut self,
        steps: usize,
        mut trajectory: Option<&mut Trajectory>,
        y: &mut [f64],
    ) -> Result<(), RunError> {
        if let Some(t) = trajectory.as_deref_mut() {
            self.first_rates()?;
            t.start(0.0, &self.shown());
        }
        let (period, oil) = (self.a.period, self.a.oil_steps());
        self.a.begin_oil(y, &self.work.w).map_err(stopped(0.0))?;
        for k in 0..steps {
            let (t, end) = (period * k as f64 / steps as f64, period * (k + 1) as f64 / steps as f64);
            self.step(t, end)?;
            if let Some(t) = trajectory.as_deref_mut() {
                t.end(end, &self.shown());
            }
            let moved = (k + 1) * oil;
            if moved.is_multiple_of(steps) {
                self.states(y);
                let Work { x, w, .. } = &mut *self.work;
                self.a.move_oil(moved / steps - 1, y, w, x).map_err(stopped(end))?;
            }
        }
        self.states(y);
        Ok(())
    }

    /// Rates at the start of the cycle.
    fn first_rates(&mut self) -> Result<(), RunError> {
        let Work { x, w, .. } = &mut *self.work;
        x.copy_from_slice(&self.from);
        if self.mass.is_some() {
            w[..2].copy_from_slice(&self.v);
            return Ok(());
        }
        let now = self.a.instant(0.0);
        self.a.piston.ask(&now, x, w).balance().map(|_| ()).map_err(stopped(0.0))
    }

    /// One step, halved where it has to be.
    fn step(&mut self, mut t: f64, end: f64) -> Result<(), RunError> {
        let omega = self.a.omega();
        let mut h = end - t;
        let mut halved = 0;
        while t < end {
            self.a.go_on().map_err(stopped(t))?;
            let now = self.a.instant(t + h);
            let momentum = self.mass.map(|mass| Momentum { mass, v: self.v });
            let Work { x, w, .. } = &mut *self.work;
            match self.a.piston.euler_step(&now, &self.from, momentum, h / omega, w, x) {
                Ok(()) => {
                    self.from.copy_from_slice(x);
                    self.v = [w[0], w[1]];
                    t = if end - (t + h) < 1e-12 { end } else { t + h };
                    h = h.min(end - t);
                    self.stats.steps += 1;
                }
                Err(e) if e.is_recoverable() && halved < HALVINGS => {
                    h *= 0.5;
                    halved += 1;
                    self.stats.rejected += 1;
                    w[..2].copy_from_slice(&self.v);
                }
                Err(e) => return Err(stopped(t)(e)),
            }
        }
        Ok(())
    }

    /// The states of now, into `y`.
    fn states(&self, y: &mut [f64]) {
        let layout = &self.a.layout;
        if let Some(law) = self.a.motion.edge_law() {
            law.states_at([self.from[0], self.from[1]], self.v, &mut y[layout.motion.clone()]);
        }
        for (y, q) in y[layout.shapes.clone()].iter_mut().zip(&self.from[2..]) {
            *y = q / self.a.clearance;
        }
    }

    /// What a trajectory keeps: the states, then the rates of all coordinates in clearances per radian.
    fn shown(&self) -> Vec<f64> {
        let speed = self.a.clearance * self.a.omega();
        let mut shown = vec![0.0; self.a.layout.n];
        self.states(&mut shown);
        shown.extend(self.work.w.iter().map(|w| w / speed));
        shown
    }
}

/// Why a motion cannot be stepped by the backward Euler method.
const NO_LAW: &str = "`backward_euler` steps lateral motions that are a law of the displacements of both edges alone, which this one is not";
