//! Morris's measures.

use serde::Serialize;

use super::{NoFigure, Used, mean, of_points};
use crate::sampling::{Morris, Points};

/// Elementary effects of one input: change of the result by the change of the input in quantiles, so an effect of 1 means that the result
/// changes by 1 from one end of the input's range to the other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ElementaryEffects {
    /// Mean.
    pub mu: f64,
    /// Mean magnitude: how much the input matters. Campolongo, Cariboni and Saltelli, Environ. Model. Softw. 22 (2007) 1509-1518.
    pub mu_star: f64,
    /// Standard deviation, with `n - 1`: large beside `mu_star` where the effect depends on the other inputs or is nonlinear.
    pub sigma: f64,
    /// Steps.
    #[serde(flatten)]
    pub steps: Used,
}

/// Elementary effects of every input, from the results of a design's points in their order. A failed point costs the two steps that it is part
/// of.
///
/// # Errors
/// Results of another number than points; an input of which no step is left.
pub fn elementary_effects(design: &Morris, results: &[f64]) -> Result<Vec<ElementaryEffects>, NoFigure> {
    of_points(design.len(), results.len())?;
    let mut effects: Vec<Vec<f64>> = vec![Vec::new(); design.dimensions()];
    for (trajectory, y) in results.chunks(design.dimensions() + 1).enumerate() {
        for (step, input) in design.order(trajectory).into_iter().enumerate() {
            let change = if design.rises(trajectory, input) { Morris::STEP } else { -Morris::STEP };
            let effect = (y[step + 1] - y[step]) / change;
            if effect.is_finite() {
                effects[input].push(effect);
            }
        }
    }
    let of = design.trajectories();
    effects.iter().map(|all| measures(all, of)).collect()
}

fn measures(all: &[f64], of: usize) -> Result<ElementaryEffects, NoFigure> {
    if all.is_empty() {
        return Err(NoFigure::TooFew { left: 0, of, needed: 1 });
    }
    let mu = mean(all);
    let squares: f64 = all.iter().map(|e| (e - mu) * (e - mu)).sum();
    Ok(ElementaryEffects {
        mu,
        mu_star: mean(&all.iter().map(|e| e.abs()).collect::<Vec<_>>()),
        sigma: (squares / all.len().saturating_sub(1).max(1) as f64).sqrt(),
        steps: Used { used: all.len(), left_out: of - all.len() },
    })
}
