//! What the scene `rig` refuses, and where it points.

use crate::common::*;
use gudgeon_core::result::{Check, NoteLevel, Verdict};
use gudgeon_scene::check;

#[test]
fn mistakes_in_sweeps_are_found_before_anything_runs() {
    let refused = |set: &str| match check(&case_file("rigs/kinematics"), &[set.to_owned()]) {
        Ok(_) => panic!("{set} was accepted"),
        Err(report) => report.to_string(),
    };
    for (set, says) in [
        ("sweeps=[{path=\"rig.spede\", values=[\"1 rpm\"]}]", "spede"),
        ("sweeps=[{path=\"rig.speed\", from=\"1 rpm\", to=\"2 rad/s\", points=3}]", "same unit"),
        ("sweeps=[{path=\"rig.speed\", from=\"1 rpm\", to=\"2 rpm\", points=1}]", "2 to"),
        ("sweeps=[{path=\"rig.speed\", values=[\"1 rpm\"], results=[\"strok\"]}]", "did you mean `stroke`"),
    ] {
        let text = refused(set);
        assert!(text.contains(says), "{set}: {text}");
    }
}

#[test]
fn what_is_not_a_number_holds_no_check() {
    let check = |value: f64, verdict: Verdict| Check {
        set: Vec::new(),
        against: None,
        result: "load".into(),
        value,
        reference: 1.0,
        unit: "N".into(),
        tolerance: 1e-3,
        source: String::new(),
        verdict,
    };
    for verdict in Verdict::ALL {
        assert!(!check(f64::NAN, verdict).holds());
        let close = verdict == Verdict::Reproduced;
        assert_eq!(check(1.0, verdict).holds(), close);
        assert_eq!(check(2.0, verdict).holds(), !close);
    }
}

/// Every rig that is shipped gives its results at every point of its sweeps: `gudgeon run` ends without a failure.
#[test]
fn shipped_rigs_run_at_every_point() {
    let folder = case_file("rigs/kinematics").with_file_name("");
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .expect("a folder")
        .filter_map(|e| Some(e.ok()?.path().file_stem()?.to_str()?.to_owned()))
        .collect();
    names.sort_unstable();
    for name in &names {
        let r = run_case(&format!("rigs/{name}"), &[]);
        let failed: Vec<_> = r.solver.notes.iter().filter(|n| n.level == NoteLevel::Failure).collect();
        assert!(failed.is_empty(), "{name}: {failed:?}");
    }
    assert!(names.len() > 30, "{names:?}");
}
