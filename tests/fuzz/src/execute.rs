//! Runs one case in this process and says what came out of it.

use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use gudgeon_case::{Level, Report};
use gudgeon_core::result::{NoteLevel, RunResult, Series, Value};
use gudgeon_scene::{Checked, RunError};
use serde::{Deserialize, Serialize};

use crate::bounds;

/// What a child is asked to do.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Job {
    /// File below the folder of cases.
    pub base: String,
    /// The `--set` arguments.
    pub set: Vec<String>,
    /// Whether to run it again one level finer.
    pub refine: bool,
    /// Paths that are not refined: what shortens a case makes it coarse.
    pub coarse: Vec<String>,
    /// Whether to run it again as it stands.
    pub twice: bool,
}

/// How a case ended.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// With results.
    #[default]
    Done,
    /// Its input was refused. `placed` says whether every mistake has its place.
    Refused {
        /// The first mistake.
        message: String,
        /// Whether every mistake has a place in the file or in a `--set` argument.
        placed: bool,
    },
    /// The run failed, with this reason.
    Failed(String),
    /// A result was not a number.
    NotANumber(String),
    /// The program panicked.
    Panic {
        /// Where.
        place: String,
        /// What it said.
        message: String,
    },
    /// The process ended: a stack overflow, memory that was refused.
    Died(String),
    /// It did not end in time.
    Hang,
}

/// What came out of a case.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// How it ended.
    pub end: End,
    /// Wall time of the first run \[s\].
    pub seconds: f64,
    /// Topics of notes that say that something acted or failed.
    pub notes: Vec<String>,
    /// Relative closure of each balance.
    pub balance: Vec<(String, f64)>,
    /// Results and columns that are not finite.
    pub not_finite: Vec<String>,
    /// Results outside the bounds of physics.
    pub absurd: Vec<String>,
    /// Results that move when the numerical settings are refined.
    pub moved: Vec<String>,
    /// What differs between two runs.
    pub unequal: Vec<String>,
}

/// A note that says what became of the input, not of the result.
const OF_THE_INPUT: &str = "dropped_keys";

/// Place and message of the last panic.
static PANIC: Mutex<Option<(String, String)>> = Mutex::new(None);

/// Keeps place and message of a panic for the outcome, in place of the usual words on the terminal.
pub fn keep_panics() {
    std::panic::set_hook(Box::new(|info| {
        let payload = info.payload();
        let message = payload
            .downcast_ref::<&str>()
            .map(|s| (*s).to_owned())
            .or_else(|| payload.downcast_ref::<String>().cloned())
            .unwrap_or_default();
        let place = info.location().map_or_else(String::new, |l| format!("{}:{}", l.file(), l.line()));
        let mut last = PANIC.lock().unwrap_or_else(PoisonError::into_inner);
        // Later ones follow from the first.
        last.get_or_insert((place, message));
    }));
}

/// Runs a job.
#[must_use]
pub fn execute(folder: &Path, job: &Job) -> Outcome {
    let begin = Instant::now();
    let mut outcome =
        catch_unwind(AssertUnwindSafe(|| attempt(folder, job))).unwrap_or_else(|_| Outcome::default());
    let panic = PANIC.lock().unwrap_or_else(PoisonError::into_inner).take();
    if let Some((place, message)) = panic {
        outcome.end = End::Panic { place, message };
    }
    if outcome.seconds == 0.0 {
        outcome.seconds = begin.elapsed().as_secs_f64();
    }
    outcome
}

fn attempt(folder: &Path, job: &Job) -> Outcome {
    let begin = Instant::now();
    let mut o = Outcome::default();
    let checked = match gudgeon_scene::check(&folder.join(&job.base), &job.set) {
        Ok(c) => c,
        Err(report) => {
            o.end = refused(&report);
            return o;
        }
    };
    let result = match run(&checked) {
        Ok(r) => r,
        Err(e) => {
            o.end = failed(&e);
            return o;
        }
    };
    o.seconds = begin.elapsed().as_secs_f64();
    judge(&checked, &result, &mut o);
    if job.twice {
        o.unequal = match run(&checked) {
            Ok(again) => differences(&result, &again),
            Err(e) => vec![format!("the second run failed: {e}")],
        };
    }
    if job.refine {
        o.moved = unsettled(&checked, &result, &job.coarse);
    }
    o
}

fn run(c: &Checked) -> Result<RunResult, RunError> {
    gudgeon_scene::run(c, &mut gudgeon_scene::unwatched)
}

fn refused(report: &Report) -> End {
    let first = report.diagnostics.first();
    End::Refused {
        message: first.map_or_else(String::new, |d| d.headline()),
        placed: first.is_some() && report.diagnostics.iter().all(|d| report.place(d).is_some()),
    }
}

fn failed(e: &RunError) -> End {
    match e {
        RunError::NotANumber(name) => End::NotANumber(name.clone()),
        // What is refused after `check` said nothing stands nowhere.
        RunError::Refused(what) => End::Refused { message: what.clone(), placed: false },
        e => End::Failed(e.to_string()),
    }
}

fn judge(checked: &Checked, r: &RunResult, o: &mut Outcome) {
    let acted = |n: &&gudgeon_core::result::Note| n.level > NoteLevel::Info && n.topic != OF_THE_INPUT;
    o.notes = r.solver.notes.iter().filter(acted).map(|n| n.topic.clone()).collect();
    let b = &r.balance;
    let all = [
        ("gas mass", b.gas_mass),
        ("oil mass", b.oil_mass),
        ("flank oil", b.flank_oil),
        ("skirt oil", b.skirt_oil),
        ("energy", b.energy),
        ("momentum", b.momentum),
    ];
    o.balance = all.into_iter().filter_map(|(name, v)| Some((name.to_owned(), v?))).collect();
    let finite =
        |s: &Series| s.columns.iter().chain([&s.axis]).all(|c| c.values.iter().all(|v| v.is_finite()));
    o.not_finite.extend(r.results.iter().filter(|(_, v)| !v.value.is_finite()).map(|(n, _)| n.clone()));
    o.not_finite
        .extend(o.balance.iter().filter(|(_, v)| !v.is_finite()).map(|(n, _)| format!("balance of {n}")));
    let tables = [("series", &r.series)].into_iter().chain(r.tables.iter().map(|(n, t)| (n.as_str(), t)));
    o.not_finite.extend(tables.filter(|(_, t)| !finite(t)).map(|(n, _)| format!("table {n}")));
    o.absurd = bounds::broken(&checked.case.resolved(), r);
    // A name that is not known before a run is refused where a sweep or a comparison asks for it.
    let known: Option<HashSet<String>> = checked.case.result_names().map(|names| names.into_iter().collect());
    let unforeseen = r.results.keys().filter(|n| known.as_ref().is_some_and(|k| !k.contains(*n)));
    o.absurd.extend(unforeseen.map(|n| format!("result `{n}` is not among those told before the run")));
}

/// Results that move when a group of numerical settings is refined by one level. A level that cannot be run says nothing here.
fn unsettled(c: &Checked, r: &RunResult, coarse: &[String]) -> Vec<String> {
    let fine =
        |level: &&Level| !level.set.iter().any(|s| coarse.iter().any(|path| s.contains(path.as_str())));
    let refinements = c.case.refinements();
    let first = refinements.iter().filter_map(|group| group.levels.first()).filter(fine);
    first.filter_map(|level| run(&c.with(&level.set).ok()?).ok()).flat_map(|finer| moved(r, &finer)).collect()
}

/// What two runs of one case do not share, wall times apart.
fn differences(a: &RunResult, b: &RunResult) -> Vec<String> {
    let same = |x: f64, y: f64| x.to_bits() == y.to_bits();
    let equal = |s: &Series, t: &Series| {
        s.columns.len() == t.columns.len()
            && s.columns.iter().chain([&s.axis]).zip(t.columns.iter().chain([&t.axis])).all(|(x, y)| {
                x.values.len() == y.values.len() && x.values.iter().zip(&y.values).all(|(x, y)| same(*x, *y))
            })
    };
    let mut out: Vec<String> = a
        .results
        .iter()
        .filter(|(n, v)| !b.results.get(*n).is_some_and(|w| same(v.value, w.value)))
        .map(|(n, _)| n.clone())
        .collect();
    if !equal(&a.series, &b.series) {
        out.push("series".into());
    }
    out.extend(
        a.tables
            .iter()
            .filter(|(n, t)| !b.tables.get(*n).is_some_and(|u| equal(t, u)))
            .map(|(n, _)| n.clone()),
    );
    if a.solver != b.solver {
        out.push("work or notes".into());
    }
    out
}

/// A result that a finer solution moves by more than this part of itself is not settled.
const SETTLED: f64 = 0.05;
/// Below this part of the largest result of its unit, a result is noise of cancellation.
const NOISE: f64 = 1e-3;
/// The cycle \[deg\], around which angles are compared. Those of extremes are not: two of nearly one height change places.
const CYCLE: f64 = 720.0;
/// Results that measure the numerics themselves; they are there to change.
const OF_THE_NUMERICS: &[&str] = &["error", "residual", "iterations", "certificate", "stationarity"];

fn moved(a: &RunResult, b: &RunResult) -> Vec<String> {
    let largest = |unit: &str| {
        a.results.values().filter(|v| v.unit == unit).fold(0.0_f64, |m, v: &Value| m.max(v.value.abs()))
    };
    let differs = |name: &str, v: &Value, w: &Value| {
        let d = (v.value - w.value).abs();
        if v.unit == "deg" {
            return d.min((CYCLE - d).abs()) > SETTLED * CYCLE && !name.ends_with("_angle");
        }
        d > SETTLED * v.value.abs().max(w.value.abs()) + NOISE * largest(&v.unit)
    };
    a.results
        .iter()
        .filter(|(name, _)| !OF_THE_NUMERICS.iter().any(|w| name.contains(w)))
        .filter_map(|(name, v)| Some((name, v, b.results.get(name)?)))
        .filter(|(name, v, w)| differs(name, v, w))
        .map(|(name, v, w)| format!("{name}: {:.4e} is {:.4e} {} one level finer", v.value, w.value, v.unit))
        .collect()
}
