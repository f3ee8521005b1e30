//! Loads of the pin: sums of two harmonics with a known maximum, and the refusals of every model.

use std::f64::consts::PI;

use gudgeon_core::kinds::{
    CylinderPressure, CylinderPressureCtx, CylinderPressureSpec, EngineCycle, Kinematics, KinematicsCtx,
    KinematicsSpec, PinLoadCase, PinLoadCtx, PinLoadSpec, PistonMotion,
};
use gudgeon_core::quantity::quantity;
use gudgeon_core::result::Note;
use gudgeon_core::{BuildError, register_model};
use gudgeon_pin::{Cycle, Given, OtherCase};
use serde::{Deserialize, Serialize};

use crate::common::*;

/// A Scotch yoke: harmonic motion.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct Yoke {}

#[register_model(
    name = "yoke",
    summary = "harmonic motion",
    equations = "y = l + r cos theta",
    validity = "A test.",
    references = [],
    example = "",
)]
impl KinematicsSpec for Yoke {
    fn build(&self, ctx: &KinematicsCtx) -> Result<Box<dyn Kinematics>, BuildError> {
        for (name, bad) in [
            ("crank_radius", ctx.crank_radius > 0.2),
            ("offset", ctx.offset > 0.1),
            ("rod", ctx.rod_length < ctx.crank_radius),
        ] {
            if bad {
                return Err(BuildError::at(name, "out of range"));
            }
        }
        Ok(Box::new(Harmonic { r: ctx.crank_radius, l: ctx.rod_length, omega: ctx.omega }))
    }
}

#[derive(Debug, Clone, Copy)]
struct Harmonic {
    r: f64,
    l: f64,
    omega: f64,
}

impl Kinematics for Harmonic {
    fn motion(&self, theta: f64) -> PistonMotion {
        PistonMotion { a: -self.r * self.omega * self.omega * theta.cos(), ..PistonMotion::default() }
    }
    fn y_tdc(&self) -> f64 {
        self.l + self.r
    }
    fn stroke(&self) -> f64 {
        2.0 * self.r
    }
    fn omega(&self) -> f64 {
        self.omega
    }
}

/// `p = base + amplitude (1 + cos(theta - phase))` over two turns, and one instant at which it is `spike`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
struct Wave {
    base: f64,
    amplitude: f64,
    phase: f64,
    #[serde(default)]
    spike: f64,
}

/// Where the spike stands \[rad\]: on no row of half a degree.
const SPIKE_AT: [f64; 1] = [1.0];

#[register_model(
    name = "wave",
    summary = "one harmonic",
    equations = "p = base + amplitude (1 + cos(theta - phase))",
    validity = "A test.",
    references = [],
    example = "base = 1e5\namplitude = 5e6\nphase = 0.1\n",
)]
impl CylinderPressureSpec for Wave {
    fn build(&self, ctx: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError> {
        // The area of the piston is that of its bore; rounding of three products.
        if (ctx.piston_area / (0.25 * PI * BORE * BORE) - 1.0).abs() > 1e-15 {
            return Err(BuildError::at("base", "another piston"));
        }
        Ok(Box::new(self.clone()))
    }
}

impl CylinderPressure for Wave {
    fn pressure(&self, theta: f64) -> f64 {
        if self.spike > 0.0 && theta == SPIKE_AT[0] {
            return self.spike;
        }
        self.base + self.amplitude * (1.0 + (theta - self.phase).cos())
    }
    fn kinks(&self) -> &[f64] {
        &SPIKE_AT
    }
    fn period(&self) -> f64 {
        4.0 * PI
    }
    fn notes(&self) -> Vec<Note> {
        vec![Note::info("wave", "A wave.")]
    }
}

const CRANKCASE: f64 = 1.5e5;
const AREA: f64 = 0.25 * PI * BORE * BORE;

fn wave(spike: f64) -> Wave {
    Wave { base: CRANKCASE, amplitude: 3e6, phase: 0.7, spike }
}

fn cycle(pressure: Wave, mass: f64) -> Cycle {
    Cycle {
        speed: quantity(300.0),
        stroke: quantity(80e-3),
        rod_length: quantity(140e-3),
        offset: quantity(0.0),
        piston_mass: quantity(mass),
        crankcase_pressure: quantity(CRANKCASE),
        kinematics: Box::new(Yoke {}),
        cylinder_pressure: Box::new(pressure),
    }
}

fn ctx() -> PinLoadCtx<'static> {
    load_ctx(PI)
}

/// `A P (1 + cos(θ - φ)) - m r ω² cos θ` is a constant and one harmonic: its maximum and its angle in closed form.
fn is_the_maximum_of_the_wave(load: &PinLoadCase, mass: f64) {
    let (gas, inertia) = (AREA * 3e6, mass * 40e-3 * 300.0 * 300.0);
    let (x, y) = (gas * 0.7f64.cos() - inertia, gas * 0.7f64.sin());
    let forces = load.design.forces;
    // Rounding of sums of a few terms.
    assert!((forces.total() / (gas + x.hypot(y)) - 1.0).abs() < 1e-14, "{}", forces.total());
    let angle = (load.design.theta - y.atan2(x)).rem_euclid(2.0 * PI);
    // The top is flat: an angle is known to the root of rounding.
    assert!(angle.min(2.0 * PI - angle) < 1e-7, "{angle}");
    let theta = load.design.theta;
    assert!((forces.inertia + inertia * theta.cos()).abs() < 1e-12 * gas);
    assert!((forces.gas - (load.design.pressure - CRANKCASE) * AREA).abs() < 1e-12 * gas);
}

#[test]
fn the_largest_force_of_a_cycle_lies_between_its_rows() {
    let load = cycle(wave(0.0), 0.8).build(&ctx()).expect("builds");
    is_the_maximum_of_the_wave(&load, 0.8);
    assert_eq!(load.cycle.len(), 1440);
    // Rows over two turns, half a degree apart.
    assert!((load.cycle[1439].theta - 4.0 * PI * 1439.0 / 1440.0).abs() < 1e-14);
    assert_eq!(load.omega, Some(300.0));
    assert!((load.crank_ratio.expect("known") - 40.0 / 140.0).abs() < 1e-15);
    assert_eq!(load.notes.len(), 1);
}

/// Inertia alone: the largest force pulls, at a dead centre, and counts by its amount.
#[test]
fn a_force_that_pulls_counts_by_its_amount() {
    let pressure = Wave { base: CRANKCASE - 1e3, amplitude: 0.0, phase: 0.0, spike: 0.0 };
    let load = cycle(pressure, 1.0).build(&ctx()).expect("builds");
    let inertia = 40e-3 * 300.0 * 300.0;
    assert!((load.design.forces.total() + inertia + 1e3 * AREA).abs() < 1e-12 * inertia);
}

#[test]
fn a_kink_of_the_pressure_is_looked_at() {
    let load = cycle(wave(2e7), 0.8).build(&ctx()).expect("builds");
    assert_eq!((load.design.theta, load.design.pressure), (1.0, 2e7));
}

#[test]
fn a_cycle_that_cannot_be_is_refused_at_its_place() {
    let fails = |change: &dyn Fn(&mut Cycle)| {
        let mut c = cycle(wave(0.0), 0.8);
        change(&mut c);
        c.build(&ctx()).expect_err("refused").field
    };
    // The mechanism is described beside the model, so the place is that of the case.
    assert_eq!(fails(&|c| c.stroke = quantity(0.5)), "stroke");
    assert_eq!(fails(&|c| c.offset = quantity(0.2)), "offset");
    assert_eq!(fails(&|c| c.rod_length = quantity(0.03)), "rod_length");
    let other_bore = PinLoadCtx { bore: 2.0 * BORE, ..ctx() };
    let e = cycle(wave(0.0), 0.8).build(&other_bore).expect_err("refused");
    assert_eq!(e.field, "cylinder_pressure.base");
    let not_a_number = Wave { amplitude: f64::NAN, ..wave(0.0) };
    assert!(cycle(not_a_number, 0.8).build(&ctx()).is_err());
    let nothing = Wave { amplitude: 0.0, ..wave(0.0) };
    assert!(cycle(nothing, 0.0).build(&ctx()).is_err());
    let names = cycle(wave(0.0), 0.8).models();
    assert_eq!(names, [("kinematics", "yoke"), ("cylinder_pressure", "wave")]);
}

#[test]
fn the_engine_of_another_case_must_have_the_same_bore() {
    let engine = |bore: f64| EngineCycle {
        bore,
        kinematics: Box::new(Harmonic { r: 40e-3, l: 140e-3, omega: 300.0 }),
        pressure: Box::new(wave(0.0)),
        crankcase_pressure: CRANKCASE,
    };
    let cycle_of = |name: &str| match name {
        "same" => Ok(engine(BORE)),
        // Written in inches: off by rounding.
        "rounded" => Ok(engine(BORE * (1.0 + 1e-10))),
        "wider" => Ok(engine(1.001 * BORE)),
        "narrower" => Ok(engine(0.999 * BORE)),
        _ => Err(BuildError::at("elsewhere", "no such case")),
    };
    let ctx = PinLoadCtx { cycle_of: &cycle_of, ..ctx() };
    let of = |name: &str| OtherCase { case: name.into(), piston_mass: quantity(0.8) }.build(&ctx);
    is_the_maximum_of_the_wave(&of("same").expect("builds"), 0.8);
    assert!(of("rounded").is_ok());
    for name in ["wider", "narrower", "missing"] {
        assert_eq!(of(name).expect_err("refused").field, "case", "{name}");
    }
}

#[test]
fn given_forces_are_taken_as_they_are() {
    let of = |gas: f64, inertia: f64| Given { gas: quantity(gas), inertia: quantity(inertia) }.build(&ctx());
    let load = of(50e3, -2e3).expect("builds");
    assert_eq!(load.design.forces.total(), 48e3);
    assert!((load.design.pressure / (50e3 / AREA) - 1.0).abs() < 1e-15);
    assert_eq!(of(50e3, -50e3).expect_err("refused").field, "inertia");
}

#[test]
fn the_rule_of_the_peak_pressure_refuses_what_it_does_not_hold_for() {
    let build = |key: &str, value: &str| {
        let mut json = serde_json::json!({
            "model": "peak_pressure_rule", "compression_ratio": 12, "speed": "2700 rpm", "stroke": "79.3 mm",
            "rod_length": "138.5 mm", "piston_mass": "335 g",
        });
        json[key] = serde_json::json!(value);
        spec::<dyn PinLoadSpec>(json).build(&ctx())
    };
    for (key, good, bad) in [
        ("compression_ratio", "1.1", "1"),
        ("rod_length", "39.7 mm", "39.65 mm"),
        // Inertia grows with the square of the speed: 49.5 kN against 1 kN at 2700 rpm.
        ("speed", "18000 rpm", "20000 rpm"),
    ] {
        assert!(build(key, good).is_ok(), "{key} = {good}");
        assert_eq!(build(key, bad).expect_err("refused").field, key);
    }
}
