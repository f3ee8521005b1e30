use gudgeon_core::kinds::{BoundaryFriction, BoundaryFrictionSpec, Rubbing};
use gudgeon_core::quantity::{NonNegative, Ratio, Velocity, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::check::check;
use super::rounded_sign::rounded_sign;

/// A constant coefficient against the direction of sliding, rounded at rest: `μ(v) = μ_c v/√(v² + v_0²)`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// Coefficient of friction μ_c.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
    /// Speed v_0 that rounds the jump at rest; 0 leaves it, with no friction at rest itself.
    #[serde(default = "slow")]
    pub rounding_speed: Velocity<NonNegative>,
}

fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}
fn slow() -> Velocity<NonNegative> {
    quantity(0.01)
}

#[register_model(
    name = "coulomb",
    summary = "constant coefficient of friction, rounded at rest",
    equations = "mu(v) = mu_c v/sqrt(v^2 + v_0^2)",
    validity = "Sliding at speeds above v_0; surfaces at rest creep instead of sticking. v_0 = 0 is for schemes that find the reversal themselves.",
    references = [],
    example = "friction_coefficient = 0.12\nrounding_speed = \"1 cm/s\"\n",
)]
impl BoundaryFrictionSpec for Coulomb {
    fn build(&self) -> Result<Box<dyn BoundaryFriction>, BuildError> {
        Ok(Box::new(Rounded {
            coefficient: self.friction_coefficient.si(),
            rounding: self.rounding_speed.si(),
        }))
    }
}

#[derive(Debug)]
struct Rounded {
    coefficient: f64,
    rounding: f64,
}

impl BoundaryFriction for Rounded {
    fn is_off(&self) -> bool {
        self.coefficient == 0.0
    }
    fn coefficient(
        &self,
        at: &Rubbing<'_>,
        coefficient: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError> {
        check("coulomb", at, [coefficient.len(), slope.len()])?;
        for (i, &v) in at.speed.iter().enumerate() {
            let (sign, rise) = rounded_sign(v, self.rounding);
            coefficient[i] = self.coefficient * sign;
            slope[i] = self.coefficient * rise;
        }
        Ok(())
    }
}
