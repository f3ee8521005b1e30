//! One module per command.

pub mod bench;
pub mod check;
pub mod compare;
pub mod completions;
pub mod describe;
pub mod explain;
pub mod gradient;
mod keys;
pub mod man;
pub mod models;
pub mod new;
pub mod report;
pub mod run;
mod scenes;
pub mod schema;
mod sets;
mod shares;
mod spark;
pub mod study;
mod trends;
pub mod validate;

use std::path::Path;

use gudgeon_report::Folder;
use gudgeon_scene::Checked;

use crate::args::out_dir;
use crate::failure::Failure;
use crate::ui::Ui;

/// Reads and validates the case; its notes are told at once.
fn checked(case: &Path, set: &[String], ui: &Ui) -> Result<Checked, Failure> {
    let checked = gudgeon_scene::check(case, set)?;
    for note in &checked.notes {
        ui.note(note);
    }
    Ok(checked)
}

/// Opens the folder of the results before any time is spent on a run.
fn open_out(given: Option<&Path>, case: &Path, name: &str, suffix: &str) -> Result<Folder, Failure> {
    let dir = out_dir(given, name, suffix);
    // The nearest part of the path that exists must be a folder.
    if let Some(file) =
        dir.ancestors().find(|a| !a.as_os_str().is_empty() && a.exists()).filter(|a| !a.is_dir())
    {
        return Err(Failure::argument(
            format!("results cannot go to `{}`: `{}` is a file", dir.display(), file.display()),
            "give a folder with `--out DIR`",
        ));
    }
    let folder = Folder::open(&dir)?;
    let before = folder.case().filter(|before| !same_file(Path::new(before), case));
    match before {
        Some(before) if given.is_none() && !is_record(case) => Err(Failure::argument(
            format!("`{}` holds the results of another case, `{before}`", dir.display()),
            "give a folder with `--out DIR`; results of two cases of one name do not share one",
        )),
        Some(before) if is_record(case) => Ok(folder.of_case(before)),
        _ if is_record(case) => Ok(folder),
        _ => Ok(folder.of_case(case.display().to_string())),
    }
}

/// Whether a case is told by the summary of an earlier run.
fn is_record(case: &Path) -> bool {
    case.extension().is_some_and(|e| e == "json")
}

/// Whether two names stand for one file. What does not exist any more is nobody's.
fn same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => true,
    }
}
