//! Errors as the exceptions of the package.

use gudgeon_case::{Diagnostic, Report};
use gudgeon_core::result::Failure;
use gudgeon_report::ReportError;
use gudgeon_scene::Stopped;
use gudgeon_study::study::FolderError;
use pyo3::exceptions::{PyKeyError, PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::values::to_python;

pyo3::import_exception!(gudgeon.errors, CaseError);
pyo3::import_exception!(gudgeon.errors, RunError);

/// A case that is wrong: the text for a person, and every mistake with its place.
pub fn refused(py: Python<'_>, report: &Report) -> PyErr {
    match to_python(py, &report.to_json()) {
        Ok(mistakes) => CaseError::new_err((report.render(false), mistakes)),
        Err(e) => e,
    }
}

/// A run that has no result.
pub fn failed(failure: Failure) -> PyErr {
    RunError::new_err((failure.message, failure.code, failure.path))
}

/// The caller wanted it to end.
pub fn stopped() -> PyErr {
    RunError::new_err((Stopped.to_string(), "stopped", ""))
}

/// A name that does not exist.
pub fn unknown(d: Diagnostic) -> PyErr {
    let help = d.help.map_or_else(String::new, |h| format!("; {h}"));
    PyKeyError::new_err(format!("{}{help}", d.message))
}

/// Files that cannot be written.
pub fn unwritten(e: &ReportError) -> PyErr {
    PyOSError::new_err(e.to_string())
}

/// A study that cannot go on.
pub fn unstudied(py: Python<'_>, e: FolderError) -> PyErr {
    match e {
        FolderError::Input(report) => refused(py, &report),
        FolderError::Stopped => RunError::new_err((e.to_string(), "stopped", "")),
        FolderError::Folder(what) => PyValueError::new_err(what),
        e => PyOSError::new_err(e.to_string()),
    }
}
