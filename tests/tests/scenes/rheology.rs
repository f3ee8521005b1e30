//! Oil, surfaces and boundary friction of ring films in whole runs of the shipped diesel.

use crate::common::*;
use gudgeon_core::result::RunResult;

const CASE: &str = "turbo-diesel-120/flooded";
/// Seated rings: what films and friction do is not mixed with what they do to the motion in the groove, which has more than one periodic state.
const SEATED: &str = "models.ring_motion={model=\"seated\"}";
/// So many nodes that the panels at the edges, which carry their pressure however fast a ring is lifted off, are a small part of the face.
const GRID: &str = "models.hydrodynamics={model=\"gridded_face\",points=41}";
const THIN: &str = "models.shear_thinning={model=\"carreau\",critical_shear_rate=\"1e6 1/s\",exponent=0.7,high_shear_ratio=0.5}";
const ROUGH: &str =
    "models.roughness={model=\"patir_cheng\",liner_roughness=\"0.2 um\",body_roughness=\"0.2 um\"}";
const PIEZO: &str = "models.piezoviscosity={model=\"barus\",pressure_viscosity=\"15 1/GPa\"}";
const DENSE: &str = "models.compressibility={model=\"dowson_higginson\"}";

fn seated(set: &[&str]) -> RunResult {
    run_case(CASE, &[&[SEATED], set].concat())
}

fn of(r: &RunResult, names: [&str; 3]) -> [f64; 3] {
    names.map(|n| value(r, n))
}

const FRICTION: [&str; 3] = ["ring1.friction_power", "ring2.friction_power", "ring3.friction_power"];

/// A coefficient that a friction model gives is that of the contact model; a strength over the real area adds to it, a film that thins takes from it.
#[test]
fn boundary_friction_by_a_model() {
    let contact = of(&seated(&[]), FRICTION);
    let coulomb =
        of(&seated(&["models.boundary_friction={model=\"coulomb\",friction_coefficient=0.1}"]), FRICTION);
    let layer =
        "models.boundary_friction={model=\"shear_strength\",strength=\"5 MPa\",pressure_coefficient=0.1}";
    let strong = of(&seated(&[layer]), FRICTION);
    let none = of(&seated(&["models.boundary_friction={model=\"off\"}"]), FRICTION);
    for k in 0..3 {
        // The sign is rounded at rest over 0.01 m/s in either way, a thousandth of the piston speed, by another function.
        assert!((coulomb[k] / contact[k] - 1.0).abs() < 2e-3, "{k}: {coulomb:?} {contact:?}");
        // Summits are under some 1e8 Pa: 5 MPa add some hundredths to a coefficient of 0.1.
        let (added, whole) = (strong[k] - coulomb[k], coulomb[k] - none[k]);
        assert!(added > 0.0 && added < whole && whole > 0.0, "{k}: {added} {whole}");
    }
    // One ring alone has a model of its own.
    let own = of(&seated(&["rings.1.models.boundary_friction={model=\"off\"}"]), FRICTION);
    assert!((own[1] / none[1] - 1.0).abs() < 1e-3 && (own[0] / contact[0] - 1.0).abs() < 1e-3, "{own:?}");
}

#[test]
fn films_change_as_their_oil_does() {
    let h = ["ring1.h_mean", "ring2.h_mean", "ring3.h_mean"];
    let plain = of(&seated(&[GRID]), h);
    let thin = of(&seated(&[GRID, THIN]), h);
    let thick = of(&seated(&[GRID, PIEZO]), h);
    let dense = of(&seated(&[GRID, DENSE]), h);
    for k in 0..3 {
        assert!(thin[k] < plain[k] && thick[k] > plain[k], "{k}: {plain:?} {thin:?} {thick:?}");
        // Oil is a per cent denser at most under the 20 MPa of these films.
        assert!((dense[k] / plain[k] - 1.0).abs() < 0.02, "{k}: {plain:?} {dense:?}");
    }
    let closed = of(&seated(&[]), h);
    let average = of(&seated(&[THIN]), h);
    assert!((0..3).all(|k| average[k] < closed[k]), "{closed:?} {average:?}");
}

/// A coarse grid finds the velocity of a ring that carries next to nothing, too: a small difference of large loads.
#[test]
fn a_coarse_grid_runs_with_everything() {
    let coarse = "models.hydrodynamics={model=\"gridded_face\",points=11}";
    for set in [&[coarse, THIN][..], &[coarse, THIN, ROUGH, PIEZO, DENSE]] {
        let films = of(&seated(set), ["ring1.h_mean", "ring2.h_mean", "ring3.h_mean"]);
        assert!(films.iter().all(|h| *h > 0.1), "{films:?}");
    }
}

/// Flow factors end where the surfaces are pressed together, and the run says so.
#[test]
fn rough_films_say_where_their_factors_end() {
    let r = seated(&[&ROUGH.replace("0.2 um", "0.3 um")]);
    let told = r.solver.notes.iter().find(|n| n.topic == "flow_factors.ring2").expect("ring 2 touches");
    assert!(
        told.amounts["share_of_cycle"].value > 0.0 && told.amounts["below_their_end"].value > 0.0,
        "{told:?}"
    );
    assert!(r.models.iter().any(|m| m.kind == "roughness" && m.model == "patir_cheng"));
}

#[test]
fn what_does_not_fit_is_refused_at_its_place() {
    let refused = |set: &[&str]| match gudgeon_scene::check(&case_file(CASE), &overrides_of(CASE, set)) {
        Ok(_) => panic!("{set:?} is accepted"),
        Err(e) => e.to_string(),
    };
    let e = refused(&[PIEZO]);
    assert!(
        e.contains("models.piezoviscosity") && e.contains("closed_form_face") && e.contains("gridded_face"),
        "{e}"
    );
    let e = refused(&[
        "models.contact={model=\"linear_penalty\",stiffness=\"1e14 N/m3\",touching=\"0.5 um\"}",
        "models.boundary_friction={model=\"shear_strength\"}",
    ]);
    assert!(
        e.contains("models.boundary_friction") && e.contains("real area") && e.contains("linear_penalty"),
        "{e}"
    );
    let own = ROUGH.replace("models.roughness", "rings.0.models.roughness");
    let e = refused(&["models.hydrodynamics={model=\"off\"}", &own]);
    assert!(e.contains("rings.0.models.roughness"), "{e}");
}

/// Films whose heat is followed lie between their walls, a little warmer than the mean by friction.
#[test]
fn films_find_their_temperature() {
    let walls = "models.film_temperature={model=\"energy_balance\",rings=[\"160 degC\",\"150 degC\",\"140 degC\"],tdc=\"160 degC\",bdc=\"140 degC\"}";
    let given =
        "models.film_temperature={model=\"given\",temperatures=[\"155 degC\",\"150 degC\",\"140 degC\"]}";
    let (followed, fixed) = (of(&seated(&[walls]), FRICTION), of(&seated(&[given]), FRICTION));
    for k in 0..3 {
        // Between 140 and 160 degC the viscosity of SAE 30 changes by a third; films are within 10 K of the mean.
        assert!((followed[k] / fixed[k] - 1.0).abs() < 0.15, "{k}: {followed:?} {fixed:?}");
    }
}
