//! Floors, caps and drags: what acts is said, what cannot be carried is refused, and every documented model runs on the shipped diesel.

use crate::common::*;
use gudgeon_core::result::{Note, NoteLevel, RunResult};

const CASE: &str = "turbo-diesel-120";

fn note<'a>(r: &'a RunResult, topic: &str) -> Option<&'a Note> {
    r.solver.notes.iter().find(|n| n.topic == topic)
}

fn periodic(set: &[&str]) -> RunResult {
    let r = run_case(CASE, set);
    assert!(note(&r, "not_periodic").is_none(), "{set:?}: {:?}", r.solver.notes);
    r
}

/// No floor, no cap of speed and no overlap: what rounds the corner of a contact that gives way is all that acts, and it takes next to nothing.
#[test]
fn no_floor_acts_on_the_shipped_diesel() {
    let r = run_case(CASE, &[]);
    for n in r.solver.notes.iter().filter(|n| n.level > NoteLevel::Info) {
        assert!(n.topic.starts_with("contact_drag."), "{n:?}");
        // Of loads of 160 N and more while ring 2 touches: less than 2 %; where the stroke turns and films grow, less than 6 % of the cycle.
        assert!(n.amounts["drag"].value < 3.2 && n.amounts["share_of_cycle"].value < 0.06, "{n:?}");
    }
    assert!(r.events.iter().all(|e| !e.what.contains("liner")), "{:?}", r.events);
}

/// The sharp edge of a taper face carries its ring on overlapping mean planes, by the contact law alone: nothing is left for a floor.
#[test]
fn sharp_taper_is_carried_through_zero_separation() {
    let r = run_case(CASE, &["rings.1.face.land=0 mm"]);
    assert!(note(&r, "contact_floor.ring2").is_none());
    let overlap = note(&r, "overlap.ring2").expect("the edge is pressed in");
    let (depth, share) = (overlap.amounts["overlap"].value, overlap.amounts["share_of_cycle"].value);
    assert!(depth > 0.05 && depth < 2.0 && share > 0.1 && share < 0.9, "{overlap:?}");
}

#[test]
fn a_load_that_nothing_carries_is_refused() {
    // A land would ride on the oil it squeezes; a sharp edge has none.
    let set = vec!["models.contact={model=\"off\"}".into(), "rings.1.face.land=0 mm".into()];
    let e = run_all(&[(CASE, set)]).remove(0).expect_err("refused");
    assert!(
        e.contains("ring 2") && e.contains("deg crank angle") && e.contains(" N press") && e.contains("nm"),
        "{e}"
    );
    assert!(e.contains("greenwood_tripp"), "{e}");
}

#[test]
fn a_documented_floor_says_what_it_carries() {
    let r = run_case(CASE, &["models.contact={model=\"film_floor\", thickness=\"0.2 um\"}"]);
    let n = note(&r, "contact_floor.ring2").expect("acts");
    assert!(n.amounts["residual_load"].value > 100.0 && n.amounts["share_of_cycle"].value > 0.1, "{n:?}");
}

/// Rings of a pack whose films are off ride on their asperities: the contact carries the radial load at every instant.
#[test]
fn dry_rings_ride_on_their_contact() {
    let r = periodic(&["models.hydrodynamics={model=\"off\"}"]);
    let column = |name: &str| &r.series.columns.iter().find(|c| c.name == name).expect(name).values;
    for ring in 1..=3 {
        let (load, contact) =
            (column(&format!("ring{ring}.radial_load")), column(&format!("ring{ring}.contact_load")));
        let most = load.iter().copied().fold(0.0, f64::max);
        for (l, c) in load.iter().zip(contact) {
            // What the drag takes while the load changes: less than 1e-3 of the highest load.
            assert!((l - c).abs() < 1e-3 * most, "ring {ring}: {l} {c}");
        }
    }
}

/// A ring held on its flank cannot let the gas of the land below return past it: that gas lifts it off the liner, passes its face, and the
/// ring comes back. Every solver says so, and no land is left with more than the cylinder had.
#[test]
fn a_ring_that_leaves_the_liner_is_told_by_every_solver() {
    let ways: [&[&str]; 3] = [
        &[],
        &["solver.method=as_published", "solver.cycles=3", "solver.passes=720", "solver.gas_steps=64"],
        &[
            "solver.method=as_published",
            "solver.scheme=degree_march",
            "solver.cycles=3",
            "solver.gas_steps=400",
        ],
    ];
    let asked: Vec<(&str, Vec<String>)> = ways
        .iter()
        .map(|w| {
            let seated = ["models.ring_motion={model=\"seated\"}"];
            (CASE, seated.iter().chain(w.iter()).map(|s| (*s).to_owned()).collect())
        })
        .collect();
    for (r, way) in run_all(&asked).into_iter().zip(ways) {
        let r = r.unwrap_or_else(|e| panic!("{way:?}: {e}"));
        let n = note(&r, "off_the_liner.ring1").unwrap_or_else(|| panic!("{way:?}: {:?}", r.solver.notes));
        assert!(
            n.amounts["retreat"].value > 0.05 && n.amounts["share_of_cycle"].value > 1e-3,
            "{way:?}: {n:?}"
        );
        assert!(
            r.events.iter().any(|e| e.subject == "ring1" && e.what.contains("leaves the liner")),
            "{way:?}"
        );
        assert!(value(&r, "land2.p_max") < value(&r, "cylinder.p_max"), "{way:?}");
    }
}

/// What a case may ask for runs on the shipped diesel, and is periodic as it says.
#[test]
fn documented_models_run_on_the_shipped_diesel() {
    let asked: Vec<(&str, Vec<String>)> = [
        &["models.ring_motion={model=\"seated\"}"][..],
        &["models.ring_motion={model=\"seated\"}", "outputs.results=[\"blow_by\"]"],
        &["models.ring_motion={model=\"three_seat\"}", "solver.starts=[\"1 bar\"]"],
    ]
    .iter()
    .map(|set| (CASE, set.iter().map(|s| (*s).to_owned()).collect()))
    .collect();
    for (r, (_, set)) in run_all(&asked).into_iter().zip(&asked) {
        let r = r.unwrap_or_else(|e| panic!("{set:?}: {e}"));
        let failed: Vec<_> = r.solver.notes.iter().filter(|n| n.level == NoteLevel::Failure).collect();
        assert!(failed.is_empty(), "{set:?}: {failed:?}");
    }
}

/// Rings that no oil holds on their flanks, gas through channels, oil on the liner: numbers, whether periodic within four cycles or not.
#[test]
fn undamped_rings_on_a_followed_film_stay_numbers() {
    let r = run_case(
        CASE,
        &[
            "models.flank_damping={model=\"off\"}",
            "models.gas_flow={model=\"narrow_channel\"}",
            "models.oil_transport={model=\"liner_film\"}",
            "solver.max_cycles=4",
        ],
    );
    assert!(r.results.values().all(|v| v.value.is_finite()));
}

/// A cap that is too low names its key, with the angle in degrees.
#[test]
fn the_cap_of_steps_is_a_key() {
    let set = vec!["solver.limits.most_steps=100".to_owned()];
    let e = run_all(&[(CASE, set)]).remove(0).expect_err("100 steps are too few");
    assert!(
        e.contains("deg crank angle") && e.contains("100 steps") && e.contains("solver.limits.most_steps"),
        "{e}"
    );
}
