//! Gas that a moving ring squeezes out of a flank gap.

use gudgeon_core::quantity::{NonNegative, Viscosity, quantity};

use super::squeeze_film::resistance;

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
    /// Force per circumference \[N/m\] of gas `width` wide between walls at the distance `gap` that approach with `rate` (negative: separate).
    pub fn force(&self, width: f64, gap: f64, rate: f64) -> f64 {
        let slenderness = width / gap;
        let linear = self.viscosity * slenderness * slenderness * slenderness * rate;
        resistance(linear, 1.0, self.tension * width)
    }
}
