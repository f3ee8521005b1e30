//! Crank drive and gas of a cylinder.

use std::hint::black_box;

use gudgeon_core::ModelInfo;
use gudgeon_core::file::Files;
use gudgeon_core::kinds::{CylinderPressureCtx, CylinderPressureSpec, KinematicsCtx, KinematicsSpec};

use super::{Alone, alone, part, seen};

/// Crank angles over a cycle, 5 degrees apart.
fn angles() -> impl Iterator<Item = f64> {
    (0..144).map(|k| (5.0 * f64::from(k)).to_radians())
}

/// A crank drive of 140 mm stroke at 2000 rpm.
pub const DRIVE: KinematicsCtx =
    KinematicsCtx { crank_radius: 0.07, rod_length: 0.24, offset: 0.0, omega: 209.4 };

/// A cycle in 144 angles.
pub fn kinematics(m: &ModelInfo) -> Result<Alone, String> {
    alone::<dyn KinematicsSpec, _, _>(
        m,
        |s| s.build(&DRIVE),
        |k| seen(angles().map(|theta| k.motion(black_box(theta)).a).sum::<f64>()),
    )
}

/// A cycle in 144 angles, in a bore of 120 mm.
pub fn cylinder_pressure(m: &ModelInfo) -> Result<Alone, String> {
    let drive = part::<dyn KinematicsSpec>("exact_slider_crank")?.build(&DRIVE).map_err(|e| e.to_string())?;
    alone::<dyn CylinderPressureSpec, _, _>(
        m,
        move |s| {
            let files = Files::default();
            s.build(&CylinderPressureCtx { kinematics: &*drive, piston_area: 0.0113, files: &files })
        },
        |gas| seen(angles().map(|theta| gas.pressure(black_box(theta))).sum::<f64>()),
    )
}
