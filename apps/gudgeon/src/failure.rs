//! Why a command did not do what it was asked, and the exit code that says so.

use std::process::ExitCode;

use gudgeon_case::{Diagnostic, Report};
use gudgeon_core::registry::RegistryError;
use gudgeon_report::ReportError;
use gudgeon_scene::{GradientError, RunError, Stopped};
use gudgeon_study::StudyError;
use gudgeon_study::study::FolderError;

#[derive(Debug)]
pub enum Failure {
    /// The case or a `--set` argument is wrong.
    Input(Report),
    /// Another argument is wrong.
    Argument(Diagnostic),
    /// The run failed.
    Run(String),
    /// The program contradicts itself.
    Registry(Vec<RegistryError>),
}

impl Failure {
    /// An argument that is wrong.
    pub fn argument(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Argument(Diagnostic::new(message).help(help))
    }

    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Input(_) | Self::Argument(_) => ExitCode::from(2),
            Self::Run(_) | Self::Registry(_) => ExitCode::from(1),
        }
    }
}

impl From<Report> for Failure {
    fn from(r: Report) -> Self {
        Self::Input(r)
    }
}
impl From<Diagnostic> for Failure {
    fn from(d: Diagnostic) -> Self {
        Self::Argument(d)
    }
}
impl From<RunError> for Failure {
    fn from(e: RunError) -> Self {
        match e {
            RunError::Refused(what) => Self::Argument(Diagnostic::new(what)),
            e => Self::Run(e.to_string()),
        }
    }
}
impl From<GradientError> for Failure {
    fn from(e: GradientError) -> Self {
        match e {
            GradientError::Run(e) => e.into(),
            e => Self::Argument(Diagnostic::new(e.to_string())),
        }
    }
}
impl From<Stopped> for Failure {
    fn from(_: Stopped) -> Self {
        Self::Run(Stopped.to_string())
    }
}
impl From<StudyError> for Failure {
    fn from(e: StudyError) -> Self {
        match e {
            StudyError::Input(report) => Self::Input(report),
            StudyError::Run(e) => e.into(),
            e => Self::Run(e.to_string()),
        }
    }
}
impl From<FolderError> for Failure {
    fn from(e: FolderError) -> Self {
        match e {
            FolderError::Input(report) => Self::Input(report),
            FolderError::Folder(what) => Self::Argument(Diagnostic::new(what)),
            e => Self::Run(e.to_string()),
        }
    }
}
impl From<ReportError> for Failure {
    fn from(e: ReportError) -> Self {
        match e {
            ReportError::NothingHere { .. } | ReportError::Malformed { .. } => {
                Self::Argument(Diagnostic::new(e.to_string()))
            }
            e => Self::Run(e.to_string()),
        }
    }
}
