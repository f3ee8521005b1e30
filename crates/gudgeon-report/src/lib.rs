//! Result files of a run, a comparison or a benchmark, and the HTML page a person opens first.
//!
//! | call | writes |
//! |---|---|
//! | [`write_run`] | `summary.json`, `series.csv`, `report.html` |
//! | [`write_comparison`] | `comparison.json`, `comparison.csv`, `series.csv`, `report.html` |
//! | [`write_bench`] | `bench.json`, `bench.csv`, `report.html` |
//! | [`rewrite`] | `report.html` again, from the other files of a directory |
//!
//! Files appear whole or not at all: each is written beside its place under a temporary name, and all are renamed once
//! the last one is complete. The same input gives the same bytes. A page is one file that loads nothing: its style, its
//! script and its data are inside, and its content policy forbids the browser any request. A link may open it at a crank
//! angle and a range: `report.html#theta=380&view=300,480`.

mod bench;
mod comparison;
mod error;
mod number;
mod page;
mod run;
mod stage;
mod summary;
mod table;

pub use bench::{BenchFiles, write_bench};
pub use comparison::{ComparisonFiles, write_comparison};
pub use error::ReportError;
pub use run::{RunFiles, summary_json, write_run};

use std::path::{Path, PathBuf};

/// Rebuilds `report.html` of a directory from the data files beside it, after they were edited, copied or written by
/// another version of the program. Equations and validity texts come from the models linked into this program.
///
/// # Errors
/// The directory holds none of `summary.json`, `comparison.json`, `bench.json`, or a file in it cannot be read.
pub fn rewrite(dir: &Path) -> Result<PathBuf, ReportError> {
    if dir.join(run::SUMMARY).is_file() {
        run::rewrite(dir)
    } else if dir.join(comparison::COMPARISON).is_file() {
        comparison::rewrite(dir)
    } else if dir.join(bench::BENCH).is_file() {
        bench::rewrite(dir)
    } else {
        Err(ReportError::NothingHere { dir: dir.to_path_buf() })
    }
}

/// Name of the page in every result directory.
pub(crate) const REPORT: &str = "report.html";
