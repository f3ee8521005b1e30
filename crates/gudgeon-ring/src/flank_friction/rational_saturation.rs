//! Flank friction that saturates by a rational function.

use gudgeon_core::kinds::{FlankFriction, FlankFrictionSpec};
use gudgeon_core::quantity::{NonNegative, PosVelocity, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Friction proportional to the radial velocity when slow, constant when fast.
///
/// ```text
/// F = f_max h' / (|h'| + v_h) N
/// ```
///
/// with the axial load `N`, the limit `f_max` = 0.05 and the velocity of half friction `v_h` = 1 mm/s; these are the published
/// `f = h'/(20 |h'| + 0.020)`.
///
/// Source: zottin1992, eq. 3.6 (as programmed; the printed equation lacks the bars).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RationalSaturation {
    /// Coefficient of friction at high velocity.
    #[serde(default = "default_coefficient")]
    pub coefficient: Ratio<NonNegative>,
    /// Velocity at which half of it is reached.
    #[serde(default = "default_velocity")]
    pub half_velocity: PosVelocity,
}

fn default_coefficient() -> Ratio<NonNegative> {
    quantity(0.05)
}
fn default_velocity() -> PosVelocity {
    quantity(1e-3)
}

impl Default for RationalSaturation {
    fn default() -> Self {
        Self { coefficient: default_coefficient(), half_velocity: default_velocity() }
    }
}

#[register_model(
    name = "rational_saturation",
    summary = "proportional to velocity when slow, a constant coefficient when fast",
    equations = "F = f_max h' / (|h'| + v_h) N",
    validity = "Empirical. No static friction: a ring at rest is not held.",
    references = ["zottin1992"],
    example = "coefficient = 0.05\nhalf_velocity = \"1 mm/s\"\n",
)]
impl FlankFrictionSpec for RationalSaturation {
    fn build(&self) -> Result<Box<dyn FlankFriction>, BuildError> {
        Ok(Box::new(Runtime { coefficient: self.coefficient.si(), half: self.half_velocity.si() }))
    }
}

struct Runtime {
    coefficient: f64,
    half: f64,
}

impl FlankFriction for Runtime {
    fn force(&self, hdot: f64, axial_load: f64) -> f64 {
        self.coefficient * axial_load.abs() * hdot / (hdot.abs() + self.half)
    }
    fn derivative(&self, hdot: f64, axial_load: f64) -> f64 {
        let d = hdot.abs() + self.half;
        self.coefficient * axial_load.abs() * self.half / (d * d)
    }
    fn is_off(&self) -> bool {
        self.coefficient == 0.0
    }
}
