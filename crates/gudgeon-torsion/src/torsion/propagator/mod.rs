mod free;
mod particular;

use gudgeon_core::kinds::{Line, Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use free::FreeMotion;
use particular::Particular;

use super::{check_in_time, check_start};
use crate::dynamics::Dynamics;
use crate::steady::Steady;

/// Motion over time of a linear line in closed form: no time steps, each instant by itself.
///
/// The motion is that of the periodic torques (order by order), of constant torques and straight torque-speed lines (a rigid motion and
/// a static twist), and a decaying rest that is a sum of damped modes,
///
/// ```text
/// θ_h(t) = Σ_j c_j v_j e^{z_j t},   c_j = v_jᵀ(z_j J θ + J ω + C θ)(0) / v_jᵀ(2 z_j J + C) v_j
/// ```
///
/// Exact but for rounding. Gas torques go with the angle of the mean speed, not with that of the twisting shaft.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Propagator {}

#[register_model(
    name = "propagator",
    summary = "motion over time in closed form: damped modes on the periodic motion, no steps",
    equations = "theta(t) = theta_p(t) + sum_j c_j v_j exp(z_j t);  det(z^2 J + z C + K) = 0",
    validity = "Linear couplings with stiffness, constant inertia, straight torque-speed lines, gas torques by the mean angle. No double damped eigenvalue (critical damping).",
    references = ["gomes2021"],
    example = "",
)]
impl TorsionSpec for Propagator {
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        let line = ctx.line;
        let dynamics = Dynamics::new(line)?;
        check_in_time(line)?;
        check_start(ctx)?;
        check_linear(line)?;
        let steady = Steady::new(ctx)?;
        if steady.tree.is_grounded() {
            return Err(BuildError::at("inertias", "a line that is held does not turn; use `orders`"));
        }
        Ok(Box::new(Solver {
            steady,
            dynamics,
            angles: ctx.angles.to_vec(),
            speeds: ctx.speeds.to_vec(),
            times: ctx.times.to_vec(),
        }))
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Time
    }
}

/// Refuses what is not linear: laws of couplings, links without stiffness, varying inertia, torque-speed curves.
fn check_linear(line: &Line) -> Result<(), BuildError> {
    if let Some(l) = line.links.iter().position(|l| !l.coupling.is_linear()) {
        let what = format!("`{}` is not linear; use `implicit`", line.links[l].name);
        return Err(BuildError::at(format!("links.{l}"), what));
    }
    if let Some(l) = line.links.iter().position(|l| l.coupling.linear(0.0, 0.0).stiffness == 0.0) {
        let what = format!(
            "`{}` has no stiffness: what it joins slips, and has no static twist to vibrate about; use `implicit`",
            line.links[l].name
        );
        return Err(BuildError::at(format!("links.{l}"), what));
    }
    if let Some(t) = line.throws.iter().find(|t| !t.inertia.is_constant()) {
        let what = format!(
            "the inertia of `{}` varies with the angle; use `implicit`, or throw inertia `mean`",
            line.nodes[t.node].name
        );
        return Err(BuildError::at("throw_inertia", what));
    }
    if let Some(d) = line.drives.iter().position(|d| !d.drive.is_linear() && d.drive.orders().is_empty()) {
        let what = "the torque is not linear in the speed; use `implicit`, or a `linear` drive";
        return Err(BuildError::at(format!("drives.{d}"), what));
    }
    Ok(())
}

#[derive(Debug)]
struct Solver {
    steady: Steady,
    dynamics: Dynamics,
    angles: Vec<f64>,
    speeds: Vec<f64>,
    times: Vec<f64>,
}

impl Torsion for Solver {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        let particular = Particular::new(&mut self.steady)?;
        let t = &self.steady.tree;
        let n = t.len();
        // The free motion takes the start from where the particular motion is.
        let (mut phi, mut rate) = (vec![0.0; n], vec![0.0; n]);
        particular.at(0.0, &self.steady, &mut phi, &mut rate);
        for p in 0..n {
            phi[p] = self.angles[t.node[p]] / t.ratio[p] - phi[p];
            rate[p] = self.speeds[t.node[p]] / t.ratio[p] - rate[p];
        }
        let free = FreeMotion::new(t, &phi, &rate)?;
        let (mut free_phi, mut free_rate) = (vec![0.0; n], vec![0.0; n]);
        let mut alpha = vec![0.0; self.dynamics.len()];
        for &time in &self.times {
            particular.at(time, &self.steady, &mut phi, &mut rate);
            free.at(time, &mut free_phi, &mut free_rate);
            let (mut a, mut w) = (vec![0.0; n], vec![0.0; n]);
            for p in 0..n {
                a[t.node[p]] = (phi[p] + free_phi[p]) * t.ratio[p];
                w[t.node[p]] = (rate[p] + free_rate[p]) * t.ratio[p];
            }
            record(&mut self.dynamics, &self.steady, time, [a, w], &mut alpha, out);
        }
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("modes".into(), free.len() as u64);
        Ok(())
    }
}

/// Writes an instant: angles and speeds of the inertias, and torques as the method has them, by the angle of the mean speed.
fn record(
    dynamics: &mut Dynamics,
    steady: &Steady,
    time: f64,
    [a, w]: [Vec<f64>; 2],
    alpha: &mut [f64],
    out: &mut TorsionOut,
) {
    let uniform: Vec<f64> = steady.line.nodes.iter().map(|n| steady.speed * time * n.ratio).collect();
    let [angle, speed, uniform] = [&a, &w, &uniform].map(|v| dynamics.condense(v));
    dynamics.accelerations(&angle, &speed, &uniform, &uniform, alpha);
    out.torque.push(dynamics.link_torques(&angle, &speed, &uniform, alpha));
    out.gas.push(dynamics.gas.clone());
    out.drive.push(dynamics.drive.clone());
    out.times.push(time);
    out.angles.push(a);
    out.speeds.push(w);
}
