use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{AreaStiffness, Length, NonNegative, Positive, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A layer of springs: `p = k max(h_0 - h, 0)`.
///
/// There is no damping in it: in a film, squeezing the oil out takes up the energy, and a dry impact belongs to a model of motion.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearPenalty {
    /// Pressure per approach `k`.
    pub stiffness: AreaStiffness<Positive>,
    /// Separation `h_0` at which the surfaces touch. Films need one above zero: none gets to zero thickness.
    pub touching: Length<NonNegative>,
    /// Coefficient of friction of the load that the contact carries.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}

#[register_model(
    name = "linear_penalty",
    summary = "a pressure proportional to the approach",
    equations = "p = k max(h_0 - h, 0)",
    validity = "A numerical contact. The stiffness is no property of surfaces: results must not depend on it. The slope of the pressure jumps where the surfaces touch.",
    references = [],
    example = "stiffness = \"1e14 N/m3\"\ntouching = \"0.5 um\"\n",
)]
impl ContactSpec for LinearPenalty {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        Ok(Box::new(Springs {
            stiffness: self.stiffness.si(),
            touching: self.touching.si(),
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

#[derive(Debug)]
struct Springs {
    stiffness: f64,
    touching: f64,
    friction_coefficient: f64,
}

impl Contact for Springs {
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]) {
        for (p, &h) in pressure.iter_mut().zip(separation) {
            // The bound keeps the pressure of an absurd approach a number.
            *p = (self.stiffness * (self.touching - h).max(0.0)).min(f64::MAX);
        }
    }
    fn range(&self) -> f64 {
        self.touching
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
}
