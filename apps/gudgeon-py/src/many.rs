//! Rows of many runs, column by column.

use gudgeon_core::result::{Failure, Note, NoteLevel, RunResult, Value, Variant};
use gudgeon_scene::many::run_points;
use gudgeon_scene::{Progress, Scene, Stopped};
use pyo3::prelude::*;
use pyo3::types::PyByteArray;

use crate::values::numbers;

/// What stays of one run.
struct Row {
    results: Vec<(String, Value)>,
    failure: Option<Failure>,
}

impl Row {
    fn new(outcome: Result<RunResult, Failure>) -> Self {
        match outcome {
            Ok(r) => {
                let failure = marked(&r.solver.notes);
                Self { results: r.results.into_iter().collect(), failure }
            }
            Err(failure) => Self { results: Vec::new(), failure: Some(failure) },
        }
    }
}

/// A run whose results are not what was asked for: they are kept, and marked.
fn marked(notes: &[Note]) -> Option<Failure> {
    let n = notes.iter().find(|n| n.level == NoteLevel::Failure)?;
    Some(Failure { code: n.topic.clone(), message: n.text.clone(), path: String::new() })
}

/// One result over all points; not a number where there is none.
struct Told {
    name: String,
    unit: String,
    what: String,
    values: Vec<f64>,
}

/// Results and failures of many runs, in the order of their points.
#[pyclass(frozen, module = "gudgeon._native")]
pub struct Rows {
    columns: Vec<Told>,
    failures: Vec<(usize, Failure)>,
}

/// Runs `points` and gathers what they tell.
pub fn rows(
    scene: &dyn Scene,
    points: &[Vec<String>],
    threads: usize,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Rows {
    let all = run_points(scene, points, threads, |_, outcome| Row::new(outcome), progress);
    let stopped = || Failure { code: "stopped".into(), message: Stopped.to_string(), path: String::new() };
    let missing = || Row { results: Vec::new(), failure: Some(stopped()) };
    Rows::of(all.rows.into_iter().map(|row| row.unwrap_or_else(missing)))
}

/// What was kept of the combinations of a comparison.
pub fn of_variants(variants: Vec<Variant>) -> Rows {
    Rows::of(variants.into_iter().map(|v| Row::new(v.outcome)))
}

impl Rows {
    fn of(rows: impl ExactSizeIterator<Item = Row>) -> Self {
        let mut told = Self { columns: Vec::new(), failures: Vec::new() };
        let count = rows.len();
        for (k, row) in rows.enumerate() {
            told.failures.extend(row.failure.map(|f| (k, f)));
            for (place, (name, v)) in row.results.into_iter().enumerate() {
                told.put(count, k, place, name, v);
            }
        }
        told
    }

    /// Runs of one case mostly tell the same results in the same order: `place` is looked at first.
    fn put(&mut self, count: usize, row: usize, place: usize, name: String, v: Value) {
        let there = match self.columns.get(place) {
            Some(c) if c.name == name => Some(place),
            _ => self.columns.iter().position(|c| c.name == name),
        };
        let at = there.unwrap_or_else(|| {
            self.columns.push(Told { name, unit: v.unit, what: v.what, values: vec![f64::NAN; count] });
            self.columns.len() - 1
        });
        self.columns[at].values[row] = v.value;
    }
}

/// A column as Python gets it: name, unit, meaning, numbers.
type Handed<'a, 'py> = (&'a str, &'a str, &'a str, Bound<'py, PyByteArray>);

#[pymethods]
impl Rows {
    /// Every result.
    fn columns<'py>(&self, py: Python<'py>) -> PyResult<Vec<Handed<'_, 'py>>> {
        let all = self.columns.iter();
        all.map(|c| Ok((c.name.as_str(), c.unit.as_str(), c.what.as_str(), numbers(py, &c.values)?)))
            .collect()
    }

    /// Row, code, message and path of every failure.
    fn failures(&self) -> Vec<(usize, &str, &str, &str)> {
        self.failures
            .iter()
            .map(|(k, f)| (*k, f.code.as_str(), f.message.as_str(), f.path.as_str()))
            .collect()
    }
}
