//! Keys of `[engine]` and `[piston]` that a case gives and its scene does not use.

use std::collections::BTreeMap;

use gudgeon_core::result::RunResult;
use gudgeon_scene::{Checked, check, explain, run};

use crate::common::*;

/// A case of each scene with a part of a shared table unused, and other values for all of that part.
const CASES: [(&str, &[(&str, &str)]); 3] = [
    (
        "turbo-diesel-120/flooded",
        &[
            ("piston.mass", "3 kg"),
            ("piston.inertia", "0.01 kg m2"),
            ("piston.pin_mass", "0.9 kg"),
            ("piston.pin_depth", "31 mm"),
            ("piston.gravity_depth", "11 mm"),
            ("piston.gravity_offset", "2 mm"),
            ("piston.gravity_side", "thrust"),
            ("piston.alloy", "m124_cast"),
            ("piston.apparent_density", "0.7 g/cm3"),
        ],
    ),
    (
        "zhu-motored-1000",
        &[
            ("piston.pin_to_ring1", "33 mm"),
            ("piston.alloy", "m124_cast"),
            ("piston.apparent_density", "0.7 g/cm3"),
        ],
    ),
    (
        "pin-120-turbo-diesel",
        &[
            ("engine.speed", "1234 rpm"),
            ("engine.stroke", "155 mm"),
            ("engine.rod_length", "255 mm"),
            ("engine.pin_offset", "1 mm"),
            ("engine.crank_offset", "2 mm"),
            ("engine.cylinders", "7"),
            ("piston.mass", "3 kg"),
            ("piston.pin_to_ring1", "33 mm"),
        ],
    ),
];

fn sets(values: &[(&str, &str)]) -> Vec<String> {
    values.iter().map(|(path, value)| format!("{path}={value}")).collect()
}

fn checked_with(case: &str, set: &[String]) -> Checked {
    checked(case, &set.iter().map(String::as_str).collect::<Vec<_>>())
}

fn ran(case: &str, set: &[String]) -> RunResult {
    run(&checked_with(case, set), &mut gudgeon_scene::unwatched).unwrap_or_else(|e| panic!("{case}: {e}"))
}

#[test]
fn what_a_scene_does_not_use_changes_nothing_and_is_told() {
    for (case, values) in CASES {
        let set = sets(values);
        let checked = checked_with(case, &set);
        for (path, _) in values {
            let noted = checked.notes.iter().any(|n| n.contains(path) && n.contains("changes nothing"));
            assert!(noted, "{case}: {path}: {:?}", checked.notes);
        }
        let told = explain(&checked).unwrap_or_else(|e| panic!("{case}: {e}")).to_text();
        for (path, _) in values {
            assert!(told.contains(&format!("{path}: this scene does not use it")), "{case}: {path}\n{told}");
        }
        let bits = |r: &RunResult| -> BTreeMap<String, u64> {
            r.results.iter().map(|(name, v)| (name.clone(), v.value.to_bits())).collect()
        };
        assert_eq!(bits(&ran(case, &[])), bits(&ran(case, &set)), "{case}");
    }
}

#[test]
fn a_sweep_of_what_is_not_used_is_refused() {
    for (case, values) in CASES {
        let (path, value) = values[0];
        let sweep = format!("sweeps=[{{ path = \"{path}\", values = [\"{value}\"] }}]");
        let Err(refused) = check(&case_file(case), &[sweep]) else { panic!("{case}: accepted") };
        assert!(
            refused.to_string().contains(&format!("this scene does not use `{path}`")),
            "{case}: {refused}"
        );
    }
}

/// What is used is not called unused: a sweep of it stands, and the value arrives.
#[test]
fn what_a_scene_uses_changes_something() {
    for (case, path, value) in [
        ("pin-85-alcohol", "engine.bore", "86 mm"),
        ("zhu-motored-1000", "piston.gravity_offset", "3 mm"),
        ("turbo-diesel-120/flooded", "engine.cylinders", "5"),
    ] {
        let set = [format!("{path}={value}")];
        let checked = checked_with(case, &set);
        assert!(checked.notes.iter().all(|n| !n.contains("changes nothing")), "{case}: {:?}", checked.notes);
        let (a, b) = (ran(case, &[]), ran(case, &set));
        assert!(a.results.iter().any(|(name, v)| b.results[name].value != v.value), "{case}: {path}");
    }
}
