//! From a file to results: the functions behind `check`, `explain` and `run`.

use std::path::Path;

use gudgeon_case::{Report, Source, UsedSet, read};
use gudgeon_core::result::{ModelUse, Note, RunResult, Skipped};
use gudgeon_core::{BuildError, Registry, Stopped, Stopwatch};

use crate::error::{Progress, RunError};
use crate::explanation::{ExplainedModel, Explanation};
use crate::foresee;
use crate::provenance::{self, provenance};
use crate::scene::{Scene, SceneCase, load};
use crate::second::{Busy, limited};
use crate::verify::verify;
use crate::{sweep, sweep_input};

/// A case that was read, resolved and found to be possible.
pub struct Checked {
    /// Name of the case: the file name without its extension.
    pub name: String,
    /// Name of the case file without its folder.
    pub file: String,
    /// What a person should know although nothing is wrong (keys dropped by a model swap).
    pub notes: Vec<String>,
    /// The case.
    pub case: Box<dyn Scene>,
}

/// Reads, resolves and validates a case, or the case that the `summary.json` of a run recorded.
///
/// # Errors
/// Everything that is wrong with it, with places.
pub fn check(path: &Path, overrides: &[String]) -> Result<Checked, Report> {
    let source = read(path)?;
    if path.extension().is_some_and(|e| e == "json") {
        let (file, source, recorded) = provenance::recorded(&source)?;
        let all: Vec<String> = recorded.iter().chain(overrides).cloned().collect();
        return check_source(file, source, &all);
    }
    let file = path.file_name().map_or_else(|| "case".to_owned(), |s| s.to_string_lossy().into_owned());
    check_source(file, source, overrides)
}

/// As [`check`], from a text that was read before.
///
/// # Errors
/// As [`check`].
pub fn check_source(file: String, source: Source, overrides: &[String]) -> Result<Checked, Report> {
    check_case(file, load(source, overrides)?)
}

/// As [`check`], of a case that was read before.
///
/// # Errors
/// Everything that is wrong with it, with places.
pub fn check_case(file: String, case: Box<dyn Scene>) -> Result<Checked, Report> {
    let mut errors = case.legal();
    errors.extend(sweep_input::legal(case.heading().sweeps));
    // The file itself comes first: its mistakes would come back with every change.
    if errors.is_empty() {
        let sweeps = case.heading().sweeps;
        errors.extend(foresee::sweeps(case.as_ref(), sweeps));
        errors.extend(foresee::idle(case.as_ref(), sweeps));
        errors.extend(foresee::drawn(case.as_ref(), sweeps));
    }
    legal(file, case, &errors)
}

fn legal(file: String, case: Box<dyn Scene>, errors: &[BuildError]) -> Result<Checked, Report> {
    if !errors.is_empty() {
        return Err(case.refuse(errors));
    }
    let name =
        Path::new(&file).file_stem().map_or_else(|| file.clone(), |s| s.to_string_lossy().into_owned());
    let mut notes = case.notes().to_vec();
    let unused = case.unused();
    let paths = case.overrides().iter().filter_map(|o| o.split_once('=')).map(|(path, _)| path.trim());
    let idle = paths.filter(|path| unused.iter().any(|u| u == path));
    notes.extend(idle.map(|path| format!("`--set {path}=…` changes nothing: this scene does not use it")));
    Ok(Checked { name, file, notes, case })
}

impl Checked {
    /// The same file with more `--set` arguments, its sweeps apart: what a study does for each of its variants.
    ///
    /// # Errors
    /// As [`check`].
    pub fn with(&self, more: &[String]) -> Result<Self, Report> {
        let case = self.case.changed(more)?;
        let errors = case.legal();
        legal(self.file.clone(), case, &errors)
    }

    /// Title.
    #[must_use]
    pub fn title(&self) -> &str {
        self.case.heading().title
    }

    /// The case, when it is one of the scene `C`.
    #[must_use]
    pub fn of<C: SceneCase>(&self) -> Option<&C> {
        self.case.value().downcast_ref()
    }
}

/// Explains a case without running it.
///
/// # Errors
/// When the sub-models cannot be built (which [`check`] would have said).
pub fn explain(c: &Checked) -> Result<Explanation, RunError> {
    let registry = Registry::collect();
    let mut told = Explanation {
        case: c.name.clone(),
        title: c.title().into(),
        notes: c.notes.clone(),
        ..Explanation::default()
    };
    let mut used = c.case.explain(&mut told)?;
    told.sets = c.case.sets();
    cite_sets(&told.sets, &mut used);
    let idle = |path: String| Skipped { what: path, why: "this scene does not use it".into() };
    told.skipped.extend(c.case.unused().into_iter().map(idle));
    told.models = used
        .into_iter()
        .map(|used| {
            let info = registry.model(&used.kind, &used.model);
            let text = |f: fn(&gudgeon_core::ModelInfo) -> &'static str| info.map_or("", f).to_owned();
            ExplainedModel {
                summary: text(|i| i.summary),
                equations: text(|i| i.equations),
                validity: text(|i| i.validity),
                used,
            }
        })
        .collect();
    Ok(told)
}

/// Runs a case with its sweeps.
///
/// # Errors
/// What stopped it; nothing has been written.
pub fn run(
    c: &Checked,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    run_on(c, 0, progress)
}

/// As [`run`], with the points of the sweeps on `threads` threads (0: one a core); with 1 the case keeps to this thread as well. Results are the same for any number.
///
/// # Errors
/// As [`run`].
pub fn run_on(
    c: &Checked,
    threads: usize,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    let begin = Stopwatch::start();
    finish(c, begin, limited(threads, || with_sweeps(c.case.as_ref(), threads, progress))?)
}

/// As [`run`], then refines every numerical setting until the uncertainty of each result is known.
///
/// # Errors
/// As [`run`]; a refinement that cannot be run.
pub fn run_verified(
    c: &Checked,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    run_verified_on(c, 0, progress)
}

/// As [`run_verified`], on `threads` threads as [`run_on`].
///
/// # Errors
/// As [`run_verified`].
pub fn run_verified_on(
    c: &Checked,
    threads: usize,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    let result = run_on(c, threads, progress)?;
    limited(threads, || verified(c, result, progress))
}

fn verified(
    c: &Checked,
    mut result: RunResult,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    let begin = Stopwatch::start();
    verify(c.case.as_ref(), &mut result, progress)?;
    result.seconds.insert("verify".into(), begin.seconds());
    Ok(result)
}

/// Runs a case without its sweeps.
///
/// # Errors
/// As [`run`].
pub fn run_alone(
    c: &Checked,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    let begin = Stopwatch::start();
    finish(c, begin, once(c.case.as_ref(), progress)?)
}

/// As [`run_verified`] without the sweeps.
///
/// # Errors
/// As [`run_verified`].
pub fn run_alone_verified(
    c: &Checked,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    verified(c, run_alone(c, progress)?, progress)
}

fn finish(c: &Checked, begin: Stopwatch, mut result: RunResult) -> Result<RunResult, RunError> {
    result.case.clone_from(&c.name);
    result.gudgeon = env!("CARGO_PKG_VERSION").into();
    result.provenance = provenance(&c.file, c.case.as_ref());
    result.solver.notes.extend(c.notes.iter().map(|n| Note::caution("dropped_keys", n)));
    // All of them, though one would do: without an end before the last they are looked at several at once.
    let finite = |values: &[f64]| values.iter().fold(true, |all, v| all & v.is_finite());
    if let Some(column) = result.series.columns.iter().find(|c| !finite(&c.values)) {
        return Err(RunError::NotANumber(column.name.clone()));
    }
    result.seconds.insert("total".into(), begin.seconds());
    Ok(result)
}

/// Runs the case without its sweeps.
///
/// # Errors
/// What stopped it.
pub(crate) fn once(
    scene: &dyn Scene,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    let _busy = Busy::new();
    let foreseen = cfg!(debug_assertions).then(|| scene.result_names()).flatten();
    let result = scene.once(progress)?;
    if let Some(names) = foreseen {
        let told = result.results.keys().find(|told| !names.contains(told));
        debug_assert_eq!(told, None, "a result that `SceneCase::result_names` of the scene does not name");
    }
    Ok(headed(scene, result))
}

/// A result with what its case says of itself.
fn headed(scene: &dyn Scene, mut result: RunResult) -> RunResult {
    let heading = scene.heading();
    result.title = heading.title.into();
    result.source = heading.source.into();
    result.assumptions = heading.assumptions.to_vec();
    let sets = scene.sets();
    result.assumptions.extend(sets.iter().flat_map(UsedSet::assumptions));
    cite_sets(&sets, &mut result.models);
    result.scene = heading.scene.into();
    result.solver.notes.sort_by_key(|n| n.numerical);
    result
}

/// Adds the sources of parameter sets to the models that took them.
fn cite_sets(sets: &[UsedSet], models: &mut [ModelUse]) {
    for set in sets {
        let kind = set.path.rsplit('.').next().unwrap_or_default();
        for m in models.iter_mut().filter(|m| m.kind == kind) {
            let new: Vec<&str> =
                set.references().into_iter().filter(|r| !m.references.iter().any(|k| k == r)).collect();
            m.references.extend(new.into_iter().map(str::to_owned));
        }
    }
}

/// Runs the case and its sweeps. Where the case itself fails, its sweeps are still run.
///
/// # Errors
/// What stopped it.
fn with_sweeps(
    scene: &dyn Scene,
    threads: usize,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<RunResult, RunError> {
    let sweeps = scene.heading().sweeps;
    let mut result = match once(scene, progress) {
        Err(e) if !sweeps.is_empty() && !matches!(e, RunError::Stopped) => {
            let mut result = RunResult::default();
            result
                .solver
                .notes
                .push(Note::failure("case", format!("the case as it stands has no result: {e}")));
            headed(scene, result)
        }
        outcome => outcome?,
    };
    let points = sweep::run(scene, sweeps, &mut result, threads, progress)?;
    result.solver.counters.insert("runs".into(), 1 + points as u64);
    Ok(result)
}
