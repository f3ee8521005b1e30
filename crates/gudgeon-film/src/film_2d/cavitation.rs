use gudgeon_core::kinds::Superposition;
use serde::{Deserialize, Serialize};

/// What happens in a two-dimensional film where its pressure would fall below the cavitation pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Cavitation {
    /// The film ruptures, what is left of it is carried on at `p_cav` with a filling below 1, and it forms again where that
    /// fills the gap (Jakobsson, Floberg and Olsson). Oil is conserved. Friction counts the filled part. Without a history,
    /// a cavity keeps its filling where the gap opens and its void where it closes.
    #[default]
    MassConserving,
    /// No pressure below `p_cav`, and no pressure gradient where a film ends of itself (Reynolds or Swift-Stieber condition). Oil is not conserved
    /// where a film begins anew behind a cavity. Friction as if the gap were full.
    SwiftStieber,
    /// The full film, cut off at `p_cav` afterwards (Gümbel condition). Oil is not conserved at the cut. Friction as if the gap
    /// were full.
    HalfSommerfeld,
    /// The full film, however far below `p_cav`.
    FullSommerfeld,
}

impl Cavitation {
    /// How the film follows from that of its causes.
    pub(super) fn superposition(self) -> Superposition {
        match self {
            Self::MassConserving | Self::SwiftStieber => Superposition::None,
            Self::HalfSommerfeld => Superposition::CutOff,
            Self::FullSommerfeld => Superposition::Full,
        }
    }
}
