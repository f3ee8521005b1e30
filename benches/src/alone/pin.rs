//! The gudgeon pin.

use std::hint::black_box;

use gudgeon_core::ModelInfo;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{
    BossBore, CylinderPressureCtx, CylinderPressureSpec, EngineCycle, FatigueSpec, KinematicsSpec, PinForces,
    PinLoadCtx, PinLoadSpec, PinSize, PinStrengthCtx, PinStrengthSpec,
};

use super::engine::DRIVE;
use super::{Alone, alone, part, seen};

/// Bore of the cylinder \[m\].
const BORE: f64 = 0.12;

/// Quantities, gradients and second derivatives of a pin of 90 mm x 42 mm x 24 mm.
pub fn pin_strength(m: &ModelInfo) -> Result<Alone, String> {
    let size = PinSize { length: 0.090, outer: 0.042, inner: 0.024 };
    let load = PinForces { gas: 150e3, inertia: -12e3 };
    alone::<dyn PinStrengthSpec, _, _>(
        m,
        |s| {
            s.build(&PinStrengthCtx {
                boss_gap: 0.040,
                rod_width: 0.038,
                boss_bore: BossBore::Profiled,
                modulus: 210e9,
                poisson: 0.3,
                pi: std::f64::consts::PI,
            })
        },
        move |strength| {
            black_box(strength.quantities(black_box(&size), &load)?);
            seen(strength.expansion(black_box(&size), &load)?)
        },
    )
}

/// The safety at 100 ± 200 MPa.
pub fn fatigue(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn FatigueSpec, _, _>(
        m,
        |s| s.build(),
        |law| if law.is_off() { Ok(()) } else { seen(law.safety(black_box(100e6), 200e6)?) },
    )
}

/// A load is all there once it is built; what stays to be asked is its greatest force.
pub fn pin_load(m: &ModelInfo) -> Result<Alone, String> {
    let drive = part::<dyn KinematicsSpec>("exact_slider_crank")?.build(&DRIVE).map_err(|e| e.to_string())?;
    let gas = part::<dyn CylinderPressureSpec>("polytropic_burn")?;
    let files = Files::default();
    let ctx = CylinderPressureCtx { kinematics: &*drive, piston_area: 0.0113, files: &files };
    let pressure = gas.build(&ctx).map_err(|e| e.to_string())?;
    let cycle = EngineCycle { bore: BORE, kinematics: drive.clone(), pressure, crankcase_pressure: 1e5 };
    alone::<dyn PinLoadSpec, _, _>(
        m,
        move |s| {
            let files = Files::default();
            let cycle_of = |_: &str| Ok(cycle.clone());
            s.build(&PinLoadCtx { bore: BORE, pi: std::f64::consts::PI, files: &files, cycle_of: &cycle_of })
        },
        |load| seen(load.cycle.iter().map(|i| i.forces.total().abs()).fold(0.0, f64::max)),
    )
}
