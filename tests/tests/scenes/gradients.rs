//! Derivatives of results by inputs: followed through the periodic orbit, against differences of runs.

use crate::common::*;
use gudgeon_scene::gradients::{assignment, input};
use gudgeon_scene::{GradientError, RunError, Stopped, unwatched};
use gudgeon_study::gradients::gradients;

const CASE: &str = "turbo-diesel-120/flooded";

fn by(inputs: &[&str]) -> Vec<String> {
    inputs.iter().map(|s| (*s).to_owned()).collect()
}

fn refused(inputs: &[&str], set: &[&str]) -> String {
    match gradients(&checked(CASE, set), &by(inputs), &[], &mut unwatched) {
        Err(e) => e.to_string(),
        Ok(_) => panic!("{inputs:?} has derivatives"),
    }
}

/// Changes to the case on which the limits here were measured.
fn on_the_deck<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&ORIFICES[..], more].concat()
}

/// Elasticities of `result` by central differences of runs at a tight tolerance, extrapolated from two steps; a row for each input.
fn differenced(inputs: &[&str], results: &[&str]) -> Vec<Vec<f64>> {
    // What is left to the periodic state, a fifth of the tolerance of the comparison over the smaller step, is estimated with the noise of a cycle on the safe side.
    let tight = ["solver.tolerance=1e-8", "solver.periodicity=1e-7"];
    let resolved = checked(CASE, &on_the_deck(&tight)).case.resolved();
    let at = |set: &str| run_case(CASE, &on_the_deck(&[tight[0], tight[1], set]));
    let by_step = |path: &str, share: f64| -> Vec<f64> {
        let i = input(&resolved, path, share).unwrap();
        let [low, high] = [-i.step, i.step].map(|d| at(&assignment(&i, i.value + d)));
        let by = |name: &&str| {
            let (l, h) = (value(&low, name), value(&high, name));
            (h - l) / (h + l) / share
        };
        results.iter().map(by).collect()
    };
    // The error of a central difference goes with the square of its step.
    let one = |path: &&str| -> Vec<f64> {
        let (coarse, fine) = (by_step(path, 2.0 * SHARE), by_step(path, SHARE));
        fine.iter().zip(&coarse).map(|(f, c)| f + (f - c) / 3.0).collect()
    };
    inputs.iter().map(one).collect()
}

/// Part of an input by which runs differ from the case. It alone leaves 6e-4 of a derivative to the curvature, and half of it as much to the error of the runs.
const SHARE: f64 = 5e-4;

/// Inputs of the gas, of the film temperature and of the cylinder pressure, whose kinks move with the last. The differences are good to
/// 2e-4 of themselves (halving the steps); what is followed scatters by up to 2e-3 of an elasticity of a tenth with choices that are equal in right (how a
/// step is halved, when Newton's method ends), and is within 6e-4 of a cycle at 1e-9 with those that are made.
#[test]
fn blow_by_and_friction_by_inputs_are_those_of_differences() {
    let inputs = ["rings.0.cold_gap", "models.film_temperature.tdc", "models.cylinder_pressure.burn_start"];
    let results = ["blow_by", "fmep", "ring1.friction_power", "land2.p_max", "ring1.h_mean"];
    let followed = gradients(&checked(CASE, &on_the_deck(&[])), &by(&inputs), &[], &mut unwatched).unwrap();
    assert!(followed.method.contains("variational"), "{}", followed.method);
    // The orbit of the run is near enough for one followed cycle.
    assert_eq!(followed.counters["cycles_followed"], 1);
    for (k, by) in differenced(&inputs, &results).iter().enumerate() {
        for (result, b) in results.iter().zip(by) {
            let a = followed.elasticity(result, k).unwrap();
            // Results of a single ring or land beside the largest elasticities, which are of the order of one: they depend on the place of one corner.
            let floor = if ["blow_by", "fmep"].contains(result) { 0.1 } else { 1.0 };
            assert!((a - b).abs() <= 1e-3 * b.abs().max(floor), "{result} by {}: {a} {b}", inputs[k]);
        }
    }
}

/// Derivatives followed at about the tolerance of the case, in steps of which many have a corner of the rates in them, are those of a cycle that is followed in twice as
/// many steps: two of three to two thousandths, all to four; elasticities below a hundredth to as much of that. The last digits move corners from step to step: of 24
/// tolerances from 7e-5 to 1.5e-4 the derivative of the blow-by by the speed was off a cycle at 1e-9 by 7e-4 in the median and 2.3e-3 at most, and by 8e-4 and 2.4e-3 after
/// the pressure in the cylinder had changed in its last digits (2.6e-3 at 1e-4); at tolerances from 1e-7 to 4e-7 by up to 1.0e-3. The tight ones were compared with differences of runs at 1e-9.
#[test]
fn derivatives_depend_little_on_the_tolerance() {
    let inputs = by(&[
        "engine.speed",
        "rings.0.cold_gap",
        "rings.1.cold_gap",
        "rings.0.tangential_force",
        "rings.2.tangential_force",
        "rings.0.face.drop",
        "models.contact.roughness",
        "rings.0.groove.leak_lower",
        "models.film_temperature.tdc",
        "gas.crankcase_pressure",
    ]);
    let followed =
        |set: &[&str]| gradients(&checked(CASE, &on_the_deck(set)), &inputs, &[], &mut unwatched).unwrap();
    let tight = followed(&["solver.tolerance=3e-8", "solver.periodicity=3e-8"]);
    let own = [&[][..], &["solver.tolerance=7e-5"], &["solver.tolerance=1.5e-4"]].map(followed);
    for result in ["blow_by", "fmep"] {
        for (k, input) in inputs.iter().enumerate() {
            let exact = tight.elasticity(result, k).unwrap();
            let off = |g: &gudgeon_core::result::Gradients| {
                (g.elasticity(result, k).unwrap() - exact).abs() / exact.abs().max(1e-2)
            };
            let mut off = own.each_ref().map(off);
            off.sort_by(f64::total_cmp);
            assert!(off[1] <= 2e-3 && off[2] <= 4e-3, "{result} by {input}: {exact}, off by {off:?}");
        }
    }
}

/// The same bytes from the same case.
#[test]
fn derivatives_are_the_same_every_time() {
    let one =
        || gradients(&checked(CASE, &[]), &by(&["engine.speed"]), &by(&["fmep"]), &mut unwatched).unwrap();
    let (a, b) = (one(), one());
    assert_eq!(a, b);
    assert_eq!(a.results.len(), 1);
    assert_eq!(a.results["fmep"].by[0].unwrap().to_bits(), b.results["fmep"].by[0].unwrap().to_bits());
}

#[test]
fn what_is_no_continuous_quantity_is_refused_with_the_reason() {
    for (path, why) in [
        ("engine.cylinders", "count"),
        ("models.gas_flow.model", "word"),
        ("rings.0.cold_gab", "cold_gap"),
        ("rings.7.cold_gap", "3 elements"),
        ("rings.1.face.offset", "zero"),
        ("rings", "list"),
        ("rings.0.groove", "table"),
        ("models.ring_motion.gravity", "switch"),
    ] {
        let said = refused(&[path], &[]);
        assert!(said.contains(path) && said.contains(why), "{path}: {said}");
    }
    let unknown = gradients(&checked(CASE, &[]), &by(&["engine.speed"]), &by(&["blowby"]), &mut unwatched);
    assert!(unknown.is_err_and(|e| e.to_string().contains("blow_by")));
}

/// Where nothing is followed along a cycle, differences of runs answer and say so.
#[test]
fn a_case_without_derivatives_of_its_own_is_differenced() {
    let pin = checked("pin-85-alcohol", &[]);
    assert!(matches!(
        pin.case.gradients(&by(&["limits.boss_pressure"]), &mut unwatched),
        Err(GradientError::NoMethod(_))
    ));
    let oil = checked(CASE, &["models.oil_transport.model=liner_film"]);
    assert!(matches!(
        oil.case.gradients(&by(&["engine.speed"]), &mut unwatched),
        Err(GradientError::NoMethod(_))
    ));
    let decided = checked(CASE, &["models.ring_motion.model=three_seat"]);
    let found =
        gradients(&decided, &by(&["gas.meter_temperature"]), &by(&["blow_by"]), &mut unwatched).unwrap();
    assert!(found.method.contains("differences") && found.notes[0].text.contains("decided in steps"));
    // The volume of the gas at the meter is proportional to its temperature; nothing else depends on it.
    assert!((found.elasticity("blow_by", 0).unwrap() - 1.0).abs() < 1e-9);
}

/// Natural frequencies and vibration of a shaft line at its mean speed, by a stiffness, an inertia and the speed. Differences with steps of 1e-5 are good to
/// 1e-4 beside a resonance of a thousandth of the speed in width; those of single solutions to rounding over 1e-7.
#[test]
fn a_shaft_line_at_its_mean_speed_is_differentiated() {
    let inputs = by(&["shafts.0.stiffness", "inertias.2.inertia", "speed"]);
    let c = checked("compressor-4-throw", &["models.torsion.model=orders"]);
    let followed = gradients(&c, &inputs, &[], &mut unwatched).unwrap();
    assert!(followed.method.contains("direct solutions"), "{}", followed.method);
    assert_eq!(followed.counters["lines_beside"], 3);
    let mut compared = 0;
    for (k, path) in inputs.iter().enumerate() {
        let i = input(&c.case.resolved(), path, 1e-5).unwrap();
        let [low, high] = [-i.step, i.step].map(|d| {
            let set = ["models.torsion.model=orders".to_owned(), assignment(&i, i.value + d)];
            run_case("compressor-4-throw", &[&set[0], &set[1]])
        });
        for (name, g) in &followed.results {
            let (Some(a), Some(l), Some(h)) = (g.by[k], low.results.get(name), high.results.get(name)) else {
                continue;
            };
            let (value, b) = (g.value.value, (h.value - l.value) / (2.0 * i.step));
            let [a, b] = [a, b].map(|d| d * i.value);
            // Beside a thousandth of the result by all of the input lies rounding over the step.
            assert!(
                (a - b).abs() <= 1e-3 * b.abs().max(1e-3 * value.abs()),
                "{name} by {path}: {a} {b} of {value}"
            );
            compared += 1;
        }
    }
    assert!(compared > 30, "{compared}");
    // A model that iterates is good to its tolerance only.
    let iterated = checked("compressor-4-throw", &[]);
    assert!(matches!(iterated.case.gradients(&inputs, &mut unwatched), Err(GradientError::NoMethod(_))));
}

/// Whoever asks for derivatives hears how far they are, and can end them at whatever is told: followed along a cycle, at the mean speed of a line, by runs.
#[test]
fn derivatives_are_told_of_and_can_be_ended() {
    for (case, set, input) in [
        (CASE, &[][..], "rings.0.cold_gap"),
        ("compressor-4-throw", &["models.torsion.model=orders"][..], "speed"),
        ("pin-85-alcohol", &[][..], "pin.inner"),
    ] {
        let c = checked(case, set);
        let mut told = Vec::new();
        let mut hear = |p: gudgeon_scene::Progress| {
            told.push(p.fraction);
            Ok(())
        };
        gradients(&c, &by(&[input]), &[], &mut hear).unwrap();
        assert!(told.iter().filter(|f| **f > 0.0 && **f <= 1.0).count() >= 1, "{case}: {told:?}");
        assert!(told.is_sorted(), "{case}: {told:?}");
        let mut left = told.len();
        let ended = gradients(&c, &by(&[input]), &[], &mut |_| {
            left -= 1;
            if left > 0 { Ok(()) } else { Err(Stopped) }
        });
        assert!(matches!(ended, Err(GradientError::Run(RunError::Stopped))), "{case}: {ended:?}");
    }
}
