use gudgeon_core::kinds::{Line, Torsion, TorsionAnswer, TorsionCtx, TorsionOut, TorsionSpec};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::HarmonicBalance;
use crate::steady::Steady;

/// Forced vibration order by order at constant mean speed.
///
/// ```text
/// (K(ω)(1 + iη) + iωC - ω² J) a_n = T_n,   ω = nΩ
/// ```
///
/// by elimination along the tree, without a matrix and without a time step. Gas torques go with the angle of the mean speed; the
/// torque of the moving masses enters as `-½ I'(θ) Ω²`; couplings are taken at their mean torque and at the frequency of the order; the slope of a
/// torque-speed curve damps.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Orders {}

#[register_model(
    name = "orders",
    summary = "forced vibration per order, exact orders, elimination in linear time",
    equations = "(K(omega)(1 + i eta) + i omega C - omega^2 J) a_n = T_n;  omega = n Omega",
    validity = "Small vibration about constant mean speed. Torques follow the mean angle; variable inertia to first order.",
    references = ["gomes2021", "den_hartog1956"],
    example = "",
)]
impl TorsionSpec for Orders {
    fn build(&self, ctx: &TorsionCtx<'_>) -> Result<Box<dyn Torsion>, BuildError> {
        Ok(Box::new(Solver { steady: Steady::new(ctx)? }))
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Periodic
    }
    fn fuller(&self, line: &Line) -> Option<Box<dyn TorsionSpec>> {
        HarmonicBalance::default().if_it_has_more(line)
    }
}

#[derive(Debug)]
struct Solver {
    steady: Steady,
}

impl Torsion for Solver {
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
