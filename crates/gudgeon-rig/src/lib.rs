//! Test benches: one file per rig. A rig takes one sub-model, prescribes what a scene would compute, and shows what comes out.

mod along;
mod cylinder_pressure;
mod journal_1d;
mod kinematics;
mod profile;
mod ring_face;
mod slider;
mod squeeze_film;
mod contact_pair;
mod cylinder_pressure;
mod draw;
mod flank;
mod gas_passage;
mod gas_volumes;
mod kinematics;
mod lubricant;
mod ring_face;
mod rough_surface;

pub use contact_pair::ContactPairRig;
pub use cylinder_pressure::CylinderPressureRig;
pub use journal_1d::Journal1dRig;
pub use kinematics::KinematicsRig;
pub use profile::Profile;
pub use ring_face::RingFaceRig;
pub use slider::{LineEnd, SliderRig};
pub use squeeze_film::{Motion, SqueezeFilmRig};
pub use flank::FlankRig;
pub use gas_passage::{GasPassageRig, PassageLaw, PassageShape};
pub use gas_volumes::{GasBoundary, GasOpening, GasRun, GasVolume, GasVolumesRig, Pulse, Until};
pub use kinematics::KinematicsRig;
pub use lubricant::LubricantRig;
pub use ring_face::RingFaceRig;
pub use rough_surface::RoughSurfaceRig;
