use gudgeon_core::kinds::{ThrowCtx, ThrowInertia, ThrowInertiaSpec};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::Lumped;

/// A constant: the mean inertia for a long rod.
///
/// `I₀ = I_c + (1 - j) m_r r² + ½ (j m_r + m_p) r²`, the zeroth order in r/l of the exact mean. Without variable inertia there is no
/// inertia torque that excites the line.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mean {}

#[register_model(
    name = "mean",
    summary = "constant mean inertia, for a long rod",
    equations = "I_0 = I_c + (1 - j) m_r r^2 + (j m_r + m_p) r^2/2",
    validity = "Leaves out the inertia torque, which at the speeds of most machines is larger than that of the gas.",
    references = ["gomes2021"],
    example = "",
)]
impl ThrowInertiaSpec for Mean {
    fn build(&self, ctx: &ThrowCtx) -> Result<Box<dyn ThrowInertia>, BuildError> {
        let p = Lumped::new(ctx)?;
        Ok(Box::new(Same { inertia: p.turning + 0.5 * p.oscillating * p.r * p.r }))
    }
}

#[derive(Debug, Clone)]
pub(super) struct Same {
    pub(super) inertia: f64,
}

impl ThrowInertia for Same {
    fn inertia(&self, _: f64) -> (f64, f64) {
        (self.inertia, 0.0)
    }
    fn mean(&self) -> f64 {
        self.inertia
    }
    fn is_constant(&self) -> bool {
        true
    }
}
