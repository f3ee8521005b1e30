//! Tests of the crate, one module a topic.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use gudgeon_kinematics as _;

mod compressors;
mod cylinder_pressure;
mod exact_slider_crank;
mod models;
mod periodic_cubic;
mod smoothing;
mod two_harmonic_series;
