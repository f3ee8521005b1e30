//! Gas that a moving ring squeezes out of a flank gap.

use gudgeon_core::kinds::FlankFilm;
use gudgeon_core::quantity::{NonNegative, Viscosity, quantity};

/// Viscosity of air at 500 K by Sutherland's law.
pub(super) fn default_gas_viscosity() -> Viscosity<NonNegative> {
    quantity(27e-6)
}

/// The gas in a flank gap.
#[derive(Debug, Clone, Copy)]
pub(super) struct GasGap {
    /// Dynamic viscosity \[Pa s\].
    pub viscosity: f64,
    /// Greatest mean tension of gas that cannot follow a ring fast enough \[Pa\].
    pub tension: f64,
}

impl GasGap {
    /// The film of gas `width` wide \[m\], over a `circumference` \[m\]; `per_gap` one over the gap \[1/m\].
    pub fn film(&self, width: f64, per_gap: f64, circumference: f64) -> FlankFilm {
        let slenderness = width * per_gap;
        let damping = circumference * self.viscosity * slenderness * slenderness * slenderness;
        FlankFilm { approach: damping, apart: damping, tension: circumference * self.tension * width }
    }
}
