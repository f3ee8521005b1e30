//! The sub-model traits, one file per kind: a specification (what a case file says) and the runtime it builds.
//!
//! A runtime owns its work arrays, allocates only when built, answers a whole field or scene step per call, and says
//! [`EvalError::Recoverable`](crate::EvalError::Recoverable) when it cannot answer.

mod boundary_friction;
mod compressibility;
mod contact;
mod cylinder_pressure;
mod fatigue;
mod film_1d;
mod film_2d;
mod film_temperature;
mod flank_damping;
mod flank_friction;
mod gas_flow;
mod groove_friction;
mod hydrodynamics;
mod kinematics;
mod oil;
mod oil_transport;
mod piezoviscosity;
mod pin_friction;
mod pin_load;
mod pin_strength;
mod profile_curve;
mod rig;
mod ring_motion;
mod roughness;
mod secondary_motion;
mod shear_thinning;
mod skirt_compliance;
mod skirt_profile;

pub use boundary_friction::*;
pub use compressibility::*;
pub use contact::*;
pub use cylinder_pressure::*;
pub use fatigue::*;
pub use film_1d::*;
pub use film_2d::*;
pub use film_temperature::*;
pub use flank_damping::*;
pub use flank_friction::*;
pub use gas_flow::*;
pub use groove_friction::*;
pub use hydrodynamics::*;
pub use kinematics::*;
pub use oil::*;
pub use oil_transport::*;
pub use piezoviscosity::*;
pub use pin_friction::*;
pub use pin_load::*;
pub use pin_strength::*;
pub use profile_curve::*;
pub use rig::*;
pub use ring_motion::*;
pub use roughness::*;
pub use secondary_motion::*;
pub use shear_thinning::*;
pub use skirt_compliance::*;
pub use skirt_profile::*;
