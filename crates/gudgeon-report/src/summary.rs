//! `summary.json` as a type of its own: it is read back to rebuild a page, and its shape is a promise to other programs.

use gudgeon_core::result::{Figure, Headline, Note, Provenance, Refined, RunResult, Verification};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// A result. `value` is null when the number is not finite, which a run should have refused before.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct ResultValue {
    pub value: Option<f64>,
    pub unit: String,
    /// Numerical uncertainty, where it was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub uncertainty: Option<f64>,
}

impl From<&gudgeon_core::result::Value> for ResultValue {
    fn from(v: &gudgeon_core::result::Value) -> Self {
        Self { value: Some(v.value).filter(|v| v.is_finite()), unit: v.unit.clone(), uncertainty: None }
    }
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct ModelEntry {
    pub kind: String,
    pub model: String,
    #[serde(default)]
    pub references: Vec<String>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct SkippedEntry {
    pub what: String,
    pub why: String,
}

#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct BalanceSheet {
    pub gas_mass: Option<f64>,
    pub oil_mass: Option<f64>,
    #[serde(default)]
    pub flank_oil: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skirt_oil: Option<f64>,
    pub energy: Option<f64>,
    pub momentum: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gas_energy: Option<f64>,
}

#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct SolverEntry {
    #[serde(default)]
    pub method: String,
    #[serde(default)]
    pub counters: IndexMap<String, u64>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct EventEntry {
    pub theta_deg: f64,
    pub subject: String,
    pub what: String,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct BranchEntry {
    pub start: String,
    pub period: u32,
    pub results: IndexMap<String, ResultValue>,
}

/// The keys of `summary.json`, in their order. Everything from `title` on is an addition to the fixed shape.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct Summary {
    pub case: String,
    pub gudgeon: String,
    #[serde(default)]
    pub models: Vec<ModelEntry>,
    #[serde(default)]
    pub skipped: Vec<SkippedEntry>,
    #[serde(default)]
    pub results: IndexMap<String, ResultValue>,
    #[serde(default)]
    pub balance: BalanceSheet,
    #[serde(default)]
    pub solver: SolverEntry,
    /// What a person who relies on the results must know.
    #[serde(default)]
    pub notes: Vec<Note>,
    #[serde(default)]
    pub title: String,
    #[serde(default)]
    pub source: String,
    #[serde(default)]
    pub assumptions: Vec<String>,
    #[serde(default)]
    pub scene: String,
    /// What each result is, by its name.
    #[serde(default)]
    pub descriptions: IndexMap<String, String>,
    #[serde(default)]
    pub events: Vec<EventEntry>,
    #[serde(default)]
    pub branches: Vec<BranchEntry>,
    /// Geometry for the drawn section, as the scene gave it; null when there is none.
    #[serde(default)]
    pub section: Option<serde_json::Value>,
    /// What was refined to know the uncertainties.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refined: Vec<Refined>,
    /// Names of the tables beside `series.csv`.
    #[serde(default)]
    pub tables: Vec<String>,
    #[serde(default)]
    pub figures: Vec<Figure>,
    /// Results that lead, by name.
    #[serde(default)]
    pub headlines: Vec<Headline>,
    /// Title of the figure that leads.
    #[serde(default)]
    pub lead: String,
    /// What the run was made of. Last, because it is long.
    #[serde(default)]
    pub provenance: Provenance,
}

/// Results with their uncertainties.
fn certain(
    mut results: IndexMap<String, ResultValue>,
    verification: Option<&Verification>,
) -> IndexMap<String, ResultValue> {
    for (name, u) in verification.iter().flat_map(|v| &v.uncertainty).filter(|(_, u)| u.is_finite()) {
        if let Some(r) = results.get_mut(name) {
            r.uncertainty = Some(*u);
        }
    }
    results
}

impl Summary {
    pub(crate) fn new(run: &RunResult) -> Self {
        let finite = |v: Option<f64>| v.filter(|v| v.is_finite());
        let values = |r: &IndexMap<String, gudgeon_core::result::Value>| {
            r.iter().map(|(name, v)| (name.clone(), v.into())).collect::<IndexMap<String, ResultValue>>()
        };
        Self {
            case: run.case.clone(),
            gudgeon: run.gudgeon.clone(),
            models: run
                .models
                .iter()
                .map(|m| ModelEntry {
                    kind: m.kind.clone(),
                    model: m.model.clone(),
                    references: m.references.clone(),
                })
                .collect(),
            skipped: run
                .skipped
                .iter()
                .map(|s| SkippedEntry { what: s.what.clone(), why: s.why.clone() })
                .collect(),
            results: certain(values(&run.results), run.verification.as_ref()),
            refined: run.verification.as_ref().map(|v| v.refined.clone()).unwrap_or_default(),
            balance: BalanceSheet {
                gas_mass: finite(run.balance.gas_mass),
                oil_mass: finite(run.balance.oil_mass),
                flank_oil: finite(run.balance.flank_oil),
                skirt_oil: finite(run.balance.skirt_oil),
                energy: finite(run.balance.energy),
                momentum: finite(run.balance.momentum),
                gas_energy: finite(run.balance.gas_energy),
            },
            solver: SolverEntry { method: run.solver.method.clone(), counters: run.solver.counters.clone() },
            notes: run.solver.notes.clone(),
            title: run.title.clone(),
            source: run.source.clone(),
            assumptions: run.assumptions.clone(),
            scene: run.scene.clone(),
            descriptions: run
                .results
                .iter()
                .filter(|(_, v)| !v.what.is_empty())
                .map(|(name, v)| (name.clone(), v.what.clone()))
                .collect(),
            // An event without an angle has no place on a plot or in a file.
            events: run
                .events
                .iter()
                .filter(|e| e.theta_deg.is_finite())
                .map(|e| EventEntry {
                    theta_deg: e.theta_deg,
                    subject: e.subject.clone(),
                    what: e.what.clone(),
                })
                .collect(),
            branches: run
                .branches
                .iter()
                .map(|b| BranchEntry {
                    start: b.start.clone(),
                    period: b.period,
                    results: values(&b.results),
                })
                .collect(),
            // Numbers and lists only: this cannot fail, and a page without a drawing is the right answer if it did.
            section: run.section.as_ref().and_then(|s| serde_json::to_value(s).ok()),
            tables: run.tables.keys().cloned().collect(),
            figures: run.figures.clone(),
            headlines: run.leading(),
            lead: run.lead.clone(),
            provenance: run.provenance.clone(),
        }
    }

    /// The title, or the name of the case when it has none.
    pub(crate) fn heading(&self) -> &str {
        if self.title.trim().is_empty() { &self.case } else { &self.title }
    }
}
