use gudgeon_core::kinds::{BoundaryFriction, BoundaryFrictionSpec, Rubbing};
use gudgeon_core::quantity::{NonNegative, Pressure, Ratio, Velocity, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::check::check;
use super::rounded_sign::rounded_sign;

/// Boundary layers that shear where the surfaces touch, with a strength that rises with the pressure there:
///
/// ```text
/// τ = { τ_0 A_c/A + α p } v/√(v² + v_0²)        μ(v) = { α + τ_0 (A_c/A)/p } v/√(v² + v_0²)
/// ```
///
/// `p` is the nominal contact pressure and `A_c/A` the real over the nominal area of contact, both of the contact model, which has to know its real area
/// (`greenwood_tripp`, `greenwood_williamson`, `kogut_etsion`, `abbott_firestone`). `p/(A_c/A)` is the mean pressure on the summits: 0.1 to 1 GPa for
/// metals, so that τ_0 of some megapascals adds some hundredths to the coefficient α at most. τ_0 = 0 leaves the model `coulomb` with the coefficient α.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShearStrength {
    /// Shear strength τ_0 of the boundary layer without pressure.
    #[serde(default = "two_megapascals")]
    pub strength: Pressure<NonNegative>,
    /// Rise α of the strength with the pressure on it.
    #[serde(default = "boundary")]
    pub pressure_coefficient: Ratio<NonNegative>,
    /// Speed v_0 that rounds the jump at rest; 0 leaves it, with no friction at rest itself.
    #[serde(default = "slow")]
    pub rounding_speed: Velocity<NonNegative>,
}

fn two_megapascals() -> Pressure<NonNegative> {
    quantity(2e6)
}
fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}
fn slow() -> Velocity<NonNegative> {
    quantity(0.01)
}

#[register_model(
    name = "shear_strength",
    summary = "boundary layer of given shear strength over the real area, and a part of the load; rounded at rest",
    equations = "tau = {tau_0 A_c/A + alpha p} v/sqrt(v^2 + v_0^2)",
    validity = "Contact models that know their real area. The strength depends on the layer and its temperature; 2 MPa is the Eyring stress of engine oils. Sliding at speeds above v_0.",
    references = ["styles2014"],
    example = "strength = \"2 MPa\"\npressure_coefficient = 0.08\nrounding_speed = \"1 cm/s\"\n",
)]
impl BoundaryFrictionSpec for ShearStrength {
    fn build(&self) -> Result<Box<dyn BoundaryFriction>, BuildError> {
        Ok(Box::new(Layer {
            strength: self.strength.si(),
            pressure_coefficient: self.pressure_coefficient.si(),
            rounding: self.rounding_speed.si(),
        }))
    }
}

#[derive(Debug)]
struct Layer {
    strength: f64,
    pressure_coefficient: f64,
    rounding: f64,
}

impl Layer {
    /// Coefficient of fast sliding; α where nothing is pressed together.
    fn fast(&self, pressure: f64, real_area: f64) -> f64 {
        let layer = if pressure > 0.0 { self.strength * real_area / pressure } else { 0.0 };
        // Bounded for a pressure so small that its ratio to the area has no number.
        (self.pressure_coefficient + layer).min(f64::MAX)
    }
}

impl BoundaryFriction for Layer {
    fn is_off(&self) -> bool {
        self.strength == 0.0 && self.pressure_coefficient == 0.0
    }
    fn uses_real_area(&self) -> bool {
        self.strength > 0.0
    }
    fn coefficient(
        &self,
        at: &Rubbing<'_>,
        coefficient: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError> {
        check("shear_strength", at, [coefficient.len(), slope.len()])?;
        for (i, &v) in at.speed.iter().enumerate() {
            let (sign, rise) = rounded_sign(v, self.rounding);
            let fast = self.fast(at.pressure[i], at.real_area[i]);
            coefficient[i] = fast * sign;
            slope[i] = (fast * rise).min(f64::MAX);
        }
        Ok(())
    }
}
