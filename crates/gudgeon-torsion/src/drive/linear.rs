use gudgeon_core::kinds::{Drive, DriveSpec, DriveTorque};
use gudgeon_core::quantity::{PosAngularSpeed, Torque, TorsionalDamping};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A straight torque-speed line `T = C₀ + C₁ ω`: an induction motor near its synchronous speed.
///
/// Given by `intercept` and `slope`, or by `rated` torque and speed with the synchronous speed ω_s, where the torque is zero:
/// `C₁ = -T_r/(ω_s - ω_r)`, `C₀ = -C₁ ω_s`. A motor that steadies the speed has a negative slope.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// Torque C₀ at rest, on the line.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub intercept: Option<Torque>,
    /// Slope C₁ over the speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope: Option<TorsionalDamping>,
    /// The rated point instead of both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rated: Option<Rated>,
}

/// Rated point of a motor.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rated {
    /// Rated torque.
    pub torque: Torque,
    /// Rated speed.
    pub speed: PosAngularSpeed,
    /// Synchronous speed.
    pub synchronous: PosAngularSpeed,
}

#[register_model(
    name = "linear",
    summary = "straight torque-speed line, as of an induction motor near synchronous speed",
    equations = "T = C0 + C1 omega;  from the rated point C1 = -T_r/(omega_s - omega_r), C0 = -C1 omega_s",
    validity = "Small changes of speed about the rated point.",
    references = ["gomes2021", "doughty1988"],
    example = "intercept = \"2 kN m\"\nslope = \"-0.2 N m s/rad\"\n",
)]
impl DriveSpec for Linear {
    fn build(&self) -> Result<Box<dyn Drive>, BuildError> {
        let (c0, c1) = match (&self.intercept, &self.slope, &self.rated) {
            (Some(c0), Some(c1), None) => (c0.si(), c1.si()),
            (None, None, Some(r)) => {
                let slip = r.synchronous.si() - r.speed.si();
                if slip <= 0.0 {
                    let what = format!(
                        "the synchronous speed ({}) must be above the rated one ({})",
                        r.synchronous, r.speed
                    );
                    return Err(BuildError::at("rated.synchronous", what));
                }
                let c1 = -r.torque.si() / slip;
                (-c1 * r.synchronous.si(), c1)
            }
            _ => {
                let what = "a line is given by `intercept` and `slope`, or by `rated`";
                return Err(BuildError::new(what));
            }
        };
        if !(c0.is_finite() && c1.is_finite()) {
            return Err(BuildError::at("rated", "the slope is too steep to compute"));
        }
        Ok(Box::new(Line { c0, c1 }))
    }
}

#[derive(Debug, Clone)]
struct Line {
    c0: f64,
    c1: f64,
}

impl Drive for Line {
    fn torque(&self, _: f64, omega: f64) -> DriveTorque {
        DriveTorque { torque: self.c0 + self.c1 * omega, slope: self.c1 }
    }
    fn is_linear(&self) -> bool {
        true
    }
}
