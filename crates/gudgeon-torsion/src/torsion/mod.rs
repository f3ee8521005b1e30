//! How the response of a shaft line is computed.

mod harmonic_balance;
mod implicit;
mod independent_orders;
mod modal;
mod off;
mod orders;
mod propagator;
mod runge_kutta;

pub use harmonic_balance::HarmonicBalance;
pub use implicit::Implicit;
pub use modal::Modal;
pub use off::Off;
pub use orders::Orders;
pub use propagator::Propagator;
pub use runge_kutta::RungeKutta;

use gudgeon_core::BuildError;
use gudgeon_core::kinds::{Line, TorsionCtx};

/// Refuses laws that have no meaning in time: loss factors, laws over the frequency, dynamic stiffnesses.
fn check_in_time(line: &Line) -> Result<(), BuildError> {
    match line.links.iter().position(|l| l.coupling.is_harmonic_only()) {
        None => Ok(()),
        Some(i) => {
            let what = format!(
                "the law of `{}` (loss factor, relative damping, values over the frequency) has a meaning in harmonic motion only",
                line.links[i].name
            );
            Err(BuildError::at(format!("links.{i}"), what).help(
                "use `orders`, `modal` or `harmonic_balance`; or a stiffness with the viscous damping c = eta k/omega, which loses as much at the angular frequency omega",
            ))
        }
    }
}

/// The start of a motion, and that rigid links and gears agree with it.
fn check_start(ctx: &TorsionCtx<'_>) -> Result<(), BuildError> {
    let n = ctx.line.nodes.len();
    if ctx.angles.len() != n || ctx.speeds.len() != n {
        return Err(BuildError::at("start", "every inertia needs an angle and a speed to start from"));
    }
    if ctx.times.is_empty() {
        return Err(BuildError::at("time", "a motion over time needs a duration"));
    }
    let top = |v: &[f64]| v.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    for l in &ctx.line.links {
        if l.coupling.linear(0.0, 0.0).stiffness != f64::INFINITY {
            continue;
        }
        let [a, b] = l.nodes;
        let gear = ctx.line.nodes[a].ratio / ctx.line.nodes[b].ratio;
        for (name, v) in [("angles", ctx.angles), ("speeds", ctx.speeds)] {
            // Rounding of what a steady motion gives.
            if (v[a] - gear * v[b]).abs() > 1e-9 * top(v) {
                let what =
                    format!("`{}` is rigid, but its ends start with {name} of {} and {}", l.name, v[a], v[b]);
                return Err(BuildError::at("start", what));
            }
        }
    }
    Ok(())
}
