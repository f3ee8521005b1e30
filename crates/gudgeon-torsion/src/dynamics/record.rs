//! An instant of a motion as a result.

use gudgeon_core::kinds::TorsionOut;

use super::motion::Dynamics;

/// Writes an instant: angles and speeds of the inertias, torques as they are there.
pub(crate) fn record(dynamics: &mut Dynamics, t: f64, theta: &[f64], omega: &[f64], out: &mut TorsionOut) {
    let mut alpha = vec![0.0; theta.len()];
    dynamics.accelerations(theta, omega, theta, theta, &mut alpha);
    out.times.push(t);
    out.angles.push(dynamics.expand(theta));
    out.speeds.push(dynamics.expand(omega));
    out.torque.push(dynamics.link_torques(theta, omega, theta, &alpha));
    out.gas.push(dynamics.gas.clone());
    out.drive.push(dynamics.drive.clone());
}
