use gudgeon_core::kinds::{Drive, DriveSpec, DriveTorque};
use gudgeon_core::quantity::{NonNegative, PosAngularSpeed, Ratio, Torque, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

/// A torque that goes with a power of the speed: fan and propeller (2), generator on a resistance (1), hoist (0).
///
/// `T = T_r (ω/ω_r)ⁿ`, odd in the speed. As a load it stands with the role of one, so its torque is given positive.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PowerLaw {
    /// Torque T_r at the reference speed.
    pub torque: Torque,
    /// Reference speed ω_r.
    pub speed: PosAngularSpeed,
    /// Exponent n, at most 10: bodies in a fluid ask for two, and the steepest that is measured (a hull before it planes) for about five.
    #[serde(default = "square")]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub exponent: Ratio<NonNegative>,
}

/// Twice the steepest law that loads are known to follow, a hull before it planes with about the fifth power.
const STEEPEST: f64 = 10.0;

fn square() -> Ratio<NonNegative> {
    quantity(2.0)
}

#[register_model(
    name = "power_law",
    summary = "torque by a power of the speed: fan, propeller, generator",
    equations = "T = T_r sign(omega) |omega/omega_r|^n",
    validity = "Loads without a part that goes with the angle.",
    references = [],
    example = "torque = \"1 kN m\"\nspeed = \"1000 rpm\"\nexponent = 2\n",
)]
impl DriveSpec for PowerLaw {
    fn build(&self) -> Result<Box<dyn Drive>, BuildError> {
        if self.exponent.si() > STEEPEST {
            let what = format!(
                "no load goes with the power {} of the speed: at most {STEEPEST}",
                self.exponent.si()
            );
            return Err(BuildError::at("exponent", what).help("fans and propellers have 2"));
        }
        Ok(Box::new(Power { torque: self.torque.si(), speed: self.speed.si(), n: self.exponent.si() }))
    }
}

#[derive(Debug, Clone)]
struct Power {
    torque: f64,
    speed: f64,
    n: f64,
}

impl Drive for Power {
    fn torque(&self, _: f64, omega: f64) -> DriveTorque {
        let x = omega / self.speed;
        let size = elementary::powf(x.abs(), self.n);
        // The slope of powers below one has no value at rest.
        let slope = if x == 0.0 { 0.0 } else { self.torque * self.n * size / omega.abs() };
        DriveTorque { torque: self.torque * size * if x < 0.0 { -1.0 } else { 1.0 }, slope }
    }
    fn is_linear(&self) -> bool {
        self.n == 1.0 || self.n == 0.0
    }
}
