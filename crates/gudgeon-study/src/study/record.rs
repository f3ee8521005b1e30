//! `study.json`: what a study runs, complete in itself.

use std::path::Path;

use gudgeon_case::{Report, Source};
use gudgeon_core::file::Files;
use gudgeon_core::result::KeptFile;
use gudgeon_scene::{Checked, check_source, sha256};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::file::StudyFile;
use super::list::PointList;

/// A case with everything that it reads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptCase {
    /// What the table calls it.
    pub name: String,
    /// Name of the case file, without its folder.
    pub file: String,
    /// Its text.
    pub text: String,
    /// Changes to it, those of the study included.
    pub set: Vec<String>,
    /// The files that it or a value of a varied input names, by their names in it.
    pub files: IndexMap<String, KeptFile>,
}

/// What a study runs.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Record {
    /// Version of Gudgeon: another one may compute other digits.
    pub gudgeon: String,
    /// The study file.
    pub study: StudyFile,
    /// Its cases.
    pub cases: Vec<KeptCase>,
    /// Its list of points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub list: Option<PointList>,
    /// Number of points.
    pub points: usize,
    /// Points of a part file.
    pub part: usize,
    /// Hash of all of the above: parts carry it, and only parts that carry it count.
    #[serde(default)]
    pub sha256: String,
}

impl Record {
    /// The hash of everything but itself.
    #[must_use]
    pub fn hash(&self) -> String {
        let bare = Self { sha256: String::new(), ..self.clone() };
        // Text, numbers and lists: JSON refuses none of them.
        sha256(serde_json::to_string(&bare).unwrap_or_default().as_bytes())
    }

    /// The cases, read again.
    ///
    /// # Errors
    /// A case that this version of the program refuses.
    pub fn checked(&self) -> Result<Vec<Checked>, Report> {
        self.cases.iter().map(KeptCase::checked).collect()
    }
}

impl KeptCase {
    /// Keeps a case with what was read of its files so far.
    #[must_use]
    pub fn of(name: &str, set: &[String], case: &Checked) -> Self {
        let source = case.case.source();
        let file = |(name, text): (String, std::sync::Arc<str>)| {
            (name, KeptFile { sha256: sha256(text.as_bytes()), text: text.to_string() })
        };
        Self {
            name: name.to_owned(),
            file: case.file.clone(),
            text: source.text.clone(),
            set: set.to_vec(),
            files: source.files.read_so_far().into_iter().map(file).collect(),
        }
    }

    fn checked(&self) -> Result<Checked, Report> {
        let kept = self.files.iter().map(|(name, f)| (name.clone(), f.text.clone()));
        let source =
            Source { name: self.file.clone(), text: self.text.clone(), files: Files::recorded(kept) };
        let name = Path::new(&self.file)
            .file_name()
            .map_or_else(|| self.file.clone(), |n| n.to_string_lossy().into_owned());
        check_source(name, source, &self.set)
    }
}
