//! Ring tension from the equilibrium of half a ring.

use std::f64::consts::PI;

use gudgeon_core::kinds::{Hoop, HoopSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Equilibrium of half a ring: two ends pull with `F_t` each, an even pressure `p` on the outer cylinder answers.
///
/// ```text
/// 2 F_t = p D b        F_r = p π D b = 2 π F_t
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Correct {}

#[register_model(
    name = "correct",
    summary = "equilibrium of half a ring",
    equations = "F_r = 2 pi F_t, which is p = 2 F_t/(D b) on the outer cylinder",
    validity = "Even pressure of the free ring on a round bore. The pressure distribution that a ring is made with is not meant.",
    references = [],
    example = "",
)]
impl HoopSpec for Correct {
    fn build(&self) -> Result<Box<dyn Hoop>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl Hoop for Correct {
    fn radial_force(&self, tangential: f64) -> f64 {
        2.0 * PI * tangential
    }
}
