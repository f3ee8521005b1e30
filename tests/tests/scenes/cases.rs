//! The cases that ship with Gudgeon.

use std::path::{Path, PathBuf};

use crate::common::*;
use gudgeon_scene::{check, explain};
use gudgeon_scene_ring_pack::case::RingPackCase;

/// The cases of a folder, in order.
fn files_of(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder").map(|e| e.expect("an entry").path());
    let mut files: Vec<_> = entries.filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    files.sort();
    files
}

#[test]
fn every_case_is_possible_and_explains_itself() {
    let folder = case_file("x").parent().expect("a folder").to_owned();
    let mut seen = 0;
    for path in files_of(&folder) {
        let checked = check(&path, &[]).unwrap_or_else(|r| panic!("{}: {r}", path.display()));
        let case = checked.case.heading();
        assert!(!case.title.is_empty() && !case.source.is_empty(), "{}", path.display());
        assert!(!case.assumptions.is_empty(), "{}: nothing is assumed?", path.display());
        let e = explain(&checked).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert!(!e.models.is_empty() && !e.to_text().is_empty());
        assert!(checked.of::<RingPackCase>().is_none() || !e.states.is_empty(), "{}", path.display());
        seen += 1;
    }
    assert!(seen >= 6, "only {seen} cases");
}

/// That a run tells no other result is asserted at every run of every test.
#[test]
fn results_are_known_before_a_run() {
    let folder = case_file("x").parent().expect("a folder").to_owned();
    let mut seen = 0;
    for path in files_of(&folder).into_iter().chain(files_of(&folder.join("rigs"))) {
        let checked = check(&path, &[]).unwrap_or_else(|r| panic!("{}: {r}", path.display()));
        let known = checked.case.result_names().expect("a case that is legal");
        let single: std::collections::HashSet<&String> = known.iter().collect();
        assert_eq!(single.len(), known.len(), "{}: a name twice", path.display());
        assert!(!known.is_empty(), "{}", path.display());
        seen += 1;
    }
    assert!(seen >= 60, "only {seen} cases");
}
