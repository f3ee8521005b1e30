//! How the response of a shaft line is computed.

mod harmonic_balance;
mod implicit;
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

/// Refuses what has no meaning in time: rigid links, loss factors, laws over the frequency, inertias of zero.
fn check_in_time(line: &Line) -> Result<(), BuildError> {
    for (i, l) in line.links.iter().enumerate() {
        let v = l.coupling.linear(0.0, 0.0);
        let at = |what: String| Err(BuildError::at(format!("links.{i}"), what));
        if v.stiffness == f64::INFINITY {
            return at(format!(
                "`{}` is rigid: motion over time wants a stiffness, or one inertia for both",
                l.name
            ));
        }
        if v.loss_factor != 0.0 || l.coupling.depends_on_frequency() {
            return at(format!(
                "the damping of `{}` has a meaning in harmonic motion only; motion over time wants viscous damping",
                l.name
            ));
        }
    }
    for i in 0..line.nodes.len() {
        if line.mean_inertia(i) <= 0.0 {
            let what = format!("the inertia of `{}` is zero: motion over time wants one", line.nodes[i].name);
            return Err(BuildError::at(format!("inertias.{i}"), what));
        }
    }
    Ok(())
}

fn check_start(ctx: &TorsionCtx<'_>) -> Result<(), BuildError> {
    let n = ctx.line.nodes.len();
    if ctx.angles.len() != n || ctx.speeds.len() != n {
        return Err(BuildError::at("start", "every inertia needs an angle and a speed to start from"));
    }
    if ctx.times.is_empty() {
        return Err(BuildError::at("time", "a motion over time needs a duration"));
    }
    Ok(())
}
