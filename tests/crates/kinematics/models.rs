//! Every model of this crate through the front door: registry, case syntax, defaults.

use gudgeon_core::Registry;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{CylinderPressureCtx, CylinderPressureSpec, KinematicsCtx, KinematicsSpec};

const ENGINE: KinematicsCtx =
    KinematicsCtx { crank_radius: 0.0387, rod_length: 0.144, offset: 0.0, omega: 314.0 };

#[test]
fn every_model_is_described_and_its_example_runs() {
    let registry = Registry::collect();
    let names = |kind| registry.models(kind).iter().map(|m| m.name).collect::<Vec<_>>();
    assert_eq!(names("kinematics"), ["exact_slider_crank", "two_harmonic_series"]);
    assert_eq!(
        names("cylinder_pressure"),
        [
            "angle_windows",
            "constant",
            "ideal_valves",
            "motored",
            "polytropic_burn",
            "single_zone_wiebe",
            "table",
            "valve_losses"
        ]
    );
    if let Err(e) = registry.verify() {
        // Other kinds have no models in this test program; only complaints about these two count.
        assert!(
            !e.iter().any(|e| e.to_string().contains("kinematics") || e.to_string().contains("pressure")),
            "{e:?}"
        );
    }
    for m in registry.models("kinematics") {
        let spec: Box<dyn KinematicsSpec> =
            toml::from_str(&format!("model = \"{}\"\n{}", m.name, m.example)).expect(m.name);
        let motion = spec.build(&ENGINE).expect(m.name).motion(1.0);
        assert!(motion.y.is_finite() && motion.v < 0.0 && motion.a.is_finite());
    }
    let kinematics = gudgeon_kinematics::ExactSliderCrank {}.build(&ENGINE).expect("builds");
    let ctx = CylinderPressureCtx { kinematics: &*kinematics, piston_area: 5e-3, files: &Files::default() };
    for m in registry.models("cylinder_pressure") {
        let spec: Box<dyn CylinderPressureSpec> =
            toml::from_str(&format!("model = \"{}\"\n{}", m.name, m.example)).expect(m.name);
        assert!(spec.build(&ctx).expect(m.name).pressure(1.0) > 0.0);
    }
}

#[test]
fn a_resolved_specification_reads_back_to_the_same_bits() {
    let registry = Registry::collect();
    for kind in ["kinematics", "cylinder_pressure"] {
        let resolve = registry.kind(kind).expect("exists").resolve;
        for m in registry.models(kind) {
            let spec: toml::Table =
                toml::from_str(&format!("model = \"{}\"\n{}", m.name, m.example)).expect("parses");
            let once = resolve(serde_json::to_value(spec).expect("json")).expect("resolves");
            assert_eq!(resolve(once.clone()).expect("resolves again"), once, "{}", m.name);
        }
    }
}

#[test]
fn unknown_keys_are_refused() {
    let e = toml::from_str::<Box<dyn KinematicsSpec>>("model = \"exact_slider_crank\"\nrod = 1").err();
    assert!(e.is_some_and(|e| e.to_string().contains("unknown key `rod`")));
    let e =
        toml::from_str::<Box<dyn CylinderPressureSpec>>("model = \"constant\"\npressure = \"0 bar\"").err();
    assert!(e.is_some_and(|e| e.to_string().contains("greater than zero")));
}
