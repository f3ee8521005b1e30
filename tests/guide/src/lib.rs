//! The guide under `docs/guide`: its generated pages, its links, its commands, and the tree that mdBook builds.
//!
//! Pages below `src/reference` are written from the registry and the schemas; all others are written by people. `gudgeon-guide` is the
//! program: `write`, `check`, `run`, `stage`, `links`.

pub mod benches;
pub mod bib;
pub mod cases;
pub mod check;
pub mod commands;
pub mod compared;
pub mod html;
pub mod keys;
pub mod markdown;
pub mod reference;
pub mod stage;
pub mod svg;

use std::path::{Path, PathBuf};

/// What a step of the guide can end with: a text for the person who runs it.
pub type Outcome<T> = Result<T, String>;

/// Root of the repository.
#[must_use]
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).unwrap_or(here).to_owned()
}

/// Sources of the guide, as mdBook reads them.
#[must_use]
pub fn source() -> PathBuf {
    root().join("docs/guide/src")
}

/// A text file, or why it cannot be read.
///
/// # Errors
/// The file and the reason.
pub fn read(file: &Path) -> Outcome<String> {
    std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))
}

/// Writes a text file and the folders above it.
///
/// # Errors
/// The file and the reason.
pub fn write(file: &Path, text: &str) -> Outcome<()> {
    let told = |e: std::io::Error| format!("{}: {e}", file.display());
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(told)?;
    }
    std::fs::write(file, text).map_err(told)
}

/// Files below a folder whose name ends so, sorted.
///
/// # Errors
/// A folder that cannot be read.
pub fn files(folder: &Path, ending: &str) -> Outcome<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))? {
        let path = entry.map_err(|e| e.to_string())?.path();
        if path.is_dir() {
            found.extend(files(&path, ending)?);
        } else if path.to_string_lossy().ends_with(ending) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// A path without `.` and `..`, which need not exist.
#[must_use]
pub fn tidy(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            std::path::Component::CurDir => {}
            std::path::Component::ParentDir => {
                out.pop();
            }
            other => out.push(other),
        }
    }
    out
}

/// The way from one folder to a file, both below the same root.
#[must_use]
pub fn relative(from: &Path, to: &Path) -> String {
    let (a, b): (Vec<_>, Vec<_>) = (from.components().collect(), to.components().collect());
    let shared = a.iter().zip(&b).take_while(|(x, y)| x == y).count();
    let up = std::iter::repeat_n("..".to_owned(), a.len() - shared);
    let down = b[shared..].iter().map(|c| c.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}
