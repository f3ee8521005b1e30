//! The crank drive in its two spellings, what is missing, and where mistakes are told.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use gudgeon_core::file::Files;
use gudgeon_core::kinds::{CylinderPressureSpec, KinematicsSpec};
use gudgeon_core::serde_json::{from_value, json};
use gudgeon_machine::{Engine, GravityFrom, GravitySide, Piston};

use gudgeon_kinematics as _;

fn engine(more: gudgeon_core::serde_json::Value) -> Engine {
    let mut all = json!({ "speed": "2000 rpm", "bore": "120 mm", "rod_length": "240 mm" });
    let keys = all.as_object_mut().expect("a table");
    keys.extend(more.as_object().expect("a table").clone());
    from_value(all).unwrap_or_else(|e| panic!("{e}"))
}

fn slider_crank() -> Box<dyn KinematicsSpec> {
    from_value(json!({ "model": "exact_slider_crank" })).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn stroke_and_crank_radius_say_the_same() {
    let (a, b) = (engine(json!({ "stroke": "140 mm" })), engine(json!({ "crank_radius": "70 mm" })));
    let motion = |e: &Engine| e.motion(&*slider_crank()).unwrap_or_else(|e| panic!("{e}"));
    let (a, b) = (motion(&a), motion(&b));
    for k in 0..24 {
        let theta = 0.3 * f64::from(k);
        assert_eq!(a.motion(theta), b.motion(theta));
    }
    // Half of 0.14 is not the number that 0.07 is read as in every notation: one rounding.
    assert!((a.stroke() - 0.14).abs() <= 2.0 * f64::EPSILON);
}

#[test]
fn one_of_stroke_and_crank_radius() {
    let none = engine(json!({})).crank().expect_err("no stroke");
    assert_eq!((none.field.as_str(), none.message.as_str()), ("engine", "missing key `stroke`"));
    let both = engine(json!({ "stroke": 0.14, "crank_radius": 0.07 })).crank().expect_err("both");
    assert_eq!(both.field, "engine.crank_radius");
}

#[test]
fn what_is_missing_is_named() {
    let mut e = engine(json!({ "stroke": 0.14 }));
    e.speed = None;
    assert_eq!(e.crank().expect_err("no speed").message, "missing key `speed`");
    let p: Piston = from_value(json!({ "mass": 0.5 })).expect("a piston");
    assert_eq!(p.body(0.0).expect_err("no inertia").message, "missing key `inertia`");
}

/// The pin's line of motion is `crank_offset - pin_offset` from the crank axis: moving both moves the cylinder alone.
#[test]
fn offsets_count_by_their_difference() {
    let with = |pin: f64, crank: f64| {
        let e = engine(json!({ "stroke": 0.14, "pin_offset": pin, "crank_offset": crank }));
        e.motion(&*slider_crank()).unwrap_or_else(|e| panic!("{e}"))
    };
    let (a, b, c) = (with(0.0, 0.0), with(1e-3, 1e-3), with(0.0, 1e-3));
    assert_eq!(a.motion(1.0), b.motion(1.0));
    assert_ne!(a.motion(1.0), c.motion(1.0));
    // y = r cos θ + √(l² − (r sin θ − e)²), or with the other sign of e: the side is what this test is for.
    let (r, l, e, theta) = (0.07, 0.24, 1e-3, 1.0f64);
    let y = r * theta.cos() + (l * l - (r * theta.sin() - e).powi(2)).sqrt();
    // Some ten operations on lengths of 0.3 m.
    assert!((c.motion(theta).y - y).abs() < 1e-15, "{} {y}", c.motion(theta).y);
}

#[test]
fn a_mechanism_that_cannot_turn_is_told_at_the_engine() {
    let mut e = engine(json!({ "stroke": 0.14 }));
    e.rod_length = from_value(json!(0.05)).ok();
    let wrong = e.motion(&*slider_crank()).expect_err("rod shorter than crank");
    assert!(wrong.field.starts_with("engine."), "{wrong:?}");
}

#[test]
fn the_cycle_knows_its_bore_and_crankcase() {
    let e = engine(json!({ "stroke": 0.14 }));
    let pressure: Box<dyn CylinderPressureSpec> =
        from_value(json!({ "model": "constant", "pressure": "5 bar" })).unwrap_or_else(|e| panic!("{e}"));
    let cycle = e
        .cycle(&*slider_crank(), &*pressure, gudgeon_core::quantity::quantity(1e5), &Files::recorded([]))
        .unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((cycle.bore, cycle.crankcase_pressure, cycle.pressure.pressure(1.0)), (0.12, 1e5, 5e5));
}

#[test]
fn the_centre_of_gravity_stands_on_the_anti_thrust_side_unless_told() {
    let masses = json!({ "mass": 0.5, "inertia": 1e-3, "pin_mass": 0.1, "pin_depth": 0.02, "gravity_depth": 0.01,
        "gravity_offset": 2e-3 });
    let mut p: Piston = from_value(masses).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(p.body(5e-4).expect("whole").gravity_offset, -2e-3);
    p.gravity_side = Some(GravitySide::Thrust);
    assert_eq!(p.body(5e-4).expect("whole").gravity_offset, 2e-3);
    // From the axis of the bore: 0.5 mm less when the pin stands that far towards the thrust side.
    p.gravity_from = Some(GravityFrom::Bore);
    assert_eq!(p.body(5e-4).expect("whole").gravity_offset, 1.5e-3);
    assert_eq!(p.apparent_density(), 550.0);
}
