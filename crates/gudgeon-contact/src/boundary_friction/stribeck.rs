use gudgeon_core::kinds::{BoundaryFriction, BoundaryFrictionSpec, Rubbing};
use gudgeon_core::quantity::{NonNegative, PosRatio, PosVelocity, Ratio, Velocity, quantity};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::check::check;
use super::rounded_sign::rounded_sign;

/// A coefficient that falls from a static to a kinetic value with the sliding speed:
///
/// ```text
/// μ(v) = { μ_k + (μ_s - μ_k) exp[-(|v|/v_s)^n] } v/√(v² + v_0²)
/// ```
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stribeck {
    /// Static coefficient μ_s.
    pub static_coefficient: Ratio<NonNegative>,
    /// Kinetic coefficient μ_k of fast sliding.
    pub kinetic_coefficient: Ratio<NonNegative>,
    /// Stribeck speed v_s.
    pub stribeck_speed: PosVelocity,
    /// Exponent n, at least 1: 1 or 2 are usual.
    #[serde(default = "two")]
    pub exponent: PosRatio,
    /// Speed v_0 that rounds the jump at rest, well below v_s; 0 leaves it, with no friction at rest itself.
    #[serde(default = "slow")]
    pub rounding_speed: Velocity<NonNegative>,
}

fn two() -> PosRatio {
    quantity(2.0)
}
fn slow() -> Velocity<NonNegative> {
    quantity(0.01)
}

#[register_model(
    name = "stribeck",
    summary = "coefficient that falls from a static to a kinetic value, rounded at rest",
    equations = "mu(v) = {mu_k + (mu_s - mu_k) exp[-(|v|/v_s)^n]} v/sqrt(v^2 + v_0^2)",
    validity = "Empirical. Falls with speed below v_s, which can make motion unstable. Of the solid contact alone: not to be added to a film that has a Stribeck curve of its own.",
    references = ["armstrong1994"],
    example = "static_coefficient = 0.15\nkinetic_coefficient = 0.10\nstribeck_speed = \"10 cm/s\"\nrounding_speed = \"1 cm/s\"\n",
)]
impl BoundaryFrictionSpec for Stribeck {
    fn build(&self) -> Result<Box<dyn BoundaryFriction>, BuildError> {
        let (exponent, inverse) = (self.exponent.si(), self.stribeck_speed.si().recip());
        if exponent < 1.0 {
            return Err(BuildError::at(
                "exponent",
                format!("with the exponent {exponent} the slope at rest is infinite"),
            )
            .help("give 1 or more"));
        }
        if !inverse.is_finite() {
            return Err(BuildError::at("stribeck_speed", "the Stribeck speed is too small to compute with"));
        }
        Ok(Box::new(Falling {
            kinetic: self.kinetic_coefficient.si(),
            surplus: self.static_coefficient.si() - self.kinetic_coefficient.si(),
            inverse,
            exponent,
            rounding: self.rounding_speed.si(),
        }))
    }
}

#[derive(Debug)]
struct Falling {
    kinetic: f64,
    /// `μ_s - μ_k`.
    surplus: f64,
    /// `1/v_s`.
    inverse: f64,
    exponent: f64,
    rounding: f64,
}

/// `(|v|/v_s)^n` beyond which the surplus is gone: `exp(-800)` is zero.
const GONE: f64 = 800.0;

impl BoundaryFriction for Falling {
    fn is_off(&self) -> bool {
        self.kinetic == 0.0 && self.surplus == 0.0
    }
    fn coefficient(
        &self,
        at: &Rubbing<'_>,
        coefficient: &mut [f64],
        slope: &mut [f64],
    ) -> Result<(), EvalError> {
        check("stribeck", at, [coefficient.len(), slope.len()])?;
        for (i, &v) in at.speed.iter().enumerate() {
            let (sign, rise) = rounded_sign(v, self.rounding);
            let x = v.abs() * self.inverse;
            let power = elementary::powf(x, self.exponent);
            let (value, fall) = if power < GONE {
                let e = self.surplus * elementary::exp(-power);
                let per_speed = if x > 0.0 {
                    power / x
                } else if self.exponent == 1.0 {
                    1.0
                } else {
                    0.0
                };
                // The magnitude falls alike on both sides of rest.
                (
                    self.kinetic + e,
                    -e * self.exponent * per_speed * self.inverse * if v < 0.0 { -1.0 } else { 1.0 },
                )
            } else {
                (self.kinetic, 0.0)
            };
            coefficient[i] = value * sign;
            slope[i] = value * rise + fall * sign;
        }
        Ok(())
    }
}
