//! Empirical damping with the tangent of an angle in radians and the oil's viscosity.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{Flank, FlankCtx, FlankLaw, FlankResistance, FlankSpec};
use gudgeon_core::quantity::{PosRatio, quantity};
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::{check_fill, check_oil};

/// Empirical adhesion of the ring to the groove flanks.
///
/// ```text
/// F = -(A/w) μ v F_a0 ( tan |2 e - 1| )^( 10 (1.1 - f_o) )
/// ```
///
/// `A/w` is the circumference: flank annulus over radial width. The tangent of 1 rad at the flanks is 1.557, so the force there is
/// finite; its size is set by `F_a0`, for which only the range 1e4 to 1e8 is known.
///
/// Source: kornprobst1989 as given by tomanik1993, eq. 18.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TangentRadians {
    /// `F_a0`.
    #[serde(default = "default_adhesion")]
    pub adhesion: PosRatio,
}

fn default_adhesion() -> PosRatio {
    quantity(1e6)
}

impl Default for TangentRadians {
    fn default() -> Self {
        Self { adhesion: default_adhesion() }
    }
}

#[register_model(
    name = "tangent_radians",
    summary = "empirical: proportional to velocity and viscosity, zero in mid-groove",
    equations = "F = -(A/w) mu v F_a0 tan(|2 e - 1|)^(10 (1.1 - f_o))",
    validity = "The constant F_a0 is known within four orders of magnitude only (1e4 to 1e8).",
    references = ["kornprobst1989", "tomanik1993"],
    example = "adhesion = 1e6\n",
)]
impl FlankSpec for TangentRadians {
    fn build(&self, ctx: &FlankCtx) -> Result<Box<dyn Flank>, BuildError> {
        check_fill(ctx)?;
        check_oil(ctx)?;
        Ok(Box::new(Runtime {
            per_area: ctx.mu * self.adhesion.si() / ctx.width,
            exponent: 10.0 * (1.1 - ctx.oil_fill),
        }))
    }
}

#[derive(Clone, Copy)]
struct Runtime {
    per_area: f64,
    exponent: f64,
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
        area * self.per_area * elementary::powf(elementary::tan((2.0 * e - 1.0).abs()), self.exponent)
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
