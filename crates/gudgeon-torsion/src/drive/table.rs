use gudgeon_core::kinds::{Drive, DriveSpec, DriveTorque};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::table::Pchip;
use serde::{Deserialize, Serialize};

/// A measured torque-speed curve, by monotone cubics between the rows and straight on beyond the ends.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Speeds \[rpm\], ascending.
    pub speed_rpm: Vec<f64>,
    /// Torques \[N m\].
    pub torque: Vec<f64>,
}

#[register_model(
    name = "table",
    summary = "measured torque-speed curve",
    equations = "T(omega): monotone piecewise cubic through the rows, straight beyond the ends",
    validity = "As good as the curve; at least two rows.",
    references = ["fritsch1980"],
    example = "speed_rpm = [0, 900, 1140, 1180, 1200]\ntorque = [1800, 2400, 4200, 2100, 0]\n",
)]
impl DriveSpec for Table {
    fn build(&self) -> Result<Box<dyn Drive>, BuildError> {
        crate::coupling::check_table("speed_rpm", &self.speed_rpm, &[("torque", &self.torque)], 2)?;
        let omega: Vec<f64> = self.speed_rpm.iter().map(|n| n * std::f64::consts::PI / 30.0).collect();
        let ends = (omega[0], omega[omega.len() - 1]);
        let curve = Pchip::new(omega, self.torque.clone())
            .map_err(|e| BuildError::at("speed_rpm", format!("the curve cannot be used: {e}")))?;
        Ok(Box::new(Curve { curve, ends }))
    }
}

#[derive(Debug, Clone)]
struct Curve {
    curve: Pchip,
    ends: (f64, f64),
}

impl Drive for Curve {
    fn torque(&self, _: f64, omega: f64) -> DriveTorque {
        let at = omega.clamp(self.ends.0, self.ends.1);
        let (torque, slope) = self.curve.eval(at);
        DriveTorque { torque: torque + slope * (omega - at), slope }
    }
    fn is_linear(&self) -> bool {
        false
    }
}
