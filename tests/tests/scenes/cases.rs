//! The cases that ship with Gudgeon.

use crate::common::*;
use gudgeon_sim::case::RingPackCase;
use gudgeon_sim::{check, explain};

#[test]
fn every_case_is_possible_and_explains_itself() {
    let folder = case_file("x").parent().expect("a folder").to_owned();
    let mut seen = 0;
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("the folder").map(|e| e.expect("an entry").path()).collect();
    files.sort();
    for path in files.iter().filter(|p| p.extension().is_some_and(|e| e == "toml")) {
        let checked = check(path, &[]).unwrap_or_else(|r| panic!("{}: {r}", path.display()));
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
