//! The scene `rig`: one sub-model on a test bench, with sweeps of any input and comparison with the values of a source.

pub mod case;
mod sweep;

use std::path::Path;
use std::time::Instant;

use gudgeon_core::kinds::{RigCtx, RigOut};
use gudgeon_core::result::{Check, RunResult};
use gudgeon_core::{BuildError, EvalError, Registry};

use crate::load::Loaded;
use crate::run::{Progress, RunError, model_use};
use case::{Expect, RigCase};

/// Everything that is wrong with a case, the changes that its sweeps and checks make included.
#[must_use]
pub fn legal(loaded: &Loaded<RigCase>) -> Vec<BuildError> {
    let (case, folder) = (&loaded.value, &loaded.source.folder);
    let mut errors: Vec<BuildError> = match case.rig.build(&RigCtx { folder }) {
        Ok(_) => Vec::new(),
        Err(e) => e.into_iter().map(|e| e.within("rig")).collect(),
    };
    errors.extend(sweep::legal(case));
    // The file itself comes first: its mistakes would come back with every change.
    if !errors.is_empty() {
        return errors;
    }
    for (k, set) in sweep::first_values(case) {
        if let Err(e) = changed(loaded, &[set]) {
            errors.push(BuildError::at(format!("sweeps.{k}.path"), e.to_string()));
        }
    }
    for (k, c) in case.checks.iter().enumerate() {
        if let Err(e) = changed(loaded, &c.set) {
            errors.push(BuildError::at(format!("checks.{k}.set"), e.to_string()));
        }
        for (j, e) in c.expect.iter().enumerate() {
            if !(e.value.is_finite() && e.tolerance.is_finite() && e.tolerance >= 0.0) {
                errors.push(BuildError::at(
                    format!("checks.{k}.expect.{j}"),
                    "a value and a tolerance of zero or more are needed",
                ));
            }
        }
    }
    errors
}

/// The models on the bench, in the order the rig names them, the rig itself first.
#[must_use]
pub fn models(case: &RigCase) -> Vec<(&'static str, &'static str)> {
    let mut all = vec![("rig", case.rig.typetag_name())];
    for m in case.rig.models() {
        if !all.contains(&m) {
            all.push(m);
        }
    }
    all
}

/// Runs the bench once.
fn once(case: &RigCase, folder: &Path) -> Result<RigOut, RunError> {
    let refused = |e: &[BuildError]| {
        RunError::Refused(e.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    };
    let mut rig = case.rig.build(&RigCtx { folder }).map_err(|e| refused(&e))?;
    let mut out = RigOut::default();
    rig.run(&mut out).map_err(|source: EvalError| RunError::Rig { source })?;
    match out.results.iter().find(|(_, v)| !v.value.is_finite()) {
        Some((name, _)) => Err(RunError::NotANumber(name.clone())),
        None => Ok(out),
    }
}

/// Runs the bench, its sweeps and its checks.
///
/// # Errors
/// The sub-model refused, or a check names a result that the rig does not have.
pub fn run(loaded: &Loaded<RigCase>, progress: &mut dyn FnMut(Progress)) -> Result<RunResult, RunError> {
    let (case, folder) = (&loaded.value, &loaded.source.folder);
    let begin = Instant::now();
    let out = once(case, folder)?;
    let solved = begin.elapsed().as_secs_f64();
    let registry = Registry::collect();
    let mut result = RunResult {
        title: case.title.clone(),
        source: case.source.clone(),
        assumptions: case.assumptions.clone(),
        scene: "rig".into(),
        models: models(case).into_iter().map(|(k, m)| model_use(&registry, k, m)).collect(),
        results: out.results,
        balance: out.balance,
        series: out.series,
        tables: out.tables,
        figures: out.figures,
        ..RunResult::default()
    };
    result.solver.method = case.rig.typetag_name().into();
    result.solver.counters = out.counters;
    result.solver.notes = out.notes;
    result.seconds.insert("solve".into(), solved);
    sweep::run(loaded, &mut result, progress)?;
    for (k, c) in case.checks.iter().enumerate() {
        progress(Progress {
            phase: "comparing with the source".into(),
            fraction: k as f64 / case.checks.len() as f64,
        });
        let changed = if c.set.is_empty() { None } else { Some(variant(loaded, &c.set)?) };
        let results = changed.as_ref().map_or(&result.results, |o| &o.results);
        let mut rows = Vec::new();
        for e in &c.expect {
            rows.push(check(e, &c.set, results)?);
        }
        result.checks.extend(rows);
    }
    Ok(result)
}

/// The case with some values changed.
fn changed(loaded: &Loaded<RigCase>, set: &[String]) -> Result<Loaded<RigCase>, RunError> {
    loaded.reload(set).map_err(|report| {
        RunError::Refused(format!(
            "{}: {}",
            set.join(", "),
            report.diagnostics.iter().map(|d| d.headline()).collect::<Vec<_>>().join("; ")
        ))
    })
}

/// The bench with some values changed.
fn variant(loaded: &Loaded<RigCase>, set: &[String]) -> Result<RigOut, RunError> {
    once(&changed(loaded, set)?.value, &loaded.source.folder)
}

fn check(
    e: &Expect,
    set: &[String],
    results: &indexmap::IndexMap<String, gudgeon_core::result::Value>,
) -> Result<Check, RunError> {
    let name = e.result.as_str();
    let Some(v) = results.get(name) else {
        let known: Vec<&str> = results.keys().map(String::as_str).collect();
        let near = crate::load::advice(name, &known);
        return Err(RunError::Refused(format!(
            "a check names the result `{name}`, which this rig does not have; {near}"
        )));
    };
    Ok(Check {
        set: set.to_vec(),
        result: name.to_owned(),
        value: v.value,
        reference: e.value,
        unit: v.unit.clone(),
        tolerance: e.tolerance,
        source: e.source.clone(),
        must_fail: e.must_fail,
    })
}
