//! Inputs by which results are differentiated, and the cases beside a case that tell what they change.

use gudgeon_case::{Loaded, advice};
use gudgeon_core::result::GradientInput;
use serde_json::Value;

use crate::error::RunError;
use crate::scene::SceneCase;

/// Part of itself by which an input is made larger. The case beside tells rates and results to rounding, so the step can be far below any corner of
/// a law, and the error of a difference goes with it.
const STEP: f64 = 1e-7;

/// Why there are no derivatives.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GradientError {
    /// The scene, its solver or this case has no derivatives of its own; differences of runs do.
    #[error("{0}")]
    NoMethod(String),
    /// An input by which nothing can be differentiated.
    #[error("`{path}` {why}")]
    Input {
        /// Its path.
        path: String,
        /// What is wrong.
        why: String,
    },
    /// A run failed.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl GradientError {
    /// As [`RunError::plain`].
    pub(crate) fn plain(self) -> Self {
        match self {
            Self::Run(e) => Self::Run(e.plain()),
            e => e,
        }
    }
}

/// A case with a higher value of one input, built.
pub struct Varied<C: SceneCase> {
    /// By how much the value is higher, in the SI unit of the input; negative where only a lower one is legal.
    pub step: f64,
    /// The case.
    pub loaded: Loaded<C>,
    /// Its sub-models.
    pub built: C::Built,
}

/// The input at `path` of a resolved case. Its step is `share` of its value.
///
/// # Errors
/// There is none, or it is no continuous quantity, or it is zero.
pub fn input(resolved: &Value, path: &str, share: f64) -> Result<GradientInput, GradientError> {
    let refuse = |why: String| GradientError::Input { path: path.to_owned(), why };
    let mut node = resolved;
    for step in path.split('.') {
        let inner = match node {
            Value::Array(items) => step.parse::<usize>().ok().and_then(|k| items.get(k)),
            Value::Object(table) => table.get(step),
            _ => None,
        };
        node = inner.ok_or_else(|| refuse(absent(node, step)))?;
    }
    let (value, unit) = number(node).map_err(&refuse)?;
    if value == 0.0 {
        return Err(refuse("is zero, so a small part of it is no step: give it a small value first".into()));
    }
    Ok(GradientInput { path: path.to_owned(), value, unit, step: share * value.abs() })
}

/// The relative step of derivatives that are followed.
pub(crate) fn followed(resolved: &Value, path: &str) -> Result<GradientInput, GradientError> {
    input(resolved, path, STEP)
}

fn absent(node: &Value, step: &str) -> String {
    let names: Vec<&str> = match node {
        Value::Object(table) => table.keys().map(String::as_str).collect(),
        _ => Vec::new(),
    };
    match node {
        Value::Array(items) => format!("is not given: there are {} elements, counted from 0", items.len()),
        _ => format!("is not given: no `{step}`. {}", advice(step, &names)),
    }
}

/// A quantity of a resolved case, in its SI unit.
fn number(node: &Value) -> Result<(f64, String), String> {
    match node {
        Value::Number(n) if n.is_f64() => Ok((n.as_f64().unwrap_or_default(), "1".into())),
        Value::Number(_) => Err("is a count: results do not depend on it continuously".into()),
        Value::String(text) => {
            let (number, unit) = text.split_once(' ').unwrap_or((text, "1"));
            let value = number.parse().map_err(|_| format!("is the word `{text}` and no quantity"))?;
            Ok((value, unit.to_owned()))
        }
        Value::Bool(_) => Err("is a switch and no quantity".into()),
        Value::Array(_) => Err("is a list: name one of its elements, counted from 0".into()),
        Value::Object(_) => Err("is a table: name one of its keys".into()),
        Value::Null => Err("is not given".into()),
    }
}

/// The `--set` argument that gives an input another value.
#[must_use]
pub fn assignment(input: &GradientInput, value: f64) -> String {
    if input.unit == "1" {
        format!("{}={value:?}", input.path)
    } else {
        format!("{}={value:?} {}", input.path, input.unit)
    }
}
