//! What a case of the scene `rig` may say.

use gudgeon_core::kinds::RigSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// One sub-model under prescribed conditions.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigCase {
    /// What is simulated.
    pub scene: SceneName,
    /// One line for reports.
    #[serde(default)]
    pub title: String,
    /// Where the case comes from.
    #[serde(default)]
    pub source: String,
    /// Inputs that no source gives and that were assumed, one sentence each. Reports show them.
    #[serde(default)]
    pub assumptions: Vec<String>,
    /// The bench: `model` names it, its other keys are the sub-model and the conditions.
    pub rig: Box<dyn RigSpec>,
    /// Inputs that are varied, one or two: every combination is run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sweeps: Vec<Sweep>,
    /// Results of a source to compare with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checks: Vec<CheckCase>,
}

/// Scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SceneName {
    /// One sub-model on a test bench.
    Rig,
}

/// One varied input. Give `values`, or `from`, `to` and `points`.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Path of the input, `rig.speed` or `rig.film.model`.
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
    pub points: u32,
    /// How they are spaced.
    #[serde(default)]
    pub spacing: Spacing,
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

/// A setting and the results that a source gives for it.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CheckCase {
    /// Changes to the case, as `--set` takes them; empty: the case as it stands.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// Expected results.
    pub expect: Vec<Expect>,
}

/// A result of a source.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Name of the result.
    pub result: String,
    /// The value, in the unit of the result.
    pub value: f64,
    /// Admitted deviation: relative, or absolute when the value is zero.
    pub tolerance: f64,
    /// Where the value comes from, and why the tolerance is what it is.
    pub source: String,
    /// The model is known to be wrong here, and the case shows it: the deviation must be *larger* than `tolerance`.
    #[serde(default)]
    pub must_fail: bool,
}
