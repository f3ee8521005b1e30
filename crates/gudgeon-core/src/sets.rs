//! Parameter sets: named groups of values that a table of a case may take over, each value with its source or marked as assumed.
//!
//! A specification says in its schema which sets it has; nothing else knows of them:
//!
//! ```
//! use gudgeon_core::sets::Sets;
//!
//! /// An oil.
//! #[derive(serde::Deserialize, schemars::JsonSchema)]
//! #[serde(deny_unknown_fields)]
//! #[schemars(transform = Sets(r#"{ "water": { "about": "at 20 degC", "values": {
//!     "viscosity": { "value": "1.0 mPa s", "source": "kestin1978" },
//!     "smell": { "value": "none", "assumed": "who would measure it" } } } }"#))]
//! struct Oil {
//!     viscosity: String,
//!     smell: String,
//! }
//!
//! let schema = schemars::schema_for!(Oil);
//! let sets = gudgeon_core::sets::of(schema.as_value());
//! assert_eq!(sets["water"].values["viscosity"].source.as_deref(), Some("kestin1978"));
//! ```
//!
//! A case says `set = "water"` in that table. What reads cases puts the values in where the case gives none of its own, and takes the key `set`
//! away, so that the specification itself only ever sees values.

use indexmap::IndexMap;
use schemars::Schema;
use schemars::transform::Transform;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// Key of a table that names the set.
pub const SET: &str = "set";

/// Key of a schema that holds the sets of its table.
pub const X_SETS: &str = "x-sets";

/// A value of a set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetValue {
    /// As a case would say it.
    pub value: Value,
    /// Key into `REFERENCES.bib`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Where in the source, or how it follows from what the source gives.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// Why this value, where no source gives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub assumed: Option<String>,
    /// Keys that say the same in another way: where the case gives one of them, this value is left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unless: Vec<String>,
}

impl SetValue {
    /// Where the value comes from, in words.
    #[must_use]
    pub fn origin(&self) -> String {
        let known = self.source.iter().map(|s| format!("[{s}]"));
        let assumed = self.assumed.iter().map(|why| format!("assumed: {why}"));
        known.chain(self.note.clone()).chain(assumed).collect::<Vec<_>>().join(" ")
    }

    /// The value as a case says it.
    #[must_use]
    pub fn text(&self) -> String {
        self.value.as_str().map_or_else(|| self.value.to_string(), str::to_owned)
    }
}

/// A named group of values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterSet {
    /// What it describes, in one line.
    pub about: String,
    /// The values by key.
    pub values: IndexMap<String, SetValue>,
}

/// Parameter sets of a table by name.
pub type ParameterSets = IndexMap<String, ParameterSet>;

/// Gives the table of a specification parameter sets, told as JSON: `#[schemars(transform = Sets(include_str!("walther.json")))]`.
#[derive(Debug, Clone, Copy)]
pub struct Sets(pub &'static str);

impl Transform for Sets {
    /// # Panics
    /// A text that holds no sets, which is a defect of the program: texts are compiled in.
    fn transform(&mut self, schema: &mut Schema) {
        let sets: ParameterSets = match serde_json::from_str(self.0) {
            Ok(sets) => sets,
            Err(e) => panic!("parameter sets that cannot be read: {e}"),
        };
        let words: Vec<Value> =
            sets.iter().map(|(name, s)| json!({ "const": name, "description": s.about })).collect();
        let about = "Set of values, each with its source, taken where the table gives none of its own.";
        let properties = schema.ensure_object().entry("properties").or_insert_with(|| json!({}));
        if let Some(properties) = properties.as_object_mut() {
            properties.insert(SET.into(), json!({ "description": about, "oneOf": words, "default": null }));
        }
        schema.insert(X_SETS.into(), json!(sets));
    }
}

/// The sets of the table that a schema describes; none where it has none.
#[must_use]
pub fn of(schema: &Value) -> ParameterSets {
    // What [`Sets`] wrote can be read.
    schema.get(X_SETS).and_then(|s| ParameterSets::deserialize(s).ok()).unwrap_or_default()
}
