use gudgeon_core::kinds::{Drive, DriveSpec, DriveTorque};
use gudgeon_core::quantity::{NonNegative, PosAngularSpeed, PosRatio, PosTorque, Torque, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// An induction motor over its whole range of speed, by the formula of Kloss.
///
/// ```text
/// T = 2 T_b/(s/s_b + s_b/s),   s = (ω_s - ω)/ω_s
/// ```
///
/// T_b pull-out (breakdown) torque at the slip s_b, ω_s synchronous speed. Above ω_s it brakes. The alternating torque at
/// line frequency that a motor has while it is switched on is not part of this stationary curve.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InductionMotor {
    /// Synchronous speed ω_s: 2π times line frequency over pole pairs.
    pub synchronous: PosAngularSpeed,
    /// Pull-out torque T_b.
    pub breakdown_torque: PosTorque,
    /// Slip s_b at the pull-out torque.
    pub breakdown_slip: PosRatio,
    /// Torque that friction and windage take off.
    #[serde(default = "none")]
    pub losses: Torque<NonNegative>,
}

fn none() -> Torque<NonNegative> {
    quantity(0.0)
}

#[register_model(
    name = "induction_motor",
    summary = "induction motor from rest to synchronous speed, by the formula of Kloss",
    equations = "T = 2 T_b/(s/s_b + s_b/s);  s = (omega_s - omega)/omega_s",
    validity = "Quasi-steady torque: slow against the electrical time constants. No alternating torque at line frequency.",
    references = ["kloss1916"],
    example = "synchronous = \"1200 rpm\"\nbreakdown_torque = \"5 kN m\"\nbreakdown_slip = \"8 %\"\n",
)]
impl DriveSpec for InductionMotor {
    fn build(&self) -> Result<Box<dyn Drive>, BuildError> {
        Ok(Box::new(Kloss {
            synchronous: self.synchronous.si(),
            top: self.breakdown_torque.si(),
            at: self.breakdown_slip.si(),
            losses: self.losses.si(),
        }))
    }
}

#[derive(Debug, Clone)]
struct Kloss {
    synchronous: f64,
    top: f64,
    at: f64,
    losses: f64,
}

impl Drive for Kloss {
    fn torque(&self, _: f64, omega: f64) -> DriveTorque {
        // T = 2 T_b x/(x² + 1) with x = s/s_b: no division by zero at synchronous speed.
        let x = (self.synchronous - omega) / (self.synchronous * self.at);
        let bottom = x * x + 1.0;
        let dx = -1.0 / (self.synchronous * self.at);
        DriveTorque {
            torque: 2.0 * self.top * x / bottom - self.losses,
            slope: 2.0 * self.top * (1.0 - x * x) / (bottom * bottom) * dx,
        }
    }
    fn is_linear(&self) -> bool {
        false
    }
}
