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

#[test]
fn nothing_acts_on_the_shipped_diesel() {
    let r = run_case(CASE, &[]);
    assert!(r.solver.notes.iter().all(|n| n.level == NoteLevel::Info), "{:?}", r.solver.notes);
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
    let e = run_all(&[(CASE, vec!["models.contact={model=\"off\"}".into()])]).remove(0).err().expect("refused");
    assert!(e.contains("ring 2") && e.contains("deg crank angle") && e.contains(" N press") && e.contains("nm"), "{e}");
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
        let (load, contact) = (column(&format!("ring{ring}.radial_load")), column(&format!("ring{ring}.contact_load")));
        let most = load.iter().copied().fold(0.0, f64::max);
        for (l, c) in load.iter().zip(contact) {
            // What the drag takes while the load changes: less than 1e-3 of the highest load.
            assert!((l - c).abs() < 1e-3 * most, "ring {ring}: {l} {c}");
        }
    }
}
