//! The cases of the repository: what each is, and which models it uses.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gudgeon_scene::{check, explain};

use crate::{Outcome, files, root};

/// One case file.
#[derive(Debug, Clone)]
pub struct Case {
    /// Path in the repository, `cases/rigs/slider-step.toml`.
    pub path: String,
    /// Its scene.
    pub scene: String,
    /// Its title.
    pub title: String,
    /// What it uses: `kind/model`.
    pub models: Vec<String>,
    /// The page that compares it with its sources, in the repository.
    pub validation: Option<String>,
}

impl Case {
    /// `rigs/slider-step`.
    #[must_use]
    pub fn name(&self) -> &str {
        self.path.trim_start_matches("cases/").trim_end_matches(".toml")
    }
}

/// All cases, by path; those of studies are no cases.
///
/// # Errors
/// A case that cannot be read or built.
pub fn all() -> Outcome<Vec<Case>> {
    let folder = root().join("cases");
    let paths: Vec<PathBuf> =
        files(&folder, ".toml")?.into_iter().filter(|p| !p.starts_with(folder.join("studies"))).collect();
    paths.iter().map(|p| case(p)).collect()
}

fn case(file: &Path) -> Outcome<Case> {
    let path = crate::relative(&root(), file);
    let checked = check(file, &[]).map_err(|e| format!("{path}: {e}"))?;
    let told = explain(&checked).map_err(|e| format!("{path}: {e}"))?;
    let mut models: Vec<String> =
        told.models.iter().map(|m| format!("{}/{}", m.used.kind, m.used.model)).collect();
    models.sort();
    models.dedup();
    let scene = checked.case.resolved()["scene"].as_str().unwrap_or_default().to_owned();
    let page = format!(
        "docs/validation/{}.md",
        path.trim_start_matches("cases/").trim_end_matches(".toml").replace('/', "-")
    );
    let validation = root().join(&page).is_file().then_some(page);
    Ok(Case { path, scene, title: checked.title().to_owned(), models, validation })
}

/// Names of the cases that use a model, by `kind/model`.
#[must_use]
pub fn users(cases: &[Case]) -> BTreeMap<&str, Vec<&Case>> {
    let mut out: BTreeMap<&str, Vec<&Case>> = BTreeMap::new();
    for case in cases {
        for model in &case.models {
            out.entry(model).or_default().push(case);
        }
    }
    out
}
