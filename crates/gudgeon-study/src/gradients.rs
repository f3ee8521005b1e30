//! Derivatives of the results of a case by some of its inputs: by the scene's own method where it has one, else by differences of runs.

use gudgeon_core::result::{Gradient, GradientInput, Gradients, Note};
use gudgeon_scene::gradients::{assignment, input};
use gudgeon_scene::run::run_alone;
use gudgeon_scene::{Checked, GradientError, Progress, RunError, Stopped, foresee};

/// Part of itself by which an input is made smaller and larger in runs. The error of a derivative is that of the runs over this, and goes with its
/// square.
const SHARE: f64 = 1e-3;

/// Derivatives of the results by the inputs at the paths `inputs`; of those named `results` alone, where any are.
///
/// A scene with derivatives of its own ([`gudgeon_scene::SceneCase::gradients`]) follows them through its solution. For all others, and for a case of which it has
/// none, each input is made a thousandth smaller and larger and the case run again; the method of the answer and a note say so.
///
/// # Errors
/// An input that is no continuous quantity, a result that the case does not have, a run that failed, a caller that wants it to end.
pub fn gradients(
    base: &Checked,
    inputs: &[String],
    results: &[String],
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Gradients, GradientError> {
    if let Some(known) = base.case.result_names() {
        foresee::all_known(results, &known).map_err(RunError::Refused)?;
    }
    progress(Progress { phase: "derivatives".into(), fraction: 0.0 }).map_err(RunError::from)?;
    let mut found = match base.case.gradients(inputs, progress) {
        Err(GradientError::NoMethod(why)) => {
            let mut found = differences(base, inputs, progress)?;
            found.notes.push(Note::info("gradients_by_runs", format!("differences of runs: {why}")));
            found
        }
        other => other?,
    };
    if !results.is_empty() {
        found.results.retain(|name, _| results.contains(name));
    }
    Ok(found)
}

/// Central differences of runs.
///
/// # Errors
/// As [`gradients`].
pub fn differences(
    base: &Checked,
    inputs: &[String],
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Gradients, GradientError> {
    let resolved = base.case.resolved();
    let inputs = inputs.iter().map(|p| input(&resolved, p, SHARE)).collect::<Result<Vec<_>, _>>()?;
    let runs = 1 + 2 * inputs.len();
    let mut done = 0;
    let mut run = |case: &Checked, phase: &str| -> Result<Results, GradientError> {
        let mut tell = |part: f64| {
            progress(Progress { phase: phase.to_owned(), fraction: (f64::from(done) + part) / runs as f64 })
        };
        tell(0.0).map_err(RunError::from)?;
        let found = run_alone(case, &mut |p| tell(p.fraction))?;
        done += 1;
        Ok(found.results)
    };
    let own = run(base, "the case as it stands")?;
    let mut found = Gradients {
        method: format!("central differences of runs with each input {SHARE} of itself lower and higher"),
        results: own.into_iter().map(|(name, v)| (name, Gradient::new(v))).collect(),
        ..Gradients::default()
    };
    for i in &inputs {
        let low = run(&changed(base, i, -i.step)?, &i.path)?;
        let high = run(&changed(base, i, i.step)?, &i.path)?;
        for (name, g) in &mut found.results {
            match (low.get(name), high.get(name)) {
                (Some(a), Some(b)) => g.difference(a.value, b.value, i.step),
                _ => g.by.push(None),
            }
        }
    }
    found.counters.insert("runs".into(), runs as u64);
    found.inputs = inputs;
    Ok(found)
}

type Results = indexmap::IndexMap<String, gudgeon_core::result::Value>;

/// The case with an input changed by `d`.
fn changed(base: &Checked, i: &GradientInput, d: f64) -> Result<Checked, GradientError> {
    let refuse =
        |why: String| GradientError::Input { path: i.path.clone(), why: format!("cannot be varied: {why}") };
    base.with(&[assignment(i, i.value + d)])
        .map_err(|r| refuse(r.diagnostics.first().map_or_else(String::new, |d| d.headline())))
}
