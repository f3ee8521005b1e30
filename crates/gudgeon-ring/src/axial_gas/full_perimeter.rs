//! Axial gas force of a published program.

use std::f64::consts::PI;

use gudgeon_core::geometry::RingSection;
use gudgeon_core::kinds::{AxialGas, AxialGasSpec};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The whole pressure difference on `π D w` (tomanik1993 eq. 4).
///
/// ```text
/// F = π D w (p_below - p_above)
/// ```
///
/// `D` the bore, `w` the radial width of the ring.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FullPerimeter {}

#[register_model(
    name = "full_perimeter",
    summary = "full pressure difference on the bore circumference times the radial width",
    equations = "F = pi D w (p_below - p_above)",
    validity = "Reproduces tomanik1993. Twice the force of a linear profile, on an area that is too large by that of the bore against the mean circumference.",
    references = ["tomanik1993"],
    example = "",
)]
impl AxialGasSpec for FullPerimeter {
    fn build(&self) -> Result<Box<dyn AxialGas>, BuildError> {
        Ok(Box::new(*self))
    }
}

impl AxialGas for FullPerimeter {
    fn force(&self, ring: &RingSection<'_>) -> f64 {
        2.0 * PI * ring.bore_radius * ring.geometry.width * (ring.p_below - ring.p_above)
    }
}
