//! What a case would do: models, what runs and what is skipped, every value.

use gudgeon_case::UsedSet;
use gudgeon_core::Registry;
use gudgeon_core::result::{ModelUse, Skipped};
use serde::Serialize;

/// A model with the references of its registration.
#[must_use]
pub fn model_use(registry: &Registry, kind: &str, model: &str) -> ModelUse {
    ModelUse {
        kind: kind.into(),
        model: model.into(),
        references: registry
            .model(kind, model)
            .map(|m| m.references.iter().map(|r| (*r).to_owned()).collect())
            .unwrap_or_default(),
    }
}

/// One model in an [`Explanation`].
#[derive(Debug, Clone, Serialize)]
pub struct ExplainedModel {
    /// Kind and name.
    #[serde(rename = "model")]
    pub used: ModelUse,
    /// One line.
    pub summary: String,
    /// Governing equations.
    pub equations: String,
    /// Where it holds.
    pub validity: String,
}

/// The resolved case: every model, default and unit; what runs and what is skipped.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Explanation {
    /// Name of the case.
    pub case: String,
    /// Title.
    pub title: String,
    /// Every value, defaults filled in, SI units.
    pub resolved: serde_json::Value,
    /// Models that run.
    pub models: Vec<ExplainedModel>,
    /// Parameter sets that the case names.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub sets: Vec<UsedSet>,
    /// What runs, and why.
    pub runs: Vec<Skipped>,
    /// What is left out, and why.
    pub skipped: Vec<Skipped>,
    /// Wanted results.
    pub results: Vec<String>,
    /// Floors, caps and drags: key, value, reason.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub limits: Vec<(String, String, String)>,
    /// Names of the states that are integrated.
    pub states: Vec<String>,
    /// Notes.
    pub notes: Vec<String>,
}

impl Explanation {
    /// As text for a person.
    #[must_use]
    pub fn to_text(&self) -> String {
        use std::fmt::Write as _;
        let mut s = String::new();
        // Writing to a String cannot fail.
        let _ = writeln!(s, "{}: {}\n", self.case, self.title);
        let _ = writeln!(s, "Models");
        for m in &self.models {
            let _ = writeln!(s, "  {:<18} {}", m.used.kind, m.used.model);
            let _ = writeln!(s, "  {:<18}   {}", "", m.summary);
            for line in m.equations.split(";  ") {
                let _ = writeln!(s, "  {:<18}     {}", "", line.trim());
            }
            if !m.used.references.is_empty() {
                let _ = writeln!(s, "  {:<18}   [{}]", "", m.used.references.join(", "));
            }
        }
        if !self.sets.is_empty() {
            let _ = writeln!(s, "\nParameter sets");
        }
        for set in &self.sets {
            let _ = writeln!(s, "  {} = \"{}\": {}", set.path, set.name, set.about);
            for (key, v) in &set.taken {
                let _ = writeln!(s, "    {key} = {}  {}", v.text(), v.origin());
            }
            if !set.own.is_empty() {
                let _ = writeln!(s, "    values of the case instead: {}", set.own.join(", "));
            }
        }
        let _ = writeln!(s, "\nRuns");
        for r in &self.runs {
            let _ = writeln!(s, "  {}: {}", r.what, r.why);
        }
        let _ = writeln!(s, "\nSkipped");
        if self.skipped.is_empty() {
            let _ = writeln!(s, "  nothing");
        }
        for r in &self.skipped {
            let _ = writeln!(s, "  {}: {}", r.what, r.why);
        }
        if !self.limits.is_empty() {
            let _ = writeln!(s, "\nFloors, caps and drags (what acts in a run is noted)");
            for (key, value, reason) in &self.limits {
                let _ = writeln!(s, "  {key} = {value}\n      {reason}");
            }
        }
        if !self.states.is_empty() {
            let _ = writeln!(s, "\nStates integrated ({}): {}", self.states.len(), self.states.join(", "));
        }
        if !self.results.is_empty() {
            let _ = writeln!(s, "Results: {}", self.results.join(", "));
        }
        for n in &self.notes {
            let _ = writeln!(s, "Note: {n}");
        }
        let _ = writeln!(s, "\nResolved case (SI units, defaults filled in)");
        print_value(&mut s, "", &self.resolved);
        s
    }
}

/// Flat `path = value` lines.
fn print_value(s: &mut String, path: &str, v: &serde_json::Value) {
    use std::fmt::Write as _;
    let join = |k: &str| if path.is_empty() { k.to_owned() } else { format!("{path}.{k}") };
    match v {
        serde_json::Value::Object(o) if !o.is_empty() => {
            for (k, v) in o {
                print_value(s, &join(k), v);
            }
        }
        serde_json::Value::Array(a) if a.iter().any(|v| v.is_object()) => {
            for (k, v) in a.iter().enumerate() {
                print_value(s, &join(&k.to_string()), v);
            }
        }
        v => {
            let _ = writeln!(s, "  {path} = {v}");
        }
    }
}
