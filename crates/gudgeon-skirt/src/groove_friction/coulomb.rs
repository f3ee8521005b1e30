use std::f64::consts::PI;

use gudgeon_core::kinds::{GrooveFriction, GrooveFrictionCtx, GrooveFrictionSpec};
use gudgeon_core::quantity::{Length, NonNegative, PosForce, PosLength, PosVelocity, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

/// Dry friction on the flank that the gas presses the top ring onto.
///
/// `F = -μ (π D w p + F₀) tanh(v/v₀)`, with the gas pressure `p`, the width `w` of the ring in its groove, and what presses it down without
/// gas, `F₀`. The ring itself stays where the liner is.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// Coefficient of friction.
    pub coefficient: Ratio<NonNegative>,
    /// Height of the groove above the upper edge of the skirt.
    pub height: Length,
    /// Width of the flank under the gas.
    pub width: PosLength,
    /// Force on the flank without gas.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preload: Option<PosForce>,
    /// Lateral velocity over which friction turns round.
    #[serde(default = "creep")]
    pub reversal_speed: PosVelocity,
}

fn creep() -> PosVelocity {
    quantity(1e-3)
}

#[register_model(
    name = "coulomb",
    summary = "dry friction of the top ring on its flank against motion of the piston across the bore",
    equations = "F = -mu (pi D w p + F0) tanh(v/v0)",
    validity = "One ring carries the gas pressure; the friction reverses within v0.",
    references = [],
    example = "coefficient = 0.05\nheight = \"12 mm\"\nwidth = \"3 mm\"\n",
)]
impl GrooveFrictionSpec for Coulomb {
    fn build(&self, ctx: &GrooveFrictionCtx) -> Result<Box<dyn GrooveFriction>, BuildError> {
        Ok(Box::new(Dry {
            coefficient: self.coefficient.si(),
            height: self.height.si(),
            area: PI * ctx.bore * self.width.si(),
            preload: self.preload.map_or(0.0, |f| f.si()),
            reversal: self.reversal_speed.si(),
        }))
    }
}

#[derive(Debug)]
struct Dry {
    coefficient: f64,
    height: f64,
    area: f64,
    preload: f64,
    reversal: f64,
}

impl GrooveFriction for Dry {
    fn is_off(&self) -> bool {
        self.coefficient == 0.0
    }
    fn height(&self) -> f64 {
        self.height
    }
    fn force(&self, pressure: f64, v: f64) -> (f64, f64) {
        let most = self.coefficient * (self.area * pressure.abs() + self.preload);
        let t = elementary::tanh(v / self.reversal);
        (-most * t, -most * (1.0 - t * t) / self.reversal)
    }
}
