//! Piston motion and cylinder pressure.
//!
//! | to do | use |
//! |---|---|
//! | follow a piston over the crank angle | [`ExactSliderCrank`] or [`TwoHarmonicSeries`], [`build`](gudgeon_core::kinds::KinematicsSpec::build), then [`Kinematics::motion`](gudgeon_core::kinds::Kinematics::motion) |
//! | know the volume above a piston | [`Chamber`] |
//! | have the pressure in a cylinder | a model below, then [`CylinderPressure::pressure`](gudgeon_core::kinds::CylinderPressure::pressure) |
//! | read a measured trace | [`Table`]; its curve is a [`PeriodicCubic`], its filter [`smoothing`] |
//!
//! | kind | models |
//! |---|---|
//! | `kinematics` | [`ExactSliderCrank`], [`TwoHarmonicSeries`] |
//! | `cylinder_pressure`, engines | [`Table`], [`PolytropicBurn`], [`SingleZoneWiebe`], [`Motored`], [`Constant`] |
//! | `cylinder_pressure`, compressors | [`IdealValves`], [`ValveLosses`], [`AngleWindows`] |
//!
//! Crank angle 0 is the gas-exchange top dead centre, 2π the firing one; the crank angle counts from the throw pointing at
//! the head. With an offset crank the piston is highest a little after (or before) that. Units are SI, angles radians, pressures
//! absolute.
//!
//! A piston and its cylinder pressure alone:
//!
//! ```
//! use gudgeon_core::file::Files;
//! use gudgeon_core::kinds::{CylinderPressureCtx, CylinderPressureSpec, KinematicsCtx, KinematicsSpec};
//! use gudgeon_kinematics::{Constant, ExactSliderCrank, PolytropicBurn};
//!
//! # fn main() -> Result<(), gudgeon_core::BuildError> {
//! let omega = 2000.0 * std::f64::consts::PI / 30.0; // rad/s at 2000 1/min
//! let crank = KinematicsCtx { crank_radius: 0.07, rod_length: 0.24, offset: 0.0, omega };
//! let piston = ExactSliderCrank {}.build(&crank)?;
//! assert!((piston.stroke() - 0.14).abs() < 1e-15);
//! assert!(piston.motion(0.0).v == 0.0 && piston.motion(0.0).a < 0.0); // top dead centre
//!
//! let cylinder = CylinderPressureCtx { kinematics: &*piston, piston_area: 0.0113, files: &Files::of(".".as_ref()) };
//! let firing = PolytropicBurn::default().build(&cylinder)?;
//! let (theta, p) = firing.highest(); // rad, Pa
//! assert!(theta > 2.0 * std::f64::consts::PI && p > 100e5);
//! let shut_off = Constant::default().build(&cylinder)?;
//! assert_eq!(shut_off.pressure(theta), 1e5);
//! # Ok(())
//! # }
//! ```
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod angle_windows;
mod chamber;
mod compressor;
mod constant;
mod exact_slider_crank;
mod ideal_valves;
mod mechanism;
mod motored;
mod periodic;
mod periodic_cubic;
mod polytropic_burn;
mod pulses;
mod single_zone_wiebe;
pub mod smoothing;
mod table;
mod table_rows;
mod two_harmonic_series;
mod valve_losses;

pub use angle_windows::AngleWindows;
pub use chamber::Chamber;
pub use compressor::Clearance;
pub use constant::Constant;
pub use exact_slider_crank::ExactSliderCrank;
pub use ideal_valves::IdealValves;
pub use motored::Motored;
pub use periodic::FOUR_STROKE;
pub use periodic_cubic::{PeriodicCubic, TooClose};
pub use polytropic_burn::PolytropicBurn;
pub use single_zone_wiebe::{ChamberVolume, SingleZoneWiebe};
pub use table::{Interpolation, Smoothing, Table};
pub use two_harmonic_series::TwoHarmonicSeries;
pub use valve_losses::ValveLosses;

gudgeon_core::link!(
    AngleWindows,
    Constant,
    ExactSliderCrank,
    IdealValves,
    Motored,
    PolytropicBurn,
    SingleZoneWiebe,
    Table,
    TwoHarmonicSeries,
    ValveLosses,
);
