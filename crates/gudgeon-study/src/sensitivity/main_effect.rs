//! Main effects from any sample: the mean of a result over one input, whatever the others are.

use serde::Serialize;

use super::{NoFigure, mean, of_points};

/// A part of an input's range.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Bin {
    /// Mean coordinate of its points, 0 to 1.
    pub u: f64,
    /// Mean result of its points.
    pub mean: f64,
    /// Its points.
    pub points: usize,
}

/// How the mean of a result goes along an input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MainEffect {
    /// Means over parts with equally many points, from low to high quantiles of the input.
    pub bins: Vec<Bin>,
    /// Largest mean less smallest mean.
    pub range: f64,
    /// Share of the variance of the result that the means explain: an estimate of the first-order Sobol index. It is corrected for the
    /// scatter of means of random points, so it may come out slightly below 0 for an input without effect.
    pub share: f64,
    /// Points that failed, left out.
    pub left_out: usize,
}

/// Fewest points of a bin: with fewer its mean says little.
const LEAST: usize = 5;
/// Most bins; finer ones would follow the scatter.
const MOST: usize = 20;

/// Main effect of every input over a sample of equally likely points (Latin hypercube, Sobol sequence), `points[k]` with `results[k]`.
///
/// An input's points are sorted and cut into `min(20, √n)` parts. The share is `1 - (1 - η²)(n - 1)/(n - b)` with the correlation ratio
/// `η²` of `b` parts (Kelley, Proc. Nat. Acad. Sci. 21 (1935) 554-559). Failed points are left out.
///
/// # Errors
/// Fewer than ten results; all of them equal.
pub fn main_effects(points: &[Vec<f64>], results: &[f64]) -> Result<Vec<MainEffect>, NoFigure> {
    of_points(points.len(), results.len())?;
    let good: Vec<usize> = (0..results.len()).filter(|k| results[*k].is_finite()).collect();
    if good.len() < 2 * LEAST {
        return Err(NoFigure::TooFew { left: good.len(), of: results.len(), needed: 2 * LEAST });
    }
    let y: Vec<f64> = good.iter().map(|k| results[*k]).collect();
    let centre = mean(&y);
    let total: f64 = y.iter().map(|v| (v - centre) * (v - centre)).sum();
    if total == 0.0 {
        return Err(NoFigure::Constant);
    }
    let bins = ((good.len() as f64).sqrt() as usize).clamp(2, MOST);
    let dimensions = points.first().map_or(0, Vec::len);
    Ok((0..dimensions)
        .map(|input| {
            let mut order = good.clone();
            order.sort_by(|a, b| points[*a][input].total_cmp(&points[*b][input]));
            let bins = cut(&order, bins, |k| points[k][input], |k| results[k]);
            let between: f64 = bins.iter().map(|b| b.points as f64 * (b.mean - centre).powi(2)).sum();
            let (n, parts) = (good.len() as f64, bins.len() as f64);
            let means = || bins.iter().map(|b| b.mean);
            MainEffect {
                range: means().fold(f64::NEG_INFINITY, f64::max) - means().fold(f64::INFINITY, f64::min),
                share: 1.0 - (1.0 - between / total) * (n - 1.0) / (n - parts),
                left_out: results.len() - good.len(),
                bins,
            }
        })
        .collect())
}

/// Cuts points in order into parts whose numbers differ by at most one.
fn cut(order: &[usize], parts: usize, u: impl Fn(usize) -> f64, y: impl Fn(usize) -> f64) -> Vec<Bin> {
    let at = |part: usize| part * order.len() / parts;
    let of = |own: &[usize], f: &dyn Fn(usize) -> f64| mean(&own.iter().map(|k| f(*k)).collect::<Vec<_>>());
    (0..parts)
        .map(|part| {
            let own = &order[at(part)..at(part + 1)];
            Bin { u: of(own, &u), mean: of(own, &y), points: own.len() }
        })
        .collect()
}
