//! Time integrators of implicit solvers, by name.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Time integrators of the implicit solver.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum IntegratorName {
    /// `rodas3` at loose tolerances, `rodas5p` at tight ones (default).
    #[default]
    Rodas,
    /// Rosenbrock method of order 3, of few stages: the cheapest for errors of 1e-3 to 1e-5.
    Rodas3,
    /// Rosenbrock method of order 5.
    Rodas5p,
    /// Radau IIA of order 5, for references at tight tolerances.
    Radau5,
}
