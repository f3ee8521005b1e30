//! What each scene shows first: which inputs have a slider, and what makes a quick preview of a run. Which results lead, a run says itself.
//!
//! `#` stands for any number. A case of a scene that is not listed, or that has too little of what is, shows the numbers that its text gives.

/// What a scene shows first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shown {
    /// Name of the scene.
    pub scene: &'static str,
    /// Paths of inputs with a slider, the most telling first.
    pub sliders: &'static [&'static str],
    /// Changes that make a run quicker: path and value. A number is only ever raised.
    pub preview: &'static [(&'static str, &'static str)],
}

const RINGS: &[&str] = &[
    "engine.speed",
    "rings.0.cold_gap",
    "rings.1.cold_gap",
    "rings.#.tangential_force",
    "models.oil_transport.supply",
    "models.film_temperature.tdc",
    "models.cylinder_pressure.burn_pressure",
    "rings.0.face.drop",
    "rings.1.face.drop",
    "rings.0.groove.height",
];

/// Every scene that says it.
pub const SHOWN: &[Shown] = &[
    Shown { scene: "ring_pack", sliders: RINGS, preview: RING_PREVIEW },
    Shown {
        scene: "power_cylinder",
        // Its cases name other cases and have no numbers of their own.
        sliders: &[],
        preview: &[],
    },
    Shown {
        scene: "piston_secondary",
        sliders: &[
            "engine.speed",
            "engine.pin_offset",
            "skirt.clearance",
            "piston.mass",
            "models.oil.viscosity",
            "skirt.oil_temperature",
        ],
        preview: &[],
    },
    Shown {
        scene: "shaft_line",
        sliders: &[
            "speed",
            "throws.0.ends.0.cylinder_pressure.discharge",
            "inertias.#.inertia",
            "shafts.#.stiffness",
            "shafts.#.diameter",
        ],
        preview: &[],
    },
    Shown {
        scene: "pin",
        sliders: &[
            "engine.bore",
            "pin.outer",
            "pin.inner",
            "pin.length",
            "models.pin_load.compression_ratio",
            "models.pin_load.speed",
            "limits.bending_stress",
            "limits.ovalisation",
            "limits.boss_pressure",
            "limits.deflection",
        ],
        preview: &[],
    },
    Shown { scene: "rig", sliders: &["rig.film", "rig.speed", "rig.viscosity", "rig.length"], preview: &[] },
];

/// Without oil that is carried along the liner, and with a tolerance whose errors show in the third digit.
const RING_PREVIEW: &[(&str, &str)] = &[("models.oil_transport.model", "off"), ("solver.tolerance", "1e-2")];

/// What a scene shows first.
#[must_use]
pub fn of(scene: &str) -> Option<&'static Shown> {
    SHOWN.iter().find(|s| s.scene == scene)
}

/// Whether a name fits a pattern whose `#` stand for numbers.
#[must_use]
pub fn fits(pattern: &str, name: &str) -> bool {
    let Some((before, rest)) = pattern.split_once('#') else { return pattern == name };
    let Some(after) = name.strip_prefix(before) else { return false };
    let behind = after.trim_start_matches(|c: char| c.is_ascii_digit());
    behind.len() < after.len() && fits(rest, behind)
}
