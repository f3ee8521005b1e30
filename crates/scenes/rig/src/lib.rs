//! The scene `rig` and its test benches: one file per rig. A rig takes one sub-model, prescribes what a scene would compute, and shows what comes out.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod along;
pub mod case;
mod contact_pair;
mod cylinder_pressure;
mod draw;
mod flank;
mod gas_passage;
mod gas_volumes;
mod journal_1d;
mod journal_2d;
mod kinematics;
mod lubricant;
mod profile;
mod ring_face;
mod rough_surface;
mod scene;
mod shaft_line;
pub mod sheet;
mod skirt;
mod slider;
mod slider_2d;
mod squeeze_film;
pub mod validity;

pub use contact_pair::ContactPairRig;
pub use cylinder_pressure::CylinderPressureRig;
pub use flank::FlankRig;
pub use gas_passage::{GasPassageRig, PassageLaw, PassageShape};
pub use gas_volumes::{GasBoundary, GasOpening, GasRun, GasVolume, GasVolumesRig, Pulse, Until};
pub use journal_1d::Journal1dRig;
pub use journal_2d::{Journal2dRig, JournalSupply};
pub use kinematics::KinematicsRig;
pub use lubricant::LubricantRig;
pub use profile::Profile;
pub use ring_face::RingFaceRig;
pub use rough_surface::RoughSurfaceRig;
pub use shaft_line::ShaftLineRig;
pub use skirt::SkirtRig;
pub use slider::{LineEnd, SliderRig};
pub use slider_2d::{BetweenNodes, Dimples, PadProfile, Sides, Slider2dRig};
pub use squeeze_film::{Motion, SqueezeFilmRig};

gudgeon_core::link!(
    case::RigCase,
    ContactPairRig,
    CylinderPressureRig,
    FlankRig,
    GasPassageRig,
    GasVolumesRig,
    Journal1dRig,
    Journal2dRig,
    KinematicsRig,
    LubricantRig,
    RingFaceRig,
    RoughSurfaceRig,
    ShaftLineRig,
    SkirtRig,
    Slider2dRig,
    SliderRig,
    SqueezeFilmRig,
);
