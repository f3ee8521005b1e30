//! Keys that several gas-flow models have in common.

use gudgeon_core::quantity::{Length, NonNegative, PosLength, PosTime, quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which film thickness sets the passages and the volume behind a ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FilmHeight {
    /// The film thickness of the instant: gas flow and film are solved together.
    #[default]
    Instantaneous,
    /// The constant thickness `nominal_film`: the gas flow does not need the films.
    Nominal,
}

impl FilmHeight {
    /// The constant film thickness \[m\]; `None` for that of the instant.
    pub(crate) fn nominal(self, film: Length<NonNegative>) -> Option<f64> {
        match self {
            Self::Instantaneous => None,
            Self::Nominal => Some(film.si()),
        }
    }
}

/// What becomes of spaces behind rings that fill much faster than anything else changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Elimination {
    /// Every space stores gas and is integrated.
    #[default]
    Never,
    /// Spaces that fill in less than `eliminate_below` store nothing: what enters past one flank leaves past the other, and the
    /// pressure between follows from that.
    Auto,
}

impl Elimination {
    /// Filling time \[s\] below which a space is left out.
    pub(crate) fn below(self, limit: PosTime) -> Option<f64> {
        (self == Self::Auto).then(|| limit.si())
    }
}

/// Default of `face_oil`: flooded films of rings stay below it.
pub(crate) fn fifty_micrometres() -> PosLength {
    quantity(50e-6)
}

/// Default of `eliminate_below`.
pub(crate) fn ten_nanoseconds() -> PosTime {
    quantity(1e-8)
}
