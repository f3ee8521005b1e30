//! Derivatives of results by inputs.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::{Note, Value};

/// Derivatives of the results of one case by some of its inputs.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Gradients {
    /// How they were found.
    pub method: String,
    /// The inputs.
    pub inputs: Vec<GradientInput>,
    /// The results with their derivatives, in the order of the scene.
    pub results: IndexMap<String, Gradient>,
    /// Work, by name.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub counters: IndexMap<String, u64>,
    /// What a person who relies on the derivatives must know.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<Note>,
}

/// An input by which results are differentiated.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct GradientInput {
    /// Its path in the case.
    pub path: String,
    /// Its value, in `unit`.
    pub value: f64,
    /// SI unit of the value; `1` for a plain number.
    pub unit: String,
    /// By how much it was made smaller and larger to see what it changes, in `unit`.
    pub step: f64,
}

/// A result and its derivatives.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Gradient {
    /// The result.
    pub value: Value,
    /// Its derivative by each input, in the unit of the result over the unit of the input; none where it has a corner, or jumps.
    pub by: Vec<Option<f64>>,
}

/// Part by which the derivatives of a result on both sides of an input may differ before it counts as a corner.
const CORNER: f64 = 0.05;
/// Part of a result by which the differences on both sides may differ whatever they are: curvature and the error of runs near a place where the
/// result hardly depends on the input.
const FLAT: f64 = 1e-5;

impl Gradient {
    /// A result without derivatives yet.
    #[must_use]
    pub const fn new(value: Value) -> Self {
        Self { value, by: Vec::new() }
    }

    /// Adds the central difference between what the result is with the next input `step` lower and `step` higher, unless the differences on
    /// either side tell of a corner, a jump or a count.
    pub fn difference(&mut self, low: f64, high: f64, step: f64) {
        let (below, above) = (self.value.value - low, high - self.value.value);
        let flat = FLAT * self.value.value.abs().max(low.abs()).max(high.abs());
        let smooth = (above - below).abs() <= CORNER * above.abs().max(below.abs()) + flat;
        self.by.push(smooth.then_some(0.5 * (high - low) / step));
    }
}

/// Unit of the derivative of a result by an input, from theirs. Quotients, and an input with several units, stand in brackets: `(l/min)/m`, `g/(N/m)`.
#[must_use]
pub fn derivative_unit(result: &str, input: &str) -> String {
    let within = |unit: &str, marks: &[char]| match unit {
        "" => "1".to_owned(),
        u if u.contains(marks) => format!("({u})"),
        u => u.to_owned(),
    };
    match input {
        "" | "1" if result.is_empty() => "1".to_owned(),
        "" | "1" => result.to_owned(),
        _ => format!("{}/{}", within(result, &['/']), within(input, &['/', ' '])),
    }
}

impl Gradients {
    /// Unit of the derivative of a result by input `k`.
    #[must_use]
    pub fn unit(&self, result: &str, k: usize) -> Option<String> {
        Some(derivative_unit(&self.results.get(result)?.value.unit, &self.inputs.get(k)?.unit))
    }

    /// By how much of itself a result changes when input `k` changes by a part of itself, `p/R dR/dp`.
    #[must_use]
    pub fn elasticity(&self, result: &str, k: usize) -> Option<f64> {
        let (gradient, input) = (self.results.get(result)?, self.inputs.get(k)?);
        let value = gradient.value.value;
        gradient.by.get(k).copied().flatten().filter(|_| value != 0.0).map(|d| d * input.value / value)
    }

    /// Adds derivatives by more inputs of the same results.
    pub fn extend(&mut self, other: Self) {
        let before = self.inputs.len();
        self.inputs.extend(other.inputs);
        for (name, gradient) in &mut self.results {
            let more = other.results.get(name).map_or(&[][..], |g| &g.by);
            gradient.by.resize(before, None);
            gradient.by.extend(more);
            gradient.by.resize(self.inputs.len(), None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_derivatives_have_one_reading() {
        for (result, input, wanted) in [
            ("l/min", "m", "(l/min)/m"),
            ("g", "m", "g/m"),
            ("g", "N/m", "g/(N/m)"),
            ("l/min", "Pa s", "(l/min)/(Pa s)"),
            ("N m", "K", "N m/K"),
            ("kW", "1", "kW"),
            ("1", "m", "1/m"),
            ("", "m", "1/m"),
            ("", "", "1"),
        ] {
            assert_eq!(derivative_unit(result, input), wanted);
        }
    }
}
