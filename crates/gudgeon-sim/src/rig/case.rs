//! What a case of the scene `rig` may say.

use gudgeon_core::kinds::RigSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::{CheckCase, SceneName};
use crate::sweep::Sweep;

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
