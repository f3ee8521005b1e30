//! Inputs that a case varies.

use gudgeon_core::BuildError;
use gudgeon_core::quantity::with_decimal_point;
use gudgeon_numerics::elementary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A varied input and the values it takes: `values`, or `points` values between `from` and `to`.
#[derive(Debug, Clone, Default, Serialize, Deserialize, JsonSchema)]
pub struct Axis {
    /// Path of the input, `rig.speed` or `models.oil.model`.
    pub path: String,
    /// The values as a case would write them: `["1 um", "2 um"]`, `["complementarity", "elrod_adams"]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<String>,
    /// First value, with its unit.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub from: String,
    /// Last value, in the same unit.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub to: String,
    /// Number of values between `from` and `to`, both included.
    #[serde(default)]
    #[schemars(range(max = 100_000))]
    pub points: u32,
    /// How they are spaced.
    #[serde(default)]
    pub spacing: Spacing,
}

/// One varied input. Give `values`, or `from`, `to` and `points`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// The input and its values.
    #[serde(flatten)]
    pub axis: Axis,
    /// Results that the report draws over the sweep; empty: the first six.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub results: Vec<String>,
}

/// Spacing of the values of a sweep.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// Equal steps.
    #[default]
    Linear,
    /// Equal ratios.
    Log,
}

/// Most runs of one sweep: at a millisecond each, a minute and a half.
const MOST: usize = 100_000;

/// `"1.5 um"` as 1.5 and `um`; `"3"` as 3 and nothing.
#[must_use]
pub fn number(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let (value, unit) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    value.parse::<f64>().ok().filter(|v| v.is_finite()).map(|v| (v, unit.trim()))
}

/// The values of an input as a case would write them.
///
/// # Errors
/// Values that are given twice or not at all, ends that are no numbers of one unit.
pub fn values(s: &Axis) -> Result<Vec<String>, BuildError> {
    let ends = !s.from.is_empty() || !s.to.is_empty() || s.points != 0;
    if !s.values.is_empty() {
        return if ends {
            Err(BuildError::at("values", "a sweep has `values` or `from`, `to` and `points`, not both"))
        } else {
            Ok(s.values.clone())
        };
    }
    let (Some((a, unit)), Some((b, unit_b))) = (number(&s.from), number(&s.to)) else {
        let (field, text) = if number(&s.from).is_none() { ("from", &s.from) } else { ("to", &s.to) };
        if let Some(pointed) = with_decimal_point(text) {
            return Err(BuildError::at(field, format!("`{text}` is not a number with a unit"))
                .help(format!("the decimal mark is a point: `\"{pointed}\"`")));
        }
        return Err(BuildError::at(field, "a sweep needs `values`, or `from` and `to` with a number each")
            .help("for example `from = \"1 um\"`, `to = \"10 um\"`, `points = 10`"));
    };
    if unit != unit_b {
        return Err(BuildError::at(
            "to",
            format!("`from` and `to` must have the same unit, not `{unit}` and `{unit_b}`"),
        ));
    }
    let n = s.points as usize;
    if !(2..=MOST).contains(&n) {
        return Err(BuildError::at("points", format!("a sweep has 2 to {MOST} points, not {n}")));
    }
    if s.spacing == Spacing::Log && a * b <= 0.0 {
        return Err(BuildError::at("spacing", "equal ratios need two values of the same sign, neither zero"));
    }
    let at = |k: usize| {
        let f = k as f64 / (n - 1) as f64;
        match s.spacing {
            _ if k == 0 => a,
            _ if k == n - 1 => b,
            Spacing::Linear => a + f * (b - a),
            Spacing::Log => a * elementary::powf(b / a, f),
        }
    };
    Ok((0..n)
        .map(|k| if unit.is_empty() { format!("{}", at(k)) } else { format!("{} {unit}", at(k)) })
        .collect())
}

/// What is wrong with the sweeps of a case.
pub fn legal(sweeps: &[Sweep]) -> Vec<BuildError> {
    let mut errors = Vec::new();
    if sweeps.len() > 2 {
        errors.push(BuildError::at(
            "sweeps.2",
            "a case has one or two sweeps; more can be run from a script with `--set`",
        ));
    }
    let mut runs = 1usize;
    for (k, s) in sweeps.iter().enumerate() {
        match values(&s.axis) {
            Ok(v) => runs = runs.saturating_mul(v.len()),
            Err(e) => errors.push(e.within(&format!("sweeps.{k}"))),
        }
    }
    if runs > MOST {
        errors.push(BuildError::at("sweeps", format!("{runs} runs are more than {MOST}")));
    }
    errors
}
