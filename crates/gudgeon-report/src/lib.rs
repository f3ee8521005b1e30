//! Result files of a run, a comparison or a benchmark, and the HTML page a person opens first.
//!
//! | call | writes |
//! |---|---|
//! | [`write_run`] | `summary.json`, `series.csv`, `report.html` |
//! | [`write_comparison`] | `comparison.json`, `comparison.csv`, `series.csv`, `report.html` |
//! | [`write_bench`] | `bench.json`, `bench.csv`, `report.html` |
//! | [`write_validation`] | an index and a page for each case, in Markdown |
//! | [`rewrite`] | `report.html` again, from the other files of a directory |
//!
//! A folder changes whole or not at all ([`Folder`]), and old results never stand beside new ones. The same input gives the same
//! bytes; wall times stand in `timing.json`. A page is one file that loads nothing: its style, its
//! script and its data are inside, and its content policy forbids the browser any request. A link may open it at a crank
//! angle and a range: `report.html#theta=380&view=300,480`.
#![cfg_attr(doctest, doc = include_str!("../README.md"))]

mod bench;
mod comparison;
mod differences;
mod error;
mod folder;
mod gradients;
mod inputs;
mod number;
mod over_values;
mod overview;
mod page;
mod results;
mod run;
mod shares;
mod spark;
mod study;
mod summary;
mod table;
mod validation;

pub use bench::{BenchFiles, write_bench, write_bench_in};
pub use comparison::{ComparisonFiles, write_comparison, write_comparison_in};
pub use error::ReportError;
pub use folder::Folder;
pub use gradients::{gradients_json, gradients_value, write_gradients_in};
pub use page::{OVER_CYCLE, RUN_SCRIPTS};
pub use run::{RunFiles, run_data, run_files, summary_json, write_run, write_run_in};
pub use study::{StudyPage, study_page};
pub use validation::{page_name, validation_index, validation_page};

use std::path::{Path, PathBuf};

use gudgeon_core::result::Validated;

/// Rebuilds `report.html` of a directory from the data files beside it, after they were edited, copied or written by
/// another version of the program. Equations and validity texts come from the models linked into this program.
///
/// # Errors
/// The directory holds none of `summary.json`, `comparison.json`, `bench.json`, or a file in it cannot be read.
pub fn rewrite(dir: &Path) -> Result<PathBuf, ReportError> {
    folder::settle(dir)?;
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

/// Writes the page of every case into the folder `pages`, and the page that links them as `index`, which stands above or in it.
///
/// # Errors
/// A file system that refuses.
pub fn write_validation(all: &[Validated], index: &Path, pages: &Path) -> Result<(), ReportError> {
    let mut folder = Folder::open(pages)?;
    for v in all {
        folder.add(&format!("{}.md", page_name(v)), validation_page(v).as_bytes())?;
    }
    let below = index.parent().and_then(|above| pages.strip_prefix(above).ok()).unwrap_or(pages);
    let text = validation_index(all, &below.display().to_string());
    folder.commit()?;
    std::fs::write(index, text).map_err(ReportError::io("write", index))
}

/// Name of the page in every result directory.
pub(crate) const REPORT: &str = "report.html";
