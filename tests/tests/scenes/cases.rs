//! The cases that ship with Gudgeon.

use crate::common::*;
use gudgeon_scene::{check, explain, run};
use gudgeon_scene_ring_pack::case::RingPackCase;

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

#[test]
fn results_are_known_before_a_run() {
    let folder = case_file("x").parent().expect("a folder").to_owned();
    let files = |below: &str| -> Vec<_> {
        let mut all: Vec<_> = std::fs::read_dir(folder.join(below))
            .expect("the folder")
            .map(|e| e.expect("an entry").path())
            .filter(|p| p.extension().is_some_and(|e| e == "toml"))
            .collect();
        all.sort();
        all
    };
    let quick = |p: &std::path::PathBuf| {
        let name = p.file_name().expect("a file").to_string_lossy();
        ["pin-", "skirt-profile", "geared", "compressor-4", "turbo-diesel-120.toml"]
            .iter()
            .any(|n| name.starts_with(n))
    };
    let mut seen = 0;
    for path in files("rigs").into_iter().chain(files("").into_iter().filter(quick)) {
        let checked = check(&path, &[]).unwrap_or_else(|r| panic!("{}: {r}", path.display()));
        let known = checked.case.result_names().expect("a case that is legal");
        let single: std::collections::HashSet<&String> = known.iter().collect();
        assert_eq!(single.len(), known.len(), "{}: a name twice", path.display());
        let told = run(&checked, &mut |_| {}).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        for name in told.results.keys() {
            assert!(single.contains(name), "{}: `{name}` was not known", path.display());
        }
        seen += 1;
    }
    assert!(seen >= 40, "only {seen} cases");
}
