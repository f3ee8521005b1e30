//! The linear response order by order: the running model of `orders`, and of `harmonic_balance` where nothing is nonlinear.

use gudgeon_core::kinds::{Torsion, TorsionCtx, TorsionOut};
use gudgeon_core::{BuildError, EvalError};

use crate::steady::Steady;

/// A line whose orders do not know of each other.
#[derive(Debug)]
pub(super) struct IndependentOrders {
    steady: Steady,
}

impl IndependentOrders {
    /// # Errors
    /// As [`Steady::new`].
    pub fn new(ctx: &TorsionCtx<'_>) -> Result<Self, BuildError> {
        Ok(Self { steady: Steady::new(ctx)? })
    }
}

impl Torsion for IndependentOrders {
    fn run(&mut self, out: &mut TorsionOut) -> Result<(), EvalError> {
        let orders = std::mem::take(&mut self.steady.excitation.orders);
        let found = orders.iter().map(|o| self.steady.respond(o)).collect::<Result<_, _>>();
        self.steady.excitation.orders = orders;
        out.orders = found?;
        out.counters.insert("time_steps".into(), 0);
        out.counters.insert("linear_solutions".into(), out.orders.len() as u64);
        self.steady.describe(out);
        Ok(())
    }
    fn set_speed(&mut self, speed: f64) -> Result<(), EvalError> {
        self.steady.set_speed(speed);
        Ok(())
    }
}
