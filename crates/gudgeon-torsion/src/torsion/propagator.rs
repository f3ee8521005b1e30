use gudgeon_core::kinds::{Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::linalg::Complex;
use serde::{Deserialize, Serialize};

use super::{check_in_time, check_start};
use crate::dynamics::Dynamics;
use crate::eigen;
use crate::steady::Steady;
use crate::tree::{Singular, Tree, Work};

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
        if let Some(d) = line.drives.iter().position(|d| !d.drive.is_linear() && d.drive.orders().is_empty())
        {
            let what = "the torque is not linear in the speed; use `implicit`, or a `linear` drive";
            return Err(BuildError::at(format!("drives.{d}"), what));
        }
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

#[derive(Debug)]
struct Solver {
    steady: Steady,
    dynamics: Dynamics,
    angles: Vec<f64>,
    speeds: Vec<f64>,
    times: Vec<f64>,
}

/// Motion of a free linear line: the terms of the sum.
#[derive(Debug, Clone)]
pub(crate) struct Terms {
    /// Eigenvalues and amplitudes by position; conjugates are not listed but taken twice the real part (`twice`).
    pub list: Vec<(Complex, Vec<Complex>, bool)>,
    /// Rigid motion `a + b t` in φ.
    pub rigid: [f64; 2],
}

impl Terms {
    /// From the state at time zero by position (φ and its rate).
    pub fn new(tree: &Tree, phi: &[f64], rate: &[f64]) -> Result<Self, EvalError> {
        let n = tree.len();
        let omega = eigen::natural_frequencies(tree, usize::MAX)?;
        let normal = eigen::shapes(tree, &omega);
        let spectrum = eigen::roots(tree, &omega, &normal)?;
        let mut work = Work::new(n);
        let drag: f64 = tree.damping.iter().sum();
        let c_times = |x: &[Complex]| -> Vec<Complex> {
            let mut y: Vec<Complex> =
                x.iter().zip(&tree.damping).map(|(x, d)| *x * Complex::new(*d, 0.0)).collect();
            for p in 0..n - 1 {
                let q = tree.parent[p];
                let t = (x[p] - x[q]) * Complex::new(tree.c[p], 0.0);
                y[p] = y[p] + t;
                y[q] = y[q] - t;
            }
            y
        };
        let real = |v: f64| Complex::new(v, 0.0);
        let start: Vec<Complex> = phi.iter().map(|x| real(*x)).collect();
        let c_start = c_times(&start);
        let dot =
            |a: &[Complex], b: &[Complex]| a.iter().zip(b).fold(Complex::default(), |s, (a, b)| s + *a * *b);
        let j: Vec<Complex> = tree.inertia.iter().map(|j| real(*j)).collect();
        let mut terms = Self { list: Vec::new(), rigid: [0.0; 2] };
        let total = tree.total_inertia();
        let momentum: f64 = rate.iter().zip(&tree.inertia).map(|(w, j)| w * j).sum();
        let first: f64 = phi.iter().zip(&tree.inertia).map(|(x, j)| x * j).sum();
        if drag == 0.0 {
            terms.rigid = [first / total, momentum / total];
        } else {
            let c: f64 = c_start.iter().map(|c| c.re).sum();
            terms.rigid = [(momentum + c) / drag, 0.0];
        }
        let mut add = |z: Complex, seed: &[f64], twice: bool, terms: &mut Self| {
            // The shape of a damped mode: inverse iteration from the undamped one.
            let mut v: Vec<Complex> = seed.iter().map(|v| real(*v)).collect();
            let (mut x, mut t) = (vec![Complex::default(); n], vec![Complex::default(); n]);
            for _ in 0..2 {
                let rhs: Vec<Complex> = v.iter().zip(&j).map(|(v, j)| *v * *j).collect();
                if tree.solve(z, &rhs, &mut x, &mut t, Singular::Perturb, &mut work).is_ok() {
                    let top =
                        x.iter().fold(Complex::default(), |a, b| if b.abs() > a.abs() { *b } else { a });
                    if top.abs() > 0.0 && top.abs().is_finite() {
                        let inv = real(1.0) / top;
                        v = x.iter().map(|x| *x * inv).collect();
                    }
                }
            }
            let jv: Vec<Complex> = v.iter().zip(&j).map(|(v, j)| *v * *j).collect();
            let below = real(2.0) * z * dot(&v, &jv) + dot(&v, &c_times(&v));
            let above = (0..n).fold(Complex::default(), |s, i| {
                s + v[i] * (z * j[i] * start[i] + j[i] * real(rate[i]) + c_start[i])
            });
            let c = above / below;
            terms.list.push((z, v.iter().map(|v| *v * c).collect(), twice));
        };
        for (k, pair) in spectrum.pairs.iter().enumerate() {
            if omega[k] == 0.0 {
                if drag != 0.0 {
                    add(pair[1], &normal[k], false, &mut terms);
                }
            } else if pair[0].im > 0.0 {
                add(pair[0], &normal[k], true, &mut terms);
            } else {
                add(pair[0], &normal[k], false, &mut terms);
                add(pair[1], &normal[k], false, &mut terms);
            }
        }
        // The sum must give what it was made from.
        let (mut a, mut b) = (vec![0.0; n], vec![0.0; n]);
        terms.at(0.0, &mut a, &mut b);
        let size = |x: &[f64]| x.iter().map(|v| v.abs()).fold(0.0, f64::max);
        let fastest = omega.iter().copied().fold(0.0, f64::max);
        let scale = size(phi) * fastest + size(rate);
        let worst =
            (0..n).map(|i| ((a[i] - phi[i]).abs() * fastest).max((b[i] - rate[i]).abs())).fold(0.0, f64::max);
        if worst.is_nan() || worst > 1e-7 * scale {
            return Err(EvalError::fatal(
                "propagator",
                "two damped modes are (nearly) one: a critically damped pair has no sum of exponentials; use `implicit`",
            ));
        }
        Ok(terms)
    }

    /// Angles and speeds by position at time `t`.
    pub fn at(&self, t: f64, phi: &mut [f64], rate: &mut [f64]) {
        phi.fill(self.rigid[0] + self.rigid[1] * t);
        rate.fill(self.rigid[1]);
        for (z, v, twice) in &self.list {
            let (sin, cos) = (z.im * t).sin_cos();
            let size = (z.re * t).exp() * if *twice { 2.0 } else { 1.0 };
            let e = Complex::new(size * cos, size * sin);
            let d = *z * e;
            for ((p, r), v) in phi.iter_mut().zip(rate.iter_mut()).zip(v) {
                *p += v.re * e.re - v.im * e.im;
                *r += v.re * d.re - v.im * d.im;
            }
        }
    }
}

impl Torsion for Solver {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        let orders = std::mem::take(&mut self.steady.excitation.orders);
        let periodic =
            orders.iter().map(|o| self.steady.respond(o)).collect::<Result<Vec<_>, EvalError>>()?;
        let s = &self.steady;
        let (t, n) = (&s.tree, s.tree.len());
        // Constant torques: those of straight lines at rest, of gas in the mean.
        let mut mean: Vec<f64> = s.excitation.mean.clone();
        for (i, m) in mean.iter_mut().enumerate() {
            // All that depends on the speed is in the damping of the tree.
            let p = t.position[i];
            *m += t.damping[p] * s.speed / t.ratio[p];
        }
        let f: Vec<f64> = (0..n).map(|p| mean[t.node[p]] * t.ratio[p]).collect();
        let (force, drag, total) = (f.iter().sum::<f64>(), t.damping.iter().sum::<f64>(), t.total_inertia());
        // Rigid motion under constant torque, and the twist that goes with it.
        let (speed, growth) = if drag == 0.0 { (0.0, force / total) } else { (force / drag, 0.0) };
        let mut load: Vec<f64> =
            (0..n).map(|p| f[p] - t.inertia[p] * growth - t.damping[p] * speed).collect();
        for p in 0..n - 1 {
            load[t.parent[p]] += load[p];
        }
        let mut twist = vec![0.0; n];
        for p in (0..n - 1).rev() {
            twist[p] = twist[t.parent[p]] + load[p] / t.k[p];
        }
        // Particular motion of the periodic torques at angle Ωt, by position.
        let at = |time: f64, phi: &mut [f64], rate: &mut [f64]| {
            for p in 0..n {
                phi[p] = twist[p] + speed * time + 0.5 * growth * time * time;
                rate[p] = speed + growth * time;
            }
            for o in &periodic {
                let w = o.order * s.speed;
                let (sin, cos) = (w * time).sin_cos();
                for p in 0..n {
                    let [re, im] = o.angle[t.node[p]];
                    phi[p] += (re * cos - im * sin) / t.ratio[p];
                    rate[p] -= w * (re * sin + im * cos) / t.ratio[p];
                }
            }
        };
        let (mut phi, mut rate) = (vec![0.0; n], vec![0.0; n]);
        at(0.0, &mut phi, &mut rate);
        for p in 0..n {
            phi[p] = self.angles[t.node[p]] / t.ratio[p] - phi[p];
            rate[p] = self.speeds[t.node[p]] / t.ratio[p] - rate[p];
        }
        let terms = Terms::new(t, &phi, &rate)?;
        let (mut free, mut free_rate) = (vec![0.0; n], vec![0.0; n]);
        let mut alpha = vec![0.0; self.dynamics.len()];
        for &time in &self.times {
            at(time, &mut phi, &mut rate);
            terms.at(time, &mut free, &mut free_rate);
            let (mut a, mut w) = (vec![0.0; n], vec![0.0; n]);
            for p in 0..n {
                a[t.node[p]] = (phi[p] + free[p]) * t.ratio[p];
                w[t.node[p]] = (rate[p] + free_rate[p]) * t.ratio[p];
            }
            // Torques as the method has them: by the angle of the mean speed.
            let even: Vec<f64> = s.line.nodes.iter().map(|n| s.speed * time * n.ratio).collect();
            let d = &mut self.dynamics;
            let [angle, speed, even] = [&a, &w, &even].map(|v| d.condense(v));
            d.accelerations(&angle, &speed, &even, &even, &mut alpha);
            out.torque.push(d.link_torques(&angle, &speed, &even, &alpha));
            out.gas.push(d.gas.clone());
            out.drive.push(d.drive.clone());
            out.times.push(time);
            out.angles.push(a);
            out.speeds.push(w);
        }
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("modes".into(), terms.list.len() as u64);
        self.steady.excitation.orders = orders;
        Ok(())
    }
}
