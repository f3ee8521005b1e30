//! What the compressor models share: clearance, dead centres, the closed compression and expansion lines.

use std::f64::consts::PI;

use gudgeon_core::BuildError;
use gudgeon_core::elementary;
use gudgeon_core::kinds::{CylinderPressureCtx, Kinematics};
use gudgeon_core::quantity::{PosLength, PosRatio, PosVolume};
use serde::{Deserialize, Serialize};

use crate::periodic::reduced;

/// Length of a compressor's cycle \[rad\].
pub const TURN: f64 = 2.0 * PI;

/// Largest exponent of a compression: 5/3 is that of a monatomic gas without heat flow, leakage seems to add some.
const MAX_EXPONENT: f64 = 2.0;

/// The space left at the dead centre: one of `volume`, `fraction` and `compression_ratio`.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clearance {
    /// Volume at the dead centre, pockets included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub volume: Option<PosVolume>,
    /// That volume by the swept volume.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fraction: Option<PosRatio>,
    /// Ratio ε of the largest to the smallest volume: clearance is area times stroke by ε - 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compression_ratio: Option<PosRatio>,
    /// Stroke that goes with the compression ratio, where it is not that of the piston.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stroke: Option<PosLength>,
}

impl Clearance {
    fn volume_of(&self, area: f64, stroke: f64) -> Result<f64, BuildError> {
        if self.stroke.is_some() && self.compression_ratio.is_none() {
            return Err(BuildError::at("clearance.stroke", "goes with `compression_ratio` only"));
        }
        match (self.volume, self.fraction, self.compression_ratio) {
            (Some(v), None, None) => Ok(v.si()),
            (None, Some(f), None) => Ok(f.si() * area * stroke),
            (None, None, Some(e)) if e.si() > 1.0 => {
                Ok(area * self.stroke.map_or(stroke, |s| s.si()) / (e.si() - 1.0))
            }
            (None, None, Some(e)) => Err(BuildError::at(
                "clearance.compression_ratio",
                format!("a compression ratio of {} cannot be, it must be above 1", e.si()),
            )),
            _ => Err(BuildError::at(
                "clearance",
                "exactly one of `volume`, `fraction` and `compression_ratio` says how large it is",
            )),
        }
    }
}

/// A gas space with its dead centres.
#[derive(Debug, Clone)]
pub(crate) struct Space {
    kinematics: Box<dyn Kinematics>,
    area: f64,
    /// Volume at the upper dead centre \[m³\].
    pub v_min: f64,
    /// Volume at the lower dead centre \[m³\].
    pub v_max: f64,
    /// Crank angle of the smallest volume, in `[0, 2π)`.
    pub top: f64,
    /// Crank angle from there to the largest volume.
    pub down: f64,
}

impl Space {
    pub fn new(ctx: &CylinderPressureCtx<'_>, clearance: &Clearance) -> Result<Self, BuildError> {
        let kinematics = dyn_clone::clone_box(ctx.kinematics);
        let stroke = kinematics.stroke();
        let swept = ctx.piston_area * stroke;
        if !(swept.is_finite() && swept > 0.0) {
            let what =
                format!("the swept volume is {swept} m³: area {} m², stroke {stroke} m", ctx.piston_area);
            return Err(BuildError::new(what));
        }
        let v_min = clearance.volume_of(ctx.piston_area, stroke)?;
        if !(v_min.is_finite() && v_min > 0.0) {
            return Err(BuildError::at("clearance", format!("a clearance volume of {v_min} m³ cannot be")));
        }
        let top = dead_centre(&*kinematics, 1.0);
        let bottom = dead_centre(&*kinematics, -1.0);
        let down = reduced(bottom - top, TURN);
        Ok(Self { kinematics, area: ctx.piston_area, v_min, v_max: v_min + swept, top, down })
    }

    /// Angle since the smallest volume, in `[0, 2π)`.
    pub fn since_top(&self, theta: f64) -> f64 {
        reduced(theta - self.top, TURN)
    }

    pub fn volume(&self, theta: f64) -> f64 {
        self.volume_at(self.kinematics.height(theta))
    }

    /// Volume \[m³\] with the pin at a height.
    pub fn volume_at(&self, height: f64) -> f64 {
        // At least the clearance, up to rounding.
        (self.area * (self.kinematics.y_tdc() - height) + self.v_min).max(self.v_min)
    }

    /// Piston speed by its largest, squared: 0 at the dead centres.
    pub fn speed(&self, theta: f64) -> f64 {
        self.kinematics.velocity(theta).abs()
    }

    /// Crank angle at which `f` changes sign between two angles, to rounding.
    pub fn crossing(&self, from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let (mut a, mut b) = (from, to);
        let positive = f(a) > 0.0;
        for _ in 0..100 {
            let m = a + 0.5 * (b - a);
            if m <= a || m >= b {
                break;
            }
            if (f(m) > 0.0) == positive {
                a = m;
            } else {
                b = m;
            }
        }
        b
    }
}

/// Crank angle in `[0, 2π)` at which the piston is highest (`sign` 1) or lowest (-1).
fn dead_centre(k: &dyn Kinematics, sign: f64) -> f64 {
    let scale = 1e-13 * k.omega() * k.stroke();
    let y = |t: f64| sign * k.motion(t).y;
    // Without an offset they stand at 0 and π exactly.
    for t in [0.0, PI] {
        if k.motion(t).v.abs() <= scale && y(t) > y(t + 1.0) {
            return t;
        }
    }
    let n = 180;
    let best =
        (0..n).map(|i| TURN * f64::from(i) / f64::from(n)).fold(0.0, |a, b| if y(b) > y(a) { b } else { a });
    let step = TURN / f64::from(n);
    let (mut a, mut b) = (best - step, best + step);
    for _ in 0..100 {
        let m = a + 0.5 * (b - a);
        if m <= a || m >= b {
            break;
        }
        if sign * k.motion(m).v > 0.0 {
            a = m;
        } else {
            b = m;
        }
    }
    reduced(b, TURN)
}

/// Checks the pressures and the exponent that all compressor models have.
pub(crate) fn check(suction: f64, discharge: f64, exponent: f64, space: &Space) -> Result<(), BuildError> {
    if discharge <= suction {
        let what =
            format!("the discharge pressure ({discharge} Pa) must be above that of suction ({suction} Pa)");
        return Err(BuildError::at("discharge", what));
    }
    if !(1.0..=MAX_EXPONENT).contains(&exponent) {
        return Err(BuildError::at(
            "exponent",
            format!(
                "an exponent of {exponent} cannot be, it is between 1 (isothermal) and {MAX_EXPONENT} (no gas has more than 5/3)"
            ),
        ));
    }
    if !(suction * elementary::powf(space.v_max / space.v_min, exponent)).is_finite() {
        return Err(BuildError::at("exponent", "the exponent makes the pressure infinite"));
    }
    Ok(())
}
