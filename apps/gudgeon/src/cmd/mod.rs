//! One module per command.

pub mod bench;
pub mod check;
pub mod compare;
pub mod describe;
pub mod explain;
pub mod models;
pub mod report;
pub mod run;
pub mod schema;

use std::path::Path;

use gudgeon_sim::Checked;

use crate::args::CaseArgs;
use crate::failure::Failure;
use crate::ui::Ui;

/// Reads and validates the case; its notes are told at once.
fn checked(a: &CaseArgs, ui: &Ui) -> Result<Checked, Failure> {
    let checked = gudgeon_sim::check(&a.case, &a.set)?;
    for note in &checked.notes {
        ui.note(note);
    }
    Ok(checked)
}

/// Refuses an output folder that cannot be one before any time is spent on a run.
fn check_out(dir: &Path) -> Result<(), Failure> {
    // The nearest part of the path that exists must be a folder.
    match dir.ancestors().find(|a| !a.as_os_str().is_empty() && a.exists()) {
        Some(a) if !a.is_dir() => Err(Failure::argument(
            format!("results cannot go to `{}`: `{}` is a file", dir.display(), a.display()),
            "give a folder with `--out DIR`",
        )),
        _ => Ok(()),
    }
}
