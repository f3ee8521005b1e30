//! A study in its folder.

use std::path::{Path, PathBuf};

use gudgeon_study::study::{FolderError, Job, Part, Record};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::to_value;

use crate::errors::unstudied;
use crate::interrupt::Watch;
use crate::values::to_python;

/// A study in its folder, or its record alone.
#[pyclass(frozen, module = "gudgeon._native")]
pub struct Study {
    study: gudgeon_study::study::Study,
}

/// Bytes of the rows of a part, and of its series.
type Files<'py> = (Bound<'py, PyBytes>, Option<Bound<'py, PyBytes>>);

impl Study {
    fn new(py: Python<'_>, study: Result<gudgeon_study::study::Study, FolderError>) -> PyResult<Self> {
        Ok(Self { study: study.map_err(|e| unstudied(py, e))? })
    }
}

#[pymethods]
impl Study {
    /// Makes the folder of a study from a study file, or finds it made already.
    #[staticmethod]
    fn create(py: Python<'_>, folder: PathBuf, file: PathBuf) -> PyResult<Self> {
        Self::new(py, py.detach(|| gudgeon_study::study::Study::create(&folder, &file)))
    }

    /// Opens the folder of a study.
    #[staticmethod]
    fn open(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        Self::new(py, py.detach(|| gudgeon_study::study::Study::open(&folder)))
    }

    /// A study from the text of its `study.json`, for workers that do not see its folder.
    #[staticmethod]
    fn read(py: Python<'_>, record: &str) -> PyResult<Self> {
        Self::new(py, py.detach(|| gudgeon_study::study::Study::read(Path::new(""), record)))
    }

    /// What [`Study::read`] takes.
    fn record(&self) -> String {
        // What was read from JSON can be written.
        serde_json::to_string::<Record>(&self.study.record).unwrap_or_default()
    }

    /// The folder.
    fn folder(&self) -> PathBuf {
        self.study.dir().to_owned()
    }

    /// How far the study is: `points`, `done`, `failed`, `left_out`, `parts`, `missing`.
    fn status(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let status = py.detach(|| self.study.status());
        to_python(py, &to_value(status).unwrap_or_default())
    }

    /// Runs the parts that are missing, on `threads` threads.
    fn run(&self, py: Python<'_>, threads: usize, progress: Option<Py<PyAny>>) -> PyResult<()> {
        let mut watch = Watch::new(progress);
        let outcome = py.detach(|| self.study.run(Job::ALL, threads, &mut |p| watch.tell(p)));
        watch.end()?;
        outcome.map(drop).map_err(|e| unstudied(py, e))
    }

    /// The files of one part; nothing is written.
    fn compute<'py>(&self, py: Python<'py>, part: usize, threads: usize) -> PyResult<Files<'py>> {
        let mut watch = Watch::new(None);
        let files = py.detach(|| self.study.compute(part, threads, &mut |p| watch.tell(p)));
        watch.end()?;
        let files = files.map_err(|e| unstudied(py, e))?;
        Ok((PyBytes::new(py, &files.rows), files.curves.map(|c| PyBytes::new(py, &c))))
    }

    /// Puts the files of a part into the folder.
    fn put(&self, py: Python<'_>, part: usize, rows: Vec<u8>, curves: Option<Vec<u8>>) -> PyResult<()> {
        let files = Part { rows, curves };
        py.detach(|| self.study.put(part, &files)).map_err(|e| unstudied(py, e))
    }

    /// Writes the tables and the page of the study, and answers the path of the table and what the results depend on, when all rows are there.
    fn collect(&self, py: Python<'_>) -> PyResult<(PathBuf, Py<PyAny>)> {
        let collected = py.detach(|| self.study.write_table(true)).map_err(|e| unstudied(py, e))?;
        let analysis = to_value(&collected.analysis).unwrap_or_default();
        Ok((collected.path, to_python(py, &analysis)?))
    }
}
