//! Oil in the groove.

mod dry;
mod resistance;
mod squeeze_film;
mod tangent_degrees;
mod tangent_radians;
mod wetted_strip;
