use serde::{Deserialize, Serialize};

/// Friction of the part of a face that is not under full film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CavityShear {
    /// `full` for the Sommerfeld conditions, as programs that use them count it; `streamers` otherwise.
    #[default]
    Auto,
    /// Streamers of oil over the fraction of the width that the flux through the cavity fills: `h_r/h` in a steady film.
    Streamers,
    /// As if the gap were full: `μ u/h`.
    Full,
    /// None.
    None,
}
