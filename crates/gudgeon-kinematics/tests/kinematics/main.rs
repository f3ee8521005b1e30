//! Tests of the crate, one module a topic.

use gudgeon_kinematics as _;

mod compressors;
mod cylinder_pressure;
mod exact_slider_crank;
mod models;
mod periodic_cubic;
mod smoothing;
mod two_harmonic_series;
