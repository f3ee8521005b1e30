use gudgeon_core::kinds::{Line, Torsion, TorsionAnswer, TorsionCtx, TorsionSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::HarmonicBalance;
use super::independent_orders::IndependentOrders;

/// Forced vibration order by order at constant mean speed.
///
/// ```text
/// (K(ω)(1 + iη) + iωC - ω² J) a_n = T_n,   ω = nΩ
/// ```
///
/// by elimination along the tree, without a matrix and without a time step. Gas torques go with the angle of the mean speed; the
/// torque of the moving masses enters as `-½ I'(θ) Ω²`; couplings are taken at their mean torque and at the frequency of the order; the negative
/// derivative of a torque-speed curve damps.
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
        Ok(Box::new(IndependentOrders::new(ctx)?))
    }
    fn is_linear(&self) -> bool {
        true
    }
    fn answers(&self) -> TorsionAnswer {
        TorsionAnswer::Periodic
    }
    fn fuller(&self, line: &Line) -> Option<Box<dyn TorsionSpec>> {
        HarmonicBalance::of_what_is_left_out(line)
    }
}
