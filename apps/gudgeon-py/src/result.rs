//! What a run produced.

use std::path::PathBuf;

use gudgeon_core::result::{RunResult, Series};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes};
use serde_json::{Value, json};

use crate::errors::unwritten;
use crate::values::{self, numbers, to_python};

/// Name of the table that holds the series.
const SERIES: &str = "series";

/// What a run produced. Does not change.
#[pyclass(frozen, module = "gudgeon._native")]
pub struct Outcome {
    run: RunResult,
}

impl Outcome {
    pub fn new(run: RunResult) -> Self {
        Self { run }
    }

    fn table(&self, name: &str) -> PyResult<&Series> {
        let found = if name == SERIES { Some(&self.run.series) } else { self.run.tables.get(name) };
        found.ok_or_else(|| PyKeyError::new_err(name.to_owned()))
    }
}

fn value(v: &impl serde::Serialize) -> Value {
    // Text, numbers and maps with text keys: there is nothing in it that JSON refuses.
    serde_json::to_value(v).unwrap_or_default()
}

fn packed(run: &RunResult) -> PyResult<Vec<u8>> {
    rmp_serde::to_vec_named(run).map_err(|e| PyValueError::new_err(e.to_string()))
}

#[pymethods]
impl Outcome {
    /// A result from its state.
    #[staticmethod]
    fn restored(py: Python<'_>, state: &[u8]) -> PyResult<Self> {
        let run = py.detach(|| rmp_serde::from_slice(state));
        Ok(Self { run: run.map_err(|e| PyValueError::new_err(format!("this is no result: {e}")))? })
    }

    /// What [`Outcome::restored`] takes.
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &packed(&self.run)?))
    }

    /// Whether two results are equal, wall times apart.
    fn equals(&self, other: &Self) -> PyResult<bool> {
        // As bytes: a row without a result holds what is not a number.
        let timeless = |r: &RunResult| packed(&RunResult { seconds: Default::default(), ..r.clone() });
        Ok(timeless(&self.run)? == timeless(&other.run)?)
    }

    /// Name, value, unit and meaning of every result.
    fn results(&self) -> Vec<(&str, f64, &str, &str)> {
        let all = self.run.results.iter();
        all.map(|(name, v)| (name.as_str(), v.value, v.unit.as_str(), v.what.as_str())).collect()
    }

    /// Everything but results, series and tables.
    fn about(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let r = &self.run;
        to_python(
            py,
            &json!({
                "case": r.case, "title": r.title, "source": r.source, "assumptions": r.assumptions, "scene": r.scene,
                "gudgeon": r.gudgeon, "provenance": value(&r.provenance), "verification": value(&r.verification),
                "models": value(&r.models), "skipped": value(&r.skipped), "balance": value(&r.balance),
                "method": r.solver.method, "counters": value(&r.solver.counters), "notes": value(&r.solver.notes),
                "seconds": value(&r.seconds), "figures": value(&r.figures), "events": value(&r.events),
                "branches": value(&r.branches),
            }),
        )
    }

    /// Names of all tables, that of the series first.
    fn tables(&self) -> Vec<&str> {
        std::iter::once(SERIES).chain(self.run.tables.keys().map(String::as_str)).collect()
    }

    /// Name and unit of every column of a table, its axis first.
    fn columns(&self, table: &str) -> PyResult<Vec<(&str, &str)>> {
        Ok(values::columns(self.table(table)?))
    }

    /// The numbers of one column.
    fn column<'py>(&self, py: Python<'py>, table: &str, number: usize) -> PyResult<Bound<'py, PyByteArray>> {
        let column = values::all(self.table(table)?).nth(number);
        numbers(py, &column.ok_or_else(|| PyKeyError::new_err(number))?.values)
    }

    /// Writes what `gudgeon run --out` writes.
    fn write(&self, py: Python<'_>, folder: PathBuf) -> PyResult<PathBuf> {
        let files = py.detach(|| gudgeon_report::write_run(&self.run, &folder));
        Ok(files.map_err(|e| unwritten(&e))?.report)
    }

    /// The text of `summary.json`.
    fn summary(&self, py: Python<'_>) -> String {
        py.detach(|| gudgeon_report::summary_json(&self.run))
    }
}
