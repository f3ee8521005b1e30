//! The reader of openTorsion's format.

use std::f64::consts::PI;

use gudgeon_scene_shaft_line::tors::parse;

const ENGINE: &str = r#"{
    "components": [
        {"name": "engine", "elements": [
            {"name": "flywheel", "type": "Disk", "inertia": 1.6, "damping": 0.5},
            {"name": "shaft", "type": "ShaftDiscrete", "stiffness": 1.8e6, "damping": 2.0, "colour": "red"},
            {"name": "throw", "type": "Disk", "inertia": 0.055, "damping": 1.5, "excitation": {"values": [1, 2]}},
            {"name": "pinion", "type": "GearElement", "inertia": 0.01, "teeth": 20},
            {"name": "wheel", "type": "GearElement", "inertia": 0.2, "teeth": 60, "parent": "pinion"}]},
        {"name": "pump", "elements": [
            {"name": "quill", "type": "ShaftContinuous", "length": 500, "innerDiameter": 0, "outerDiameter": 40},
            {"name": "rotor", "type": "Disk", "inertia": 0.3, "damping": 0.0},
            {"name": "magic", "type": "Wormhole"}]}],
    "structure": [["engine.wheel", "pump.quill"]],
    "author": "somebody"}"#;

#[test]
fn reads_disks_shafts_and_gears_and_tells_the_rest() {
    let i = parse(ENGINE).expect("reads");
    let names: Vec<&str> = i.line.nodes.iter().map(|n| n.name.as_str()).collect();
    assert_eq!(names, ["engine.flywheel", "engine.throw", "engine.wheel", "pump.rotor"]);
    assert!((i.line.nodes[1].inertia - 0.065).abs() < 1e-15, "disk and pinion on one node");
    assert!((i.line.nodes[2].ratio + 1.0 / 3.0).abs() < 1e-15, "the wheel turns slower and the other way");
    let quill = i.line.links[2].coupling.linear(0.0, 0.0).stiffness;
    assert!((quill / (80e9 * PI * 0.04_f64.powi(4) / 32.0 / 0.5) - 1.0).abs() < 1e-14);
    let half = 8000.0 * PI * 0.04_f64.powi(4) / 32.0 * 0.25;
    assert!((i.line.nodes[3].inertia - 0.3 - half).abs() < 1e-15);
    let told = i.report.join("\n");
    for word in ["author", "colour", "excitation", "Wormhole", "half of the shaft's inertia"] {
        assert!(told.contains(word), "{word} in {told}");
    }
    assert!(gudgeon_torsion::tree::Tree::new(&i.line).is_ok());
}

#[test]
fn refuses_what_is_not_tors() {
    let message = |t: &str| parse(t).err().unwrap_or_default();
    assert!(message("{").contains("JSON"));
    assert!(message("{}").contains("components"));
    assert!(message(r#"{"components": [], "structure": [["a", "b"]]}"#).contains("structure.0"));
    let circle = r#"{"components": [{"name": "a", "elements": [{"name": "d", "type": "Disk", "inertia": 1}]},
        {"name": "b", "elements": [{"name": "d", "type": "Disk", "inertia": 1}]},
        {"name": "s", "elements": [{"name": "d", "type": "Disk", "inertia": 1}]}],
        "structure": [["s.d", "a.d"], ["a.d", "b.d"], ["b.d", "a.d"]]}"#;
    assert!(message(circle).contains("circles"));
    let bad = r#"{"components": [{"name": "a", "elements": [{"name": "d", "type": "Disk", "inertia": "x"}]}], "structure": []}"#;
    assert!(message(bad).contains("a.d: `inertia`"));
}
