//! What no wanted result needs is neither built nor evaluated, and it is said so.

use crate::common::*;
use gudgeon_scene::explain;

const GAS_ONLY: &str = "outputs.results=[\"blow_by\"]";
/// The published march, as short as it can be.
const QUICK: [&str; 3] = ["solver.cycles=2", "solver.gas_steps=20", "solver.starts=[\"1 bar\"]"];

fn all(more: &[&'static str]) -> Vec<&'static str> {
    QUICK.iter().chain(more).copied().collect()
}

#[test]
fn blow_by_alone_needs_no_film() {
    let set = all(&[GAS_ONLY, "models.ring_motion.film_force=false"]);
    let r = run_case("alcohol-1600-3000", &set);
    assert_eq!(r.solver.counters["film_evaluations"], 0);
    assert!(r.solver.counters["gas_evaluations"] > 0);
    // Four volumes: two lands, two spaces behind rings.
    assert_eq!(r.solver.counters["states"], 4);
    assert_eq!(r.results.keys().collect::<Vec<_>>(), ["blow_by"]);
    assert!(r.series.get("ring1.h_min").is_none() && r.series.get("ring1.position").is_some());
    let film = r.skipped.iter().find(|s| s.what.contains("hydrodynamics")).expect("it is said");
    assert!(film.why.contains("gap_orifice") && film.why.contains("three_seat"), "{}", film.why);
    assert!(
        r.models
            .iter()
            .all(|m| !["hydrodynamics", "contact", "oil", "film_temperature"].contains(&m.kind.as_str()))
    );

    let e = explain(&checked("alcohol-1600-3000", &set)).expect("explains");
    assert!(e.skipped.iter().any(|s| s.what.contains("hydrodynamics")));
    assert!(e.states.iter().all(|s| !s.contains("film")));
    assert!(e.to_text().contains("hydrodynamics"));
}

#[test]
fn the_answer_is_the_same_with_films_that_nobody_needs() {
    let lazy = run_case("alcohol-1600-3000", &all(&[GAS_ONLY, "models.ring_motion.film_force=false"]));
    let full = run_case("alcohol-1600-3000", &all(&["models.ring_motion.film_force=false"]));
    assert!(full.solver.counters["film_evaluations"] > 0);
    assert_eq!(value(&lazy, "blow_by").to_bits(), value(&full, "blow_by").to_bits());
}

#[test]
fn a_film_that_motion_or_gas_depends_on_is_solved() {
    // The film's force decides the seats.
    let r = run_case("alcohol-1600-3000", &all(&[GAS_ONLY]));
    assert!(r.solver.counters["film_evaluations"] > 0);
    // The gap area of the orifice network depends on the film.
    let r = run_case(
        "alcohol-1600-3000",
        &all(&[GAS_ONLY, "models.ring_motion.film_force=false", "models.gas_flow.model=orifice_network"]),
    );
    let e = explain(&checked(
        "alcohol-1600-3000",
        &[GAS_ONLY, "models.ring_motion.film_force=false", "models.gas_flow.model=orifice_network"],
    ))
    .expect("explains");
    let film = e.runs.iter().find(|s| s.what.contains("hydrodynamics"));
    assert_eq!(film.is_some(), r.solver.counters["film_evaluations"] > 0);
}

#[test]
fn seated_rings_have_no_states() {
    let set = [
        GAS_ONLY,
        "models.ring_motion.model=seated",
        "models.gas_flow.film_height=nominal",
        "solver.method=implicit",
    ];
    let r = run_case("turbo-diesel-120/flooded", &set);
    // Two lands and two spaces behind rings; the oil ring's groove drains.
    assert_eq!(r.solver.counters["states"], 4);
    assert_eq!(r.solver.counters["film_evaluations"], 0);
    for what in ["ring_motion", "flank", "hydrodynamics"] {
        assert!(r.skipped.iter().any(|s| s.what.contains(what)), "{what}");
    }
    assert_eq!(r.balance.energy, None);
    assert!(r.series.get("ring1.force_gas").is_none() && r.series.get("ring1.axial_velocity").is_none());

    // Two more states per ring that moves and two for the oil on its flanks, one per ring with a film.
    let e = explain(&checked("turbo-diesel-120/flooded", &[])).expect("explains");
    assert_eq!(e.states.len(), 4 + 3 + 6 + 6);
    let e = explain(&checked("turbo-diesel-120/flooded", &["rings.0.models.ring_motion.model=seated"]))
        .expect("explains");
    assert_eq!(e.states.len(), 4 + 3 + 4 + 4);
}

#[test]
fn prescribed_parts_of_a_three_piece_ring() {
    let r = run_case("alcohol-1600-3000", &all(&[]));
    assert!(r.skipped.iter().any(|s| s.what.contains("ring 3") && s.why.contains("three-piece")));
    assert!(r.series.get("ring3.position").is_none());
}

#[test]
fn spaces_that_store_nothing_are_not_integrated() {
    let full = run_case("turbo-diesel-120/flooded", &[]);
    // A limit that no space exceeds: nothing behind any ring is integrated.
    let set = ["models.gas_flow.eliminate=auto", "models.gas_flow.eliminate_below=1 s"];
    let less = run_case("turbo-diesel-120/flooded", &set);
    let states = |r: &gudgeon_core::result::RunResult| r.solver.counters["states"];
    assert!(states(&less) < states(&full), "{} {}", states(&less), states(&full));
    // Behind the top ring the pressure follows the land above it, with a state of its own or without: 4e-6 at the peak, where the
    // space changes little.
    let top = |r: &gudgeon_core::result::RunResult| peak(r, "ring1.back.p", 0.0, 720.0).0;
    assert!((top(&less) / top(&full) - 1.0).abs() < 1e-4, "{} {}", top(&less), top(&full));
    // But these spaces are no small ones: what they store is some tenth of the blow-by.
    let change = (value(&less, "blow_by") / value(&full, "blow_by") - 1.0).abs();
    assert!(change > 0.02 && change < 0.3, "{change}");
    // Gas in less gas out less gas stored is rounding, as with all spaces.
    assert!(less.balance.gas_mass.is_some_and(|b| b.abs() < 1e-10), "{:?}", less.balance);
    // By default none of them is fast enough, and it is the same run to the last bit.
    let auto = run_case("turbo-diesel-120/flooded", &["models.gas_flow.eliminate=auto"]);
    assert_eq!(value(&auto, "blow_by").to_bits(), value(&full, "blow_by").to_bits());
}
