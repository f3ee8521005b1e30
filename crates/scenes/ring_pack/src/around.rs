//! The same pack with inputs a little higher.

use super::pack::Pack;
use super::results::Meter;

/// An input that is varied, and the pack with its higher value.
pub struct Varied {
    /// By how much it is higher, in SI units; negative where it can only be lower.
    pub step: f64,
    /// The pack.
    pub pack: Pack,
    /// How its blow-by is metered.
    pub meter: Meter,
}

/// What surrounds a pack.
pub struct Around<'a> {
    /// How blow-by of the pack itself is metered.
    pub meter: Meter,
    /// One for each input.
    pub varied: &'a mut [Varied],
}
