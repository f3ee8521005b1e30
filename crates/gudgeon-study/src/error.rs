//! Why a study has no answer.

use std::fmt;

use gudgeon_case::Report;
use gudgeon_scene::{RunError, Stopped};

/// Why a study has no answer.
#[derive(Debug)]
#[non_exhaustive]
pub enum StudyError {
    /// The input is wrong.
    Input(Report),
    /// A run that everything else counts from has no result, or there is nothing to run.
    Run(RunError),
    /// The caller wanted it to end.
    Stopped,
}

impl From<RunError> for StudyError {
    fn from(e: RunError) -> Self {
        match e {
            RunError::Stopped => Self::Stopped,
            e => Self::Run(e),
        }
    }
}

impl From<Report> for StudyError {
    fn from(report: Report) -> Self {
        Self::Input(report)
    }
}

impl From<Stopped> for StudyError {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

impl fmt::Display for StudyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(report) => report.fmt(f),
            Self::Run(e) => e.fmt(f),
            Self::Stopped => Stopped.fmt(f),
        }
    }
}

impl std::error::Error for StudyError {}
