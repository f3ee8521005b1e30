//! What results depend on: from the results of a design's points to indices, effects and bands.
//!
//! A point that failed has a result that is no finite number. It never enters a figure: every function says in its documentation what it leaves
//! out beside it, and in what it returns ([`Used`]) how much.

mod band;
mod elementary_effects;
mod main_effect;
mod sobol_indices;
mod tornado;

use serde::Serialize;

pub use band::{Band, band};
pub use elementary_effects::{ElementaryEffects, elementary_effects};
pub use main_effect::{Bin, MainEffect, main_effects};
pub use sobol_indices::{Bootstrap, Estimate, SobolIndex, SobolIndices, sobol_indices};
pub use tornado::{Swing, Tornado, tornado};

/// How much of what was run stands behind a figure.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Used {
    /// Points (rows, steps: as the figure says) that were used.
    pub used: usize,
    /// Those that were not, because a point of theirs failed.
    pub left_out: usize,
}

/// Why there is no figure.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoFigure {
    /// The results are not those of the design.
    #[error("the design has {points} points, and there are {results} results")]
    Length {
        /// Points of the design.
        points: usize,
        /// Results.
        results: usize,
    },
    /// Too many points failed, or too few were asked for.
    #[error("{left} of {of} results are left, at least {needed} are needed")]
    TooFew {
        /// What is left.
        left: usize,
        /// What there was.
        of: usize,
        /// What the figure needs.
        needed: usize,
    },
    /// The result is the same at every point: nothing has a share in a variance of zero.
    #[error("the result is the same at every point")]
    Constant,
}

/// Refuses results that are not those of a design.
fn of_points(points: usize, results: usize) -> Result<(), NoFigure> {
    if points == results { Ok(()) } else { Err(NoFigure::Length { points, results }) }
}

/// Mean; 0 of nothing.
fn mean(y: &[f64]) -> f64 {
    // Around the first value: rounding is that of the differences.
    let Some(first) = y.first() else { return 0.0 };
    first + y.iter().map(|v| v - first).sum::<f64>() / y.len() as f64
}

/// The value below which a part `u` of sorted values lies, linear between them (Hyndman and Fan 1996, definition 7).
fn sorted_quantile(sorted: &[f64], u: f64) -> f64 {
    let place = u * sorted.len().saturating_sub(1) as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}
