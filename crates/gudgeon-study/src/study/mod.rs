//! Studies in folders: from one case to as many runs as wanted, on threads, by parts on many machines, broken off and resumed.
//!
//! ```text
//! study.json                    what is run: cases with their files, changes, points; its hash names everything that follows
//! parts/part-000000.parquet     rows of the points 0 to n-1; written aside and renamed, so that a part is there whole or not at all
//! parts/curves-000000.parquet   series of these points, where they were asked for
//! table.parquet                 all rows, once collected
//! ```
//!
//! Files are the truth. Whoever fills the folder (threads, an array of jobs, Dask), in whatever order and however often it is broken off: the parts
//! have the same bytes.

mod analysis;
mod collect;
mod columnar;
mod figures;
mod file;
mod folder;
mod input;
mod linear;
mod list;
mod notes;
mod part;
mod points;
mod prepare;
mod record;
mod table;

pub use analysis::{Analysis, Dependence, Finding, GridShares, Group};
pub use collect::Collected;
pub use columnar::{from_parquet, to_parquet};
pub use file::{Case, Changed, StudyFile};
pub use folder::{Job, Part, Status, Study};
pub use input::Input;
pub use linear::{Linear, Part as LinearPart};
pub use list::PointList;
pub use notes::Said;
pub use points::{Plan, Varied};
pub use record::{KeptCase, Record};
pub use table::{Column, Table, Values};

use std::path::PathBuf;

use gudgeon_case::Report;
use gudgeon_scene::Stopped;

/// Why a study cannot go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FolderError {
    /// The study file, a case or a list of points is wrong.
    #[error("{0}")]
    Input(Report),
    /// The folder is not what it should be.
    #[error("{0}")]
    Folder(String),
    /// The file system refused.
    #[error("cannot {what} {}: {source}", path.display())]
    Io {
        /// `read`, `write`.
        what: &'static str,
        /// What.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A table is damaged.
    #[error("{}: {why}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// The caller wanted it to end; what is done is kept.
    #[error("stopped; what is done is kept, and the same command goes on")]
    Stopped,
}

impl From<Report> for FolderError {
    fn from(report: Report) -> Self {
        Self::Input(report)
    }
}

impl From<Stopped> for FolderError {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

impl FolderError {
    fn io(what: &'static str, path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { what, path, source }
    }
}
