//! Comparisons of a case with the values of a source. They stand in files of their own, `validation/<case>.toml`, apart from the case
//! that a person copies, and run only when they are asked for.

use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};

use gudgeon_case::{Loaded, Report, advice, load};
use gudgeon_core::BuildError;
use gudgeon_core::result::{Check, Validated, Value, Verdict};
use gudgeon_scene::many::run_many;
use gudgeon_scene::{Checked, Progress, RunError, Scene, Stopped, changed, check, foresee};
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A file of comparisons.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ValidationFile {
    /// Case file, relative to the folder of this file.
    pub case: String,
    /// Settings of the case and what a source gives for them.
    pub checks: Vec<CheckCase>,
}

/// A setting and the results that a source gives for it.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CheckCase {
    /// Changes to the case, as `--set` takes them; empty: the case as it stands.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// A setting to compare with, as `set`: expected are then changes of results from there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub against: Option<Vec<String>>,
    /// With `against`: changes are told as parts of the value there.
    #[serde(default)]
    pub relative: bool,
    /// Expected results.
    pub expect: Vec<Expect>,
}

/// A result of a source.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Name of the result.
    pub result: String,
    /// The value, in the unit of the result.
    pub value: f64,
    /// Admitted deviation: relative, or absolute when the value is zero.
    pub tolerance: f64,
    /// Where the value comes from, and why the tolerance is what it is.
    pub source: String,
    /// What the comparison shows.
    #[serde(default)]
    pub verdict: Verdict,
}

/// A file of comparisons that was read, with its case.
struct Comparisons {
    file: Loaded<ValidationFile>,
    case: Checked,
    /// Its path.
    path: PathBuf,
}

/// Reads a file of comparisons and its case.
///
/// # Errors
/// Every mistake of the file, of its case and of the changes that its settings make, with places.
fn read(path: &Path) -> Result<Comparisons, Report> {
    let file = load::<ValidationFile>(path, &[])?;
    let case_path = tidy(&file.source.files.path(&file.value.case));
    let case = check(&case_path, &[]).map_err(|report| {
        let told: Vec<String> = report.diagnostics.iter().map(|d| d.headline()).collect();
        file.refuse(&[BuildError::at("case", format!("{}: {}", case_path.display(), told.join("; ")))])
    })?;
    let errors = legal(&file.value, &case);
    if errors.is_empty() {
        Ok(Comparisons { file, case, path: path.to_owned() })
    } else {
        Err(file.refuse(&errors))
    }
}

/// A path without the steps that lead back.
fn tidy(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for c in path.components() {
        match c {
            Component::ParentDir if matches!(out.components().next_back(), Some(Component::Normal(_))) => {
                out.pop();
            }
            Component::CurDir => {}
            c => out.push(c),
        }
    }
    out
}

fn legal(file: &ValidationFile, case: &Checked) -> Vec<BuildError> {
    let mut errors = Vec::new();
    for (k, c) in file.checks.iter().enumerate() {
        for (field, set) in [("set", Some(&c.set)), ("against", c.against.as_ref())] {
            if let Some(set) = set.filter(|s| !s.is_empty())
                && let Err(e) = changed(case.case.as_ref(), set)
            {
                errors.push(BuildError::at(format!("checks.{k}.{field}"), e.to_string()));
            }
        }
        if c.relative && c.against.is_none() {
            errors.push(BuildError::at(format!("checks.{k}.relative"), "needs `against`"));
        }
        for (j, e) in c.expect.iter().enumerate() {
            if !(e.value.is_finite() && e.tolerance.is_finite() && e.tolerance >= 0.0) {
                let what = "a value and a tolerance of zero or more are needed";
                errors.push(BuildError::at(format!("checks.{k}.expect.{j}"), what));
            }
        }
    }
    errors
}

/// The files of comparisons below a folder, in the order of their names.
///
/// # Errors
/// A folder that cannot be read.
pub fn files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(f) = folders.pop() {
        for entry in std::fs::read_dir(&f)? {
            let entry = entry?;
            // What a link leads to may lie above.
            let kind = entry.file_type()?;
            if kind.is_dir() {
                folders.push(entry.path());
            } else if kind.is_file() && entry.path().extension().is_some_and(|e| e == "toml") {
                found.push(entry.path());
            }
        }
    }
    found.sort();
    Ok(found)
}

/// Where a folder of the name `validation` is looked for: beside the folders that a case lies in.
const FOLDER: &str = "validation";

/// The file of comparisons of a case: in the nearest folder `validation` above it, the one that names it.
///
/// # Errors
/// A folder that cannot be read.
pub fn file_of(case: &Path) -> std::io::Result<Option<PathBuf>> {
    let wanted = case.canonicalize()?;
    for above in wanted.ancestors().skip(1) {
        let folder = above.join(FOLDER);
        if !folder.is_dir() {
            continue;
        }
        for f in files(&folder)? {
            let Ok(text) = load::<ValidationFile>(&f, &[]) else { continue };
            let named = text.source.files.path(&text.value.case);
            if named.canonicalize().is_ok_and(|n| n == wanted) {
                return Ok(Some(f));
            }
        }
    }
    Ok(None)
}

/// Comparisons with the runs that they need.
struct Planned {
    comparisons: Comparisons,
    /// A setting for each run.
    runs: Vec<Vec<String>>,
    /// The run of each setting: two settings that resolve to the same values share one.
    of: HashMap<Vec<String>, usize>,
}

/// What a run gave.
type Ran = Result<IndexMap<String, Value>, RunError>;

impl Comparisons {
    fn plan(self) -> Result<Planned, RunError> {
        let scene = self.case.case.as_ref();
        let checks = &self.file.value.checks;
        let unknown = compared(scene, checks);
        if !unknown.is_empty() {
            return Err(RunError::Refused(self.file.refuse(&unknown).render(false)));
        }
        let (mut runs, mut of, mut by_values) = (Vec::new(), HashMap::new(), HashMap::new());
        for set in checks.iter().flat_map(|c| std::iter::once(&c.set).chain(&c.against)) {
            if !of.contains_key(set) {
                let values = changed(scene, set)?.resolved().to_string();
                let run = *by_values.entry(values).or_insert_with(|| {
                    runs.push(set.clone());
                    runs.len() - 1
                });
                of.insert(set.clone(), run);
            }
        }
        Ok(Planned { comparisons: self, runs, of })
    }

    fn run(&self, set: &[String], progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>) -> Ran {
        progress(Progress { phase: format!("{}: {}", self.case.name, set.join(", ")), fraction: 0.0 })?;
        Ok(changed(self.case.case.as_ref(), set)?.once(progress)?.results)
    }

    fn refused(&self, check: usize, expect: usize, what: String) -> RunError {
        let e = BuildError::at(format!("checks.{check}.expect.{expect}.result"), what);
        RunError::Refused(self.file.refuse(&[e]).render(false))
    }
}

impl Planned {
    /// What the sources say beside what the runs gave.
    fn compare(&self, ran: &[IndexMap<String, Value>]) -> Result<Validated, RunError> {
        let Comparisons { file, case, path } = &self.comparisons;
        let mut done = Vec::new();
        for (k, c) in file.value.checks.iter().enumerate() {
            for (j, e) in c.expect.iter().enumerate() {
                let compared = compare(c, e, |set| &ran[self.of[set]]);
                done.push(compared.map_err(|e| self.comparisons.refused(k, j, e))?);
            }
        }
        let heading = case.case.heading();
        Ok(Validated {
            case: case.name.clone(),
            file: path.display().to_string(),
            title: heading.title.into(),
            source: heading.source.into(),
            runs: ran.len(),
            checks: done,
        })
    }
}

fn compare<'a>(
    c: &CheckCase,
    e: &Expect,
    results: impl Fn(&[String]) -> &'a IndexMap<String, Value>,
) -> Result<Check, String> {
    let name = e.result.as_str();
    let find = |set: &[String]| -> Result<&Value, String> {
        let results = results(set);
        results.get(name).ok_or_else(|| {
            let names: Vec<&str> = results.keys().map(String::as_str).collect();
            format!("this setting has no result `{name}`; {}", advice(name, &names))
        })
    };
    let own = find(&c.set)?;
    let (value, unit, result) = match &c.against {
        None => (own.value, own.unit.clone(), name.to_owned()),
        Some(from) => {
            let from = find(from)?.value;
            if c.relative && from == 0.0 {
                return Err(format!(
                    "`{name}` is 0 with the setting to compare with: there is no relative change"
                ));
            } else if c.relative {
                (own.value / from - 1.0, "1".into(), format!("relative change of {name}"))
            } else {
                (own.value - from, own.unit.clone(), format!("change of {name}"))
            }
        }
    };
    Ok(Check {
        set: c.set.clone(),
        against: c.against.clone(),
        result,
        value,
        reference: e.value,
        unit,
        tolerance: e.tolerance,
        source: e.source.clone(),
        verdict: e.verdict,
    })
}

/// Results that comparisons name and that the case does not have with their changes.
fn compared(scene: &dyn Scene, checks: &[CheckCase]) -> Vec<BuildError> {
    let Some(own) = scene.result_names() else { return Vec::new() };
    let mut errors = Vec::new();
    for (k, c) in checks.iter().enumerate() {
        let names: Vec<String> = c.expect.iter().map(|e| e.result.clone()).collect();
        if foresee::unknown(&names, &own).next().is_none() {
            continue;
        }
        // Another model may have results of its own; a change that cannot be is another mistake.
        let Ok(there) = scene.changed(&c.set) else { continue };
        let Some(there) = there.legal().is_empty().then(|| there.result_names()).flatten() else {
            continue;
        };
        let wrong = foresee::unknown(&names, &there);
        errors.extend(wrong.map(|(j, e)| e.within(&format!("checks.{k}.expect.{j}.result"))));
    }
    errors
}

/// Why a file of comparisons has no answer.
#[derive(Debug)]
pub enum ValidateError {
    /// It is wrong.
    Input(Report),
    /// A run failed.
    Run(PathBuf, RunError),
}

/// Runs the settings of files of comparisons side by side on `threads` threads (0: one a core). Answers stand in the order of the files, whatever ended first.
///
/// # Errors
/// The caller stopped it.
pub fn validate(
    files: &[PathBuf],
    threads: usize,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Vec<Result<Validated, ValidateError>>, Stopped> {
    let planned: Vec<Result<Planned, ValidateError>> = files
        .iter()
        .map(|f| {
            let read = read(f).map_err(ValidateError::Input)?;
            read.plan().map_err(|e| ValidateError::Run(f.clone(), e))
        })
        .collect();
    let points: Vec<(&Comparisons, &[String])> = planned
        .iter()
        .flatten()
        .flat_map(|p| p.runs.iter().map(|set| (&p.comparisons, set.as_slice())))
        .collect();
    let work = |k: usize, tell: &mut dyn FnMut(Progress) -> Result<(), Stopped>| {
        let (comparisons, set) = points[k];
        comparisons.run(set, tell)
    };
    let mut ran = run_many(points.len(), threads, work, progress).all()?.into_iter();
    let answers = planned.into_iter().zip(files).map(|(planned, f)| {
        let planned = planned?;
        let own: Vec<Ran> = ran.by_ref().take(planned.runs.len()).collect();
        let own: Result<Vec<_>, _> = own.into_iter().collect();
        own.and_then(|own| planned.compare(&own)).map_err(|e| ValidateError::Run(f.clone(), e))
    });
    Ok(answers.collect())
}
