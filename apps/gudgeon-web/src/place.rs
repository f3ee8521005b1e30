//! The case of a text.

use gudgeon_case::{Report, Source};
use gudgeon_scene::{Checked, check_source};

use crate::cases::files;

/// The source of a text, with the files that it may name.
pub fn source(file: &str, text: String) -> Source {
    Source { name: file.to_owned(), text, files: files(file) }
}

/// Name of a case without its folder, as a record of a run has it.
pub fn base(file: &str) -> String {
    file.rsplit('/').next().unwrap_or(file).to_owned()
}

/// Reads and checks a text with changes.
///
/// # Errors
/// Everything that is wrong with it.
pub fn checked(file: &str, text: String, set: &[String]) -> Result<Checked, Report> {
    check_source(base(file), source(file, text), set)
}
