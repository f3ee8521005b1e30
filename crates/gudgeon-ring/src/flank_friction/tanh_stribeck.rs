//! Flank friction with a Stribeck peak.

use gudgeon_core::kinds::{FlankFriction, FlankFrictionSpec};
use gudgeon_core::quantity::{NonNegative, PosVelocity, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Friction that rises steeply through zero velocity, peaks, and falls back to the sliding value.
///
/// ```text
/// F = μ_0 N tanh(y) { 1 + ½ |y| ( coth(|y|/3) - 1 ) }        y = h' / V_0
/// ```
///
/// With the published `V_0` = 1 cm/s this is 0 at rest, 1.57 `μ_0 N` at `V_0`, at most 1.70 near `1.5 V_0`, 1.18 at `5 V_0` and
/// 1.00 beyond `20 V_0`. The source adds the two terms instead of multiplying them, which gives a jump of ±1.5 at rest although the
/// text asks for a continuous passage through zero; the product is continuous and has the same two ends.
///
/// Between the peak and `20 V_0` the friction decreases with velocity: the [`derivative`](FlankFriction::derivative) is negative there.
///
/// Source: tomanik1993, eq. 17, corrected.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TanhStribeck {
    /// Coefficient of friction `μ_0` at high velocity.
    #[serde(default = "default_coefficient")]
    pub coefficient: Ratio<NonNegative>,
    /// Velocity `V_0` that sets the width of the passage through zero and the place of the peak.
    #[serde(default = "default_velocity")]
    pub velocity: PosVelocity,
}

fn default_coefficient() -> Ratio<NonNegative> {
    quantity(0.1)
}
fn default_velocity() -> PosVelocity {
    quantity(0.01)
}

impl Default for TanhStribeck {
    fn default() -> Self {
        Self { coefficient: default_coefficient(), velocity: default_velocity() }
    }
}

#[register_model(
    name = "tanh_stribeck",
    summary = "steep but continuous passage through rest, a Stribeck peak, then a constant coefficient",
    equations = "F = mu_0 N tanh(y) {1 + |y|/2 (coth(|y|/3) - 1)},  y = h'/V_0",
    validity = "Empirical. Decreases with velocity between 1.5 V_0 and 20 V_0 (1.5 to 20 cm/s by default), far above usual radial ring velocities.",
    references = ["tomanik1993"],
    example = "coefficient = 0.1\nvelocity = \"1 cm/s\"\n",
)]
impl FlankFrictionSpec for TanhStribeck {
    fn build(&self) -> Result<Box<dyn FlankFriction>, BuildError> {
        Ok(Box::new(Runtime { coefficient: self.coefficient.si(), velocity: self.velocity.si() }))
    }
}

struct Runtime {
    coefficient: f64,
    velocity: f64,
}

/// `y > 0` below which `z coth z` is taken by its series, `z = y/3`.
pub const SERIES: f64 = 0.03;

/// The factor in braces and its derivative, for `y >= 0`.
pub fn stribeck(y: f64) -> (f64, f64) {
    let z = y / 3.0;
    // z coth z and its derivative coth z - z / sinh² z.
    let (z_coth, d) = if y < SERIES {
        // The next terms, 2 z^6/945 and 12 z^5/945, are below 1e-12 here.
        let z2 = z * z;
        (1.0 + z2 / 3.0 - z2 * z2 / 45.0, z * (2.0 / 3.0 - 4.0 / 45.0 * z2))
    } else {
        let coth = elementary::tanh(z).recip();
        let csch2 = coth * coth - 1.0;
        (z * coth, coth - z * csch2)
    };
    (1.0 + 1.5 * (z_coth - z), 0.5 * (d - 1.0))
}

impl FlankFriction for Runtime {
    fn force(&self, hdot: f64, axial_load: f64) -> f64 {
        let y = hdot / self.velocity;
        self.coefficient * axial_load.abs() * elementary::tanh(y) * stribeck(y.abs()).0
    }

    fn derivative(&self, hdot: f64, axial_load: f64) -> f64 {
        let y = (hdot / self.velocity).abs();
        let (g, dg) = stribeck(y);
        let t = elementary::tanh(y);
        self.coefficient * axial_load.abs() / self.velocity * ((1.0 - t * t) * g + t * dg)
    }

    fn is_off(&self) -> bool {
        self.coefficient == 0.0
    }
}
