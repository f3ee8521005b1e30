//! Time integrators of a ring pack, by name.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Time integrators of the implicit solver of a ring pack.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RingIntegrator {
    /// `rodas3` down to a tolerance of 5e-5, `rodas5p` below (default).
    #[default]
    Rodas,
    /// Rosenbrock method of order 3, of few stages: the cheapest for errors of 1e-3 to 1e-5.
    Rodas3,
    /// Rosenbrock method of order 5.
    Rodas5p,
    /// Singly diagonally implicit method of order 2 whose stages the pack solves itself, each ring by a bracket: half the steps at errors of 1e-3. For
    /// packs whose models solve stages. Not for rings that leave the liner: heavy ones at 5000 rpm come back too slowly, and blow-by is wrong at every tolerance.
    Sdirk2,
    /// Gas with the rings in their grooves, and films, each at steps of its own over the whole cycle, in turns until both agree: the cheapest for errors of 1e-3,
    /// at a tolerance of 5e-3, with the stages of `sdirk2`. Within a step of the gas each ring takes as many as its own motion needs. For packs whose models solve
    /// stages. Where a ring leaves the liner in the first cycle, or the two do not come to agree, the run tells so and integrates the pack whole.
    Waveform,
    /// Radau IIA of order 5, for references at tight tolerances.
    Radau5,
}

/// Tolerance below which the integrator of order 5 needs less work than that of order 3.
const ORDER_FIVE: f64 = 5e-5;

impl RingIntegrator {
    /// Whether it needs models that solve stages.
    #[must_use]
    pub const fn has_stages(self) -> bool {
        matches!(self, Self::Sdirk2 | Self::Waveform)
    }

    /// The integrator that runs at a tolerance: never [`RingIntegrator::Rodas`].
    #[must_use]
    pub fn at(self, tolerance: f64) -> Self {
        match self {
            Self::Rodas if tolerance >= ORDER_FIVE => Self::Rodas3,
            Self::Rodas => Self::Rodas5p,
            other => other,
        }
    }
}
