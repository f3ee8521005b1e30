//! What every registered model must keep, whoever wrote it: `models`, `describe`, `schema`, case files and reports rely
//! on nothing else. A new model is checked here without a line of its own, but for its name in `registered.txt`.

use std::collections::BTreeMap;
use std::path::Path;

use gudgeon_core::Registry;
use gudgeon_testkit::{Bibliography, assert_none, for_every_model};

/// How the physics of each kind is switched off: its `off` model, or the model that takes its place by giving the
/// answer instead of computing it. A piston always moves and a pin always
/// bears, so `kinematics` and `pin_strength` have none; a bench without a model is none; of two conventions one holds.
const SWITCHED_OFF: &[(&str, Option<&str>)] = &[
    ("axial_gas", None),
    ("boundary_friction", Some("off")),
    ("cavitation_datum", None),
    ("compressibility", Some("off")),
    ("contact", Some("off")),
    ("coupling", Some("off")),
    ("cylinder_pressure", Some("constant")),
    ("drag", None),
    ("drive", Some("off")),
    ("evaporation", Some("off")),
    ("fatigue", Some("off")),
    ("film_1d", Some("off")),
    ("film_2d", Some("off")),
    ("film_force", None),
    ("film_temperature", Some("given")),
    ("flank", Some("dry")),
    ("flank_friction", Some("off")),
    ("gas_flow", Some("prescribed")),
    ("groove_friction", Some("off")),
    ("hoop", None),
    ("hydrodynamics", Some("off")),
    ("kinematics", None),
    ("natural_frequencies", None),
    ("oil", Some("constant")),
    ("oil_transport", Some("off")),
    ("piezoviscosity", Some("off")),
    ("pin_friction", Some("off")),
    ("pin_load", Some("given")),
    ("pin_strength", None),
    ("piston_solver", None),
    ("profile_curve", None),
    ("radial_gas", None),
    ("radial_motion", None),
    ("rig", None),
    ("ring_motion", Some("seated")),
    ("ring_pack_solver", None),
    ("roughness", Some("off")),
    ("secondary_motion", Some("held")),
    ("shear_thinning", Some("off")),
    ("skirt_compliance", Some("rigid")),
    ("skirt_oil", Some("off")),
    ("skirt_profile", Some("cylindrical")),
    ("throw_inertia", Some("off")),
    ("torsion", Some("off")),
    ("twin_land_friction", None),
];

/// A model that is missing in the list was added without anyone noticing, or is no longer linked. `tests/wasm/run` compares the same file with what is
/// registered on WebAssembly.
#[test]
fn what_is_registered_is_the_list_of_registered_txt() {
    let found = gudgeon_models::registered();
    if found != include_str!("../registered.txt") {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("registered.txt");
        std::fs::write(&file, &found).expect("the folder for files of tests can be written");
        panic!(
            "not the list of crates/gudgeon-models/tests/registered.txt; what is registered now stands in {}",
            file.display()
        );
    }
}

/// On targets whose linker keeps what is referred to, and nothing else, a model that its crate's `link!` does not name is lost.
#[test]
fn every_crate_links_all_that_it_registers() {
    let registry = Registry::collect();
    let mut registered: BTreeMap<&str, usize> = BTreeMap::new();
    for m in registry.kinds().flat_map(|k| registry.models(k.kind)) {
        *registered.entry(m.crate_name()).or_default() += 1;
    }
    for s in gudgeon_scene::scenes() {
        *registered.entry(s.crate_name()).or_default() += 1;
    }
    assert_eq!(gudgeon_models::linked().collect::<BTreeMap<_, _>>(), registered);
    assert_eq!(gudgeon_models::link(), registered.values().sum::<usize>());
}

#[test]
fn every_physics_can_be_switched_off() {
    let registry = Registry::collect();
    let kinds: Vec<&str> = registry.kinds().map(|k| k.kind).collect();
    let listed: Vec<&str> = SWITCHED_OFF.iter().map(|(k, _)| *k).collect();
    assert_eq!(kinds, listed, "the list at the top of this file says how each kind is switched off");
    for (kind, model) in SWITCHED_OFF {
        if let Some(model) = model {
            assert!(registry.model(kind, model).is_some(), "{kind}/{model} does not exist");
        }
    }
}

/// Names, texts, examples, keys, schemas, descriptions: `gudgeon_testkit::contract` says what.
#[test]
fn every_model_keeps_the_contract() {
    gudgeon_testkit::check_all();
}

#[test]
fn every_reference_stands_in_the_bibliography() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../REFERENCES.bib");
    let text = std::fs::read_to_string(&file).expect("REFERENCES.bib stands at the root of the repository");
    let bibliography = Bibliography::read(&text);
    assert_none(bibliography.complaints());
    for_every_model(|_, m| bibliography.missing(m));
}
