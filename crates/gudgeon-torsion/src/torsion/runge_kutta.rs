use gudgeon_core::kinds::{Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::quantity::PosTime;
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::linalg::Complex;
use serde::{Deserialize, Serialize};

use super::{check_in_time, check_start};
use crate::dynamics::{Dynamics, record};

/// Motion over time by the classical Runge-Kutta method of order 4 with a fixed step, as published.
///
/// With `look_ahead` the gas torque of each stage is evaluated as the published listing does it: the window of the indicator diagram by
/// the angle of the stage, volume and lever by the angle of the next one. The torque then runs ahead by about a quarter of a step, and
/// the method is of first order under gas torque.
///
/// The step must be below `2.785/ω` of the highest mode; beyond it the motion blows up, which is reported as such.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RungeKutta {
    /// Step.
    pub step: PosTime,
    /// Whether gas torques look ahead by one stage.
    #[serde(default)]
    pub look_ahead: bool,
}

/// Maximum number of steps of a run: 20 s of 1 µs.
const MAX_STEPS: f64 = 2e7;

#[register_model(
    name = "runge_kutta",
    summary = "motion over time, fixed-step Runge-Kutta of order 4, as published",
    equations = "dtheta/dt = omega;  J domega/dt = T - C omega - K theta - J' omega^2/2",
    validity = "Explicit: stable below a step of 2.785 over the highest angular frequency.",
    references = ["gomes2021"],
    example = "step = \"50 us\"\nlook_ahead = true\n",
)]
impl TorsionSpec for RungeKutta {
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        let dynamics = Dynamics::new(ctx.line)?;
        check_in_time(ctx.line)?;
        check_start(ctx)?;
        let h = self.step.si();
        let end = ctx.times[ctx.times.len() - 1];
        if end / h > MAX_STEPS {
            let what = format!("{:.3e} steps to {end} s are more than {MAX_STEPS:.0e}", end / h);
            return Err(BuildError::at("step", what));
        }
        let row = vec![0.0; dynamics.len()];
        Ok(Box::new(Solver {
            theta: dynamics.condense(ctx.angles),
            omega: dynamics.condense(ctx.speeds),
            dynamics,
            h,
            look_ahead: self.look_ahead,
            // Results at the nearest step.
            at: ctx.times.iter().map(|t| (t / h).round() as u64).collect(),
            u: std::array::from_fn(|_| row.clone()),
            v: std::array::from_fn(|_| row.clone()),
            k: std::array::from_fn(|_| row.clone()),
        }))
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Time
    }
    /// `|1 + x + x²/2 + x³/6 + x⁴/24| > 1`, `x = zh`.
    fn grows(&self, zh: [f64; 2]) -> Option<bool> {
        let real = |v: f64| Complex::new(v, 0.0);
        let x = Complex::new(zh[0], zh[1]);
        let r = real(1.0) + x * (real(1.0) + x * (real(0.5) + x * (real(1.0 / 6.0) + x * real(1.0 / 24.0))));
        Some(r.abs() > 1.0 + 1e-12)
    }
}

#[derive(Debug)]
struct Solver {
    dynamics: Dynamics,
    h: f64,
    look_ahead: bool,
    theta: Vec<f64>,
    omega: Vec<f64>,
    at: Vec<u64>,
    /// Angles and speeds of stages 2 to 4.
    u: [Vec<f64>; 3],
    v: [Vec<f64>; 3],
    /// Accelerations of the stages.
    k: [Vec<f64>; 4],
}

impl Solver {
    fn step(&mut self) {
        let Self { dynamics, h, look_ahead, theta, omega, u, v, k, .. } = self;
        let (h, ahead) = (*h, *look_ahead);
        let n = theta.len();
        let [ua, ub, uc] = u;
        let [va, vb, vc] = v;
        let [k1, k2, k3, k4] = k;
        // A stage's angles follow from the speeds of the stage before, so those of the next one are known in time.
        for i in 0..n {
            ua[i] = theta[i] + 0.5 * h * omega[i];
        }
        dynamics.accelerations(theta, omega, theta, if ahead { ua } else { theta }, k1);
        for i in 0..n {
            va[i] = omega[i] + 0.5 * h * k1[i];
            ub[i] = theta[i] + 0.5 * h * va[i];
        }
        dynamics.accelerations(ua, va, ua, if ahead { ub } else { ua }, k2);
        for i in 0..n {
            vb[i] = omega[i] + 0.5 * h * k2[i];
            uc[i] = theta[i] + h * vb[i];
        }
        dynamics.accelerations(ub, vb, ub, if ahead { uc } else { ub }, k3);
        for i in 0..n {
            vc[i] = omega[i] + h * k3[i];
            theta[i] += h / 6.0 * (omega[i] + 2.0 * va[i] + 2.0 * vb[i] + vc[i]);
        }
        dynamics.accelerations(uc, vc, uc, if ahead { theta } else { uc }, k4);
        for i in 0..n {
            omega[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
}

impl Torsion for Solver {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        let mut done = 0_u64;
        for r in 0..self.at.len() {
            while done < self.at[r] {
                self.step();
                done += 1;
            }
            if self.omega.iter().chain(&self.theta).any(|v| !v.is_finite() || v.abs() > 1e100) {
                let what = format!(
                    "the motion blows up before {:.6} s: the step of {} s is too large for the highest mode",
                    done as f64 * self.h,
                    self.h
                );
                return Err(EvalError::fatal("runge_kutta", what));
            }
            // Gas and drives as the method used them, torques in the links as they are at this instant.
            let used = (self.dynamics.gas.clone(), self.dynamics.drive.clone());
            record(&mut self.dynamics, done as f64 * self.h, &self.theta, &self.omega, out);
            let last = out.gas.len() - 1;
            out.gas[last].clone_from(&used.0);
            out.drive[last].clone_from(&used.1);
            (self.dynamics.gas, self.dynamics.drive) = used;
        }
        out.counters.insert("time_steps".into(), done);
        out.counters.insert("right_hand_sides".into(), 4 * done);
        Ok(())
    }
}
