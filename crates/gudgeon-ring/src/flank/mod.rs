//! Oil between a ring and the flanks of its groove.

mod checks;
pub mod dry;
mod gas_gap;
pub mod squeeze_film;
pub mod tangent_degrees;
pub mod tangent_radians;
pub mod wetted_strip;
