//! Viscosity under pressure.

mod barus;
mod off;
mod roelands;
mod tame_exp;
