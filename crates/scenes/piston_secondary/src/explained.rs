//! What of a case runs, what is left out and why, and which models are in use.

use gudgeon_core::Registry;
use gudgeon_core::result::{ModelUse, Skipped};
use gudgeon_scene::model_use;

use super::assembly::Assembly;
use super::case::PistonSecondaryCase;
use super::plan::ResultInfo;

/// What runs besides the films, and what is left out.
#[derive(Debug, Default)]
pub struct Explained {
    /// What runs.
    pub runs: Vec<Skipped>,
    /// What does not.
    pub skipped: Vec<Skipped>,
}

impl Explained {
    /// Of an assembly and the results that are wanted.
    #[must_use]
    pub fn new(case: &PistonSecondaryCase, a: &Assembly, wanted: &[ResultInfo]) -> Self {
        let mut all = Self::default();
        let m = &case.models;
        let contact = a.piston.sides.iter().any(gudgeon_skirt::Side::has_contact);
        let why = "summed where the gap is within its range";
        all.model(contact, "solid contact", why, "the contact model", m.contact.typetag_name());
        let why = "it turns the piston";
        let pin = a.piston.has_pin_friction();
        all.model(pin, "friction of the pin", why, "the model", m.pin_friction.typetag_name());
        let (what, why) = ("friction of the rings in their grooves", "it holds the piston");
        let rings = a.piston.has_groove_friction();
        all.model(rings, what, why, "the model", m.groove_friction.typetag_name());
        let rod = case.rod.is_some();
        all.say(
            rod,
            "inertia of the rod",
            if rod { "it presses the pin aside" } else { "the rod has no mass" },
        );
        let why = "it says which part of the films carries";
        all.model(
            m.skirt_oil.keeps_oil(),
            "oil kept in the films",
            why,
            "the model",
            m.skirt_oil.typetag_name(),
        );
        let flow = wanted.iter().any(|r| r.flow);
        all.say(
            flow,
            "flow of oil over the edges of the skirt",
            if flow { "a wanted result needs it" } else { "no wanted result needs it" },
        );
        for part in a.motion.parts() {
            all.say(part.runs, part.what, part.why);
        }
        let whole = a.piston.sides.iter().all(|s| s.nodes() == s.grid().len());
        all.say(
            whole,
            "one half of each side",
            if whole {
                "an odd number of intervals, or a shape that is no mirror image"
            } else {
                "it is the mirror image of the other"
            },
        );
        all
    }

    fn say(&mut self, runs: bool, what: &str, why: &str) {
        let s = Skipped { what: what.into(), why: why.into() };
        if runs { self.runs.push(s) } else { self.skipped.push(s) }
    }

    /// A part of the physics that a model of the name `name` adds, for the reason `why`, or does not.
    fn model(&mut self, runs: bool, what: &str, why: &str, kind: &str, name: &str) {
        if runs {
            self.say(true, what, why);
        } else {
            self.say(false, what, &format!("{kind} is `{name}`"));
        }
    }
}

/// The models in use.
pub fn models(case: &PistonSecondaryCase) -> Vec<ModelUse> {
    let registry = Registry::collect();
    let m = &case.models;
    [
        ("kinematics", m.kinematics.typetag_name()),
        ("cylinder_pressure", m.cylinder_pressure.typetag_name()),
        ("secondary_motion", m.secondary_motion.typetag_name()),
        ("film_2d", m.film_2d.typetag_name()),
        ("roughness", m.roughness.typetag_name()),
        ("contact", m.contact.typetag_name()),
        ("skirt_profile", m.skirt_profile.typetag_name()),
        ("skirt_compliance", m.skirt_compliance.typetag_name()),
        ("skirt_oil", m.skirt_oil.typetag_name()),
        ("pin_friction", m.pin_friction.typetag_name()),
        ("groove_friction", m.groove_friction.typetag_name()),
        ("oil", m.oil.typetag_name()),
        ("shear_thinning", m.shear_thinning.typetag_name()),
    ]
    .into_iter()
    .chain(m.boundary_friction.as_ref().map(|f| ("boundary_friction", f.typetag_name())))
    .map(|(kind, model)| model_use(&registry, kind, model))
    .collect()
}
