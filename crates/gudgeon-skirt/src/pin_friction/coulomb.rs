use gudgeon_core::kinds::{PinFriction, PinFrictionSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, PosVelocity, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

/// Dry friction of the pin: the rod drags the piston along as it turns.
///
/// `M = μ R F tanh(R ω/v₀)`, with the pin's radius `R`, the rod force `F` and the rod's angular velocity `ω` against the piston.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// Coefficient of friction.
    pub coefficient: Ratio<NonNegative>,
    /// Radius of the pin.
    pub radius: PosLength,
    /// Sliding speed over which friction turns round.
    #[serde(default = "creep")]
    pub reversal_speed: PosVelocity,
}

fn creep() -> PosVelocity {
    quantity(0.01)
}

#[register_model(
    name = "coulomb",
    summary = "dry friction of the gudgeon pin",
    equations = "M = mu R F tanh(R omega/v0)",
    validity = "Boundary lubrication; the friction reverses within v0.",
    references = [],
    example = "coefficient = 0.05\nradius = \"9 mm\"\n",
)]
impl PinFrictionSpec for Coulomb {
    fn build(&self) -> Result<Box<dyn PinFriction>, BuildError> {
        Ok(Box::new(Dry {
            lever: self.coefficient.si() * self.radius.si(),
            turn: self.radius.si() / self.reversal_speed.si(),
        }))
    }
}

#[derive(Debug)]
struct Dry {
    lever: f64,
    turn: f64,
}

impl PinFriction for Dry {
    fn is_off(&self) -> bool {
        self.lever == 0.0
    }
    fn moment(&self, load: f64, rotation: f64) -> f64 {
        self.lever * load * elementary::tanh(self.turn * rotation)
    }
}
