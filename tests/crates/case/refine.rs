//! Settings that --verify refines.

use gudgeon_case::{Level, Loaded, load_str};
use schemars::JsonSchema;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

fn loaded<T: DeserializeOwned + Serialize + JsonSchema + 'static>(text: &str) -> Loaded<T> {
    load_str("refine.toml", text, ".".as_ref(), &[]).unwrap_or_else(|r| panic!("{r}"))
}

fn sets(levels: &[Level]) -> Vec<Vec<String>> {
    levels.iter().map(|l| l.set.clone()).collect()
}

#[derive(Serialize, Deserialize, JsonSchema)]
struct Inner {
    #[schemars(extend("x-refine" = { "group": "tolerance", "factor": 0.1 }))]
    tolerance: f64,
    #[schemars(extend("x-refine" = { "group": "grid", "factor": 2 }))]
    cells: u32,
    #[schemars(extend("x-refine" = { "group": "grid", "factor": 2 }))]
    automatic: u32,
}

#[derive(Serialize, Deserialize, JsonSchema)]
struct Outer {
    parts: Vec<Inner>,
    name: String,
}

#[test]
fn a_group_has_as_many_levels_as_its_dearest_setting() {
    #[derive(Serialize, Deserialize, JsonSchema)]
    struct Plane {
        #[schemars(extend("x-refine" = { "group": "grid", "factor": 2, "levels": 2 }))]
        along: u32,
        #[schemars(extend("x-refine" = { "group": "grid", "factor": 2 }))]
        across: u32,
    }
    let found = loaded::<Plane>("along = 20\nacross = 16\n").refinements();
    assert_eq!(found.len(), 1);
    assert_eq!(sets(&found[0].levels), [["along=40", "across=32"], ["along=80", "across=64"]]);
}

#[test]
fn a_group_is_coarsened_as_far_as_its_counts_stay_counts() {
    let part = "[[parts]]\ntolerance = 1e-4\ncells = 5\nautomatic = 0\n";
    let found = loaded::<Outer>(&format!("name = \"x\"\n{part}")).refinements();
    // 5, 3 (2.5 rounded), 1 (1.25 rounded), and no cell at all.
    assert_eq!(sets(&found[1].coarser), [["parts.0.cells=3"], ["parts.0.cells=1"]]);
    assert_eq!(found[1].own.set, ["parts.0.cells=5"]);
    assert_eq!(found[1].own.words, "cells 5");
    assert_eq!(found[1].own.asked, None, "a grid asks for no error");
    let asked: Vec<_> = found[0].coarser.iter().map(|l| (l.words.as_str(), l.asked)).collect();
    let expected =
        [("tolerance 1e-3", Some(1e-3)), ("tolerance 0.01", Some(1e-2)), ("tolerance 0.1", Some(0.1))];
    assert_eq!(asked, expected);
}

#[test]
fn settings_of_one_name_are_refined_together() {
    let part = "[[parts]]\ntolerance = 1e-4\ncells = 20\nautomatic = 0\n";
    let text = format!("name = \"x\"\n{part}{part}");
    let found = loaded::<Outer>(&text).refinements();
    let what: Vec<&str> = found.iter().map(|r| r.what.as_str()).collect();
    assert_eq!(what, ["tolerance", "grid"]);
    assert_eq!(found[0].levels[0].set, ["parts.0.tolerance=1e-5", "parts.1.tolerance=1e-5"]);
    assert_eq!(found[1].levels[0].set, ["parts.0.cells=40", "parts.1.cells=40"]);
    assert_eq!(found[1].levels[1].set, ["parts.0.cells=80", "parts.1.cells=80"]);
}
