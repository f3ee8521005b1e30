use gudgeon_core::kinds::{Drive, DriveSpec, DriveTorque};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// No torque: a free end, a machine that coasts.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no torque",
    equations = "T = 0",
    validity = "Coasting machines, free vibration.",
    references = [],
    example = "",
)]
impl DriveSpec for Off {
    fn build(&self) -> Result<Box<dyn Drive>, BuildError> {
        Ok(Box::new(Nothing))
    }
}

#[derive(Debug, Clone)]
struct Nothing;

impl Drive for Nothing {
    fn torque(&self, _: f64, _: f64) -> DriveTorque {
        DriveTorque::default()
    }
    fn is_linear(&self) -> bool {
        true
    }
}
