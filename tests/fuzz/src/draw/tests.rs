use std::collections::BTreeSet;

use super::*;
use crate::corpus::shipped;

fn corpus() -> Corpus {
    Corpus::read(&shipped()).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn seed_and_index_say_all() {
    let (corpus, again) = (corpus(), corpus());
    let (a, b) = (Draw::new(&corpus, 3, 0.3), Draw::new(&again, 3, 0.3));
    let other = Draw::new(&corpus, 4, 0.3);
    let case = |d: &Draw<'_>, i| d.case(i).unwrap_or_else(|e| panic!("{e}"));
    // Backwards, as another thread might.
    let backwards: Vec<Case> = (0..60).rev().map(|i| case(&b, i)).collect();
    let mut differ = 0;
    for (i, theirs) in backwards.iter().rev().enumerate() {
        let mine = case(&a, i as u64);
        assert_eq!(mine, *theirs);
        differ += usize::from(mine != case(&other, i as u64));
    }
    assert!(differ > 50, "{differ} of 60 cases depend on the seed");
}

#[test]
fn every_scene_and_every_legal_model_is_reached() {
    let corpus = corpus();
    let draw = Draw::new(&corpus, 1, 0.0);
    let registry = Registry::collect();
    let mut missing: BTreeSet<(&str, &str)> =
        registry.kinds().flat_map(|k| registry.models(k.kind).iter().map(|m| (m.kind, m.name))).collect();
    let mut scenes = BTreeSet::new();
    // A case has three and a half changes, a fifth of them models: 20000 cases draw each of some 130 models 20 times if a kind is asked for
    // by one site in five hundred.
    for i in 0..20_000 {
        let case = draw.case(i).unwrap_or_else(|e| panic!("{e}"));
        for c in &case.changes {
            // A solver is chosen by `method`, every other model by `model` or, of a table that is there, by its name alone.
            let chosen = |name: &str| {
                ["model", "method"].iter().any(|k| c.value.contains(&format!("{k} = \"{name}\"")))
            };
            missing.retain(|(_, name)| !chosen(name) && c.value != *name);
        }
        scenes.insert(case.scene);
        if missing.is_empty() && scenes.len() == corpus.schemas.len() {
            return;
        }
    }
    panic!("scenes reached: {scenes:?}; models not reached: {missing:?}");
}

#[test]
fn plausible_changes_keep_to_what_they_say() {
    let corpus = corpus();
    let draw = Draw::new(&corpus, 2, 0.0);
    let wild = Draw::new(&corpus, 2, 1.0);
    let case = |d: &Draw<'_>, i| d.case(i).unwrap_or_else(|e| panic!("{e}"));
    for i in 0..300 {
        let c = case(&draw, i);
        assert!(!c.wild() && c.changes.len() <= MOST);
        assert!(case(&wild, i).wild() || case(&wild, i).changes.is_empty());
        // What is plausible is at least text that the loader can read.
        for set in c.set() {
            let value = set.split_once('=').expect("a path and a value").1;
            let quoted = value.starts_with(['[', '{', '"']);
            assert!(!quoted || format!("v = {value}").parse::<toml::Table>().is_ok(), "{set}");
        }
    }
}
