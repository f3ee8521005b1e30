//! Oil in the groove.

mod dry;
mod squeeze_film;
mod tangent_degrees;
mod tangent_radians;
mod wetted_strip;
