//! What a case of the scene `power_cylinder` may say.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::{CheckCase, SceneName};
use crate::sweep::Sweep;

/// Rings and skirt of one cylinder, each as a case of its own, driven by the same crank and the same gas.
///
/// The ring pack's case says engine speed, bore, crank, rod, piston motion and cylinder pressure; the skirt's case takes them from there,
/// whatever its file says.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PowerCylinderCase {
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
    /// The rings.
    pub ring_pack: Part,
    /// The skirt.
    pub piston_secondary: Part,
    /// Inputs that are varied, one or two: every combination is run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sweeps: Vec<Sweep>,
    /// Results of a source to compare with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub checks: Vec<CheckCase>,
}

/// A part of the cylinder.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// Case file, in the folder of this case.
    pub case: String,
    /// Changes to it, as `--set` takes them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
}
