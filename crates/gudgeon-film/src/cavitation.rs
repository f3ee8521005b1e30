use serde::{Deserialize, Serialize};

/// Condition of a film where its pressure would fall below the cavitation pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Cavitation {
    /// Ruptures where pressure and pressure gradient vanish and, behind the cavity, forms again where the flux that the
    /// liner carries through it fills the gap (Jakobsson, Floberg and Olsson). Load and friction are continuous in every
    /// input. The cavity is quasi-steady: its void keeps its volume, so that the flux in it is `q_r - ḣ (x - x_r)`, and a
    /// cavity that runs dry on the way takes oil from neither side.
    #[default]
    MassConserving,
    /// Ruptures where pressure and pressure gradient vanish; from there to the trailing edge the pressure is `p_cav`
    /// (Reynolds or Swift-Stieber condition). When the trailing edge is above `p_cav` the load jumps where the film first
    /// ruptures. Without sliding there is no trailing edge and both edges keep their films, as in `mass_conserving`.
    SwiftStieber,
    /// The full film, cut off at `p_cav` afterwards (Gümbel condition). Loses oil at the cut.
    HalfSommerfeld,
    /// The full film, however far below `p_cav`.
    FullSommerfeld,
}
