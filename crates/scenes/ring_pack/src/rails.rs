//! Three-piece oil rings with an expander, taken apart into their two rails.
//!
//! Each rail becomes a ring with motion, film and oil of its own. Between them stands a land: the space of the groove, in which the expander is. The
//! upper rail is open to it below, the lower one above, so gas passes the flank that a rail seals, and its end gap. The way of a rail in the groove is all
//! the axial clearance that rails and expander leave, the other rail being at rest on its own flank. The expander stands for the other flank, with oil as on a
//! flank, and its force is constant: it has no stiffness along the groove and no friction against the rails.

use std::borrow::Cow;
use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::quantity::quantity;
use gudgeon_core::result::Skipped;
use gudgeon_machine::Land;

use crate::case::{Expander, Ring, RingDesign, RingPackCase};

/// Density of the expander \[kg/m³\].
const STEEL: f64 = 7850.0;

/// A case whose rings are single bodies.
pub struct TakenApart<'a> {
    /// The case.
    pub case: Cow<'a, RingPackCase>,
    /// The ring of the case that each of them belongs to.
    of: Vec<usize>,
}

impl<'a> TakenApart<'a> {
    /// Takes the three-piece rings with an expander of a case apart.
    ///
    /// # Errors
    /// What cannot be of them, with its place in the case.
    pub fn new(case: &'a RingPackCase) -> Result<Self, Vec<BuildError>> {
        let n = case.rings.len();
        let plain = |case| Ok(Self { case, of: (0..n).collect() });
        // A pack whose lands do not fit its rings is refused as it is.
        if case.rings.iter().all(|r| r.expander.is_none()) || case.piston.lands.len() != n {
            return plain(Cow::Borrowed(case));
        }
        let (mut whole, mut of, mut errors) = (case.clone(), Vec::new(), Vec::new());
        whole.rings.clear();
        whole.piston.lands.clear();
        for (i, (ring, land)) in case.rings.iter().zip(&case.piston.lands).enumerate() {
            whole.piston.lands.push(land.clone());
            match ring.expander.as_ref().map(|e| rails(ring, e, land, case.engine.bore.si() / 2.0)) {
                None => whole.rings.push(ring.clone()),
                Some(Ok((pair, between))) => {
                    whole.rings.extend(pair);
                    whole.piston.lands.push(between);
                    of.push(i);
                }
                Some(Err(e)) => errors.push(e.within(&format!("rings.{i}"))),
            }
            of.push(i);
        }
        if errors.is_empty() { Ok(Self { case: Cow::Owned(whole), of }) } else { Err(errors) }
    }

    /// Errors about these rings and lands at their places in the case.
    #[must_use]
    pub fn located(&self, mut errors: Vec<BuildError>) -> Vec<BuildError> {
        for e in &mut errors {
            if let Some(field) = self.field(&e.field) {
                e.field = field;
            }
        }
        errors
    }

    /// The place in the case of a place in this one, where it is another.
    fn field(&self, field: &str) -> Option<String> {
        let part = |list: &str| {
            let (k, rest) =
                field.strip_prefix(list).map(|rest| rest.split_once('.').unwrap_or((rest, "")))?;
            Some((k.parse::<usize>().ok()?, rest))
        };
        let at = |list: &str, k: usize, rest: &str| {
            if rest.is_empty() { format!("{list}{k}") } else { format!("{list}{k}.{rest}") }
        };
        if let Some((k, rest)) = part("rings.") {
            return Some(at("rings.", *self.of.get(k)?, rest));
        }
        let (k, rest) = part("piston.lands.")?;
        let own = self.case.rings.get(k)?.design == RingDesign::LowerRail;
        let k = *self.of.get(k)?;
        Some(if own { at("rings.", k, "groove") } else { at("piston.lands.", k, rest) })
    }
}

/// What a ring is called in words, by its number from 0.
#[must_use]
pub fn name(case: &RingPackCase, i: usize) -> String {
    match case.rings[i].design {
        RingDesign::UpperRail => format!("ring {} (upper rail)", i + 1),
        RingDesign::LowerRail => format!("ring {} (lower rail)", i + 1),
        _ => format!("ring {}", i + 1),
    }
}

/// That three-piece rings are taken apart, for `explain`.
pub fn told(case: &RingPackCase) -> impl Iterator<Item = Skipped> {
    let lower = case.rings.iter().enumerate().filter(|(_, r)| r.design == RingDesign::LowerRail);
    lower.map(|(i, _)| Skipped {
        what: format!("ring {i} and ring {}", i + 1),
        why: "they are the upper and the lower rail of a three-piece oil ring with an expander".into(),
    })
}

/// The flank that a ring seals when gas and inertia let it.
#[must_use]
pub fn flank(case: &RingPackCase, i: usize) -> &'static str {
    if case.rings[i].design == RingDesign::UpperRail { "upper" } else { "lower" }
}

/// What the space above a ring is called in words.
#[must_use]
pub fn land_name(case: &RingPackCase, i: usize) -> String {
    match case.rings[i].design {
        RingDesign::LowerRail => format!("land {} (between the rails)", i + 1),
        _ => format!("land {}", i + 1),
    }
}

/// Both rails of a ring under a land, and the space between them.
fn rails(
    ring: &Ring,
    expander: &Expander,
    above: &Land,
    bore_radius: f64,
) -> Result<([Ring; 2], Land), BuildError> {
    if ring.design != RingDesign::ThreePiece {
        let what = "only a three-piece ring has an expander";
        return Err(BuildError::at("expander", what)
            .help("write `design = \"three_piece\"`, or leave the expander out"));
    }
    let clearance = clearance(ring, expander)?;
    let mass = 0.5 * (ring.mass.si() - expander.mass.si());
    if mass <= 0.0 {
        let what = format!(
            "the expander weighs {:.3} g, the whole ring {:.3} g: nothing is left for the rails",
            1e3 * expander.mass.si(),
            1e3 * ring.mass.si()
        );
        return Err(BuildError::at("expander.mass", what));
    }
    let angle = expander.ear_angle.si();
    if !(0.0..=PI / 4.0).contains(&angle) {
        let what = format!("ears at {:.3} deg do not push a rail outwards", angle.to_degrees());
        return Err(BuildError::at("expander.ear_angle", what).help("between 0 and 45 deg"));
    }
    let between = Land {
        height: Some(quantity(expander.height.si() - clearance)),
        volume: Some(quantity(space(ring, expander, clearance, bore_radius)?)),
        temperature: ring.groove.temperature,
        ..above.clone()
    };
    let rail = |design: RingDesign, name: &str| {
        let mut rail = ring.clone();
        rail.design = design;
        rail.name = if ring.name.is_empty() { name.to_owned() } else { format!("{}, {name}", ring.name) };
        rail.mass = quantity(mass);
        rail.tangential_force = quantity(0.5 * ring.tangential_force.si());
        (rail.groove.height, rail.groove.clearance) = (None, Some(quantity(clearance)));
        rail
    };
    let (mut upper, mut lower) =
        (rail(RingDesign::UpperRail, "upper rail"), rail(RingDesign::LowerRail, "lower rail"));
    // The other side of each is the expander.
    (upper.groove.lower_angle, lower.groove.upper_angle) = (quantity(0.0), quantity(0.0));
    (upper.groove.chamfer_lower, lower.groove.chamfer_upper) = (None, None);
    Ok(([upper, lower], between))
}

/// Axial clearance that both rails and the expander leave in the groove \[m\].
fn clearance(ring: &Ring, expander: &Expander) -> Result<f64, BuildError> {
    let (rail, spacer) = (ring.height.si(), expander.height.si());
    let (key, clearance) = match (ring.groove.height, ring.groove.clearance) {
        (Some(_), Some(_)) => {
            let what = "both `height` and `clearance` are given";
            return Err(BuildError::at("groove.clearance", what).help("keep one of them"));
        }
        (Some(height), None) => ("groove.height", height.si() - 2.0 * rail - spacer),
        (None, Some(clearance)) => ("groove.clearance", clearance.si()),
        (None, None) => {
            return Err(BuildError::at("groove", "the groove has neither `height` nor `clearance`"));
        }
    };
    let needs = format!("two rails of {:.4} mm and an expander of {:.4} mm", 1e3 * rail, 1e3 * spacer);
    if clearance <= 0.0 {
        let what = format!("{needs} leave an axial clearance of {:.4} mm in the groove", 1e3 * clearance);
        return Err(BuildError::at(key, what)
            .help(format!("they need more than {:.4} mm", 1e3 * (2.0 * rail + spacer))));
    }
    if clearance >= spacer {
        let what = format!(
            "{needs} leave an axial clearance of {:.4} mm: the expander could tip over",
            1e3 * clearance
        );
        return Err(BuildError::at(key, what).help("a clearance of some hundredths of a millimetre is usual"));
    }
    Ok(clearance)
}

/// Gas between and behind the rails \[m³\]: given, or that of the groove up to the bore, less what rails and expander take.
fn space(ring: &Ring, expander: &Expander, clearance: f64, bore_radius: f64) -> Result<f64, BuildError> {
    let Some(root) = ring.groove.root_diameter else {
        let what = "the groove has no `root_diameter`, which the rails need";
        return Err(BuildError::at("groove", what));
    };
    if let Some(volume) = ring.groove.back_volume {
        return Ok(volume.si());
    }
    let (root, inner) = (root.si() / 2.0, bore_radius - ring.width.si());
    let annulus = |r: f64| PI * (bore_radius * bore_radius - r * r);
    let (rail, spacer) = (ring.height.si(), expander.height.si());
    let groove = annulus(root) * (2.0 * rail + spacer + clearance);
    let volume = groove - 2.0 * rail * annulus(inner) - expander.mass.si() / STEEL;
    if volume > 0.0 {
        return Ok(volume);
    }
    let what = format!("rails and expander take more room than the groove has, by {:.4} cm3", -1e6 * volume);
    Err(BuildError::at("groove.root_diameter", what)
        .help("check the mass of the expander, or give `back_volume`"))
}
