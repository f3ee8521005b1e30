//! Rough surfaces in a film.

mod checks;
mod gaussian_gap;
mod held_above;
pub mod off;
pub mod patir_cheng;
pub mod sawtooth_waviness;
pub mod tripp;

pub use gaussian_gap::GaussianGap;
