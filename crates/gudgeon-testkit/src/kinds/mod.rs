//! Running models of single kinds.

mod contact;
mod cylinder_pressure;
mod gas_flow;
mod hydrodynamics;
mod kinematics;
mod oil;
mod pin_strength;

pub use contact::contact;
pub use cylinder_pressure::cylinder_pressure;
pub use gas_flow::gas_flow;
pub use hydrodynamics::hydrodynamics;
pub use kinematics::kinematics;
pub use oil::oil;
pub use pin_strength::pin_strength;
