use gudgeon_core::kinds::{Fatigue, FatigueSpec};
use gudgeon_core::quantity::PosPressure;
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::{ordered, tension};

/// Straight line from the endurance limit to the yield strength.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Soderberg {
    /// Fully reversed stress that the material, with its surface, endures for ever.
    pub endurance_limit: PosPressure,
    /// Yield strength.
    pub yield_strength: PosPressure,
}

#[register_model(
    name = "soderberg",
    summary = "straight line to the yield strength",
    equations = "1/n = s_a/S_e + s_m/S_y",
    validity = "Excludes yielding too; the most cautious of the criteria.",
    references = ["budynas2011"],
    example = "endurance_limit = \"350 MPa\"\nyield_strength = \"800 MPa\"\n",
)]
impl FatigueSpec for Soderberg {
    fn build(&self) -> Result<Box<dyn Fatigue>, BuildError> {
        ordered(self.endurance_limit.si(), self.yield_strength.si(), "yield strength")?;
        Ok(Box::new(ToYield { endurance: self.endurance_limit.si(), strength: self.yield_strength.si() }))
    }
}

#[derive(Debug)]
struct ToYield {
    endurance: f64,
    strength: f64,
}

impl Fatigue for ToYield {
    fn safety(&self, mean: f64, amplitude: f64) -> Result<f64, EvalError> {
        let (m, a) = tension("soderberg", mean, amplitude)?;
        Ok(1.0 / (a / self.endurance + m / self.strength))
    }
}
