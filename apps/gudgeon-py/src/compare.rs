//! Combinations of models and settings, and which of them matter.

use std::sync::Arc;

use gudgeon_core::result::ShareTable;
use gudgeon_scene::Checked;
use gudgeon_study::{Plan, StudyError, Subject, compare_cases};
use pyo3::prelude::*;
use serde_json::{Value, json, to_value};

use crate::case::Case;
use crate::errors::{failed, refused, stopped};
use crate::interrupt::Watch;
use crate::many::{Rows, of_variants};
use crate::values::to_python;

/// What is compared: a path with its values, each as a case would write it.
type Swap = (String, Vec<String>);

/// Runs every combination of `swaps` on every case: the rows, the names of the cases, and the tables of shares.
#[pyfunction]
#[pyo3(signature = (cases, swaps, verify, results, threads, progress))]
pub fn compare(
    py: Python<'_>,
    cases: Vec<PyRef<'_, Case>>,
    swaps: Vec<Swap>,
    verify: bool,
    results: Vec<String>,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Rows, Vec<String>, Py<PyAny>)> {
    let plan =
        Plan { cases: subjects(&cases), swaps, verify, headlines: results, results_only: true, threads };
    let mut watch = Watch::new(progress);
    let outcome = py.detach(|| compare_cases(&plan, &mut |p| watch.tell(p)));
    watch.end()?;
    let compared = outcome.map_err(|e| match e {
        StudyError::Input(report) => refused(py, &report),
        StudyError::Run(e) => failed(e.failure()),
        _ => stopped(),
    })?;
    let names = compared.cases.into_iter().map(|c| c.name).collect();
    let shares: Vec<Value> = compared.shares.iter().map(table).collect();
    Ok((of_variants(compared.variants), names, to_python(py, &shares.into())?))
}

/// The cases, each with the changes that not all of them have, as a person writes them: without quotes.
fn subjects(cases: &[PyRef<'_, Case>]) -> Vec<Subject> {
    let all: Vec<&Arc<Checked>> = cases.iter().map(|c| c.checked()).collect();
    let common = |set: &String| all.iter().all(|c| c.case.overrides().contains(set));
    let own = |c: &&Arc<Checked>| {
        c.case.overrides().iter().filter(|set| !common(set)).map(|set| set.replace('"', "")).collect()
    };
    all.iter().map(|c| Subject { case: Arc::clone(c), own: own(c) }).collect()
}

/// A table of shares with the names of its effects.
fn table(t: &ShareTable) -> Value {
    let effects: Vec<String> = (0..t.effects.len()).map(|k| t.effect(k)).collect();
    json!({
        "case": t.case, "effects": effects, "rows": to_value(&t.rows).unwrap_or_default(),
        "verified": t.verified, "findings": t.findings,
    })
}
