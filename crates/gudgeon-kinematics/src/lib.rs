//! Piston motion and cylinder pressure.
//!
//! | kind | models |
//! |---|---|
//! | `kinematics` | [`ExactSliderCrank`], [`TwoHarmonicSeries`] |
//! | `cylinder_pressure` | [`Table`], [`PolytropicBurn`], [`SingleZoneWiebe`], [`Motored`], [`Constant`]; compressors: [`IdealValves`], [`ValveLosses`], [`AngleWindows`] |
//!
//! Crank angle 0 is the gas-exchange top dead centre, 2π the firing one; the crank angle counts from the throw pointing at
//! the head. With an offset crank the piston is highest a little after (or before) that.

mod angle_windows;
mod chamber;
mod compressor;
mod constant;
mod exact_slider_crank;
mod ideal_valves;
mod motored;
mod periodic_cubic;
mod polytropic_burn;
mod single_zone_wiebe;
mod smoothing;
mod table;
mod two_harmonic_series;
mod valve_losses;

pub use angle_windows::AngleWindows;
pub use chamber::Chamber;
pub use compressor::Clearance;
pub use constant::Constant;
pub use exact_slider_crank::ExactSliderCrank;
pub use ideal_valves::IdealValves;
pub use motored::Motored;
pub use polytropic_burn::PolytropicBurn;
pub use single_zone_wiebe::{ChamberVolume, SingleZoneWiebe};
pub use table::{Interpolation, Smoothing, Table};
pub use two_harmonic_series::TwoHarmonicSeries;
pub use valve_losses::ValveLosses;

use gudgeon_core::BuildError;
use gudgeon_core::kinds::KinematicsCtx;

/// Length of a four-stroke cycle \[rad\].
pub const FOUR_STROKE: f64 = 4.0 * std::f64::consts::PI;

/// Checks that the mechanism exists and turns all the way round.
fn check_mechanism(ctx: &KinematicsCtx) -> Result<(), BuildError> {
    let KinematicsCtx { crank_radius: r, rod_length: l, offset: e, omega } = *ctx;
    for (name, v) in [("crank_radius", r), ("rod_length", l), ("omega", omega)] {
        if !(v.is_finite() && v > 0.0) {
            return Err(BuildError::at(
                name,
                format!("{name} is {v}, it must be a number greater than zero"),
            ));
        }
    }
    if !e.is_finite() {
        return Err(BuildError::at("offset", format!("offset is {e}, it must be a number")));
    }
    if l <= r + e.abs() {
        let what = format!(
            "the crank cannot turn: the rod ({l} m) must be longer than the crank radius ({r} m) plus the offset ({} m)",
            e.abs()
        );
        return Err(BuildError::at("rod_length", what));
    }
    Ok(())
}

/// `theta` reduced to one period, `0 <= result < period`.
fn reduced(theta: f64, period: f64) -> f64 {
    if (0.0..period).contains(&theta) {
        return theta;
    }
    // The quotient may be rounded across a whole number, and the result by an ulp to either side of the interval.
    let x = theta - period * (theta / period).floor();
    // (A `theta` that is not a number stays one.)
    if x >= period || x < 0.0 { 0.0 } else { x }
}
