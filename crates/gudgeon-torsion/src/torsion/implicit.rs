use gudgeon_core::kinds::{Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::quantity::{Positive, Ratio, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::ode::{Flow, Integrator, OdeSystem, Options, Stats};
use gudgeon_numerics::rodas::{Formula, Rodas};
use serde::{Deserialize, Serialize};

use super::{check_in_time, check_start};
use crate::dynamics::{Dynamics, record};

/// Motion over time with error control: nonlinear couplings, variable inertia, motors over their whole curve.
///
/// An L-stable Rosenbrock method of order 5. Stiff couplings do not bound its step; what is wanted between its steps is found by
/// interpolation of order 4. Its linear systems are eliminated along the tree, so a step costs in proportion to the number of inertias.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Implicit {
    /// Relative error per step, against the largest speed and the largest twist.
    #[serde(default = "tolerance")]
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    pub tolerance: Ratio<Positive>,
}

fn tolerance() -> Ratio<Positive> {
    quantity(1e-6)
}

impl Default for Implicit {
    fn default() -> Self {
        Self { tolerance: tolerance() }
    }
}

#[register_model(
    name = "implicit",
    summary = "motion over time with error control, for anything nonlinear",
    equations = "J(theta) domega/dt + J'(theta) omega^2/2 = T(theta, omega) - coupling torques",
    validity = "Viscous damping; every inertia greater than zero but for those on rigid links.",
    references = ["gomes2021", "steinebach2023"],
    example = "tolerance = 1e-6\n",
)]
impl TorsionSpec for Implicit {
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        let dynamics = Dynamics::new(ctx.line)?;
        check_in_time(ctx.line)?;
        check_start(ctx)?;
        if !(1e-13..=1e-2).contains(&self.tolerance.si()) {
            return Err(BuildError::at("tolerance", "must be between 1e-13 and 1e-2"));
        }
        let fastest = ctx.speeds.iter().map(|v| v.abs()).fold(ctx.speed.abs(), f64::max).max(1e-3);
        Ok(Box::new(Solver {
            start: [dynamics.condense(ctx.angles), dynamics.condense(ctx.speeds)].concat(),
            system: System { n: dynamics.len(), dynamics },
            tolerance: self.tolerance.si(),
            fastest,
            times: ctx.times.to_vec(),
        }))
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Time
    }
}

#[derive(Debug)]
struct System {
    dynamics: Dynamics,
    n: usize,
}

impl OdeSystem for System {
    fn dim(&self) -> usize {
        2 * self.n
    }
    fn rhs(&mut self, _: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        let (theta, omega) = y.split_at(self.n);
        let (rates, accelerations) = f.split_at_mut(self.n);
        rates.copy_from_slice(omega);
        self.dynamics.accelerations(theta, omega, theta, theta, accelerations);
        Ok(())
    }
    fn linearise(&mut self, _: f64, y: &[f64], _: &[f64]) -> Result<(), EvalError> {
        let (theta, omega) = y.split_at(self.n);
        self.dynamics.linearise(theta, omega);
        Ok(())
    }
    fn factor(&mut self, d: f64) -> bool {
        self.dynamics.factor(d)
    }
    fn solve(&mut self, b: &mut [f64]) {
        self.dynamics.solve(b);
    }
    fn time_derivative(&mut self, _: f64, _: &[f64], _: &[f64], d: &mut [f64]) -> Result<bool, EvalError> {
        d.fill(0.0);
        Ok(true)
    }
}

#[derive(Debug)]
struct Solver {
    system: System,
    tolerance: f64,
    fastest: f64,
    start: Vec<f64>,
    times: Vec<f64>,
}

impl Torsion for Solver {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        let n = self.system.n;
        let mut integrator = Rodas::structured(Formula::Rodas5P, 2 * n);
        // Twists are milliradians where speeds are hundreds: errors of an angle count against a hundredth of a radian.
        let scale: Vec<f64> = (0..2 * n).map(|i| if i < n { 1e-2 } else { self.fastest }).collect();
        let mut options = Options::new(self.tolerance, &scale);
        options.absolute = (0..2 * n).map(|i| i < n).collect();
        let end = self.times[self.times.len() - 1];
        let mut stats = Stats::default();
        let mut y = self.start.clone();
        let mut next = 0;
        let mut state = vec![0.0; 2 * n];
        let times = &self.times;
        let mut keep = |dynamics: &mut Dynamics, t: f64, y: &[f64]| {
            let (theta, omega) = y.split_at(n);
            record(dynamics, t, theta, omega, out);
        };
        while next < times.len() && times[next] <= 0.0 {
            keep(&mut self.system.dynamics, times[next], &y);
            next += 1;
        }
        if next < times.len() {
            integrator
                .integrate(
                    &mut self.system,
                    (0.0, end),
                    &[],
                    &mut y,
                    &mut [],
                    &options,
                    &mut stats,
                    &mut |s, view| {
                        while next < times.len() && times[next] <= view.t1() {
                            view.interpolate(times[next], &mut state);
                            keep(&mut s.dynamics, times[next], &state);
                            next += 1;
                        }
                        Flow::Continue
                    },
                )
                .map_err(|e| EvalError::fatal("implicit", e.to_string()))?;
        }
        out.counters.insert("time_steps".into(), stats.steps);
        out.counters.insert("rejected".into(), stats.rejected);
        out.counters.insert("right_hand_sides".into(), stats.rhs);
        Ok(())
    }
}
