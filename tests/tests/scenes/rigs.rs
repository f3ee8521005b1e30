//! What the scene `rig` refuses, and where it points.

use crate::common::*;
use gudgeon_core::result::Check;
use gudgeon_sim::check;

#[test]
fn mistakes_in_sweeps_and_checks_are_found_before_anything_runs() {
    let refused = |set: &str| match check(&case_file("rigs/kinematics"), &[set.to_owned()]) {
        Ok(_) => panic!("{set} was accepted"),
        Err(report) => report.to_string(),
    };
    for (set, says) in [
        ("sweeps=[{path=\"rig.spede\", values=[\"1 rpm\"]}]", "spede"),
        ("sweeps=[{path=\"rig.speed\", from=\"1 rpm\", to=\"2 rad/s\", points=3}]", "same unit"),
        ("sweeps=[{path=\"rig.speed\", from=\"1 rpm\", to=\"2 rpm\", points=1}]", "2 to"),
        ("checks=[{set=[\"rig.nothing=1\"], expect=[]}]", "nothing"),
    ] {
        let text = refused(set);
        assert!(text.contains(says), "{set}: {text}");
    }
}

#[test]
fn what_is_not_a_number_holds_no_check() {
    let check = |value: f64, must_fail: bool| Check {
        set: Vec::new(),
        against: None,
        result: "load".into(),
        value,
        reference: 1.0,
        unit: "N".into(),
        tolerance: 1e-3,
        source: String::new(),
        must_fail,
    };
    assert!(!check(f64::NAN, true).holds() && !check(f64::NAN, false).holds());
    assert!(check(1.0, false).holds() && !check(1.0, true).holds());
    assert!(check(2.0, true).holds() && !check(2.0, false).holds());
}
