use gudgeon_core::kinds::{ThrowCtx, ThrowInertia, ThrowInertiaSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::Lumped;

/// Mean inertia with its second order, for a long rod.
///
/// `I = I₀ (1 - ε cos 2θ)`, `ε I₀ = ½ (j m_r + m_p) r²`: the exact inertia to zeroth order in r/l, the first harmonic of a turn of the
/// piston.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FirstHarmonic {}

#[register_model(
    name = "first_harmonic",
    summary = "mean inertia and its part of twice the crank angle, for a long rod",
    equations = "I = I_0 (1 - eps cos(2 theta));  eps I_0 = (j m_r + m_p) r^2/2",
    validity = "Rod much longer than the crank radius: orders 1 and 3 of the inertia torque are missing.",
    references = ["gomes2021"],
    example = "",
)]
impl ThrowInertiaSpec for FirstHarmonic {
    fn build(&self, ctx: &ThrowCtx) -> Result<Box<dyn ThrowInertia>, BuildError> {
        let p = Lumped::new(ctx)?;
        let swing = 0.5 * p.oscillating * p.r * p.r;
        Ok(Box::new(Wave { mean: p.turning + swing, swing }))
    }
}

#[derive(Debug, Clone)]
struct Wave {
    mean: f64,
    swing: f64,
}

impl ThrowInertia for Wave {
    fn inertia(&self, theta: f64) -> (f64, f64) {
        let (sin, cos) = elementary::sin_cos(2.0 * theta);
        (self.mean - self.swing * cos, 2.0 * self.swing * sin)
    }
    fn mean(&self) -> f64 {
        self.mean
    }
    fn is_constant(&self) -> bool {
        self.swing == 0.0
    }
}
