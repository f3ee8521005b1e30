//! Skirts whose films keep their oil.

use crate::common::*;
use gudgeon_core::result::RunResult;
use gudgeon_scene::check;

const CASE: &str = "turbo-diesel-120-skirt";
/// Films that are full wherever they do not tear.
const CUT_OFF: &str = "models.film_2d={ model = \"direct\", cavitation = \"half_sommerfeld\" }";
/// Films without a history.
const FLOODED: &str = "models.skirt_oil={ model = \"off\" }";
/// The case on a film that is coarse and quick.
const KEPT: [&str; 4] = [
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
    assert_eq!(r.balance.skirt_oil, Some(v("oil_ledger")));
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
    let without = run_case(CASE, &[&KEPT[..], &[CUT_OFF, FLOODED]].concat());
    assert_eq!(without.balance.skirt_oil, None);
    assert!(value(&without, "oil_made") * 1e-6 * 6.0 * 60e3 > 100.0, "{}", value(&without, "oil_made"));
    assert!(value(&r, "oil_made").abs() < 1e-9 * value(&without, "oil_made"));
}

#[test]
fn a_flooded_skirt_moves_as_one_whose_cavities_conserve_oil() {
    let r = kept(&["models.skirt_oil.splash=1 mm", "models.skirt_oil.above=1 mm"]);
    closed(&r);
    let steady = run_case(CASE, &[&KEPT[..], &[FLOODED]].concat());
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
fn a_skirt_that_hardly_yields_keeps_its_oil_as_a_rigid_one() {
    // One cycle from the same start: a search of the periodic motion ends somewhere within its distance, which counts more than the yielding here.
    let cycle = |compliance: &str| {
        let r = kept(&[
            compliance,
            "solver.rigid_below=0",
            "solver.cycles=1",
            "solver.tolerance=1e-5",
            "solver.max_film_evaluations=10000000",
            "models.skirt_oil.step=2 deg",
            "outputs.series_step=5 deg",
        ]);
        ["h_min", "e_top_max", "tilt_max"].map(|name| value(&r, name))
    };
    let yielding = |stiffness: &str| {
        cycle(&format!(
            "models.skirt_compliance={{ model = \"modal\", stiffness = [\"{stiffness}\"], shapes = [{{ power = 2, waves = 1 }}] }}"
        ))
    };
    let rigid = cycle("models.skirt_compliance={ model = \"rigid\" }");
    let (soft, hard) = (yielding("1e4 N/um"), yielding("1e5 N/um"));
    for k in 0..rigid.len() {
        // Goes with the compliance. Errors of the steps are some 1e-6 um, as seen at ten times the stiffness, a hundredth of the smallest difference of the harder one;
        // what is of second order in the deflection is less than a hundredth of that of the softer.
        let ratio = (soft[k] - rigid[k]) / (hard[k] - rigid[k]);
        assert!((ratio * 0.1 - 1.0).abs() < 0.03, "{k}: {ratio} of {soft:?} {hard:?} {rigid:?}");
    }
}

#[test]
fn films_that_know_no_filling_are_refused() {
    let told = refused(&[CUT_OFF]);
    assert!(told.contains("does not know how full") && told.contains("film_2d"), "{told}");
    let with = |more: &str| refused(&[more]);
    let told = with("gas.cavitation_pressure=0.5 bar");
    assert!(told.contains("open to the crankcase") && told.contains("gas.cavitation_pressure"), "{told}");
    assert!(with("models.skirt_oil.step=20 deg").contains("between 0.05 and 10 degrees"));
    assert!(with("models.skirt_oil.splash=-1 um").contains("splash"));
}

#[test]
fn motions_that_only_full_films_resist_are_refused() {
    let quasi_static = "models.secondary_motion={ model = \"quasi_static\" }";
    let told = refused(&[quasi_static]);
    for what in ["models.secondary_motion", "where the gap is not full", "full_inertia"] {
        assert!(told.contains(what), "{what}: {told}");
    }
    assert!(check(&case_file(CASE), &[quasi_static.to_owned(), FLOODED.to_owned()]).is_ok());
}

#[test]
fn results_of_a_skirt_in_flight_do_not_hang_on_one_step_of_its_oil() {
    let of = |step: &str| {
        let above = "models.skirt_oil.above=10 um";
        kept(&[&format!("models.skirt_oil.step={step}"), above])
    };
    let (coarse, fine) = (of("1 deg"), of("0.25 deg"));
    // The piston crosses 0.4 of the clearance in one degree, a tenth in a quarter of it.
    let told = |r: &RunResult| r.solver.notes.iter().any(|n| n.topic == "oil_step_too_long");
    assert!(told(&coarse) && !told(&fine));
    // The energy that is lost on the way to the liner is that of a flight of many steps: steps of first order, of some percent.
    let ratio = value(&coarse, "slap_energy") / value(&fine, "slap_energy");
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
}

#[test]
fn films_by_stroke_hold_the_thinnest_one() {
    let r = kept(&[]);
    let films = &r.tables["skirt_films"];
    let of = |name: &str| films.get(name).expect("a column").values.clone();
    assert_eq!(films.axis.values, [1.0, 2.0, 3.0, 4.0]);
    let least = ["thrust.h_min", "anti_thrust.h_min"].into_iter().flat_map(of).fold(f64::INFINITY, f64::min);
    // The same extreme of the same gaps, in another window.
    assert!((1e6 * least / value(&r, "h_min") - 1.0).abs() < 1e-6, "{least:e} {}", value(&r, "h_min"));
    for (stroke, angle) in of("thrust.h_min_angle").into_iter().enumerate() {
        let from = 180.0 * stroke as f64;
        assert!((from..=from + 180.0).contains(&angle), "{stroke}: {angle}");
    }
}

#[test]
fn a_power_cylinder_keeps_the_oil_of_its_skirt() {
    let skirt = "piston_secondary.set=['solver.intervals_along=12', 'solver.intervals_across=10', 'outputs.map_step=90 deg']";
    let r = run_case("turbo-diesel-120-power-cylinder", &[skirt]);
    let open = r.balance.skirt_oil.expect("a ledger");
    assert!(open < 1e-9 && value(&r, "skirt.oil_ledger") == open, "{open:e}");
    // In mm3, of more than a thousand that pass.
    assert!(value(&r, "skirt.oil_made").abs() < 1e-9 * value(&r, "skirt.oil_in_down"));
}

#[test]
fn rings_that_follow_their_oil_feed_the_skirt() {
    let skirt = "piston_secondary.set=['models.skirt_oil={ model = \"fill_history\", room_above = \"3 mm2\" }', 'solver.intervals_along=8', 'solver.intervals_across=6', 'solver.cycles=1', 'outputs.map_step=90 deg']";
    let rings = "ring_pack.set=['models.oil_transport={ model = \"liner_film\" }']";
    let r = run_case("turbo-diesel-120-power-cylinder", &[rings, skirt]);
    let note = r.solver.notes.iter().find(|n| n.topic == "film_from_rings").expect("a note");
    // Half of the gap of a land that rides on less than some micrometres.
    let film = note.amounts["film"].value;
    assert!((0.05..5.0).contains(&film), "{film}");
    assert!(value(&r, "skirt.oil_ledger") < 1e-9);
}
