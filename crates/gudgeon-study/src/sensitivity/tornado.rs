//! Tornado: how far each input alone moves a result.

use serde::Serialize;

use super::{NoFigure, of_points};
use crate::sampling::{OneAtATime, Points};

/// What one input does alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Swing {
    /// Number of the input, from 0.
    pub input: usize,
    /// Result at its low quantile; none where that point failed.
    pub low: Option<f64>,
    /// Result at its high quantile; none where that point failed.
    pub high: Option<f64>,
    /// How far the results at the middle, the low and the high quantile lie apart, of those that there are.
    pub range: f64,
}

/// A result at the middle, and how far each input moves it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tornado {
    /// The result with all inputs at their medians; none where that point failed.
    pub middle: Option<f64>,
    /// The inputs, the widest first; equally wide ones in the order of the inputs.
    pub swings: Vec<Swing>,
    /// Points that failed.
    pub failed: usize,
}

/// Swings of a result, from the results of a design's points in their order. A failed point is left open; the range of its input is that of
/// what is there.
///
/// # Errors
/// Results of another number than points; no point has a result.
pub fn tornado(design: &OneAtATime, results: &[f64]) -> Result<Tornado, NoFigure> {
    of_points(design.len(), results.len())?;
    let value = |k: usize| Some(results[k]).filter(|v| v.is_finite());
    let failed = results.iter().filter(|v| !v.is_finite()).count();
    if failed == results.len() {
        return Err(NoFigure::TooFew { left: 0, of: results.len(), needed: 1 });
    }
    let mut swings: Vec<Swing> = (0..design.dimensions())
        .map(|input| {
            let (low, high) = (value(2 * input + 1), value(2 * input + 2));
            let there = || [value(0), low, high].into_iter().flatten();
            let range = there().fold(f64::NEG_INFINITY, f64::max) - there().fold(f64::INFINITY, f64::min);
            Swing { input, low, high, range: range.max(0.0) }
        })
        .collect();
    swings.sort_by(|a, b| b.range.total_cmp(&a.range));
    Ok(Tornado { middle: value(0), swings, failed })
}
