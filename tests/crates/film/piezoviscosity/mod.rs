//! Viscosity under pressure.

mod barus;
mod off;
mod reduced_pressure;
mod roelands;
mod tame_exp;
