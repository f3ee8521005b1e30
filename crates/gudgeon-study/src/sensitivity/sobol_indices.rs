//! First-order and total Sobol indices.

use serde::Serialize;

use super::{NoFigure, Used, mean, of_points, sorted_quantile};
use crate::random::Stream;
use crate::sampling::{Points, Saltelli};

/// A number with the interval that resampling gives it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end of its interval of 95 %.
    pub low: f64,
    /// Upper end of its interval of 95 %.
    pub high: f64,
}

/// Indices of one input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SobolIndex {
    /// Share of the variance that the input explains alone: what fixing it would take away on average.
    pub first: Estimate,
    /// Share of the variance in which the input takes part, alone or with others: what stays when all others are fixed.
    pub total: Estimate,
    /// Rows of the design.
    #[serde(flatten)]
    pub rows: Used,
}

/// Indices of all inputs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SobolIndices {
    /// Mean of the result.
    pub mean: f64,
    /// Variance of the result.
    pub variance: f64,
    /// One a input.
    pub inputs: Vec<SobolIndex>,
    /// Points that failed.
    pub failed: usize,
}

/// How intervals are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bootstrap {
    /// Number of resamplings of the rows.
    pub resamples: usize,
    /// Another seed draws other rows.
    pub seed: u64,
}

impl Default for Bootstrap {
    fn default() -> Self {
        Self { resamples: 1000, seed: 0 }
    }
}

/// One row: results at A, B, and the mixtures.
type Row<'a> = &'a [f64];

/// Fewest rows whose resampling means something.
const LEAST: usize = 4;

/// Indices of every input, from the results of a design's points in their order.
///
/// With `f_A`, `f_B` and `f_i` the results at A, B and A with input `i` from B, their mean taken off, and `V` the variance over A and B,
///
/// ```text
/// first = mean(f_B (f_i - f_A)) / V              Saltelli et al. 2010, table 2 (b)
/// total = mean((f_A - f_i)²) / (2 V)             Jansen 1999, table 2 (f) there
/// ```
///
/// The intervals are percentiles of the bootstrap over rows; those of a Sobol sequence are cautious, because its rows are more even than
/// random ones. A row whose A or B failed is left out; one whose mixture `i` failed, for input `i` alone.
///
/// # Errors
/// Results of another number than points; fewer than four rows left for an input; a result that is the same everywhere.
pub fn sobol_indices(
    design: &Saltelli,
    results: &[f64],
    bootstrap: Bootstrap,
) -> Result<SobolIndices, NoFigure> {
    of_points(design.len(), results.len())?;
    let d = design.dimensions();
    let rows: Vec<Row<'_>> =
        results.chunks(d + 2).filter(|row| row[0].is_finite() && row[1].is_finite()).collect();
    let left = (0..d).map(|i| rows.iter().filter(|r| r[2 + i].is_finite()).count()).min().unwrap_or(0);
    if left < LEAST {
        return Err(NoFigure::TooFew { left, of: design.base(), needed: LEAST });
    }
    let (mean, variance) = moments(&rows);
    let estimates = indices(&rows, d).ok_or(NoFigure::Constant)?;
    let intervals = resampled(&rows, d, bootstrap);
    let inputs = (0..d)
        .map(|i| {
            let estimate = |k: usize| {
                let (low, high) = intervals[i][k];
                Estimate { value: estimates[i][k], low, high }
            };
            let used = rows.iter().filter(|r| r[2 + i].is_finite()).count();
            let rows = Used { used, left_out: design.base() - used };
            SobolIndex { first: estimate(0), total: estimate(1), rows }
        })
        .collect();
    let failed = results.iter().filter(|v| !v.is_finite()).count();
    Ok(SobolIndices { mean, variance, inputs, failed })
}

/// Mean and variance over A and B.
fn moments(rows: &[Row<'_>]) -> (f64, f64) {
    let both: Vec<f64> = rows.iter().flat_map(|r| [r[0], r[1]]).collect();
    let centre = mean(&both);
    let variance = both.iter().map(|v| (v - centre) * (v - centre)).sum::<f64>() / both.len().max(1) as f64;
    (centre, variance)
}

/// First and total index of every input; none where the result does not vary.
fn indices(rows: &[Row<'_>], d: usize) -> Option<Vec<[f64; 2]>> {
    let (centre, variance) = moments(rows);
    (variance > 0.0).then(|| {
        (0..d)
            .map(|i| {
                let (mut first, mut total, mut n) = (0.0, 0.0, 0);
                for r in rows.iter().filter(|r| r[2 + i].is_finite()) {
                    first += (r[1] - centre) * (r[2 + i] - r[0]);
                    total += 0.5 * (r[0] - r[2 + i]) * (r[0] - r[2 + i]);
                    n += 1;
                }
                [first, total].map(|sum| sum / (f64::from(n) * variance))
            })
            .collect()
    })
}

/// Intervals of both indices of every input. Resamples in which the result does not vary, or none of an input's rows came up, tell nothing and
/// are not counted.
fn resampled(rows: &[Row<'_>], d: usize, bootstrap: Bootstrap) -> Vec<[(f64, f64); 2]> {
    let mut found: Vec<[Vec<f64>; 2]> = vec![Default::default(); d];
    for k in 0..bootstrap.resamples {
        let mut random = Stream::new(&[bootstrap.seed, k as u64]);
        let drawn: Vec<Row<'_>> = rows.iter().map(|_| rows[random.below(rows.len())]).collect();
        for (all, own) in found.iter_mut().zip(indices(&drawn, d).unwrap_or_default()) {
            for (all, v) in all.iter_mut().zip(own) {
                all.extend(v.is_finite().then_some(v));
            }
        }
    }
    let interval = |all: &mut Vec<f64>| {
        all.sort_by(f64::total_cmp);
        if all.is_empty() {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        (sorted_quantile(all, 0.025), sorted_quantile(all, 0.975))
    };
    found.iter_mut().map(|[first, total]| [interval(first), interval(total)]).collect()
}
