//! The study file: what is varied, and how.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::input::Input;
use crate::sampling::Design;

/// A study, as its TOML file says it.
///
/// ```toml
/// cases = ["turbo-diesel-120.toml"]
/// results = ["blow_by", "friction_power"]
///
/// [[inputs]]
/// path = "engine.speed"
/// from = "1000 rpm"
/// to = "2600 rpm"
/// points = 9
///
/// [[inputs]]
/// path = "models.gas_flow.model"
/// values = ["orifice_network", "narrow_channel"]
/// ```
///
/// Points are numbered; the last input runs fastest, then those before it, then the rows of `list`, then the cases.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// One line for reports.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// Case files, relative to the folder of this file. Several are an axis like any other.
    #[schemars(length(min = 1))]
    pub cases: Vec<Case>,
    /// Changes to every case, as `--set` takes them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// Results that are kept; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub results: Vec<String>,
    /// Columns of the series that are kept, such as `ring1.h_min`; empty: none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<String>,
    /// A CSV file of points that belong together, relative to the folder of this file: a column an input, `engine.speed [rpm]`, a row a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub list: Option<String>,
    /// Inputs that are varied.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<Input>,
    /// Where the inputs are taken: on a grid of all their values when nothing is said.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub design: Option<Design>,
    /// Points of one part file; 0: so that there are some 250 parts, of 16 to 4096 points each.
    #[serde(default)]
    #[schemars(range(max = 100_000))]
    pub part: usize,
}

/// A case of a study.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Case {
    /// A file.
    File(String),
    /// A file with changes of its own.
    Changed(Changed),
}

/// A case with changes of its own.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Changed {
    /// The file, relative to the folder of the study file.
    pub file: String,
    /// What the table calls it; the name of the file without its extension when nothing is said.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Changes to this case, as `--set` takes them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
}

impl Case {
    /// File, name and changes.
    #[must_use]
    pub fn parts(&self) -> (&str, &str, &[String]) {
        let (file, name, set): (&str, &str, &[String]) = match self {
            Self::File(file) => (file, "", &[]),
            Self::Changed(c) => (&c.file, &c.name, &c.set),
        };
        let stem = || {
            let last = file.rsplit('/').next().unwrap_or(file);
            last.strip_suffix(".toml").unwrap_or(last)
        };
        (file, if name.is_empty() { stem() } else { name }, set)
    }
}
