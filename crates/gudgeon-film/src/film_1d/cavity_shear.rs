//! Friction of the part of a line that is not under full film.

use serde::{Deserialize, Serialize};

use crate::cavitation::Cavitation;

/// Friction of the part of a line that is not under full film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LineCavityShear {
    /// `full` for the Sommerfeld conditions, as programs that use them count it; `streamers` otherwise.
    #[default]
    Auto,
    /// Streamers of oil over the filled fraction of the width: `θ μ u/h`.
    Streamers,
    /// As if the gap were full: `μ u/h`.
    Full,
    /// None.
    None,
}

/// [`LineCavityShear`] when it is decided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shear {
    Streamers,
    Full,
    None,
}

impl LineCavityShear {
    /// What is left to decide when the condition of cavitation is known.
    pub(super) const fn decided(self, cavitation: Cavitation) -> Shear {
        match (self, cavitation) {
            (Self::None, _) => Shear::None,
            (Self::Full, _) | (Self::Auto, Cavitation::HalfSommerfeld | Cavitation::FullSommerfeld) => {
                Shear::Full
            }
            _ => Shear::Streamers,
        }
    }
}
