//! Ring tension of a published program.

use gudgeon_core::kinds::{Hoop, HoopSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Contact pressure as tomanik1993 (eq. 10) prints it: `p = 2 F_t / (2 π r b)`, smaller than the equilibrium of half a ring by π.
///
/// ```text
/// F_r = p π D b = 2 F_t
/// ```
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AsPrinted {}

#[register_model(
    name = "as_printed",
    summary = "too small by pi, as in a published program",
    equations = "F_r = 2 F_t, which is p = 2 F_t/(2 pi r b)",
    validity = "Reproduces tomanik1993. The contact pressure is too small by a factor of pi.",
    references = ["tomanik1993"],
    example = "",
)]
impl HoopSpec for AsPrinted {
    fn build(&self) -> Result<Box<dyn Hoop>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl Hoop for AsPrinted {
    fn radial_force(&self, tangential: f64) -> f64 {
        2.0 * tangential
    }
}
