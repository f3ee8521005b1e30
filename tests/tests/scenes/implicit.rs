//! The implicit solver: the limit of the published scheme, convergence, closures, determinism.

#![allow(clippy::print_stdout, reason = "measured errors are for reading")]

use std::sync::LazyLock;

use crate::common::*;
use gudgeon_core::result::RunResult;

const PUBLISHED: &str = "turbo-diesel-120-as-published";
const CASE: &str = "turbo-diesel-120/flooded";

fn runs(asked: &[(&str, Vec<String>)]) -> Vec<RunResult> {
    run_all(asked)
        .into_iter()
        .zip(asked)
        .map(|(r, a)| match r {
            Ok(r) => r,
            Err(e) => panic!("{a:?}: {e}"),
        })
        .collect()
}

fn set(case: &'static str, overrides: &[String]) -> (&'static str, Vec<String>) {
    (case, overrides.to_vec())
}

fn implicit(tolerance: &str) -> Vec<String> {
    vec![
        "solver.method=implicit".into(),
        format!("solver.tolerance={tolerance}"),
        format!("solver.periodicity={tolerance}"),
    ]
}

/// The case at a tolerance of 1e-6, which three tests look at.
static TIGHT: LazyLock<RunResult> = LazyLock::new(|| runs(&[set(CASE, &implicit("1e-6"))]).remove(0));

fn march(clamp: &str, steps: u32) -> Vec<String> {
    vec![
        "solver.passes=720".into(),
        "solver.cycles=3".into(),
        format!("solver.clamp={clamp}"),
        format!("solver.steps_per_degree={steps}"),
    ]
}

/// The equations of the published program solved implicitly are what its scheme tends to as its steps shrink.
#[test]
fn published_scheme_tends_to_the_implicit_solution() {
    let steps = [4, 8, 16];
    // Periodic to 1e-4 by its estimate: nearer takes three times the cycles and changes blow-by by 2e-7.
    let exact = [implicit("1e-5"), vec!["solver.periodicity=1e-4".into()]].concat();
    let mut asked = vec![set(PUBLISHED, &exact)];
    asked.extend(steps.iter().map(|s| set(PUBLISHED, &march("inward", *s))));
    let coarser = [8, 32];
    asked.extend(coarser.iter().map(|s| set(PUBLISHED, &march("stop", *s))));
    let r = runs(&asked);
    let (exact, inward, stop) = (&r[0], &r[1..4], &r[4..]);
    let q = |r: &RunResult| value(r, "blow_by_per_cylinder");
    let p = |r: &RunResult| value(r, "land2.p_max");
    println!("implicit: {:.5} l/min, {:.5} bar", q(exact), p(exact));
    let error: Vec<f64> = inward.iter().map(|r| (q(r) / q(exact) - 1.0).abs()).collect();
    for (k, r) in inward.iter().enumerate() {
        let order = if k > 0 { (error[k - 1] / error[k]).log2() } else { f64::NAN };
        println!(
            "clamp inward, {:2} steps per degree: {:.5} l/min, {:.5} bar, error {:.2e}, observed order {order:.2}",
            steps[k],
            q(r),
            p(r),
            error[k]
        );
    }
    for (k, r) in stop.iter().enumerate() {
        println!("clamp stop, {:2} steps per degree: {:.5} l/min, {:.5} bar", coarser[k], q(r), p(r));
    }
    // What was asked of the limit: 0.2 % in both results, at 16 steps.
    assert!((q(&inward[2]) / q(exact) - 1.0).abs() < 2e-3);
    assert!((p(&inward[2]) / p(exact) - 1.0).abs() < 2e-3);
    // The scheme is of first order: each halving of the step halves the error at least (1.6 leaves room for the second-order part
    // of either sign). The implicit solution is good to 1e-5, which does not show against 2.8e-4 at 16 steps in a factor of 1.6.
    assert!(error.windows(2).all(|w| w[0] / w[1] > 1.6), "{error:?}");
    // A ring whose velocity is set to zero at a flank sticks to a flank that moves away, the longer the smaller the steps are:
    // with that clamp there is no limit. Towards one, a quarter of the step would quarter the error; here it rises.
    let error: Vec<f64> = stop.iter().map(|r| (q(r) / q(exact) - 1.0).abs()).collect();
    assert!(error[1] > error[0], "{error:?}");
}

/// Error against the other integrator falls with the tolerance.
#[test]
fn error_follows_the_tolerance() {
    let tolerances = ["1e-2", "1e-3", "1e-4", "1e-5", "1e-6"];
    // Periodic to 3e-6 by its estimate. These results are within 4e-8 of those of both integrators at 1e-8; at 1e-7 the search takes 41 cycles for 12, and blow-by is 1.4e-6 off.
    let own = ["method=implicit", "integrator=radau5", "tolerance=5e-8", "periodicity=3e-6"];
    let mut asked = vec![set(CASE, &own.map(|own| format!("solver.{own}")))];
    asked.extend(tolerances[..4].iter().map(|t| set(CASE, &implicit(t))));
    let mut r = runs(&asked);
    r.push(TIGHT.clone());
    let names = ["blow_by_per_cylinder", "land2.p_max", "friction_power"];
    let error = |r: &RunResult, exact: &RunResult| {
        names.map(|n| (value(r, n) / value(exact, n) - 1.0).abs()).into_iter().fold(0.0, f64::max)
    };
    println!("reference, Radau IIA at 5e-8: {:?}", names.map(|n| value(&r[0], n)));
    let errors: Vec<f64> = r[1..].iter().map(|v| error(v, &r[0])).collect();
    for (k, v) in r[1..].iter().enumerate() {
        let steps = v.solver.counters["steps"] as f64 / v.solver.counters["cycles"] as f64;
        println!("tolerance {}: error {:.2e}, {steps:.0} steps per cycle", tolerances[k], errors[k]);
    }
    let slope = (errors[0] / errors[4]).log10() / 4.0;
    println!("observed slope of error over tolerance, both logarithmic: {slope:.2}");
    // Over two decades: by chance one error can be as small as that of a tenth of its tolerance (on another way to the periodic state 2.3e-5 at 1e-3, where twelve other packs have medians of 6e-5 in blow-by and 9e-5 in friction).
    assert!(errors.windows(3).all(|w| w[2] < w[0]), "{errors:?}");
    // Error control per step: proportional to the tolerance, were it not for kinks that a step may meet anywhere.
    assert!(slope > 0.5, "{slope}");
    // The results are as good as the tolerance says, at the default of 1e-4 too.
    assert!(errors.iter().zip([1e-2, 1e-3, 1e-4]).all(|(error, asked)| *error < asked), "{errors:?}");
    // Below that they are so in the root mean square: a ring that flutters makes another run of every rounding. Of ten runs each at 0.7 to 1.2e-5 with seven ways to round
    // blow-by was 5e-6 to 8e-6 off, single ones 1.8e-5: here three times that. At 1e-6 they were 6e-7 to 8e-7 off.
    assert!(errors[3] < 2.4e-5 && errors[4] < 2.4e-6, "{errors:?}");
}

/// Stages that the pack solves itself: as near to the reference as their tolerance says, in fewer steps than the Rosenbrock method of the same error.
#[test]
fn stages_that_the_pack_solves_lead_to_the_same_cycle() {
    let with = |name: &str, tolerance: &str| {
        [implicit(tolerance), vec![format!("solver.integrator={name}")]].concat()
    };
    let asked = [
        set(CASE, &with("rodas3", "3e-3")),
        set(CASE, &with("sdirk2", "1e-2")),
        set(CASE, &with("sdirk2", "1e-3")),
        set("turbo-diesel-120", &with("rodas3", "1e-3")),
        set("turbo-diesel-120", &with("sdirk2", "1e-3")),
        set(PUBLISHED, &with("sdirk2", "3e-3")),
    ];
    let r = runs(&asked);
    let error = |a: &RunResult, b: &RunResult| {
        let names = ["blow_by_per_cylinder", "land2.p_max", "friction_power"];
        names.map(|n| (value(a, n) / value(b, n) - 1.0).abs()).into_iter().fold(0.0, f64::max)
    };
    let steps = |r: &RunResult| r.solver.counters["steps"] as f64 / r.solver.counters["cycles"] as f64;
    for (a, r) in asked.iter().zip(&r) {
        println!("{} {:?}: {:.0} steps a cycle, {:?}", a.0, a.1, steps(r), r.balance);
    }
    let errors = [0, 1, 2].map(|k| error(&r[k], &TIGHT));
    println!("errors: {errors:?}");
    // What the tolerances of both methods ask for.
    assert!(errors[1] < 1e-2 && errors[2] < 1e-3, "{errors:?}");
    assert!(errors[1] < errors[0] && steps(&r[1]) < 0.7 * steps(&r[0]), "{errors:?}");
    // A film on its floor stays there, where the stages of a step alone would go 3 % below.
    for ring in 1..=3 {
        let lowest = value(&r[5], &format!("ring{ring}.h_min"));
        // 0.1 um, to rounding of its logarithm.
        assert!((lowest / 0.1 - 1.0).abs() < 1e-9, "ring {ring}: {lowest}");
    }
    // With oil on the liner the search of the periodic state ends at ten times the tolerance.
    assert!(error(&r[4], &r[3]) < 1e-2);
    for r in [&r[1], &r[2], &r[4]] {
        // Flows and states have the weights of one method: rounding of some thousand steps.
        assert!(r.balance.gas_mass.expect("there is gas") <= 1e-10);
        assert!(r.balance.flank_oil.expect("there is oil on flanks") <= 1e-10);
        // Forces at the ends and in the middle of steps, by Simpson's rule, at a tolerance of 1e-2.
        assert!(r.balance.momentum.expect("rings move") <= 1e-2);
    }
}

/// Gas with grooves, and films, in turns over the cycle: the cycle of the whole pack, with and without oil on the liner, in a third of the instants.
#[test]
fn two_halves_of_a_cycle_come_to_agree() {
    let halves = |tolerance: &str| [implicit(tolerance), vec!["solver.integrator=waveform".into()]].concat();
    let asked = [
        set(CASE, &halves("1e-2")),
        set(CASE, &halves("1e-3")),
        set("turbo-diesel-120", &halves("3e-3")),
        set("turbo-diesel-120", &[implicit("1e-3"), vec!["solver.integrator=rodas3".into()]].concat()),
        set(CASE, &halves("1e-2")),
    ];
    let r = runs(&asked);
    let error = |a: &RunResult, b: &RunResult| {
        let names = ["blow_by_per_cylinder", "land2.p_max", "friction_power"];
        names.map(|n| (value(a, n) / value(b, n) - 1.0).abs()).into_iter().fold(0.0, f64::max)
    };
    let errors = [error(&r[0], &TIGHT), error(&r[1], &TIGHT), error(&r[2], &r[3])];
    for (a, r) in asked.iter().zip(&r) {
        println!("{} {:?}: {:?}, {:?}", a.0, a.1, r.solver.counters, r.balance);
        assert!(r.solver.notes.iter().all(|n| n.topic != "halves_apart"), "{:?}", r.solver.notes);
    }
    println!("errors: {errors:?}");
    // What the tolerances ask for; with oil on the liner the search of the periodic state ends at some times the tolerance.
    assert!(errors[0] < 1e-2 && errors[1] < 1e-3 && errors[2] < 1e-2, "{errors:?}");
    for r in &r[..3] {
        // Flows and states have the weights of one method: rounding of some thousand steps.
        assert!(r.balance.gas_mass.expect("there is gas") <= 1e-10);
        assert!(r.balance.flank_oil.expect("there is oil on flanks") <= 1e-10);
        // Forces of the films of the same cycle and no other, by Simpson's rule, at a tolerance of 1e-2.
        assert!(r.balance.momentum.expect("rings move") <= 1e-2);
    }
    assert!(r[2].balance.oil_mass.expect("there is oil on the liner") <= 1e-10);
    // The flow past ring 1 lies in a wide passage: evaluated from dense output it was four fifths of itself off. What trapezia over rows a degree apart leave.
    for r in [&r[0], &r[2]] {
        let off = flow_off_mass(r, "ring1", 2000.0);
        assert!(off < 0.03, "{off}");
    }
    // Nothing of one run is left for the next.
    assert_eq!(r[0].results, r[4].results);
}

/// How far the flow past a ring, by trapezia between the rows of the series, is off the mass that passes between them, over all that passes up and down; speed in
/// revolutions per minute.
fn flow_off_mass(r: &RunResult, ring: &str, speed: f64) -> f64 {
    let column = |name: String| {
        let found = r.series.columns.iter().find(|c| c.name == name);
        &found.unwrap_or_else(|| panic!("no column {name}")).values
    };
    let (flow, mass) = (column(format!("{ring}.flow")), column(format!("{ring}.cumulative_mass")));
    let (mut off, mut all) = (0.0, 0.0);
    for (k, t) in r.series.axis.values.windows(2).enumerate() {
        let dt = (t[1] - t[0]) / (6.0 * speed);
        let passed = mass[k + 1] - mass[k];
        off += (0.5 * (flow[k] + flow[k + 1]) * dt - passed).abs();
        all += passed.abs();
    }
    off / all
}

/// Without films there is one half, the whole pack.
#[test]
fn a_pack_without_films_has_one_half() {
    let with = |name: &str| {
        let own = [format!("solver.integrator={name}"), "models.gas_flow.model=gap_orifice".into()];
        let seated = ["models.ring_motion.model=seated".into(), "outputs.results=[\"blow_by\"]".into()];
        [implicit("1e-3"), own.to_vec(), seated.to_vec()].concat()
    };
    let r = runs(&[set(CASE, &with("waveform")), set(CASE, &with("rodas5p"))]);
    let [halves, whole] = [0, 1].map(|k| value(&r[k], "blow_by"));
    assert!((halves / whole - 1.0).abs() < 1e-3, "{halves} for {whole}");
}

/// Of rings three times as heavy one leaves the liner in the first cycle: the answer is that of the whole pack, and the run says so.
#[test]
fn halves_that_do_not_agree_are_integrated_whole() {
    let heavy = ["rings.0.mass=129 g", "rings.1.mass=111 g", "rings.2.mass=132 g"].map(String::from).to_vec();
    let with = |name: &str, tolerance: &str| {
        let own = [format!("solver.integrator={name}"), "solver.periodicity=1e-2".into()];
        [implicit(tolerance), heavy.clone(), own.to_vec()].concat()
    };
    let r = runs(&[set(CASE, &with("waveform", "1e-2")), set(CASE, &with("rodas3", "3e-3"))]);
    let note = r[0].solver.notes.iter().find(|n| n.topic == "halves_apart").expect("it is told");
    assert!(note.text.starts_with("a ring leaves the liner in the first cycle"), "{}", note.text);
    assert_eq!(r[0].results, r[1].results);
}

/// A search of the whole pack begins where one in halves ends, which leaves it a few cycles; where these do not agree, as if there had been none.
#[test]
fn a_search_begins_where_halves_end() {
    let rodas3 = |tolerance: &str| [implicit(tolerance), vec!["solver.integrator=rodas3".into()]].concat();
    let heavy = ["rings.0.mass=129 g", "rings.1.mass=111 g", "rings.2.mass=132 g"].map(String::from).to_vec();
    let asked = [
        set("turbo-diesel-120", &rodas3("1e-3")),
        set(CASE, &rodas3("1e-3")),
        set(CASE, &[rodas3("3e-3"), heavy].concat()),
        set(CASE, &[implicit("1e-2"), vec!["solver.integrator=waveform".into()]].concat()),
        set(CASE, &[rodas3("1e-3"), vec!["models.ring_motion.model=three_seat".into()]].concat()),
        // Too few for both searches.
        set(CASE, &[rodas3("1e-3"), vec!["solver.max_cycles=1".into()]].concat()),
    ];
    let r = runs(&asked);
    let cycles = |k: usize, name: &str| r[k].solver.counters.get(name).copied().unwrap_or(0);
    for (k, (_, set)) in asked.iter().enumerate() {
        println!("{set:?}: {} and {} cycles", cycles(k, "coarse_cycles"), cycles(k, "cycles"));
    }
    // 17 and 5 cycles from a cold start; 2 each when this was written.
    assert!(cycles(0, "coarse_cycles") > 8 && cycles(0, "cycles") <= 4);
    assert!(cycles(1, "coarse_cycles") > 2 && cycles(1, "cycles") <= 3);
    // One of its rings leaves the liner.
    assert!(cycles(2, "coarse_cycles") == 1 && r[2].solver.notes.iter().all(|n| n.topic != "halves_apart"));
    assert!(value(&r[2], "periodicity_error") <= 3e-3);
    assert!((3..6).all(|k| cycles(k, "coarse_cycles") == 0));
    // Nearer than the periodic state is asked to be found.
    for (k, case) in ["turbo-diesel-120", CASE].iter().enumerate() {
        let exact = &runs(&[set(case, &implicit("1e-5"))])[0];
        for name in ["blow_by", "friction_power", "land2.p_max"] {
            let error = (value(&r[k], name) / value(exact, name) - 1.0).abs();
            // That of the search of a pack with oil at this tolerance is 1e-2.
            assert!(error <= [2e-3, 1e-3][k], "{case} {name}: {error:e}");
        }
    }
}

/// Where rings flutter halves do not agree, and the oil, which takes hundreds of cycles of the whole pack to its periodic state, is brought there by cycles of the films alone.
#[test]
fn films_alone_lead_where_rings_flutter() {
    let r = runs(&[
        set("alcohol-2000-5600", &[]),
        set("turbo-diesel-120", &["engine.speed=3000 rpm".into(), "solver.tolerance=3e-3".into()]),
    ]);
    // Films that come nearer, by 300 cycles at a time, to where a hundredth of what counts as one is moved: runs at tolerances of 1e-4 and 1e-5 differ by 4e-5. As far as they came before, by
    // the film on the whole liner, the friction of the diesel was 1.4e-2 of itself too low: ring 1 then had yet to run dry at its upper turning point.
    let exact = [
        [("blow_by", 11.0118), ("friction_power", 443.44)],
        [("blow_by", 86.2310), ("friction_power", 735.95)],
    ];
    for (r, exact) in r.iter().zip(exact) {
        let count = |name: &str| r.solver.counters.get(name).copied().unwrap_or(0);
        println!("{} and {} cycles", count("coarse_cycles"), count("cycles"));
        // 71 and 87 in halves and of films, 8 and 7 of the whole pack when this was written.
        assert!(count("coarse_cycles") > 20 && count("cycles") <= 14, "{:?}", r.solver.counters);
        assert!(value(r, "periodicity_error") <= 2e-3);
        for ((name, exact), admitted) in exact.into_iter().zip([2e-4, 4e-3]) {
            let error = (value(r, name) / exact - 1.0).abs();
            println!("{name}: {error:e}");
            // 1e-5 and 1.1e-4 of the blow-by, 8e-4 and 3e-4 of the friction when this was written; of other searches as good up to 3e-3.
            assert!(error <= admitted, "{name}: {error:e}");
        }
    }
}

/// Near the periodic state a cycle takes the steps of the one before again, and hardly one of them is rejected.
#[test]
fn steps_of_the_cycle_before_are_taken_again() {
    let r = &runs(&[set(CASE, &[implicit("1e-4"), vec!["engine.speed=3000 rpm".into()]].concat())])[0];
    let count = |name: &str| r.solver.counters[name] as f64;
    // Of all cycles, the first among them: 0.09 in 6 of them when this was written, 0.24 where each chose its steps.
    assert!(count("cycles") > 3.0 && count("rejected") < 0.15 * count("steps"), "{:?}", r.solver.counters);
}

/// A ring that is in flight where a cycle ends, over a film that could hold it, is held in one cycle and not in the next: neither its velocity nor which of both it was keeps
/// the search from its end.
#[test]
fn a_ring_in_flight_at_the_end_of_a_cycle_does_not_prolong_the_search() {
    let pack = [
        "engine.speed=1492.2 rpm",
        "rings.0.cold_gap=0.5677 mm",
        "rings.1.cold_gap=0.4429 mm",
        "models.contact.composite_modulus=75.127 GPa",
        "rings.1.mass=31.178 g",
        "rings.0.mass=32.885 g",
        "solver.integrator=rodas3",
        "solver.tolerance=3e-3",
    ];
    let r = run_case(CASE, &pack);
    // 3 when this was written, and 43 where the velocity counted and what a ring could be held by was asked of its place alone.
    assert!(r.solver.counters["cycles"] <= 6, "{:?}", r.solver.counters);
}

/// With oil on the liner halves may part for some cycles. Where they go on to do so they are given up as soon as that shows, and not after forty cycles: at all of nine speeds
/// from 2600 to 2800 rpm after nine. In the first cycle it is not looked for here: a ring leaves the liner in it.
#[test]
fn halves_with_oil_that_part_are_given_up_soon() {
    let own = [
        "solver.integrator=waveform",
        "solver.tolerance=5e-3",
        "solver.limits.off_the_liner=1 mm",
        "engine.speed=2700 rpm",
        "rings.0.cold_gap=0.363 mm",
        "rings.0.mass=48.1 g",
        "models.contact.composite_modulus=137.8 GPa",
        "models.oil_transport.supply=19.15 um",
    ];
    let r = run_case("turbo-diesel-120", &own);
    let note = r.solver.notes.iter().find(|n| n.topic == "halves_apart").expect("it is told");
    let cycles = note.text.split_once("agree in ").and_then(|(_, rest)| rest.split(' ').next()?.parse().ok());
    assert!(cycles.is_some_and(|n: usize| n <= 9), "{}", note.text);
    // The whole pack is integrated to three tenths of the tolerance, its periodic state found to a hundredth.
    assert!(value(&r, "periodicity_error") <= 1e-2);
}

/// A pack with two periodic states, 64.2 and 57.0 l/min: from its own start it comes to the first, in which ring 2 leaves the liner, by plain cycles of the whole pack at tolerances of
/// 1e-3 to 1e-5. Halves alone come to the second, and a search that they led ended there.
#[test]
fn a_search_ends_where_the_pack_goes_from_its_start() {
    let pack = [
        "engine.speed=2204.7 rpm",
        "rings.0.cold_gap=0.3816 mm",
        "rings.1.cold_gap=0.7831 mm",
        "models.contact.composite_modulus=126.569 GPa",
        "rings.1.mass=49.824 g",
        "rings.0.mass=38.120 g",
    ];
    for own in [
        ["solver.integrator=rodas3", "solver.tolerance=1e-4"],
        ["solver.integrator=waveform", "solver.tolerance=1e-2"],
    ] {
        let r = run_case(CASE, &[&pack[..], &own].concat());
        let (blow_by, friction) = (value(&r, "blow_by"), value(&r, "friction_power"));
        println!("{own:?}: {blow_by} l/min, {friction} W");
        // Of the run at 1e-5, which halves never led; here both are within 4e-4 of it. The other state is 11 and 33 % away.
        assert!((blow_by / 64.171 - 1.0).abs() < 2e-3 && (friction / 464.05 - 1.0).abs() < 5e-3, "{own:?}");
        assert!(r.solver.notes.iter().any(|n| n.topic == "off_the_liner.ring2"), "{:?}", r.solver.notes);
    }
}

#[test]
fn a_pack_that_cannot_solve_stages_is_told_so() {
    for integrator in ["sdirk2", "waveform"] {
        let own = format!("solver.integrator={integrator}");
        let set = [own.as_str(), "models.ring_motion.model=three_seat"];
        let report = gudgeon_scene::check(&case_file(CASE), &overrides_of(CASE, &set));
        let Err(report) = report else { panic!("three_seat has no stages") };
        let found = &report.diagnostics[0];
        let wanted = "`three_seat`, the motion of ring 1, does not solve stages of implicit steps";
        assert_eq!((found.message.as_str(), found.path.as_str()), (wanted, "solver.integrator"));
    }
}

#[test]
fn closures() {
    let asked = [
        set(CASE, &[]),
        set(
            "alcohol-1600-5600",
            &[implicit("1e-3"), vec!["solver.starts=[\"1 bar\"]".into(), "solver.max_cycles=10".into()]]
                .concat(),
        ),
        set(CASE, &["models.gas_flow.model=narrow_channel".into()]),
        set(PUBLISHED, &[]),
        set(
            "alcohol-1600-3000",
            &["solver.cycles=4".into(), "solver.gas_steps=20".into(), "solver.starts=[\"6 bar\"]".into()],
        ),
    ];
    for r in runs(&asked).iter().chain([&*TIGHT]) {
        println!("{}: {:?}", r.case, r.balance);
        // Masses are the states and flows the quadratures of one linear method: round-off of some thousand steps.
        assert!(r.balance.gas_mass.expect("there is gas") <= 1e-10, "{}: {:?}", r.case, r.balance);
    }
}

#[test]
fn runs_repeat_bit_by_bit() {
    for (case, overrides) in [
        (CASE, implicit("1e-4")),
        (PUBLISHED, vec![]),
        ("alcohol-1600-4000", vec!["solver.cycles=3".into(), "solver.gas_steps=20".into()]),
    ] {
        let r = runs(&[set(case, &overrides), set(case, &overrides)]);
        let bits = |r: &RunResult| -> Vec<u64> {
            let results = r.results.values().map(|v| v.value);
            let series = r.series.columns.iter().flat_map(|c| c.values.iter().copied());
            results.chain(r.series.axis.values.iter().copied()).chain(series).map(f64::to_bits).collect()
        };
        assert_eq!(bits(&r[0]), bits(&r[1]), "{case}");
        assert_eq!(r[0].solver, r[1].solver, "{case}");
        assert_eq!(r[0].balance, r[1].balance, "{case}");
        assert_eq!(r[0].events, r[1].events, "{case}");
        assert_eq!(r[0].branches, r[1].branches, "{case}");
    }
}
