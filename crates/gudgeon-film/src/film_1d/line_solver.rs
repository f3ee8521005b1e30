use serde::{Deserialize, Serialize};

/// Solver of the complementarity problem of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LineSolver {
    /// Steady films directly, all others by semi-smooth Newton steps from the last film.
    #[default]
    Direct,
    /// Newton's method on `p + r - √(p² + r²)`, `r = 1 - θ`, from a full film or the last one.
    FischerBurmeister,
}
