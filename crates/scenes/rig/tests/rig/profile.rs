//! Profiles of a line.

use gudgeon_scene_rig::Profile;

#[test]
fn rayleighs_optimum() {
    let k = 1.0 + 3.0_f64.sqrt() / 2.0;
    let n = k.powf(1.5) / (1.0 + k.powf(1.5));
    let json = serde_json::json!({ "shape": "step", "length": "1 mm", "h_in": "2 um", "h_out": "1 um" });
    let Ok(Profile::Step { step, .. }) = serde_json::from_value(json) else {
        panic!("a step without its place")
    };
    // Two roundings.
    assert!((step.si() - n).abs() < 1e-15, "{n}");
}
