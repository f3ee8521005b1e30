//! Test benches: one file per rig. A rig takes one sub-model, prescribes what a scene would compute, and shows what comes out.

mod cylinder_pressure;
mod journal_2d;
mod kinematics;
mod ring_face;
mod sheet;
mod skirt;
mod slider_2d;

pub use cylinder_pressure::CylinderPressureRig;
pub use journal_2d::{Journal2dRig, JournalSupply};
pub use kinematics::KinematicsRig;
pub use ring_face::RingFaceRig;
pub use skirt::SkirtRig;
pub use slider_2d::{BetweenNodes, Dimples, PadProfile, Sides, Slider2dRig};
