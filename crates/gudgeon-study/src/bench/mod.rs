//! Work-precision: run time and work against error, of the solvers of a scene, of models that solve the same equations, of any setting.

mod findings;
mod ladder;
mod measure;
mod plan;

use gudgeon_core::result::{BenchTable, RunResult, Value};
use gudgeon_scene::run::run_alone;
use gudgeon_scene::{Checked, Progress, RunError, Stopped, Threads, foresee, unwatched, with_threads};
use indexmap::IndexMap;

use plan::Plan;

use crate::error::StudyError;

/// Runs every method at every accuracy and states errors beside run time and work.
///
/// The methods are the solvers of the scene, or the models that solve the equations of the case, or the combinations of `contenders`,
/// `(path, values)`. A method that brings no settings of its own is run along the numerical settings that the case declares, coarsened and
/// refined. Errors count from a reference by another method where there is one. Runs never overlap: their times would be wrong.
///
/// # Errors
/// A contender that is no case; nothing to race; a reference that cannot be run.
pub fn bench(
    base: &Checked,
    results: &[String],
    contenders: &[(String, Vec<String>)],
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<BenchTable, StudyError> {
    if let Some(known) = base.case.result_names() {
        foresee::all_known(results, &known).map_err(RunError::Refused)?;
    }
    let plan = Plan::new(base, contenders)?;
    progress(Progress { phase: "reference".into(), fraction: 0.0 })?;
    let tight = once(base, &plan.reference.set).map_err(RunError::Refused)?;
    progress(Progress { phase: "reference check".into(), fraction: 0.1 })?;
    let loose = once(base, &plan.reference.check).map_err(RunError::Refused)?;
    let chosen = chosen(base, &plan, results, &tight)?;
    let judge = Judge { values: values(&plan, &tight, &chosen) };
    let other = values(&plan, &loose, &chosen);
    let apart =
        |(n, v): (&String, &Value)| other.get(n).map_or(f64::INFINITY, |o| relative(o.value, v.value));
    let trusted_to = judge.values.iter().map(apart).fold(0.0, f64::max);
    let mut table = BenchTable {
        case: base.name.clone(),
        title: base.title().to_owned(),
        reference: format!("{} by at most {trusted_to:.1e} (relative)", plan.reference.is),
        independent: plan.reference.independent,
        trusted_to,
        points: measure::measure(base, &plan.points, &judge, progress)?,
        reference_values: judge.values,
        findings: plan.notes,
    };
    let found = findings::findings(&table);
    table.findings.extend(found);
    Ok(table)
}

/// One run with some settings changed, on one core: times are compared.
fn once(base: &Checked, set: &[String]) -> Result<RunResult, String> {
    let c = base.with(set).map_err(|r| r.to_string())?;
    with_threads(Threads::One, || run_alone(&c, &mut unwatched)).map_err(|e| e.to_string())
}

/// The results that errors are told of: those asked for, or those of the scene that case and reference have.
fn chosen(
    base: &Checked,
    plan: &Plan,
    asked: &[String],
    reference: &RunResult,
) -> Result<Vec<String>, RunError> {
    let has = |n: &&String| reference.results.contains_key(plan.told_as(n));
    if asked.is_empty() {
        let own = base.case.result_names();
        let both = |n: &&String| has(n) && own.as_ref().is_none_or(|own| own.contains(n));
        let named: Vec<String> = plan.results.iter().filter(both).cloned().collect();
        let first = || reference.results.keys().filter(both).take(UNNAMED).cloned().collect();
        return Ok(if named.is_empty() { first() } else { named });
    }
    match asked.iter().find(|n| !has(n)) {
        None => Ok(asked.to_vec()),
        Some(missing) => {
            let known: Vec<_> = reference.results.keys().map(String::as_str).collect();
            let text = format!("the reference has no result `{missing}`; it has {}", known.join(", "));
            Err(RunError::Refused(text))
        }
    }
}

/// Results that are looked at where nobody names any.
const UNNAMED: usize = 4;

/// Values of a reference, by the names that the methods give them.
fn values(plan: &Plan, reference: &RunResult, chosen: &[String]) -> IndexMap<String, Value> {
    let value = |n: &String| {
        let told = reference.results.get(plan.told_as(n))?;
        let what = reference.results.get(n).map_or("", |own| &own.what);
        Some((n.clone(), Value { what: what.to_owned(), ..told.clone() }))
    };
    chosen.iter().filter_map(value).collect()
}

/// What errors count from.
struct Judge {
    values: IndexMap<String, Value>,
}

impl Judge {
    /// Error of each chosen result.
    fn errors(&self, r: &RunResult) -> IndexMap<String, f64> {
        let value = |n: &String| r.results.get(n).map_or(f64::NAN, |v| v.value);
        self.values.iter().map(|(n, v)| (n.clone(), relative(value(n), v.value))).collect()
    }

    /// The largest difference of the chosen results of two runs.
    fn apart(&self, a: &RunResult, b: &RunResult) -> f64 {
        let value = |r: &RunResult, n: &String| r.results.get(n).map_or(f64::NAN, |v| v.value);
        self.values.keys().map(|n| relative(value(a, n), value(b, n))).fold(0.0, f64::max)
    }
}

/// Relative error, absolute where the reference is zero.
fn relative(value: f64, reference: f64) -> f64 {
    let d = (value - reference).abs();
    if reference == 0.0 { d } else { d / reference.abs() }
}
