//! Oil that evaporates from the liner.

mod heat_mass_analogy;
mod off;
pub(crate) mod petroleum;

pub use heat_mass_analogy::{Fraction, HeatMassAnalogy};
pub use off::Off;
