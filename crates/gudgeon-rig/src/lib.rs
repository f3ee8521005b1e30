//! Test benches: one file per rig. A rig takes one sub-model, prescribes what a scene would compute, and shows what comes out.

mod along;
mod cylinder_pressure;
mod journal_1d;
mod kinematics;
mod profile;
mod ring_face;
mod slider;
mod squeeze_film;

pub use cylinder_pressure::CylinderPressureRig;
pub use journal_1d::Journal1dRig;
pub use kinematics::KinematicsRig;
pub use profile::Profile;
pub use ring_face::RingFaceRig;
pub use slider::{LineEnd, SliderRig};
pub use squeeze_film::{Motion, SqueezeFilmRig};
