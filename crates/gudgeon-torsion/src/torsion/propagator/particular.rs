//! The motion of a line under its torques, whatever its start: periodic torques order by order, constant torques as a rigid motion with a
//! static twist.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::OrderResponse;
use gudgeon_numerics::elementary;

use crate::steady::Steady;

/// Particular motion; angles by position are `φ = θ/ratio`.
#[derive(Debug)]
pub(super) struct Particular {
    orders: Vec<OrderResponse>,
    /// Speed \[rad/s\] and acceleration \[rad/s²\] of the rigid motion.
    speed: f64,
    acceleration: f64,
    /// Static twist by position \[rad\].
    twist: Vec<f64>,
}

impl Particular {
    /// # Errors
    /// An undamped resonance (Fatal).
    pub fn new(steady: &mut Steady) -> Result<Self, EvalError> {
        let excited = std::mem::take(&mut steady.excitation.orders);
        let orders = excited.iter().map(|o| steady.respond(o)).collect::<Result<Vec<_>, EvalError>>();
        steady.excitation.orders = excited;
        let orders = orders?;
        let t = &steady.tree;
        let n = t.len();
        // Constant torques: those of straight lines at rest, of gas in the mean.
        let mut mean: Vec<f64> = steady.excitation.mean.clone();
        for (i, m) in mean.iter_mut().enumerate() {
            // All that depends on the speed is in the damping of the tree.
            let p = t.position[i];
            *m += t.damping[p] * steady.speed / t.ratio[p];
        }
        let f: Vec<f64> = (0..n).map(|p| mean[t.node[p]] * t.ratio[p]).collect();
        let (force, drag, total) = (f.iter().sum::<f64>(), t.damping.iter().sum::<f64>(), t.total_inertia());
        // Rigid motion under constant torque, and the twist that goes with it.
        let (speed, acceleration) = if drag == 0.0 { (0.0, force / total) } else { (force / drag, 0.0) };
        let mut load: Vec<f64> =
            (0..n).map(|p| f[p] - t.inertia[p] * acceleration - t.damping[p] * speed).collect();
        for p in 0..n - 1 {
            load[t.parent[p]] += load[p];
        }
        let mut twist = vec![0.0; n];
        for p in (0..n - 1).rev() {
            twist[p] = twist[t.parent[p]] + load[p] / t.k[p];
        }
        Ok(Self { orders, speed, acceleration, twist })
    }

    /// Angles and speeds by position at a time; the reference shaft turns by `Ωt`.
    pub fn at(&self, time: f64, steady: &Steady, phi: &mut [f64], rate: &mut [f64]) {
        let t = &steady.tree;
        for p in 0..t.len() {
            phi[p] = self.twist[p] + self.speed * time + 0.5 * self.acceleration * time * time;
            rate[p] = self.speed + self.acceleration * time;
        }
        for o in &self.orders {
            let w = o.order * steady.speed;
            let (sin, cos) = elementary::sin_cos(w * time);
            for p in 0..t.len() {
                let [re, im] = o.angle[t.node[p]];
                phi[p] += (re * cos - im * sin) / t.ratio[p];
                rate[p] -= w * (re * sin + im * cos) / t.ratio[p];
            }
        }
    }
}
