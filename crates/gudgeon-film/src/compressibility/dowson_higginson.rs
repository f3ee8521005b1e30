use gudgeon_core::kinds::{Compressibility, CompressibilitySpec};
use gudgeon_core::quantity::{PosPressureCoefficient, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use crate::slices::check;

/// Density of mineral oil under pressure: `ρ/ρ0 = 1 + a p/(1 + b p)`, `p` above ambient.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DowsonHigginson {
    /// Compressibility at ambient pressure.
    #[serde(default = "initial")]
    pub a: PosPressureCoefficient,
    /// How soon it saturates: the density cannot exceed `1 + a/b` times that at ambient pressure.
    #[serde(default = "saturation")]
    pub b: PosPressureCoefficient,
}

impl Default for DowsonHigginson {
    fn default() -> Self {
        Self { a: initial(), b: saturation() }
    }
}

fn initial() -> PosPressureCoefficient {
    quantity(0.6e-9)
}
fn saturation() -> PosPressureCoefficient {
    quantity(1.7e-9)
}

#[register_model(
    name = "dowson_higginson",
    summary = "density of mineral oil under pressure",
    equations = "rho/rho0 = 1 + a p/(1 + b p),  a = 0.6 1/GPa, b = 1.7 1/GPa",
    validity = "Mineral oils to about 0.4 GPa; the density never exceeds 1.35 times that at ambient pressure. Pressures above -1/(2 b).",
    references = ["dowson1966"],
    example = "a = \"0.6 1/GPa\"\nb = \"1.7 1/GPa\"\n",
)]
impl CompressibilitySpec for DowsonHigginson {
    fn build(&self) -> Result<Box<dyn Compressibility>, BuildError> {
        let (a, b) = (self.a.si(), self.b.si());
        if a > b {
            return Err(BuildError::at(
                "a",
                format!("a = {a:e} 1/Pa is greater than b = {b:e} 1/Pa: the oil could halve its volume"),
            ));
        }
        Ok(Box::new(Saturating { a, b }))
    }
}

#[derive(Debug)]
struct Saturating {
    a: f64,
    b: f64,
}

impl Compressibility for Saturating {
    fn factor(&self, pressure: &[f64], factor: &mut [f64], slope: &mut [f64]) -> Result<(), EvalError> {
        check("dowson_higginson", "pressure [Pa]", pressure, &[factor.len(), slope.len()])?;
        for (i, &p) in pressure.iter().enumerate() {
            let x = self.b * p;
            if x < -0.5 {
                let least = -0.5 / self.b;
                return Err(EvalError::recoverable(
                    "dowson_higginson",
                    format!("the pressure {p:e} Pa is below {least:e} Pa"),
                ));
            }
            let inverse = 1.0 / (1.0 + x);
            // x/(1+x) as 1 - 1/(1+x) where the product would overflow.
            factor[i] = 1.0 + self.a / self.b * if x > 1.0 { 1.0 - inverse } else { x * inverse };
            slope[i] = self.a * inverse * inverse;
        }
        Ok(())
    }
}
