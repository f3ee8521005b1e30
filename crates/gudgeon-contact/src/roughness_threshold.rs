use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The surfaces touch when the film is as thin as the roughness.
///
/// A switch, not a pressure: a film that the balance of forces would make thinner than `roughness` is held there, and the
/// whole radial load then rubs with the boundary coefficient while the film contributes no shear. There is no mixed
/// regime, so friction jumps where the switch acts (Tomanik 1993, chapter 7).
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoughnessThreshold {
    /// Film thickness at which the surfaces touch: the roughness of the pair.
    pub roughness: PosLength,
    /// Coefficient of boundary friction.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}

#[register_model(
    name = "roughness_threshold",
    summary = "boundary friction of the whole load once the film is as thin as the roughness",
    equations = "h > roughness: film alone;  h = roughness: F_friction = f W, W the whole radial load, no film shear",
    validity = "Hydrodynamic films with short contact near the dead centres. Knows no mixed regime: friction jumps at the threshold, and friction power is low where asperities share the load with a film that is thicker than the threshold.",
    references = ["tomanik1993"],
    example = "roughness = \"0.2 um\"\nfriction_coefficient = 0.10\n",
)]
impl ContactSpec for RoughnessThreshold {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        Ok(Box::new(Threshold {
            roughness: self.roughness.si(),
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

#[derive(Debug)]
struct Threshold {
    roughness: f64,
    friction_coefficient: f64,
}

impl Contact for Threshold {
    fn pressure(&self, _: &[f64], pressure: &mut [f64]) {
        pressure.fill(0.0);
    }
    fn range(&self) -> f64 {
        0.0
    }
    fn floor(&self) -> Option<f64> {
        Some(self.roughness)
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
    fn floor_replaces_film(&self) -> bool {
        true
    }
}
