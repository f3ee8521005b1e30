//! Results of the scene, and what they need.

use gudgeon_core::BuildError;

use super::assembly::Assembly;
use super::case::PistonSecondaryCase;

/// One result.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultInfo {
    /// Name in `summary.json`.
    pub name: String,
    /// Unit of the value.
    pub unit: &'static str,
    /// One line.
    pub what: String,
    /// Whether the flow of oil over the edges is needed, which nothing else needs.
    pub flow: bool,
}

/// Quantities that [`Outputs::at`](super::case::Outputs::at) tells at a crank angle: name, unit, column, factor, what.
pub const AT: [(&str, &str, &str, f64, &str); 7] = [
    ("e_top", "um", "skirt.e_top", 1e6, "displacement of the upper edge"),
    ("e_bottom", "um", "skirt.e_bottom", 1e6, "displacement of the lower edge"),
    ("e_top_rate", "um/s", "skirt.e_top_rate", 1e6, "velocity of the upper edge"),
    ("e_bottom_rate", "um/s", "skirt.e_bottom_rate", 1e6, "velocity of the lower edge"),
    ("side_force", "N", "skirt.side_force", 1.0, "side force"),
    ("side_moment", "N m", "skirt.side_moment", 1.0, "moment of the side force about the pin"),
    ("friction_force", "N", "skirt.friction_force", 1.0, "friction force"),
];

/// Results that are the largest and smallest value of a column and where: name, unit, column, factor, what.
pub const EXTREMES: [(&str, &str, &str, f64, &str); 6] = [
    ("e_top", "um", "skirt.e_top", 1e6, "displacement of the upper edge, towards the anti-thrust side"),
    ("e_bottom", "um", "skirt.e_bottom", 1e6, "displacement of the lower edge, towards the anti-thrust side"),
    ("e_top_rate", "um/s", "skirt.e_top_rate", 1e6, "velocity of the upper edge"),
    ("e_bottom_rate", "um/s", "skirt.e_bottom_rate", 1e6, "velocity of the lower edge"),
    ("side_force", "N", "skirt.side_force", 1.0, "lateral force of film and contact on the skirt"),
    (
        "friction_force",
        "N",
        "skirt.friction_force",
        1.0,
        "axial force of film and contact, away from the head",
    ),
];

/// Results of a skirt that keeps its oil: name, unit, what.
pub const OIL_KEPT: [(&str, &str, &str); 9] = [
    ("oil_in_up", "mm3", "oil that enters over the upper edges in a cycle"),
    ("oil_in_down", "mm3", "oil that enters over the lower edges in a cycle"),
    ("oil_out_up", "mm3", "oil that leaves over the upper edges in a cycle"),
    ("oil_out_down", "mm3", "oil that leaves over the lower edges in a cycle"),
    ("oil_out_aside", "mm3", "oil that leaves over the flanks in a cycle"),
    ("oil_held", "mm3", "mean oil in the gaps of both sides"),
    ("oil_filled", "1", "mean part of the gaps that is filled"),
    ("oil_change", "mm3", "oil that the gaps hold more at the end of the cycle than at its start"),
    ("oil_ledger", "1", "oil_made over all that enters and was there"),
];

/// Every result of a case whose cycle has `period_deg` degrees; `inertial`: with inertia across the bore.
#[must_use]
pub fn catalogue(case: &PistonSecondaryCase, period_deg: f64, inertial: bool) -> Vec<ResultInfo> {
    let mut all = Vec::new();
    let mut add = |name: &str, unit, flow, what: &str| {
        all.push(ResultInfo { name: name.into(), unit, what: what.into(), flow });
    };
    for (name, unit, _, _, what) in EXTREMES {
        for (end, word) in [("max", "highest"), ("min", "lowest")] {
            add(&format!("{name}_{end}"), unit, false, &format!("{word} {what}"));
            add(&format!("{name}_{end}_angle"), "deg", false, &format!("crank angle of {name}_{end}"));
        }
    }
    if period_deg > 540.0 {
        add("friction_expansion", "N", false, "friction force of largest magnitude between 360 and 540 deg");
        add("friction_expansion_angle", "deg", false, "crank angle of friction_expansion");
        add("side_force_intake", "N", false, "largest side force between 0 and 180 deg");
    }
    for (name, unit, what) in [
        ("e_top_mean", "um", "mean displacement of the upper edge"),
        ("e_bottom_mean", "um", "mean displacement of the lower edge"),
        ("tilt_max", "um", "largest difference of the displacements of both edges"),
        ("h_min", "um", "smallest gap"),
        ("h_min_angle", "deg", "crank angle of the smallest gap"),
        ("p_max", "bar", "highest film pressure above that of the crankcase"),
        ("p_max_angle", "deg", "crank angle of the highest film pressure"),
        ("friction_work", "J", "friction work of a cycle, one cylinder"),
        ("friction_power", "W", "friction power, one cylinder"),
        ("fmep", "bar", "friction work over swept volume"),
        ("fmep_boundary", "bar", "the part of fmep that solid contact takes; films take the rest"),
        ("engine_friction_power", "W", "friction power of all cylinders"),
        ("contact_work", "J", "part of the friction work that rubbing does"),
        ("contact_force_max", "N", "largest force of solid contact on a side"),
        ("contact_share", "1", "share of the cycle with solid contact"),
        (
            "contact_begin",
            "deg",
            "crank angle at which solid contact begins in the longest stretch; 0 without contact",
        ),
        ("contact_end", "deg", "crank angle at which that stretch ends"),
        ("slap_energy", "mJ", "largest kinetic energy across the bore that an approach to a side loses"),
        ("slap_energy_angle", "deg", "crank angle at which it is largest"),
        (
            "slap_force_thrust",
            "N",
            "root mean square of the force on the thrust side in harmonics of the cycle from 1 to 5 kHz, of its first 2048",
        ),
        (
            "slap_force_anti_thrust",
            "N",
            "root mean square of the force on the anti-thrust side in the same harmonics",
        ),
        ("periodicity_error", "um", "estimated distance from the periodic motion"),
    ] {
        add(name, unit, false, what);
    }
    if inertial {
        let what = "largest lateral inertia force over the largest side force";
        add("inertia_share", "1", false, what);
    }
    for (name, what) in [
        ("oil_up", "oil that leaves the skirt over its upper edges in a cycle, less what enters"),
        ("oil_down", "oil that leaves the skirt over its lower edges in a cycle, less what enters"),
        ("oil_aside", "oil that leaves the skirt over its flanks in a cycle, less what enters"),
    ] {
        add(name, "mm3", true, what);
    }
    let made = "oil that the films make of nothing in a cycle: what leaves less what enters, and what they then hold more";
    add("oil_made", "mm3", true, made);
    if case.models.skirt_oil.keeps_oil() {
        for (name, unit, what) in OIL_KEPT {
            add(name, unit, true, what);
        }
    }
    for angle in &case.outputs.at {
        let deg = angle.si().to_degrees();
        for (name, unit, _, _, what) in AT {
            add(&format!("{name}@{}", tidy(deg)), unit, false, &format!("{what} at {} deg", tidy(deg)));
        }
    }
    all
}

/// An angle without the noise of its conversion.
#[must_use]
pub fn tidy(deg: f64) -> f64 {
    (deg * 1e6).round() / 1e6
}

/// Names that are wanted.
///
/// # Errors
/// Names that the scene does not have.
pub fn wanted(case: &PistonSecondaryCase, a: &Assembly) -> Result<Vec<ResultInfo>, Vec<BuildError>> {
    let all = catalogue(case, a.period.to_degrees(), a.motion.has_inertia());
    if case.outputs.results.iter().any(|r| r == "all") {
        return Ok(all);
    }
    let names: Vec<&str> = all.iter().map(|r| r.name.as_str()).collect();
    let mut errors = Vec::new();
    for (k, r) in case.outputs.results.iter().enumerate() {
        if !names.contains(&r.as_str()) {
            let what = format!("there is no result `{r}`; {}", gudgeon_case::advice(r, &names));
            errors.push(BuildError::at(format!("outputs.results.{k}"), what));
        }
    }
    if errors.is_empty() {
        Ok(all.into_iter().filter(|r| case.outputs.results.contains(&r.name)).collect())
    } else {
        Err(errors)
    }
}
