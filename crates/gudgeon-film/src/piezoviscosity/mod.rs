//! Viscosity under pressure.

pub mod barus;
pub mod off;
pub mod reduced_pressure;
pub mod roelands;
pub mod tame_exp;
