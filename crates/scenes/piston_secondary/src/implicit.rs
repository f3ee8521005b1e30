//! Adaptive L-stable integration of the motion.

use gudgeon_core::quantity::{PosRatio, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::ode::{Again, Flow, IntegrateError, Integrator, Options, StepView};
use gudgeon_numerics::radau::Radau5;
use gudgeon_numerics::rodas::{Formula, Rodas};
use gudgeon_scene::{Asked, MethodSetting, RunError};
use serde::{Deserialize, Serialize};

use super::assembly::Assembly;
use super::equations::{Equations, Work};
use super::solver::{Accuracy, Cycled, PistonSolver, PistonSolverSpec, check_tolerance, mesh};
use super::stages::Staged;
use super::trajectory::{Between, Trajectory};

/// First step of a cycle \[rad\].
pub(super) const FIRST_STEP: f64 = 1e-2;
/// Largest step \[rad\]: no pulse of the pressure is passed over.
pub(super) const LARGEST_STEP: f64 = 0.2;
/// Most steps of a cycle.
pub(super) const MAX_STEPS: u64 = 200_000;
/// Tolerance at which the method of order five needs no more films than that of order three.
const ORDER_FIVE: f64 = 2e-4;
/// Tolerance of the motion by which those at other tolerances are judged.
const TIGHT: f64 = 1e-6;
/// How repeatable a cycle is, in tolerances.
const ACCURACY: f64 = 0.1;

/// Adaptive L-stable integration with error control.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Implicit {
    /// Time integrator.
    pub integrator: PistonIntegrator,
    /// Error per step, relative to the smallest gap.
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub tolerance: PosRatio,
}

impl Default for Implicit {
    fn default() -> Self {
        Self { integrator: PistonIntegrator::Stages, tolerance: quantity(1e-3) }
    }
}

/// Time integrators of a piston in its bore.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PistonIntegrator {
    /// Of a skirt that yields, diagonally implicit stages of order 3 that find places and rates together (default). `rodas` for rigid skirts, for motions
    /// with inertia, and where films keep their oil.
    #[default]
    Stages,
    /// `rodas3` down to a tolerance of 2e-4, `rodas5p` below.
    Rodas,
    /// Rosenbrock method of order 3, of few stages.
    Rodas3,
    /// Rosenbrock method of order 5.
    Rodas5p,
    /// Radau IIA of order 5, for references at tight tolerances.
    Radau5,
}

impl Implicit {
    /// The Rosenbrock or Radau method that `stages` and `rodas` stand for at the own tolerance.
    fn integrator(&self) -> PistonIntegrator {
        self.integrator_at(self.tolerance.si())
    }

    /// The same at `tolerance`. Order five pays where the films are smooth; the switch is where both need the same films.
    fn integrator_at(&self, tolerance: f64) -> PistonIntegrator {
        match self.integrator {
            PistonIntegrator::Stages | PistonIntegrator::Rodas if tolerance >= ORDER_FIVE => {
                PistonIntegrator::Rodas3
            }
            PistonIntegrator::Stages | PistonIntegrator::Rodas => PistonIntegrator::Rodas5p,
            other => other,
        }
    }
}

#[register_model(
    name = "implicit",
    summary = "adaptive L-stable integration with error control",
    equations = "0 = r(t, y, y') by ESDIRK3(2), or y' = f(t, y) by Rodas3, Rodas5P or Radau IIA; the error of a step below the tolerance",
    validity = "Any lateral motion and any compliance.",
    references = ["hairer1996", "kennedy2003"],
    example = "",
)]
impl PistonSolverSpec for Implicit {
    fn wrong(&self, _: f64) -> Vec<BuildError> {
        check_tolerance("tolerance", self.tolerance.si()).into_iter().collect()
    }

    fn repeatable_to(&self) -> f64 {
        ACCURACY * self.tolerance.si()
    }

    fn build(&self, a: &Assembly) -> Box<dyn PistonSolver> {
        if self.integrator == PistonIntegrator::Stages && Staged::suits(a) {
            return Box::new(Staged::new(a, self.tolerance.si()));
        }
        let (own, finest) = (self.integrator(), self.integrator_at(0.0));
        let method = Method::new(own, a.layout.n);
        let finer = (own != finest).then(|| Method::new(finest, a.layout.n));
        Box::new(Adaptive { method, finer, tolerance: self.tolerance.si(), again: Again::default() })
    }

    fn settings(&self, own: Option<[u32; 2]>) -> Vec<MethodSetting> {
        let mut all = Vec::new();
        for (method, name, points) in [
            (
                "implicit, order 3",
                PistonIntegrator::Rodas3,
                &[(1e-2, 12, 10), (3e-3, 16, 12), (1e-3, 20, 16), (3e-4, 32, 20)][..],
            ),
            (
                "implicit, order 5",
                PistonIntegrator::Rodas5p,
                &[(1e-3, 20, 16), (1e-4, 32, 20), (1e-5, 48, 32)],
            ),
        ] {
            for &(t, along, across) in points {
                let same_film = own == Some([along, across]);
                let same_error = (t / self.tolerance.si() - 1.0).abs() < 1e-9;
                let set = |integrator: PistonIntegrator, tolerance: f64| {
                    let mut set = vec![
                        "solver.method=implicit".into(),
                        format!("solver.integrator={}", word(integrator)),
                        format!("solver.tolerance={tolerance:e}"),
                    ];
                    set.extend(mesh(along, across));
                    set
                };
                // The film has an error of its own: what the tolerance asks for is judged on the same film.
                let against = set(PistonIntegrator::Radau5, (1e-2 * t).min(TIGHT));
                all.push(MethodSetting {
                    method: method.into(),
                    setting: format!("tolerance {t:.0e}, {along} x {across}"),
                    is_default: same_film && same_error && self.integrator() == name,
                    set: set(name, t),
                    asked: Some(Asked { tolerance: t, against, told_by: None }),
                });
            }
        }
        all
    }
}

const fn word(name: PistonIntegrator) -> &'static str {
    match name {
        PistonIntegrator::Stages => "stages",
        PistonIntegrator::Rodas => "rodas",
        PistonIntegrator::Rodas3 => "rodas3",
        PistonIntegrator::Rodas5p => "rodas5p",
        PistonIntegrator::Radau5 => "radau5",
    }
}

enum Method {
    Rodas(Box<Rodas>),
    Radau(Box<Radau5>),
}

impl Method {
    fn new(name: PistonIntegrator, states: usize) -> Self {
        let rodas = |formula| Self::Rodas(Box::new(Rodas::with(formula, states, 0, None)));
        match name {
            PistonIntegrator::Rodas3 => rodas(Formula::Rodas3),
            PistonIntegrator::Radau5 => Self::Radau(Box::new(Radau5::new(states, 0, None))),
            _ => rodas(Formula::Rodas5P),
        }
    }
}

/// How far the states `y` are from `start`, over what counts as one between cycles.
pub(super) fn away(a: &Assembly, start: &[f64], y: &[f64]) -> f64 {
    let states = a.layout.states.iter().zip(start).zip(y);
    states.map(|((s, a), b)| (b - a).abs() / s.cycle_scale).fold(0.0, f64::max)
}

struct Adaptive {
    method: Method,
    /// That of a search that asks for less error than `tolerance`, where it is another: the longest step may leave the own one no better.
    finer: Option<Method>,
    tolerance: f64,
    again: Again,
}

impl PistonSolver for Adaptive {
    fn cycle(
        &mut self,
        of: &mut Cycled<'_>,
        y: &mut [f64],
        accuracy: Accuracy,
        mut trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        let layout = &of.a.layout;
        let scale: Vec<f64> = layout.states.iter().map(|s| s.scale).collect();
        let mut options = Options::new(accuracy.tolerance(self.tolerance), &scale);
        options.absolute = layout.states.iter().map(|s| !s.relative).collect();
        (options.h_init, options.h_max, options.max_steps) = (FIRST_STEP, LARGEST_STEP, MAX_STEPS);
        options.event_samples = 0;
        options.ends = self.again.begin(y, options.rtol, |start| away(of.a, start, y));
        if let Some(t) = trajectory.as_deref_mut() {
            t.start(0.0, y);
        }
        let outcome = self.stretches(of, y, options, trajectory);
        if outcome.is_err() {
            // Steps of a part of a cycle say nothing of the rest.
            self.again = Again::default();
        }
        outcome
    }

    fn noise(&self) -> f64 {
        self.again.noise()
    }

    fn trajectory(&self, a: &Assembly, _: &Work) -> Trajectory {
        Trajectory::new(a.layout.n, Between::Dense)
    }
}

impl Adaptive {
    /// A cycle, in stretches between which oil is moved.
    fn stretches(
        &mut self,
        of: &mut Cycled<'_>,
        y: &mut [f64],
        mut options: Options,
        mut trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError> {
        let at = |t: f64| move |source| RunError::Eval { theta_deg: t.to_degrees(), source };
        of.a.begin_oil(y, &of.work.w).map_err(at(0.0))?;
        for k in 0..of.a.oil_steps() {
            let span = (of.a.oil_angle(k), of.a.oil_angle(k + 1));
            options.h_init = self.stretch(of, span, y, &options, trajectory.as_deref_mut())?;
            let Work { x, w, .. } = &mut *of.work;
            of.a.move_oil(k, y, w, x).map_err(at(span.1))?;
        }
        Ok(())
    }

    /// Integrates over `span` \[rad\], in which the same nodes of the films are filled. Returns a good step for what follows.
    fn stretch(
        &mut self,
        of: &mut Cycled<'_>,
        span: (f64, f64),
        y: &mut [f64],
        options: &Options,
        mut trajectory: Option<&mut Trajectory>,
    ) -> Result<f64, RunError> {
        let breakpoints = std::mem::take(&mut of.a.breakpoints);
        let again = &mut self.again;
        let mut problem = Equations { a: of.a, work: of.work };
        let mut observe = |_: &mut Equations<'_>, view: &dyn StepView| {
            again.step(view.t1());
            if let Some(t) = trajectory.as_deref_mut() {
                t.step(view);
            }
            Flow::Continue
        };
        let finer = self.finer.as_mut().filter(|_| options.rtol < ORDER_FIVE);
        let outcome = match finer.unwrap_or(&mut self.method) {
            Method::Rodas(m) => {
                m.integrate(&mut problem, span, &breakpoints, y, &mut [], options, of.stats, &mut observe)
            }
            Method::Radau(m) => {
                m.integrate(&mut problem, span, &breakpoints, y, &mut [], options, of.stats, &mut observe)
            }
        };
        of.a.breakpoints = breakpoints;
        outcome.map_err(|e| match e {
            IntegrateError::Eval { t, source } => RunError::Eval { theta_deg: t.to_degrees(), source },
            other => RunError::Integrate(other),
        })
    }
}
