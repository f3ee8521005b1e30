//! The models in use and what is left out, for `explain` and the results.

use gudgeon_core::geometry::Vent;
use gudgeon_core::result::{ModelUse, Skipped};

use super::case::{RingDesign, RingModels, RingPackCase};
use super::plan::Plan;
use super::vent::vent;
use super::{evaporation, rheology};

/// The models that run and the parts that do not, for `explain` and the results.
#[must_use]
pub fn models_in_use(case: &RingPackCase, plan: &Plan) -> (Vec<ModelUse>, Vec<Skipped>) {
    let registry = gudgeon_core::Registry::collect();
    let m = &case.models;
    let own = |f: fn(&RingModels) -> Option<&'static str>| -> Vec<&'static str> {
        case.rings.iter().filter_map(|r| f(&r.models)).collect()
    };
    let mut used: Vec<(&str, &str)> = vec![
        ("kinematics", m.kinematics.typetag_name()),
        ("cylinder_pressure", m.cylinder_pressure.typetag_name()),
        ("gas_flow", m.gas_flow.typetag_name()),
    ];
    let mut pack_and_own = |kind: &'static str, name: &'static str, own: Vec<&'static str>| {
        if own.len() < case.rings.len() {
            used.push((kind, name));
        }
        for o in own {
            if !used.contains(&(kind, o)) {
                used.push((kind, o));
            }
        }
    };
    let mut skipped = plan.skipped.clone();
    if plan.axial {
        pack_and_own(
            "ring_motion",
            m.ring_motion.typetag_name(),
            own(|r| r.ring_motion.as_ref().map(|s| s.typetag_name())),
        );
        if !plan.skipped.iter().any(|s| s.what == "flank") {
            pack_and_own("flank", m.flank.typetag_name(), Vec::new());
        }
        for (kind, name) in case.conventions.axial() {
            pack_and_own(kind, name, Vec::new());
        }
    }
    if plan.film {
        pack_and_own(
            "hydrodynamics",
            m.hydrodynamics.typetag_name(),
            own(|r| r.hydrodynamics.as_ref().map(|s| s.typetag_name())),
        );
        pack_and_own(
            "contact",
            m.contact.typetag_name(),
            own(|r| r.contact.as_ref().map(|s| s.typetag_name())),
        );
        for (kind, name) in where_given(case) {
            pack_and_own(kind, name, Vec::new());
        }
        pack_and_own("oil", m.oil.typetag_name(), Vec::new());
        pack_and_own("oil_transport", m.oil_transport.typetag_name(), Vec::new());
        if evaporation::acts(m) {
            pack_and_own("evaporation", m.evaporation.typetag_name(), Vec::new());
        }
        pack_and_own("film_temperature", m.film_temperature.typetag_name(), Vec::new());
        pack_and_own("flank_friction", m.flank_friction.typetag_name(), Vec::new());
        for (kind, name) in case.conventions.film() {
            pack_and_own(kind, name, Vec::new());
        }
    }
    skipped.extend(evaporation::skipped(m, plan));
    for (i, r) in case.rings.iter().enumerate() {
        match r.design {
            RingDesign::ThreePiece => skipped.push(Skipped {
                what: format!("axial motion of ring {}", i + 1),
                why: "a three-piece oil ring without `expander` has no axial clearance: its groove is treated as sealed, gas passes its gaps alone, and blow-by is less than past a ring that leaks at its flanks".into(),
            }),
            RingDesign::UpperRail => {}
            design if vent(r) == Ok(Vent::Open) => skipped.push(Skipped {
                what: match design {
                    RingDesign::LowerRail => format!("gas volume between the rails, ring {i} and ring {}", i + 1),
                    _ => format!("gas volume behind ring {}", i + 1),
                },
                why: "the groove is vented: its gas has the pressure of the crankcase".into(),
            }),
            _ => {}
        }
    }
    let models =
        used.into_iter().map(|(kind, model)| gudgeon_scene::model_use(&registry, kind, model)).collect();
    (models, skipped)
}

/// Kind and name of the models that run where the case gives them, each once.
fn where_given(case: &RingPackCase) -> Vec<(&'static str, &'static str)> {
    let m = &case.models;
    let mut given = Vec::new();
    for (i, r) in case.rings.iter().enumerate() {
        given.extend(rheology::given(case, i).into_iter().flatten());
        let friction = r.models.boundary_friction.as_ref().or(m.boundary_friction.as_ref());
        given.extend(friction.map(|f| ("boundary_friction", f.typetag_name())));
    }
    let mut once = Vec::new();
    for g in given {
        if !once.contains(&g) {
            once.push(g);
        }
    }
    once
}
