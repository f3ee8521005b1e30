//! What benches and counters run over.

use std::collections::BTreeSet;

use gudgeon_benches::alone::{KINDS, Reach, models, reach};
use gudgeon_benches::cases::{Case, counted, instructed, one_a_scene};
use gudgeon_benches::measure::each;
use gudgeon_core::Registry;

/// A new kind is either reached alone or said to be reached within a scene.
#[test]
fn every_kind_is_in_the_list() {
    let registered: Vec<&str> = Registry::collect().kinds().map(|k| k.kind).collect();
    let listed: Vec<&str> = KINDS.iter().map(|k| k.0).collect();
    assert_eq!(registered, listed, "the list stands in benches/src/alone/mod.rs");
}

#[test]
fn every_model_that_stands_alone_is_built_and_answers() {
    let mut wrong = Vec::new();
    for m in models() {
        if let Some(Reach::Alone(stand)) = reach(m.kind)
            && let Err(e) = stand(m)
        {
            wrong.push(format!("{}/{}: {e}", m.kind, m.name));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_scene_has_a_case() {
    let of = |case: &Case| {
        let checked = case.check().expect("a shipped case");
        gudgeon_case::scene_of(checked.case.source(), checked.case.overrides())
            .expect("a case names its scene")
    };
    let found: BTreeSet<String> = one_a_scene().iter().map(of).collect();
    let all: BTreeSet<String> = gudgeon_scene::scenes().iter().map(|s| s.name.to_owned()).collect();
    assert_eq!(found, all);
}

#[test]
fn names_and_neighbours_of_cases_are_told_apart() {
    let all = counted();
    let names: BTreeSet<&str> = all.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names.len(), all.len());
    for case in &all {
        let near = case.neighbours().expect("numbers that are there");
        let different: BTreeSet<&[String]> = near.iter().map(|c| c.set.as_slice()).collect();
        assert_eq!(different.len(), near.len(), "{}", case.name);
        // A number whose last digits the reader drops would make the same case.
        let texts: BTreeSet<String> =
            near.iter().map(|c| c.check().expect("a neighbour").case.resolved().to_string()).collect();
        assert_eq!(texts.len(), near.len(), "{}", case.name);
    }
}

/// The cases that valgrind is given are small, and cover a ring pack, a film and an optimiser.
#[test]
fn counts_are_the_same_every_time_and_on_any_number_of_threads() {
    let cases = instructed();
    let once = each(&cases, 1);
    assert!(once.iter().all(Result::is_ok), "{once:?}");
    assert_eq!(each(&cases, 3), once);
}
