use gudgeon_core::kinds::{Drive, DriveSpec, DriveTorque};
use gudgeon_core::quantity::Torque;
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The same torque at all speeds and angles.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Constant {
    /// Torque in the direction of rotation.
    pub torque: Torque,
}

#[register_model(
    name = "constant",
    summary = "the same torque at all speeds",
    equations = "T = const",
    validity = "Studies about one speed.",
    references = [],
    example = "torque = \"2 kN m\"\n",
)]
impl DriveSpec for Constant {
    fn build(&self) -> Result<Box<dyn Drive>, BuildError> {
        Ok(Box::new(Same { torque: self.torque.si() }))
    }
}

#[derive(Debug, Clone)]
struct Same {
    torque: f64,
}

impl Drive for Same {
    fn torque(&self, _: f64, _: f64) -> DriveTorque {
        DriveTorque { torque: self.torque, slope: 0.0 }
    }
    fn is_linear(&self) -> bool {
        true
    }
}
