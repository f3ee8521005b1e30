//! Tests of the crate, one module a topic.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

mod central_differences;
mod closed_form_face;
mod compressibility;
mod crown;
mod evaporation;
mod film_1d;
mod film_2d;
mod film_temperature;
mod gridded_face;
mod kept_film;
mod moments;
mod oil;
mod oil_transport;
mod piezoviscosity;
mod rheology_grid;
mod roughness;
mod rows;
mod shear_thinning;
mod walther;
