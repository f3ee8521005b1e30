//! Why a study has no answer.

use std::fmt;

use gudgeon_case::Report;
use gudgeon_scene::Stopped;

/// Why a study has no answer.
#[derive(Debug)]
#[non_exhaustive]
pub enum StudyError {
    /// The input is wrong.
    Input(Report),
    /// The caller wanted it to end.
    Stopped,
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
            Self::Stopped => Stopped.fmt(f),
        }
    }
}

impl std::error::Error for StudyError {}
