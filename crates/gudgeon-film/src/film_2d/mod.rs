//! Films resolved along and across the motion.

mod central_differences;
mod complementarity;
mod direct;
mod multigrid;
mod off;
mod problem;
mod sor;

pub use central_differences::{CentralDifferences, Equations};
pub use direct::Direct;
use gudgeon_core::kinds::{FilmMode, Superposition};
use gudgeon_core::{BuildError, EvalError};
pub use multigrid::Multigrid;
pub use off::Off;
use serde::{Deserialize, Serialize};
pub use sor::Sor;

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
    fn superposition(self) -> Superposition {
        match self {
            Self::MassConserving | Self::SwiftStieber => Superposition::None,
            Self::HalfSommerfeld => Superposition::CutOff,
            Self::FullSommerfeld => Superposition::Full,
        }
    }
}

/// Which film thickness counts for the flow between two nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Flux {
    /// That halfway between them: the mean of both nodes, or what the caller gives. Second order in a full film.
    #[default]
    Face,
    /// The mean of the cubes of both nodes for the pressure flow, and the film at the node upstream for what the surface carries, as many
    /// published programs have it. First order.
    Node,
}

fn tolerance() -> f64 {
    1e-9
}

fn check_tolerance(tolerance: f64) -> Result<(), BuildError> {
    if (1e-14..=0.1).contains(&tolerance) {
        Ok(())
    } else {
        let what = format!("must be between 1e-14 and 0.1, not {tolerance}");
        Err(BuildError::at("tolerance", what))
    }
}

fn check_modes(
    model: &'static str,
    n: usize,
    modes: &[FilmMode<'_>],
    values: usize,
) -> Result<(), EvalError> {
    if values != n * modes.len() {
        return Err(EvalError::fatal(
            model,
            format!("{} modes of {n} nodes do not fit {values} values", modes.len()),
        ));
    }
    for m in modes {
        let sum = m.u + m.edge_pressure.iter().sum::<f64>() + m.dhdt.iter().sum::<f64>();
        if !(sum.is_finite() && (m.dhdt.is_empty() || m.dhdt.len() == n)) {
            return Err(EvalError::fatal(model, "a mode is not finite or not of the size of the grid"));
        }
    }
    Ok(())
}
