//! Bands of results from bands on inputs.

use serde::Serialize;

use super::{NoFigure, Used, mean, sorted_quantile};

/// How a result is spread over the points of a sample.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Band {
    /// Mean.
    pub mean: f64,
    /// Standard deviation, with `n - 1`; 0 of one point.
    pub deviation: f64,
    /// Quantiles 5 %, 50 % and 95 %, linear between the points.
    pub quantiles: [f64; 3],
    /// Smallest result.
    pub min: f64,
    /// Largest result.
    pub max: f64,
    /// Points.
    #[serde(flatten)]
    pub points: Used,
}

/// The band of a result over points that are equally likely (Latin hypercube, Sobol sequence). Failed points are left out: where what fails
/// lies at one side, the band is that of the rest.
///
/// # Errors
/// No point has a result.
pub fn band(results: &[f64]) -> Result<Band, NoFigure> {
    let mut y: Vec<f64> = results.iter().copied().filter(|v| v.is_finite()).collect();
    let points = Used { used: y.len(), left_out: results.len() - y.len() };
    y.sort_by(f64::total_cmp);
    let (Some(min), Some(max)) = (y.first().copied(), y.last().copied()) else {
        return Err(NoFigure::TooFew { left: 0, of: results.len(), needed: 1 });
    };
    let mean = mean(&y);
    let squares: f64 = y.iter().map(|v| (v - mean) * (v - mean)).sum();
    let deviation = (squares / y.len().saturating_sub(1).max(1) as f64).sqrt();
    let quantiles = [0.05, 0.5, 0.95].map(|u| sorted_quantile(&y, u));
    Ok(Band { mean, deviation, quantiles, min, max, points })
}
