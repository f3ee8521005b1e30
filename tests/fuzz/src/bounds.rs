//! What no machine does: bounds of physics by the names and units of results, for every scene.
//!
//! They are wide on purpose. A result beyond one of them is wrong whatever the case is; a result within them may be wrong as well.

use gudgeon_core::result::{RunResult, Series};
use serde_json::Value as Json;

/// Slack of a bound that is met exactly, for rounding.
const ROUNDING: f64 = 1e-9;
/// Friction as a mean effective pressure \[bar\]: of a hot engine below 3, of a cold one below 10.
const FMEP: f64 = 100.0;
/// A speed \[rad/s\] at which the rim of a millimetre of steel moves at a three-hundredth of the speed of light.
const SPEED: f64 = 1e9;
/// Pressure \[Pa\] at which a film is no liquid and a gas no gas: a hundred times the yield of steel.
const PRESSURE: f64 = 1e11;
/// Larger than any figure of a machine in any unit.
const HUGE: f64 = 1e30;
/// A bore where the case has none \[m\].
const BORE: f64 = 10.0;

/// A bound: which results it is about, and what of them is impossible.
struct Rule {
    about: fn(&str, &str) -> bool,
    impossible: fn(f64, &str, f64) -> bool,
    what: &'static str,
}

/// The rules: `about` reads the last part of a name and the unit; `impossible` gets the value in SI, the unit and the bore.
const RULES: &[Rule] = &[
    Rule {
        about: |n, u| is_length(u) && (n == "h" || n.starts_with("h_m") || n.starts_with("film_m")),
        impossible: |v, _, bore| v < -ROUNDING * 1e-3 || v > bore,
        what: "a film is between nothing and the bore",
    },
    Rule {
        about: |n, u| is_pressure(u) && (n == "p" || n == "p_max" || n == "p_min" || n == "peak_pressure"),
        impossible: |v, _, _| !(-ROUNDING * 1e5..PRESSURE).contains(&v),
        what: "absolute pressures are positive and below 1e11 Pa",
    },
    Rule {
        about: |n, u| {
            (u == "1" || u == "%" || u.is_empty())
                && (n.ends_with("share") || n == "cavity" || n == "starved")
        },
        impossible: |v, _, _| !(-ROUNDING..=1.0 + ROUNDING).contains(&v),
        what: "a share is between 0 and 1",
    },
    Rule {
        about: |n, _| n == "fill" || n == "fill_min" || n.starts_with("film_part"),
        impossible: |v, _, _| v < -ROUNDING,
        what: "no gap holds less than nothing",
    },
    Rule {
        about: |n, _| {
            n.ends_with("friction_power") || n == "friction_work" || n == "contact_work" || n == "slap_energy"
        },
        impossible: |v, _, _| v < -ROUNDING,
        what: "friction takes work",
    },
    Rule {
        about: |n, _| n == "fmep",
        impossible: |v, _, _| !(-ROUNDING..FMEP * 1e5).contains(&v),
        what: "friction is between nothing and 100 bar of mean effective pressure",
    },
    Rule {
        about: |n, u| u == "deg" && (n.ends_with("_angle") || n == "contact_begin" || n == "contact_end"),
        impossible: |v, _, _| !(-360.0 - ROUNDING..=720.0 + ROUNDING).contains(&v.to_degrees()),
        what: "an angle of the cycle is one of its 720 degrees",
    },
    Rule {
        about: |_, u| u == "rad/s" || u == "rpm",
        impossible: |v, _, _| v.abs() > SPEED,
        what: "nothing turns or twists faster than 1e9 rad/s",
    },
    Rule {
        about: |n, u| {
            (u == "g" || u == "kg") && matches!(n, "pin_mass" | "relieved_mass" | "piston_mass_estimate")
                || matches!(
                    n,
                    "second_moment" | "section_modulus" | "inner" | "outer" | "length" | "swept_volume"
                )
                || u == "Hz"
        },
        impossible: |v, _, _| v < 0.0,
        what: "masses, dimensions and frequencies are positive",
    },
    Rule {
        // Engine totals go with the number of cylinders, which may be anything.
        about: |n, _| n == "blow_by_per_cylinder" || n.starts_with("blow_by_mass"),
        impossible: |v, _, _| v.abs() > 1e3,
        what: "no cylinder loses 1000 m3/s or kg",
    },
    Rule {
        about: |_, _| true,
        impossible: |v, _, _| v.abs() > HUGE,
        what: "no figure of a machine is beyond 1e30",
    },
];

/// Units of results that are not SI, with their factor.
const UNITS: &[(&str, f64)] = &[
    ("um", 1e-6),
    ("mm", 1e-3),
    ("bar", 1e5),
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("GPa", 1e9),
    ("%", 1e-2),
    ("g", 1e-3),
    ("deg", std::f64::consts::PI / 180.0),
    ("rpm", std::f64::consts::PI / 30.0),
    ("l/min", 1e-3 / 60.0),
    ("kW", 1e3),
    ("mJ", 1e-3),
    ("mm4", 1e-12),
    ("mm3", 1e-9),
    ("cm3", 1e-6),
];

fn is_length(unit: &str) -> bool {
    matches!(unit, "m" | "mm" | "um")
}

fn is_pressure(unit: &str) -> bool {
    matches!(unit, "Pa" | "kPa" | "MPa" | "bar")
}

fn si(value: f64, unit: &str) -> f64 {
    UNITS.iter().find(|(u, _)| *u == unit).map_or(value, |(_, f)| value * f)
}

/// Results and columns beyond a bound, with the bound.
#[must_use]
pub fn broken(resolved: &Json, r: &RunResult) -> Vec<String> {
    let bore = bore_of(resolved);
    let mut out = Vec::new();
    for (name, v) in &r.results {
        out.extend(judge(name, v.value, &v.unit, bore));
    }
    // A film that may pull is a model (`full_sommerfeld`): columns are asked for gas pressures, films and speeds.
    let tables = [("series", &r.series)].into_iter().chain(r.tables.iter().map(|(n, t)| (n.as_str(), t)));
    for (table, series) in tables {
        out.extend(columns(table, series, bore));
    }
    let pressure =
        |names: &[&str]| names.iter().find_map(|n| r.results.get(*n)).map(|v| si(v.value, &v.unit));
    for (fmep, peak) in [("fmep", "cylinder.p_max"), ("rings.fmep", "rings.cylinder.p_max")] {
        if let (Some(f), Some(p)) = (pressure(&[fmep]), pressure(&[peak]))
            && f > p
        {
            out.push(format!("{fmep}: {f:.3e} Pa, above the highest pressure of the cylinder ({p:.3e} Pa)"));
        }
    }
    out
}

fn columns(table: &str, s: &Series, bore: f64) -> Vec<String> {
    // Instantaneous friction may drive: the oil that a pressure squeezes out drags the faces along.
    let asked =
        |n: &str, u: &str| is_pressure(u) || is_length(u) || u == "rad/s" || u == "rpm" || n.contains("fill");
    let gas = |n: &str| {
        ["cylinder", "land", "behind", "crankcase", "chamber", "back"].iter().any(|w| n.contains(w))
    };
    let mut out = Vec::new();
    for c in &s.columns {
        if !asked(&c.name, &c.unit) || is_pressure(&c.unit) && !gas(&c.name) {
            continue;
        }
        let first = c.values.iter().find_map(|v| judge(&c.name, *v, &c.unit, bore));
        out.extend(first.map(|what| format!("{table}: {what}")));
    }
    out
}

fn judge(name: &str, value: f64, unit: &str, bore: f64) -> Option<String> {
    // A result at an angle is named `side_force@390`.
    let last = name.split('@').next().unwrap_or(name).rsplit('.').next().unwrap_or(name);
    let rule = RULES.iter().find(|r| (r.about)(last, unit) && (r.impossible)(si(value, unit), unit, bore))?;
    Some(format!("{name}: {value:.4e} {unit}, but {}", rule.what))
}

/// The bore of a case \[m\].
fn bore_of(resolved: &Json) -> f64 {
    let text = resolved.pointer("/engine/bore").and_then(Json::as_str);
    text.and_then(|t| t.split(' ').next()?.parse().ok()).unwrap_or(BORE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_tell_the_impossible_from_the_unusual() {
        let broken = |name: &str, value: f64, unit: &str| judge(name, value, unit, 0.12).is_some();
        for (name, value, unit) in [
            ("skirt.h_min", -5.3, "um"),
            ("ring1.h_max", 121.0, "mm"),
            ("land2.p_max", -0.1, "bar"),
            ("ring1.lifted_share", 1.2, "1"),
            ("cavity", 101.0, "%"),
            ("friction_power", -1.0, "W"),
            ("fmep", 101.0, "bar"),
            ("fmep", 10_100.0, "kPa"),
            ("p_max_angle", 721.0, "deg"),
            ("inertia2.speed_max", 2.4e18, "rad/s"),
            ("pin_mass", -3.0, "g"),
            ("anything", 1e31, ""),
        ] {
            assert!(broken(name, value, unit), "{name} {value} {unit}");
        }
        for (name, value, unit) in [
            ("skirt.h_min", 0.0, "um"),
            ("ring1.h_max", 5.0, "mm"),
            ("land2.p_max", 300.0, "bar"),
            ("cavity", 99.9, "%"),
            ("fmep", 3.0, "bar"),
            ("p_max_angle", 372.0, "deg"),
            ("e_top_min", -35.0, "um"),
            ("side_force@390", -4000.0, "N"),
        ] {
            assert!(!broken(name, value, unit), "{name} {value} {unit}");
        }
    }
}
