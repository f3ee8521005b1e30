//! A cycle that repeats need not be the only one: what `--verify` tells of another, and starts that are hard to follow.

use crate::common::*;
use gudgeon_core::result::RunResult;
use gudgeon_scene::{run_verified, unwatched};

const CASE: &str = "turbo-diesel-120/flooded";
/// Loose enough for a test.
const ROUGH: &str = "solver.tolerance=1e-2";

/// The diesel with flooded faces at a speed.
fn verified(speed: &str) -> RunResult {
    let set = [&format!("engine.speed={speed}"), ROUGH];
    run_verified(&checked(CASE, &set), &mut unwatched).expect("it runs")
}

fn told(r: &RunResult, topic: &str) -> bool {
    r.solver.notes.iter().any(|n| n.topic == topic)
}

/// From 2700 to 2900 rpm ring 2 of the diesel with flooded faces either floats off the liner for part of every cycle or stays on it: gas between the rings at the start keeps it there.
#[test]
fn a_case_with_two_periodic_states_says_so() {
    let r = verified("2800 rpm");
    assert!(told(&r, "several_solutions"), "{:?}", r.solver.notes);
    let [own, other] = &r.branches[..] else { panic!("{:?}", r.branches) };
    assert_eq!((own.period, other.period), (1, 1));
    assert_eq!(own.results, r.results);
    // 81.7 and 62.2 l/min, each within 2e-3 of what a tolerance of 1e-3 gives.
    assert!(other.results["blow_by"].value < 0.8 * value(&r, "blow_by"), "{:?}", other.results["blow_by"]);
    // The other state is the one of a run that starts there.
    let there = run_case(CASE, &["engine.speed=2800 rpm", ROUGH, "solver.starts=[\"6 bar\"]"]);
    assert_eq!(other.results["blow_by"], there.results["blow_by"]);
}

#[test]
fn a_case_with_one_periodic_state_has_no_others() {
    for speed in ["2400 rpm", "3200 rpm"] {
        let r = verified(speed);
        assert!(r.branches.is_empty() && !told(&r, "several_solutions"), "{speed}: {:?}", r.solver.notes);
        assert!(r.verification.is_some());
    }
}

/// A case that starts at 6 bar itself is started lower.
#[test]
fn a_second_start_is_never_the_first() {
    let start = |set: &[&str]| checked(CASE, set).case.elsewhere()[0].starts.clone();
    assert_eq!(start(&[]), ["all lands at 1.01 bar", "all lands at 6.00 bar"]);
    assert_eq!(start(&["solver.starts=[\"5 bar\"]"]), ["all lands at 5.00 bar", "all lands at 0.83 bar"]);
    assert_eq!(start(&["solver.starts=[\"20 bar\"]"]), ["all lands at 20.00 bar", "all lands at 6.00 bar"]);
    assert!(checked(CASE, &["solver.starts=[\"1 bar\", \"6 bar\"]"]).case.elsewhere().is_empty());
}

/// A case that names several starts is told all of it by a run.
#[test]
fn starts_that_lead_to_one_state_are_one() {
    let starts = "solver.starts=[\"1.01325 bar\", \"6 bar\", \"5 bar\"]";
    let r = run_case(CASE, &["engine.speed=2800 rpm", ROUGH, starts]);
    assert_eq!(r.branches.len(), 2);
    assert_eq!(r.branches[1].start, "all lands at 6.00 bar and 5.00 bar");
    assert_eq!(r.solver.notes.iter().filter(|n| n.topic == "several_solutions").count(), 1);
}

/// With heavy rings and gas between them the first cycle takes rings off the liner. When ring 1 comes back, the flank of its keystone groove closes on it faster than it is pushed
/// away, and then pushes it out for 40 degrees: 30 000 steps and more, as long as it was not held meanwhile.
#[test]
fn a_ring_that_a_flank_has_caught_takes_few_steps() {
    let heavy = ["rings.0.mass=129 g", "rings.1.mass=111 g", "rings.2.mass=132 g", "engine.speed=4000 rpm"];
    let from = |start: &str| run_case(CASE, &[&heavy[..], &["solver.tolerance=1e-3", start]].concat());
    let [own, caught] = ["solver.starts=[\"1.01325 bar\"]", "solver.starts=[\"6 bar\"]"].map(from);
    let steps = |r: &RunResult| r.solver.counters["steps"] as f64 / r.solver.counters["cycles"] as f64;
    // 840 (caught) and 660 a cycle.
    assert!(steps(&caught) < 2.0 * steps(&own), "{} {}", steps(&caught), steps(&own));
    // One state, each good to the tolerance.
    assert!((value(&caught, "blow_by") / value(&own, "blow_by") - 1.0).abs() < 2e-3);
}
