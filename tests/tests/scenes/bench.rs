//! Run time and work against error.

use crate::common::*;
use gudgeon_core::Registry;
use gudgeon_core::kinds::{Film1dSpec, TorsionSpec};
use gudgeon_core::result::{BenchPoint, BenchTable};
use gudgeon_scene::default_solvers;
use gudgeon_study::{StudyError, bench};

fn contender(path: &str, values: &[&str]) -> (String, Vec<String>) {
    (path.to_owned(), values.iter().map(|v| (*v).to_owned()).collect())
}

fn raced(
    case: &str,
    set: &[&str],
    results: &[&str],
    contenders: &[(String, Vec<String>)],
) -> Result<BenchTable, StudyError> {
    let results: Vec<String> = results.iter().map(|r| (*r).to_owned()).collect();
    bench(&checked(case, set), &results, contenders, &mut gudgeon_scene::unwatched)
}

fn curve<'t>(table: &'t BenchTable, method: &str) -> Vec<&'t BenchPoint> {
    table.points.iter().filter(|p| p.method == method).collect()
}

#[test]
fn a_film_is_raced_against_another_model_of_its_equations() {
    let b = raced("rigs/slider-barrel", &["rig.panels=40"], &["load", "p_max"], &[]).expect("raced");
    assert!(b.independent && b.reference.contains("complementarity"), "{}", b.reference);
    let own = curve(&b, "front_tracking");
    let settings: Vec<&str> = own.iter().map(|p| p.setting.as_str()).collect();
    assert_eq!(settings, ["panels 5", "panels 10", "panels 20", "panels 40", "panels 80", "panels 160"]);
    let load: Vec<f64> = own.iter().map(|p| p.errors["load"]).collect();
    // Straight panels of the volume of the bent gap are of fourth order once they follow it, and 5 of them do not: over the whole ladder
    // second order is the least, 4^5.
    assert!(load[5] < load[0] / 1024.0, "{load:?}");
    // Panels are counted, and so are the passes over them.
    let counts: Vec<u64> = own.iter().map(|p| p.work["panels"]).collect();
    assert_eq!(counts, [5, 10, 20, 40, 80, 160]);
    assert!(own.iter().all(|p| p.work["iterations"] > 0 && p.seconds_total > 0.0));
    // A grid asks for no error.
    assert!(own.iter().all(|p| p.asked.is_none()));
    assert_eq!(b.default_point().map(|p| p.setting.as_str()), Some("panels 40"));
    assert!(b.findings.iter().any(|f| f.contains("the case as it stands (front_tracking, panels 40)")));
    assert!(b.findings.iter().any(|f| f.contains("at an error of 1e-2 in load, p_max: ")));
    assert_eq!(curve(&b, "complementarity").len(), own.len());
}

#[test]
fn contenders_are_models_and_values() {
    let models = contender("rig.film_1d.model", &["front_tracking", "elrod_adams"]);
    let b = raced("rigs/slider-barrel", &["rig.panels=40"], &["load"], &[models]).expect("raced");
    let worst = |method: &str| curve(&b, method).last().map(|p| p.errors["load"]).expect("a point");
    // Oil that is compressible is another film: its error is that of its equations, some p/beta = 5 MPa/1.5 GPa, whatever the grid.
    assert!(worst("rig.film_1d=front_tracking") < 1e-5, "{:?}", b.points);
    assert!((1e-5..1e-2).contains(&worst("rig.film_1d=elrod_adams")), "{:?}", b.points);
    let speeds = contender("rig.speed", &["10 m/s", "11 m/s"]);
    let b = raced("rigs/slider-barrel", &["rig.panels=40"], &["load"], &[speeds]).expect("raced");
    assert_eq!(b.points.iter().filter(|p| p.is_default).count(), 2, "each as it stands");
}

#[test]
fn a_contender_that_is_none_is_named_with_the_nearest() {
    let cases = [
        (contender("rig.film_1d.model", &["front_traking"]), "did you mean `front_tracking`?"),
        (contender("rig.panel", &["10"]), "did you mean `panels`?"),
        (contender("rig.panels", &["10", "0"]), "rig.panels"),
    ];
    for (wrong, said) in cases {
        match raced("rigs/slider-barrel", &[], &["load"], std::slice::from_ref(&wrong)) {
            Err(StudyError::Input(report)) => {
                assert!(report.to_string().contains(said), "{wrong:?}: {report}");
            }
            other => panic!("{wrong:?}: {other:?}"),
        }
    }
}

#[test]
fn tolerances_are_judged_by_themselves() {
    let b = raced("rigs/gas-five-volumes", &[], &["land2.p", "land2.p_max"], &[]).expect("raced");
    assert!(!b.independent && b.reference.contains("no second one is known"), "{}", b.reference);
    let all = curve(&b, "tolerance");
    assert!(all.len() >= 5);
    for p in &all {
        let (asked, over) = (p.asked.expect("a tolerance"), p.over_asked().expect("achieved"));
        // The tolerance is that of a step; a cycle adds up some, and what is left of them stays within ten.
        assert!(over < 10.0, "{asked:e}: {over}");
        assert!(p.work["steps"] > 0 && p.work["rhs"] > p.work["steps"]);
    }
    let steps: Vec<u64> = all.iter().map(|p| p.work["steps"]).collect();
    assert!(steps.windows(2).all(|w| w[0] < w[1]), "{steps:?}");
    assert!(b.default_is_enough());
}

#[test]
fn a_pin_is_weighed_against_the_bound_of_its_proof() {
    let b = raced("pin-85-alcohol-optimise", &[], &[], &[]).expect("raced");
    assert!(b.independent);
    let exact = curve(&b, "exact optimum and proof");
    // The bound lies below the optimum by the gap of 1e-7 of the pin, which is 2.4 times what is left when the relief is taken off.
    assert!(exact.iter().all(|p| p.errors["mass_differential"] < 3e-7), "{exact:?}");
    // A proof is closed to the gap that it is asked for.
    assert!(exact.iter().all(|p| p.over_asked().is_some_and(|r| r <= 1.0)), "{exact:?}");
    let published = curve(&b, "published search, outer diameter given");
    let (coarse, fine) = (published[0].errors["mass_differential"], published[5].errors["mass_differential"]);
    assert!(coarse > 1e-2 && fine < 1e-3, "{coarse:e} {fine:e}");
}

#[test]
fn a_shaft_line_is_followed_over_time() {
    let set = ["range.orders=16"];
    let b = raced("compressor-2-throw-coupling", &set, &["shaft1.torque_amplitude"], &[]).expect("raced");
    assert!(b.independent && b.reference.contains("implicit"), "{}", b.reference);
    let p = b.default_point().expect("the case as it stands");
    assert_eq!(p.setting, "orders 16");
    // The coupling hears the first orders alone.
    assert!(p.errors["shaft1.torque_amplitude"] < 1e-3, "{p:?}");
    assert!(b.default_over_asked().is_some_and(|r| r < 10.0), "{b:?}");
    assert!(b.trusted_to < 1e-5, "{}", b.reference);
    // What is stepped in time is no sum of orders.
    assert!(curve(&b, "implicit").iter().all(|p| p.setting.starts_with("tolerance")));
}

#[test]
fn methods_that_models_name_exist() {
    let registry = Registry::collect();
    let films =
        default_solvers::<dyn Film1dSpec>().into_iter().map(|(n, m)| ("film_1d", n, m.same_equations()));
    let torsion =
        default_solvers::<dyn TorsionSpec>().into_iter().map(|(n, m)| ("torsion", n, m.same_equations()));
    let named: Vec<_> = films.chain(torsion).filter(|(.., others)| !others.is_empty()).collect();
    assert!(named.len() >= 3, "{named:?}");
    for (kind, name, others) in named {
        for other in others {
            assert!(registry.model(kind, other).is_some() && *other != name, "{kind}/{name} names `{other}`");
        }
    }
}

#[test]
fn what_cannot_be_raced_says_what_can() {
    let why = |case: &str| match raced(case, &[], &[], &[]) {
        Err(e) => e.to_string(),
        Ok(b) => panic!("{b:?}"),
    };
    assert!(why("turbo-diesel-120-power-cylinder").contains("gudgeon bench turbo-diesel-120.toml"));
    assert!(why("pin-85-alcohol").contains("closed form"));
}
