//! Friction of the rings in their grooves against motion across the bore.

mod coulomb;
mod off;

pub use coulomb::Coulomb;
pub use off::Off;
