use gudgeon_core::kinds::{Fatigue, FatigueSpec};
use gudgeon_core::quantity::PosPressure;
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::{ordered, tension};

/// Straight line from the endurance limit to the tensile strength.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Goodman {
    /// Fully reversed stress that the material, with its surface, endures for ever.
    pub endurance_limit: PosPressure,
    /// Tensile strength.
    pub tensile_strength: PosPressure,
}

#[register_model(
    name = "goodman",
    summary = "straight line to the tensile strength",
    equations = "1/n = s_a/S_e + s_m/S_u",
    validity = "On the safe side for ductile steel; a compressive mean counts as none.",
    references = ["budynas2011"],
    example = "endurance_limit = \"350 MPa\"\ntensile_strength = \"1000 MPa\"\n",
)]
impl FatigueSpec for Goodman {
    fn build(&self) -> Result<Box<dyn Fatigue>, BuildError> {
        ordered(self.endurance_limit.si(), self.tensile_strength.si(), "tensile strength")?;
        Ok(Box::new(ToTensile { endurance: self.endurance_limit.si(), strength: self.tensile_strength.si() }))
    }
}

#[derive(Debug)]
struct ToTensile {
    endurance: f64,
    strength: f64,
}

impl Fatigue for ToTensile {
    fn safety(&self, mean: f64, amplitude: f64) -> Result<f64, EvalError> {
        let (m, a) = tension("goodman", mean, amplitude)?;
        Ok(1.0 / (a / self.endurance + m / self.strength))
    }
}
