//! Studies to first order: derivatives at one point, and what they make of the spread of the inputs.
//!
//! With derivatives `dR/dp` at the medians and inputs that vary independently by deviations `σ_p`,
//!
//! ```text
//! σ_R² = Σ_p (dR/dp σ_p)²,      share of p = (dR/dp σ_p)² / σ_R²
//! ```
//!
//! which holds as far as the results are linear over the spread of the inputs. `σ_p` is half the distance of the quantiles 15.9 % and 84.1 %, which is the
//! deviation of a normal distribution.

use gudgeon_core::result::{Failure, derivative_unit};
use gudgeon_scene::gradients::input;
use gudgeon_scene::{Checked, GradientError, Progress, Stopped};
use serde::Serialize;

use super::points::Plan;
use super::table::Table;

/// Quantiles one deviation of a normal distribution below and above its mean.
pub const ONE_DEVIATION: [f64; 2] = [0.158_655_253_931_457, 0.841_344_746_068_543];

/// What a result is made of to first order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Linear {
    /// The result at the medians.
    pub value: f64,
    /// Its standard deviation to first order.
    pub deviation: f64,
    /// By input, in the order of the study.
    pub inputs: Vec<Part>,
    /// Inputs by which the result has no derivative: their part is missing.
    pub undefined: usize,
}

/// The part of one input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Part {
    /// `dR/dp σ_p`: by how much the result moves when the input rises by its deviation.
    pub effect: f64,
    /// Its part of the variance.
    pub share: f64,
}

/// Name of the column of a derivative.
fn derivative(result: &str, path: &str) -> String {
    format!("d({result})/d({path})")
}

/// Name of the column of the deviation of an input.
fn deviation(path: &str) -> String {
    format!("deviation({path})")
}

/// Whether a column is one of these, and no result.
pub fn is_auxiliary(column: &str) -> bool {
    column.starts_with("d(") || column.starts_with("deviation(")
}

/// Columns of derivatives and deviations at a point: name, value, unit.
///
/// # Errors
/// An input that is no continuous quantity, a run that failed.
pub fn columns(
    plan: &Plan,
    case: &Checked,
    set: &[String],
    results: &[String],
    tell: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Vec<(String, f64, String)>, Failure> {
    let here = case.with(set).map_err(|r| r.failure())?;
    let spread = plan.spread();
    let paths: Vec<String> = spread.iter().map(|(path, _)| path.clone()).collect();
    let found = crate::gradients::gradients(&here, &paths, results, tell).map_err(|e| failure(&e))?;
    let mut out = Vec::new();
    for (path, ends) in &spread {
        let [low, high] = ends.each_ref().map(|text| value_of(&here, path, text));
        let (low, high) = (low?, high?);
        out.push((deviation(path), 0.5 * (high.0 - low.0), high.1));
    }
    for (name, g) in &found.results {
        for (k, by) in g.by.iter().enumerate() {
            if let Some(d) = by {
                let i = &found.inputs[k];
                out.push((derivative(name, &i.path), *d, derivative_unit(&g.value.unit, &i.unit)));
            }
        }
    }
    Ok(out)
}

/// An input in its SI unit when the case says `text`.
fn value_of(case: &Checked, path: &str, text: &str) -> Result<(f64, String), Failure> {
    let changed = case.with(&[format!("{path}={text}")]).map_err(|r| r.failure())?;
    let found = input(&changed.case.resolved(), path, 0.0).map_err(|e| failure(&e))?;
    Ok((found.value, found.unit))
}

fn failure(e: &GradientError) -> Failure {
    match e {
        GradientError::Run(e) => e.failure(),
        GradientError::Input { path, .. } => {
            Failure { code: gudgeon_core::result::REFUSED.into(), message: e.to_string(), path: path.clone() }
        }
        e => Failure {
            code: gudgeon_core::result::REFUSED.into(),
            message: e.to_string(),
            path: String::new(),
        },
    }
}

/// What the row of a linear study says of a result.
///
/// # Errors
/// The point failed.
pub fn of_row(table: &Table, row: usize, result: &str, paths: &[String]) -> Result<Linear, String> {
    let at = |name: &str| table.numbers(name).and_then(|v| v.get(row).copied()).filter(|v| v.is_finite());
    let value = at(result).ok_or("the point has no result")?;
    let effects: Vec<Option<f64>> =
        paths.iter().map(|p| Some(at(&derivative(result, p))? * at(&deviation(p))?)).collect();
    let variance: f64 = effects.iter().flatten().map(|e| e * e).sum();
    let part = |e: &Option<f64>| {
        let effect = e.unwrap_or(f64::NAN);
        let share = if variance > 0.0 { effect * effect / variance } else { 0.0 };
        Part { effect, share }
    };
    Ok(Linear {
        value,
        deviation: variance.sqrt(),
        undefined: effects.iter().filter(|e| e.is_none()).count(),
        inputs: effects.iter().map(part).collect(),
    })
}
