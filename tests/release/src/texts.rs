//! Files beside the manifests that name the version.

use std::path::Path;

/// What these files say of the version.
#[derive(Debug, Default)]
pub struct Kept {
    /// Files that contradict it.
    pub wrong: Vec<String>,
    /// What is left to write for a release.
    pub left: Vec<String>,
}

/// Looks at the changelog and the citation file of a repository.
#[must_use]
pub fn texts(root: &Path, version: &str) -> Kept {
    let mut kept = Kept::default();
    let read = |name: &str| std::fs::read_to_string(root.join(name)).unwrap_or_default();
    if !read("CITATION.cff").lines().any(|l| l.trim() == format!("version: {version}")) {
        kept.wrong.push(format!("CITATION.cff does not say `version: {version}`"));
    }
    let changes = read("CHANGELOG.md");
    let heading = format!("## [{version}]");
    match changes.lines().find(|l| l.starts_with(&heading)) {
        None => kept.wrong.push(format!("CHANGELOG.md has no heading `{heading}`")),
        Some(line) if !line.contains(" - 20") => {
            kept.left.push(format!("CHANGELOG.md: no date at `{heading}`"));
        }
        Some(_) => {}
    }
    if let Some(totals) = totals(&read("VALIDATION.md")).filter(|t| !changes.contains(t.as_str())) {
        kept.left.push(format!("CHANGELOG.md does not say `{totals}`, as VALIDATION.md does"));
    }
    kept
}

/// How much was reproduced, as the page of the validation says it in bold.
fn totals(validation: &str) -> Option<String> {
    let bold = validation.split("**").skip(1).step_by(2);
    bold.map(str::to_owned).find(|b| b.contains(" reproduced, "))
}
