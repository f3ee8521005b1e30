//! A case that was read and found to be possible.

use std::path::PathBuf;
use std::sync::Arc;

use gudgeon_case::{Report, Source};
use gudgeon_core::file::Files;
use gudgeon_scene::run::{run_alone, run_alone_verified, run_on, run_verified_on};
use gudgeon_scene::{Checked, GradientError, Threads, check, check_source, explain, with_threads};
use gudgeon_study::gradients::gradients;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::errors::{failed, refused};
use crate::interrupt::Watch;
use crate::many::{Rows, rows};
use crate::result::Outcome;
use crate::values::to_python;

/// What a case is made of: file name, text, `--set` arguments, and the files it names with their texts.
type State = (String, String, Vec<String>, Vec<(String, String)>);

/// A case that was read and found to be possible. Does not change.
#[pyclass(frozen, module = "gudgeon._native")]
pub struct Case {
    checked: Arc<Checked>,
}

impl Case {
    fn new(py: Python<'_>, checked: Result<Checked, Report>) -> PyResult<Self> {
        Ok(Self { checked: Arc::new(checked.map_err(|report| refused(py, &report))?) })
    }

    /// What was read.
    pub const fn checked(&self) -> &Arc<Checked> {
        &self.checked
    }
}

#[pymethods]
impl Case {
    /// Reads a case file, or the `summary.json` of a run.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        Self::new(py, py.detach(|| check(&path, &overrides)))
    }

    /// Reads a case from its text. `name` stands for the file in messages; `folder` is where relative paths start.
    #[staticmethod]
    fn loads(
        py: Python<'_>,
        text: String,
        folder: PathBuf,
        name: String,
        overrides: Vec<String>,
    ) -> PyResult<Self> {
        let source = Source { name: name.clone(), text, files: Files::of(&folder) };
        Self::new(py, py.detach(|| check_source(name, source, &overrides)))
    }

    /// A case from its state.
    #[staticmethod]
    fn restored(py: Python<'_>, state: State) -> PyResult<Self> {
        let (name, text, overrides, files) = state;
        let source = Source { name: name.clone(), text, files: Files::recorded(files) };
        Self::new(py, py.detach(|| check_source(name, source, &overrides)))
    }

    /// What [`Case::restored`] takes: it names no folder of this machine.
    fn state(&self) -> State {
        let source = self.checked.case.source();
        let files = source.files.read_so_far();
        let files = files.into_iter().map(|(name, text)| (name, text.to_string())).collect();
        (self.checked.file.clone(), source.text.clone(), self.checked.case.overrides().to_vec(), files)
    }

    /// The same case with more `--set` arguments.
    fn changed(&self, py: Python<'_>, more: Vec<String>) -> PyResult<Self> {
        Self::new(py, py.detach(|| self.checked.with(&more)))
    }

    /// Name, title, source and scene.
    fn heading(&self) -> (&str, &str, &str, String) {
        let (case, heading) = (self.checked.case.as_ref(), self.checked.case.heading());
        let scene = gudgeon_case::scene_of(case.source(), case.overrides()).unwrap_or_default();
        (&self.checked.name, heading.title, heading.source, scene)
    }

    /// What a person should know although nothing is wrong.
    fn notes(&self) -> &[String] {
        &self.checked.notes
    }

    /// Names of the results that a run may tell, where the scene knows them before.
    fn result_names(&self, py: Python<'_>) -> Option<Vec<String>> {
        py.detach(|| self.checked.case.result_names())
    }

    /// Every value in SI units, changes and defaults filled in.
    fn resolved(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        to_python(py, &self.checked.case.resolved())
    }

    /// Models, what runs and what is skipped, every value: as text for a person and as values.
    fn explain(&self, py: Python<'_>) -> PyResult<(String, Py<PyAny>)> {
        let told = py.detach(|| explain(&self.checked)).map_err(|e| failed(e.failure()))?;
        let value = serde_json::to_value(&told).unwrap_or_default();
        Ok((told.to_text(), to_python(py, &value)?))
    }

    /// Runs the case; with its sweeps on `threads` threads, and with the numerical uncertainty of every result, if asked for.
    #[pyo3(signature = (sweeps, verify, threads, progress))]
    fn run(
        &self,
        py: Python<'_>,
        sweeps: bool,
        verify: bool,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Outcome> {
        let mut watch = Watch::new(progress);
        let outcome = py.detach(|| {
            let (c, tell) = (&self.checked, &mut |p| watch.tell(p));
            let mut run = || match (sweeps, verify) {
                (true, true) => run_verified_on(c, threads, tell),
                (true, false) => run_on(c, threads, tell),
                (false, true) => run_alone_verified(c, tell),
                (false, false) => run_alone(c, tell),
            };
            if threads == 1 { with_threads(Threads::One, run) } else { run() }
        });
        watch.end()?;
        Ok(Outcome::new(outcome.map_err(|e| failed(e.failure()))?))
    }

    /// Derivatives of results by inputs; of all results where none is named.
    fn gradients(
        &self,
        py: Python<'_>,
        inputs: Vec<String>,
        results: Vec<String>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Py<PyAny>> {
        let mut watch = Watch::new(progress);
        let found = py.detach(|| gradients(&self.checked, &inputs, &results, &mut |p| watch.tell(p)));
        watch.end()?;
        let found = found.map_err(|e| match e {
            GradientError::Run(e) => failed(e.failure()),
            e => PyValueError::new_err(e.to_string()),
        })?;
        to_python(py, &gudgeon_report::gradients_value(&found))
    }

    /// Runs the case once for each of `points`, lists of `--set` arguments, sweeps apart.
    fn run_many(
        &self,
        py: Python<'_>,
        points: Vec<Vec<String>>,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Rows> {
        let mut watch = Watch::new(progress);
        let told = py.detach(|| rows(self.checked.case.as_ref(), &points, threads, &mut |p| watch.tell(p)));
        watch.end()?;
        Ok(told)
    }
}
