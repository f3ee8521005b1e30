//! Cases that went wrong once: one file each.

use std::path::Path;

use serde::Deserialize;

use crate::class::Class;

/// One file of `regressions/`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Regression {
    /// Name of the file without its extension.
    #[serde(skip)]
    pub name: String,
    /// Case file below the folder of cases.
    pub case: String,
    /// The `--set` arguments.
    pub set: Vec<String>,
    /// Classes that it may have.
    pub expect: Vec<Class>,
    /// The class that it still has instead. Whoever mends it deletes this line.
    #[serde(default)]
    pub known: Option<Class>,
    /// What it is about.
    pub why: String,
    /// Whether it is run one level finer too.
    #[serde(default)]
    pub refine: bool,
    /// Whether it is run twice.
    #[serde(default)]
    pub twice: bool,
}

/// Reads all files of a folder, in the order of their names.
///
/// # Errors
/// What cannot be read, with its name.
pub fn read(folder: &Path) -> Result<Vec<Regression>, String> {
    let told = |e: std::io::Error| format!("{}: {e}", folder.display());
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(told)? {
        let path = entry.map_err(told)?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            files.push(path);
        }
    }
    files.sort();
    let one = |path: &std::path::PathBuf| {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let mut r: Regression = toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?;
        r.name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        Ok(r)
    };
    files.iter().map(one).collect()
}
