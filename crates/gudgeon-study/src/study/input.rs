//! An input that a study varies.

use gudgeon_core::BuildError;
use gudgeon_scene::{Axis, Spacing};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::distribution::Distribution;

/// One varied input. Give `values`, or `from` and `to` (with `points` on a grid), or a `distribution`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// The input, and its values on a grid; in a design `values` are equally likely, or everything between `from` and `to` is.
    #[serde(flatten)]
    pub axis: Axis,
    /// In a design: how the input is distributed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distribution: Option<Distribution<String>>,
}

/// Where a design takes an input: quantiles to texts.
#[derive(Debug, Clone)]
pub enum Quantiles {
    /// A number and the unit behind it.
    Number(Distribution, String),
    /// One of some texts.
    Choice(Distribution<String>),
}

impl Quantiles {
    /// The value at the quantile `u`, 0 < u < 1, as a case would write it.
    #[must_use]
    pub fn text(&self, u: f64) -> String {
        match self {
            Self::Number(d, unit) => with_unit(d.quantile(u), unit),
            Self::Choice(d) => match d {
                Distribution::Discrete { values, .. } => {
                    d.choice(u).and_then(|k| values.get(k)).cloned().unwrap_or_default()
                }
                _ => String::new(),
            },
        }
    }
}

/// `1.5` and `um` as `1.5 um`, with all digits.
pub fn with_unit(value: f64, unit: &str) -> String {
    if unit.is_empty() { format!("{value}") } else { format!("{value} {unit}") }
}

impl Input {
    /// The values of a grid.
    ///
    /// # Errors
    /// Values that are given twice or not at all; a distribution, which is for designs.
    pub fn grid(&self) -> Result<Vec<String>, BuildError> {
        if self.distribution.is_some() {
            let e = BuildError::at("distribution", "a grid has `values`, or `from`, `to` and `points`");
            return Err(e.help("say in a table `design` where a distribution is taken: `method = \"latin_hypercube\"`, `points = 100`"));
        }
        gudgeon_scene::values(&self.axis)
    }

    /// What a design takes its quantiles from.
    ///
    /// # Errors
    /// Nothing or two things said; numbers that make no distribution, at their keys.
    pub fn quantiles(&self) -> Result<Quantiles, BuildError> {
        let Axis { values, from, to, spacing, .. } = &self.axis;
        let ends = !from.is_empty() || !to.is_empty();
        match (&self.distribution, values.is_empty(), ends) {
            (Some(d), true, false) => of_texts(d).map_err(|e| e.within("distribution")),
            (None, false, false) => {
                Ok(Quantiles::Choice(Distribution::Discrete { values: values.clone(), weights: Vec::new() }))
            }
            (None, true, true) => {
                let (from, to) = (from.clone(), to.clone());
                of_texts(&match spacing {
                    Spacing::Linear => Distribution::Uniform { from, to },
                    Spacing::Log => Distribution::LogUniform { from, to },
                })
            }
            _ => Err(BuildError::new(
                "a design needs one of `values`, `from` and `to`, or `distribution` for each input",
            )),
        }
    }
}

/// A distribution of texts of one unit as one of numbers.
fn of_texts(d: &Distribution<String>) -> Result<Quantiles, BuildError> {
    if matches!(d, Distribution::Discrete { .. }) {
        // Only the weights are to be checked: values may be words.
        let places = d.try_map(|_, _| Ok::<_, BuildError>(0.0))?;
        places.check()?;
        return Ok(Quantiles::Choice(d.clone()));
    }
    let mut unit: Option<String> = None;
    let numbers = d.try_map(|key, text| {
        let Some((value, own)) = gudgeon_scene::number(text) else {
            let e = BuildError::at(key, format!("`{text}` is not a number with a unit"));
            return Err(e.help("for example `from = \"0.5 mm\"`"));
        };
        match &unit {
            Some(first) if first != own => Err(BuildError::at(
                key,
                format!("all numbers must have the same unit, not `{first}` and `{own}`"),
            )),
            _ => {
                unit = Some(own.to_owned());
                Ok(value)
            }
        }
    })?;
    numbers.check()?;
    Ok(Quantiles::Number(numbers, unit.unwrap_or_default()))
}
