//! Empirical damping with the tangent of an angle in degrees.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{Flank, FlankCtx, FlankLaw, FlankResistance, FlankSpec};
use gudgeon_core::quantity::{PosAreaDamping, quantity};
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::check_fill;

/// Empirical resistance of the groove oil, large near the flanks and zero in the middle.
///
/// ```text
/// F = -A v F_s D(e)         D(e) = | tan( (100 e - 50)/1.1 deg ) |^( 10 |1 - f_o| )
/// ```
///
/// with the flank annulus `A`, the velocity `v`, the position in the groove `e = s/c` and the oil-filled fraction `f_o` of the
/// groove. `D` is symmetric about mid-groove and a little above 1 at the flanks. `e` is limited to 0…1: the tangent has its pole at
/// -0.49 and 1.49. A full groove (`f_o = 1`) has `D = 1` everywhere, mid-groove included.
///
/// Source: zottin1992, eq. 4.4.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TangentDegrees {
    /// `F_s` of all rings but the last: force per flank area and velocity.
    #[serde(default = "default_coefficient")]
    pub coefficient: PosAreaDamping,
    /// `F_s` of the last ring, which has more oil.
    #[serde(default = "default_coefficient_last")]
    pub coefficient_last: PosAreaDamping,
}

fn default_coefficient() -> PosAreaDamping {
    quantity(1e7)
}
fn default_coefficient_last() -> PosAreaDamping {
    quantity(2e7)
}

impl Default for TangentDegrees {
    fn default() -> Self {
        Self { coefficient: default_coefficient(), coefficient_last: default_coefficient_last() }
    }
}

#[register_model(
    name = "tangent_degrees",
    summary = "empirical: proportional to velocity, largest at the flanks, zero in mid-groove",
    equations = "F = -A v F_s |tan((100 e - 50)/1.1 deg)|^(10 |1 - f_o|)",
    validity = "Empirical; the constants go with f_o = 0.6 for compression rings and 0.9 for the oil ring. Does not depend on the oil's viscosity, and is \
               finite at the flanks: it delays a ring, it does not hold it.",
    references = ["zottin1992"],
    example = "coefficient = \"1e7 N s/m3\"\ncoefficient_last = \"2e7 N s/m3\"\n",
)]
impl FlankSpec for TangentDegrees {
    fn build(&self, ctx: &FlankCtx) -> Result<Box<dyn Flank>, BuildError> {
        check_fill(ctx)?;
        let last = ctx.ring + 1 == ctx.rings;
        Ok(Box::new(Runtime {
            coefficient: if last { self.coefficient_last } else { self.coefficient }.si(),
            exponent: 10.0 * (1.0 - ctx.oil_fill).abs(),
        }))
    }
}

#[derive(Clone, Copy)]
struct Runtime {
    coefficient: f64,
    exponent: f64,
}

/// `D(e)` with the exponent `10 |1 - f_o|`.
fn shape(e: f64, exponent: f64) -> f64 {
    // 0^0 = 1: the limit of a full groove.
    elementary::powf(elementary::tan(((100.0 * e - 50.0) / 1.1).to_radians()).abs(), exponent)
}

impl Stateful for Runtime {}

impl Flank for Runtime {
    fn law(&self) -> Box<dyn FlankLaw> {
        Box::new(*self)
    }
}

impl Runtime {
    /// Damping \[N s/m\] at a height over the lower flank \[m\].
    fn damping(&self, s: f64, clearance: f64, area: f64) -> f64 {
        let e = if clearance > 0.0 { (s / clearance).clamp(0.0, 1.0) } else { 0.0 };
        area * self.coefficient * shape(e, self.exponent)
    }
}

impl FlankLaw for Runtime {
    fn force(&self, _: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> f64 {
        -v * self.damping(s, clearance, area)
    }

    fn resistance(&self, _: &FlankOil, s: f64, clearance: f64, area: f64) -> Option<FlankResistance> {
        Some(FlankResistance::linear(self.damping(s, clearance, area)))
    }
}
