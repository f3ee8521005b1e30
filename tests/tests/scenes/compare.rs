//! One case with several models side by side.

use std::sync::Arc;

use crate::common::*;
use gudgeon_study::{Plan, Subject, compare, compare_cases};

fn swap(path: &str, values: &[&str]) -> (String, Vec<String>) {
    (path.to_owned(), values.iter().map(|v| (*v).to_owned()).collect())
}

#[test]
#[allow(clippy::print_stdout, reason = "the comparison is for reading")]
fn three_gas_flow_models() {
    // The case has the bare orifice law of its source, whose infinite slope at zero pressure difference suits explicit marches only.
    let overrides: Vec<String> =
        ["solver.method=implicit", "solver.starts=[\"6 bar\"]", "models.gas_flow.orifice.laminar=1e-3"]
            .map(str::to_owned)
            .to_vec();
    let names = ["gap_orifice", "orifice_network", "narrow_channel"];
    let mut told = 0.0;
    let c = compare(&case_file("alcohol-1600-3000"), &overrides, &[swap("gas_flow", &names)], &mut |p| {
        told = p.fraction;
        Ok(())
    })
    .unwrap_or_else(|r| panic!("{r}"));
    assert_eq!(c.variants.len(), 3);
    assert!(told > 0.5, "progress was told up to {told}");
    for (v, name) in c.variants.iter().zip(names) {
        assert!(v.label.contains(name), "{}", v.label);
        match &v.outcome {
            Ok(r) => {
                assert!(r.models.iter().any(|m| m.kind == "gas_flow" && m.model == name));
                assert!(r.results.values().all(|v| v.value.is_finite()));
                assert!(r.balance.gas_mass.expect("there is gas") < 1e-9);
                println!(
                    "{name}: {:.2} l/min, land 2 {:.3} bar at {:.1} deg; {:?}",
                    value(r, "blow_by"),
                    value(r, "land2.p_max"),
                    value(r, "land2.p_max_angle"),
                    r.seconds
                );
            }
            Err(e) => panic!("{name}: {e}"),
        }
    }
    // Leaks past seated flanks and faces can only add to the gap: here they are zero, and what differs is how the gap area is shared.
    let q: Vec<f64> =
        c.variants.iter().filter_map(|v| v.outcome.as_ref().ok()).map(|r| value(r, "blow_by")).collect();
    assert!(q.iter().all(|v| (1.0..100.0).contains(v)), "{q:?}");
}

#[test]
fn refused_combinations_keep_their_reason() {
    let quick: Vec<String> =
        ["solver.cycles=2", "solver.gas_steps=10", "solver.starts=[\"1 bar\"]"].map(str::to_owned).to_vec();
    let swaps = [swap("ring_motion", &["three_seat", "newton_groove", "seated"])];
    let c = compare(&case_file("alcohol-1600-3000"), &quick, &swaps, &mut gudgeon_scene::unwatched)
        .unwrap_or_else(|r| panic!("{r}"));
    assert!(c.variants[0].outcome.is_ok() && c.variants[2].outcome.is_ok());
    let why = c.variants[1].why().expect("newton_groove cannot be marched by the degree");
    assert!(
        why.starts_with("left out") && why.contains("degree_march") && why.contains("newton_groove"),
        "{why}"
    );

    // Every combination refused: the report of the first says why.
    let none = compare(
        &case_file("alcohol-1600-3000"),
        &quick,
        &[swap("ring_motion", &["newton_groove"])],
        &mut gudgeon_scene::unwatched,
    );
    assert!(none.expect_err("nothing to run").to_string().contains("degree_march"));
    // A swap without values, and a path that does not exist.
    let empty = compare(
        &case_file("alcohol-1600-3000"),
        &quick,
        &[swap("gas_flow", &[])],
        &mut gudgeon_scene::unwatched,
    );
    assert!(empty.expect_err("empty").to_string().contains("gas_flow"));
    let unknown = compare(
        &case_file("alcohol-1600-3000"),
        &quick,
        &[swap("gas_flow", &["gap_orfice"])],
        &mut gudgeon_scene::unwatched,
    );
    assert!(unknown.expect_err("unknown").to_string().contains("gap_orifice"), "no suggestion");
}

#[test]
fn two_swaps_make_every_combination() {
    let quick: Vec<String> =
        ["solver.cycles=2", "solver.gas_steps=10", "solver.starts=[\"1 bar\"]"].map(str::to_owned).to_vec();
    let swaps = [
        swap("models.gas_flow.model", &["gap_orifice", "orifice_network"]),
        swap("conventions.hoop", &["as_printed", "correct"]),
    ];
    let c = compare(&case_file("alcohol-1600-3000"), &quick, &swaps, &mut gudgeon_scene::unwatched)
        .unwrap_or_else(|r| panic!("{r}"));
    assert_eq!(c.variants.len(), 4);
    let friction = |k: usize| match &c.variants[k].outcome {
        Ok(r) => value(r, "friction_power"),
        Err(e) => panic!("{e}"),
    };
    // The hoop relation as printed has the tension too small by π.
    assert!(friction(1) > friction(0) && friction(3) > friction(2));
}

#[test]
fn several_cases_are_one_more_choice() {
    let case = |name: &str, own: &[&str]| {
        let case = Arc::new(checked(name, own));
        Subject { case, own: own.iter().map(|o| (*o).to_owned()).collect() }
    };
    let plan = Plan {
        cases: vec![case("pin-85-alcohol", &[]), case("pin-85-alcohol", &["pin.inner=12 mm"])],
        swaps: vec![
            swap("pin_strength", &["thin_ring", "{ model = \"curved_ring\" }"]),
            swap("pin.modulus", &["200 GPa", "210 GPa"]),
        ],
        ..Plan::default()
    };
    let c = compare_cases(&plan, &mut gudgeon_scene::unwatched).unwrap_or_else(|r| panic!("{r}"));
    assert_eq!(c.variants.len(), 8);
    let names: Vec<&str> = c.cases.iter().map(|k| k.name.as_str()).collect();
    assert_eq!(names, ["pin-85-alcohol", "pin-85-alcohol, pin.inner=12 mm"]);
    assert!(
        c.variants[2].label.ends_with("pin_strength=curved_ring, pin.modulus=200 GPa"),
        "{}",
        c.variants[2].label
    );
    assert!(c.variants.iter().all(|v| v.outcome.is_ok()));
    let [all, own @ ..] = c.shares.as_slice() else { panic!("no shares") };
    assert_eq!((all.case.as_deref(), own.len()), (None, 2));
    assert_eq!(all.factors, ["case", "pin_strength", "pin.modulus"]);
    for row in all.rows.iter().filter(|r| r.spread > 0.0) {
        let sum: f64 = row.shares.iter().flatten().map(|s| s.share).sum();
        // Sums of a few tens of numbers.
        assert!((sum - 1.0).abs() < 1e-12, "{}: {sum}", row.result);
    }
    // The stresses of a pin do not know its modulus, its ovalisation goes with its inverse.
    let modulus = |name: &str| {
        own[0].rows.iter().find(|r| r.result == name).and_then(|r| r.shares[1]).expect(name).share
    };
    assert!(modulus("ovalisation") > 0.0, "{}", modulus("ovalisation"));
    assert_eq!(modulus("bending_stress"), 0.0);
    assert!(!all.findings.is_empty());
    // No case at all.
    assert!(compare_cases(&Plan::default(), &mut gudgeon_scene::unwatched).is_err());
}
