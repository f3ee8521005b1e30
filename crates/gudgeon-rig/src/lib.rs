//! Test benches: one file per rig. A rig takes one sub-model, prescribes what a scene would compute, and shows what comes out.

mod cylinder_pressure;
mod kinematics;
mod ring_face;

pub use cylinder_pressure::CylinderPressureRig;
pub use kinematics::KinematicsRig;
pub use ring_face::RingFaceRig;
