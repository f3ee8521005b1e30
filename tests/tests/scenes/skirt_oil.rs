//! Skirts whose films keep their oil.

use crate::common::*;
use gudgeon_core::result::RunResult;
use gudgeon_scene::check;

const CASE: &str = "turbo-diesel-120-skirt";
/// A film that is coarse and quick, with enough oil above the skirt to carry it.
const KEPT: [&str; 6] = [
    "models.film_2d={ model = \"direct\", cavitation = \"mass_conserving\" }",
    "models.skirt_oil={ model = \"fill_history\", splash = \"100 um\", above = \"30 um\" }",
    "solver.intervals_along=12",
    "solver.intervals_across=10",
    "outputs.map_step=90 deg",
    "outputs.series_step=2 deg",
];

fn kept(more: &[&str]) -> RunResult {
    run_case(CASE, &KEPT.iter().chain(more).copied().collect::<Vec<_>>())
}

/// Why a case is refused.
fn refused(set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|s| (*s).to_owned()).collect();
    match check(&case_file(CASE), &set) {
        Ok(_) => panic!("{set:?} was not refused"),
        Err(report) => report.to_string(),
    }
}

/// What the ledger of a cycle says: nothing made, nothing lost.
fn closed(r: &RunResult) {
    let v = |name: &str| value(r, name);
    assert!(v("oil_ledger") < 1e-9, "{}", v("oil_ledger"));
    let (entered, left) =
        (v("oil_in_up") + v("oil_in_down"), v("oil_out_up") + v("oil_out_down") + v("oil_out_aside"));
    // Volumes of a thousand mm3, summed in another order than the ledger's.
    assert!(
        (entered - left - v("oil_change")).abs() < 1e-9 * entered,
        "{entered} {left} {}",
        v("oil_change")
    );
    // Net flows are those of the ledger, to rounding.
    for (net, out, inn) in
        [("oil_up", "oil_out_up", "oil_in_up"), ("oil_down", "oil_out_down", "oil_in_down")]
    {
        assert!(
            (v(net) - (v(out) - v(inn))).abs() < 1e-6 * entered,
            "{net}: {} {} {}",
            v(net),
            v(out),
            v(inn)
        );
    }
}

#[test]
fn the_ledger_of_the_oil_closes() {
    let r = kept(&[]);
    closed(&r);
    // Periodic: what is there at the end was there at the start, to the distance from the periodic motion that is admitted.
    let (change, held) = (value(&r, "oil_change"), value(&r, "oil_held"));
    assert!(change.abs() < 1e-3 * held, "{change} {held}");
    assert!((0.3..0.95).contains(&value(&r, "oil_filled")), "{}", value(&r, "oil_filled"));
    // Without a history the films make a hundred litres an hour of oil, of six cylinders at 1000 cycles a minute.
    let without = run_case(CASE, &KEPT[2..]);
    assert!(value(&without, "oil_made") * 1e-6 * 6.0 * 60e3 > 100.0, "{}", value(&without, "oil_made"));
    assert!(value(&r, "oil_made").abs() < 1e-9 * value(&without, "oil_made"));
}

#[test]
fn a_flooded_skirt_moves_as_one_whose_cavities_conserve_oil() {
    let r = kept(&["models.skirt_oil.splash=1 mm", "models.skirt_oil.above=1 mm"]);
    closed(&r);
    let set = [&KEPT[..1], &KEPT[2..]].concat();
    let steady = run_case(CASE, &set);
    // Cavities take a while to form and to fill, which the film without history leaves out: some percent of its friction, and of the clearance of 50 um.
    let ratio = |name: &str| value(&r, name) / value(&steady, name);
    for name in ["fmep", "p_max", "h_min", "tilt_max"] {
        assert!((ratio(name) - 1.0).abs() < 0.05, "{name}: {}", ratio(name));
    }
}

#[test]
fn less_oil_above_is_less_film() {
    let of = |above: &str| {
        let r = kept(&[&format!("models.skirt_oil.above={above}")]);
        closed(&r);
        [value(&r, "h_min"), value(&r, "oil_held"), value(&r, "oil_filled")]
    };
    let (more, less) = (of("60 um"), of("10 um"));
    assert!(more.iter().zip(less).all(|(m, l)| *m > l), "{more:?} {less:?}");
}

#[test]
fn finer_steps_of_the_oil_change_little() {
    let fmep = |step: &str| value(&kept(&[&format!("models.skirt_oil.step={step}")]), "fmep");
    let [coarse, middle, fine] = ["2 deg", "1 deg", "0.5 deg"].map(fmep);
    // First order: each halving leaves about half of the difference, of a part in a thousand at one degree.
    assert!((middle / fine - 1.0).abs() < 3e-3, "{coarse} {middle} {fine}");
    assert!((fine - middle).abs() < (middle - coarse).abs(), "{coarse} {middle} {fine}");
}

#[test]
fn equal_steps_find_the_same() {
    let euler = kept(&["solver.method=backward_euler", "solver.step=0.25 deg"]);
    closed(&euler);
    let implicit = kept(&[]);
    // A method of first order, at a quarter of a degree.
    for name in ["fmep", "oil_held", "oil_out_aside"] {
        let (a, b) = (value(&euler, name), value(&implicit, name));
        assert!((a / b - 1.0).abs() < 0.02, "{name}: {a} {b}");
    }
    let mut set = KEPT.to_vec();
    set.extend(["solver.method=backward_euler", "solver.step=0.8 deg", "outputs.series_step=4 deg"]);
    assert!(refused(&set).contains("a whole number of these"), "{}", refused(&set));
}

#[test]
fn a_piston_that_is_held_moves_its_oil() {
    let r = kept(&["models.secondary_motion={ model = \"held\" }"]);
    closed(&r);
    assert!(value(&r, "oil_change").abs() < 1e-3 * value(&r, "oil_held"));
}

#[test]
fn an_elastic_skirt_keeps_its_oil() {
    let shapes = "models.skirt_compliance={ model = \"modal\", stiffness = [\"300 N/um\"], shapes = [{ power = 2, waves = 1 }] }";
    closed(&kept(&[shapes, "solver.cycles=1"]));
}

#[test]
fn films_that_know_no_filling_are_refused() {
    let told = refused(&[KEPT[1]]);
    assert!(told.contains("does not know how full") && told.contains("film_2d"), "{told}");
    let with = |more: &str| refused(&[KEPT[0], KEPT[1], more]);
    let told = with("gas.cavitation_pressure=0.5 bar");
    assert!(told.contains("open to the crankcase") && told.contains("gas.cavitation_pressure"), "{told}");
    assert!(with("models.skirt_oil.step=20 deg").contains("between 0.05 and 10 degrees"));
    assert!(with("models.skirt_oil.splash=-1 um").contains("splash"));
}

#[test]
fn rings_that_follow_their_oil_feed_the_skirt() {
    let skirt = "piston_secondary.set=['models.film_2d={ model = \"direct\", cavitation = \"mass_conserving\" }', 'models.skirt_oil={ model = \"fill_history\", room_above = \"3 mm2\" }', 'solver.intervals_along=8', 'solver.intervals_across=6', 'solver.cycles=1', 'outputs.map_step=90 deg']";
    let rings = "ring_pack.set=['models.oil_transport={ model = \"liner_film\" }']";
    let r = run_case("turbo-diesel-120-power-cylinder", &[rings, skirt]);
    let note = r.solver.notes.iter().find(|n| n.topic == "film_from_rings").expect("a note");
    // Half of the gap of a land that rides on less than some micrometres.
    let film = note.amounts["film"].value;
    assert!((0.05..5.0).contains(&film), "{film}");
    assert!(value(&r, "skirt.oil_ledger") < 1e-9);
}
