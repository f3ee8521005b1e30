use gudgeon_core::kinds::{Fatigue, FatigueSpec};
use gudgeon_core::quantity::PosPressure;
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::{ordered, tension};

/// Parabola from the endurance limit to the tensile strength.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gerber {
    /// Fully reversed stress that the material, with its surface, endures for ever.
    pub endurance_limit: PosPressure,
    /// Tensile strength.
    pub tensile_strength: PosPressure,
}

#[register_model(
    name = "gerber",
    summary = "parabola to the tensile strength",
    equations = "n s_a/S_e + (n s_m/S_u)^2 = 1",
    validity = "Follows the middle of test results of ductile metals; not on the safe side.",
    references = ["budynas2011"],
    example = "endurance_limit = \"350 MPa\"\ntensile_strength = \"1000 MPa\"\n",
)]
impl FatigueSpec for Gerber {
    fn build(&self) -> Result<Box<dyn Fatigue>, BuildError> {
        ordered(self.endurance_limit.si(), self.tensile_strength.si(), "tensile strength")?;
        Ok(Box::new(Parabola { endurance: self.endurance_limit.si(), strength: self.tensile_strength.si() }))
    }
}

#[derive(Debug)]
struct Parabola {
    endurance: f64,
    strength: f64,
}

impl Fatigue for Parabola {
    fn safety(&self, mean: f64, amplitude: f64) -> Result<f64, EvalError> {
        let (m, a) = tension("gerber", mean, amplitude)?;
        let (x, y) = (a / self.endurance, m / self.strength);
        // The positive root of n x + (n y)² = 1, in the form that bears y = 0.
        Ok(2.0 / (x + (x * x + 4.0 * y * y).sqrt()))
    }
}
