use std::path::PathBuf;

/// Results could not be written or read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// The file system refused.
    #[error("cannot {what} `{path}`: {source}", path = path.display())]
    Io {
        /// `write`, `read`, `create`.
        what: &'static str,
        /// Which file or directory.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Two runs into one folder.
    #[error("another run is writing `{dir}`", dir = dir.display())]
    Busy {
        /// The folder.
        dir: PathBuf,
    },
    /// A column has another number of rows than the crank angles.
    #[error("series column `{column}` has {rows} rows, but there are {expected} crank angles")]
    Ragged {
        /// Column.
        column: String,
        /// Its rows.
        rows: usize,
        /// Crank angles.
        expected: usize,
    },
    /// A result file does not have the shape that this program writes.
    #[error("`{path}` is not a result file of this program: {why}", path = path.display())]
    Malformed {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// No results to make a page from.
    #[error("`{dir}` holds no summary.json, comparison.json or bench.json to make a report from", dir = dir.display())]
    NothingHere {
        /// The directory.
        dir: PathBuf,
    },
}

impl ReportError {
    /// Wraps a file-system error.
    pub(crate) fn io(what: &'static str, path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { what, path, source }
    }
}
