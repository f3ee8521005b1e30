//! Friction of the gudgeon pin in the piston.

mod coulomb;
mod off;

pub use coulomb::Coulomb;
pub use off::Off;
