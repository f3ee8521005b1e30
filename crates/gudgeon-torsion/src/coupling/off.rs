use gudgeon_core::kinds::{Coupling, CouplingSpec, CouplingTorque, LinearCoupling};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A rigid link: both ends turn as one. Elimination passes it without ever forming a large number; in time its
/// inertias are one.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Off {}

#[register_model(
    name = "off",
    summary = "no elasticity: a rigid link",
    equations = "theta_1 = theta_2",
    validity = "Flanges, hubs, gear meshes without elasticity.",
    references = [],
    example = "",
)]
impl CouplingSpec for Off {
    fn build(&self) -> Result<Box<dyn Coupling>, BuildError> {
        Ok(Box::new(Rigid))
    }
}

#[derive(Debug, Clone)]
struct Rigid;

impl Coupling for Rigid {
    fn torque(&self, _: f64, _: f64) -> CouplingTorque {
        CouplingTorque { torque: 0.0, stiffness: f64::INFINITY, damping: 0.0 }
    }
    fn linear(&self, _: f64, _: f64) -> LinearCoupling {
        LinearCoupling { stiffness: f64::INFINITY, damping: 0.0, loss_factor: 0.0 }
    }
    fn static_twist(&self, _: f64) -> f64 {
        0.0
    }
}
