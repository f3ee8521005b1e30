//! What a package holds.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use crate::metadata::Package;

/// Files that every package holds.
const ALWAYS: [&str; 3] = ["README.md", "LICENSE-MIT", "LICENSE-APACHE"];
/// Folders of the repository that no package carries.
const NEVER: [&str; 4] = ["tests/", "benches/", "examples/", "target/"];

/// What is missing in the list of its files, what should not be there, and links of its README that lead nowhere.
pub(crate) fn complaints<'a>(p: &Package, list: impl Iterator<Item = &'a str>) -> Vec<String> {
    let files: BTreeSet<String> = list.map(|f| f.replace('\\', "/")).collect();
    let mut wrong: Vec<String> =
        ALWAYS.iter().filter(|f| !files.contains(**f)).map(|f| format!("no {f} in the package")).collect();
    let needless = files.iter().filter(|f| NEVER.iter().any(|folder| f.starts_with(folder)));
    wrong.extend(needless.map(|f| format!("{f} is in the package")));
    for file in files.iter().filter(|f| f.ends_with(".rs")) {
        match std::fs::read_to_string(p.folder.join(file)) {
            Ok(text) => wrong.extend(missing_includes(file, &text, &files)),
            Err(e) => wrong.push(format!("{file}: {e}")),
        }
    }
    match std::fs::read_to_string(p.folder.join("README.md")) {
        Ok(text) => wrong.extend(dead_links(&p.folder, &text)),
        Err(e) => wrong.push(format!("README.md: {e}")),
    }
    wrong.into_iter().map(|w| format!("{}: {w}", p.name)).collect()
}

/// Files that a source file takes in at compile time and that are not among the files of its package.
#[must_use]
pub fn missing_includes(file: &str, text: &str, files: &BTreeSet<String>) -> Vec<String> {
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let code = text.lines().filter(|l| !l.trim_start().starts_with("//"));
    let named = code.flat_map(|l| {
        ["include_str!(\"", "include_bytes!(\"", "include!(\""]
            .into_iter()
            .filter_map(move |word| l.split_once(word)?.1.split_once('"').map(|(name, _)| name))
    });
    named
        .filter(|name| !files.contains(&resolved(&folder.join(name))))
        .map(|name| format!("{file} takes in {name}, which is not in the package"))
        .collect()
}

/// A path without `..`, with slashes.
fn resolved(path: &Path) -> String {
    let mut parts = PathBuf::new();
    for c in path.components() {
        match c {
            Component::ParentDir if parts.pop() => {}
            c => parts.push(c),
        }
    }
    parts.to_string_lossy().replace('\\', "/")
}

/// Relative links of a README whose targets are not there. The index resolves them against `repository`.
fn dead_links(folder: &Path, text: &str) -> Vec<String> {
    let targets = text.split("](").skip(1).filter_map(|t| t.split_once(')').map(|(target, _)| target));
    targets
        .filter(|t| !t.contains("://") && !t.starts_with('#'))
        .filter(|t| !folder.join(t.split('#').next().unwrap_or(t)).exists())
        .map(|t| format!("README.md links to {t}, which is not there"))
        .collect()
}
