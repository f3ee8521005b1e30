//! Every combination of some models or settings of one case, or of several, side by side; and which of these choices matters.

mod findings;
mod shares;

use std::path::Path;
use std::sync::Arc;

use gudgeon_case::{Diagnostic, Report, advice};
use gudgeon_core::result::{ComparedCase, Comparison, Failure, RunResult, Variant, short_value};
use gudgeon_core::{BuildError, Registry};
use gudgeon_scene::many::run_many;
use gudgeon_scene::run::{run_alone, run_alone_verified};
use gudgeon_scene::{Checked, Progress, RunError, Stopped, check};
use indexmap::IndexSet;

use crate::error::StudyError;

pub use shares::shares;

/// A callback that hears how far the comparison is, and says whether it may go on.
type Tell<'a> = &'a mut dyn FnMut(Progress) -> Result<(), Stopped>;

/// A case of a comparison.
#[derive(Clone)]
pub struct Subject {
    /// The case.
    pub case: Arc<Checked>,
    /// Those of its changes that tell it from other cases made of the same file: they become part of its name.
    pub own: Vec<String>,
}

/// What is compared.
#[derive(Clone, Default)]
pub struct Plan {
    /// The cases.
    pub cases: Vec<Subject>,
    /// `(path, values)`: every combination is run. A value may be a table, `{ model = "closed_form_face", cavitation = "half_sommerfeld" }`.
    pub swaps: Vec<(String, Vec<String>)>,
    /// Whether the numerical uncertainty of every result is found.
    pub verify: bool,
    /// Results that a reader looks at first; empty: those of the whole scene, whose names have no point.
    pub headlines: Vec<String>,
    /// Whether series, tables and figures of the runs are dropped: results, notes and uncertainties are enough for the shares.
    pub results_only: bool,
    /// Threads that the combinations are run on; 0: one a core.
    pub threads: usize,
}

/// `gas_flow`, `models.gas_flow` and `models.gas_flow.model` all mean the model's name; anything else is taken as written.
pub(crate) fn swap_path(path: &str) -> String {
    let registry = Registry::collect();
    let bare = path.strip_prefix("models.").unwrap_or(path);
    if registry.kind(bare).is_some() {
        return format!("models.{bare}.model");
    }
    match path.rsplit_once('.') {
        Some((_, last)) if registry.kind(last).is_some() => format!("{path}.model"),
        _ => path.to_owned(),
    }
}

/// The path that a value of a swap is set at: a table with the settings of a model stands for the model itself, a word for its name.
fn place<'a>(path: &'a str, value: &str) -> &'a str {
    if value.starts_with('{') { path.strip_suffix(".model").unwrap_or(path) } else { path }
}

/// What a swap is called: `gas_flow` for `models.gas_flow.model`.
fn short(path: &str) -> &str {
    path.trim_start_matches("models.").trim_end_matches(".model")
}

/// Most combinations of one comparison: each is a run, and all their results are kept.
const MAX_COMBINATIONS: usize = 1000;

/// Runs every combination of `swaps`, `(path, values)`.
///
/// Every combination is checked before any is run; those that cannot be are kept with the reason.
///
/// # Errors
/// The case itself is wrong, a swap has no values, or no combination is possible.
pub fn compare(
    path: &Path,
    overrides: &[String],
    swaps: &[(String, Vec<String>)],
    progress: Tell<'_>,
) -> Result<Comparison, StudyError> {
    let subject = Subject { case: Arc::new(check(path, overrides)?), own: Vec::new() };
    let plan = Plan { cases: vec![subject], swaps: swaps.to_vec(), ..Plan::default() };
    compare_cases(&plan, progress)
}

/// Runs every combination of the swaps on every case, and takes the variance of the results apart.
///
/// Every combination is checked before any is run; those that cannot be are kept with the reason.
///
/// # Errors
/// A swap has no values, or no combination is possible for any case; there is no case.
pub fn compare_cases(plan: &Plan, progress: Tell<'_>) -> Result<Comparison, StudyError> {
    let Some(first) = plan.cases.first() else {
        return Err(Report::unreadable("", Diagnostic::new("a comparison needs a case")).into());
    };
    let jobs = jobs(&first.case, plan)?;
    let run: Run = if plan.verify { run_alone_verified } else { run_alone };
    let outcome = |k: usize, tell: Tell<'_>| match &jobs[k].checked {
        Err(report) => Err(report.failure()),
        Ok(c) => run(c, tell).map(|r| kept(plan, r)).map_err(|e| e.failure()),
    };
    let outcomes = run_many(jobs.len(), plan.threads, outcome, progress).all()?;
    let cases = named(&plan.cases);
    let variants =
        jobs.into_iter().zip(outcomes).map(|(job, outcome)| job.variant(&cases, outcome)).collect();
    let mut comparison = Comparison {
        case: cases.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(" · "),
        title: match cases.as_slice() {
            [one] => one.title.clone(),
            several => format!("{} cases", several.len()),
        },
        cases,
        swaps: plan.swaps.iter().map(|(p, v)| (swap_path(p), v.clone())).collect(),
        variants,
        shares: Vec::new(),
    };
    comparison.shares = shares::shares(&comparison, &plan.headlines);
    Ok(comparison)
}

/// What stays of a run.
fn kept(plan: &Plan, run: RunResult) -> RunResult {
    if !plan.results_only {
        return run;
    }
    RunResult {
        results: run.results,
        solver: run.solver,
        verification: run.verification,
        ..RunResult::default()
    }
}

/// Every combination of every case, checked.
fn jobs(first: &Checked, plan: &Plan) -> Result<Vec<Job>, Report> {
    let combinations = combinations(first, plan)?;
    let with = |(case, s): (usize, &Subject)| {
        combinations.iter().map(|c| Job::new(case, &s.case, c)).collect::<Vec<_>>()
    };
    let jobs: Vec<Job> = plan.cases.iter().enumerate().flat_map(with).collect();
    if jobs.iter().all(|j| j.checked.is_err()) {
        // Nothing is possible: the first refusal says why, with places.
        let report = jobs.into_iter().find_map(|j| j.checked.err());
        return Err(report.unwrap_or_else(|| first.case.refuse(&[BuildError::new("no combination to run")])));
    }
    if !plan.headlines.is_empty() {
        let names = jobs.iter().flat_map(|j| &j.checked).filter_map(|c| c.case.result_names());
        let known: IndexSet<String> = names.flatten().collect();
        let unknown: Vec<&String> =
            plan.headlines.iter().filter(|n| !known.is_empty() && !known.contains(*n)).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        let error = |n: &String| BuildError::new(format!("there is no result `{n}`")).help(advice(n, &known));
        let errors: Vec<BuildError> = unknown.into_iter().map(error).collect();
        if !errors.is_empty() {
            return Err(first.case.refuse(&errors));
        }
    }
    Ok(jobs)
}

/// Values of all swaps.
type Combination = Vec<(String, String)>;

/// How one combination is run.
type Run = fn(&Checked, Tell<'_>) -> Result<RunResult, RunError>;

/// One combination of one case.
struct Job {
    case: usize,
    swaps: Combination,
    checked: Result<Checked, Report>,
}

impl Job {
    fn new(case: usize, base: &Checked, swaps: &Combination) -> Self {
        let set: Vec<String> = swaps.iter().map(|(p, v)| format!("{p}={v}")).collect();
        let first = base.case.overrides().len();
        let checked = base.with(&set).map_err(|report| report.written_as(first, "--swap"));
        Self { case, swaps: swaps.clone(), checked }
    }

    fn variant(self, cases: &[ComparedCase], outcome: Result<RunResult, Failure>) -> Variant {
        let swaps: Vec<String> =
            self.swaps.iter().map(|(p, v)| format!("{}={}", short(p), short_value(v))).collect();
        let label = match cases {
            [_] => swaps.join(", "),
            several => format!("{}: {}", several[self.case].name, swaps.join(", ")),
        };
        Variant { label, case: self.case, swaps: self.swaps, outcome }
    }
}

/// Names of the cases, with the changes of their own where two share one.
fn named(subjects: &[Subject]) -> Vec<ComparedCase> {
    let alone = |base: &Checked| subjects.iter().filter(|s| s.case.name == base.name).count() == 1;
    let name = |base: &Checked, own: &[String]| {
        let own = own.iter().filter(|_| !alone(base)).map(String::as_str);
        std::iter::once(base.name.as_str()).chain(own).collect::<Vec<_>>().join(", ")
    };
    let case = |s: &Subject| ComparedCase { name: name(&s.case, &s.own), title: s.case.title().to_owned() };
    subjects.iter().map(case).collect()
}

/// Every combination of the swaps, the last swap the fastest.
fn combinations(base: &Checked, plan: &Plan) -> Result<Vec<Combination>, Report> {
    let swaps = &plan.swaps;
    let count = swaps.iter().fold(plan.cases.len(), |n, (_, v)| n.saturating_mul(v.len()));
    if count > MAX_COMBINATIONS {
        let what = match plan.cases.len() {
            1 => format!("the swaps make {count} combinations, at most {MAX_COMBINATIONS} are compared"),
            n => format!(
                "{n} cases and the swaps make {count} combinations, at most {MAX_COMBINATIONS} are compared"
            ),
        };
        let e = BuildError::new(what).help("fewer values, or one `--swap` after the other");
        return Err(base.case.refuse(&[e]));
    }
    let mut all: Vec<Combination> = vec![Vec::new()];
    for (p, values) in swaps {
        if values.is_empty() || values.iter().any(String::is_empty) {
            let e = BuildError::new(format!("the swap `{p}` has an empty value"))
                .help("write `--swap PATH=A,B,C`");
            return Err(base.case.refuse(&[e]));
        }
        let p = swap_path(p);
        let with = |c: &Combination, v: &String| {
            c.iter().cloned().chain([(place(&p, v).to_owned(), v.clone())]).collect()
        };
        all = all.iter().flat_map(|c| values.iter().map(|v| with(c, v)).collect::<Vec<_>>()).collect();
    }
    Ok(all)
}
