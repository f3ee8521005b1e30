use gudgeon_core::elementary;
use gudgeon_core::kinds::{CylinderPressure, CylinderPressureCtx, CylinderPressureSpec};
use gudgeon_core::quantity::{PosAngle, PosPressure, PosRatio, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::compressor::{Clearance, Space, TURN, check};
use crate::ideal_valves::air;
use crate::periodic::reduced;

/// A compressor cylinder whose valves act at fixed crank angles, as in a published program.
///
/// With the angle a since the upper dead centre:
///
/// ```text
/// a < suction_opens       p = p_d (V_c/V)ⁿ
/// … half a turn           p = p_s
/// … discharge_opens       p = p_s (V_max/V)ⁿ
/// … a turn                p = p_d
/// ```
///
/// Where the angles do not fit the pressures and volumes, the pressure jumps there.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AngleWindows {
    /// Suction pressure p_s.
    pub suction: PosPressure,
    /// Discharge pressure p_d.
    pub discharge: PosPressure,
    /// Exponent n of compression and expansion.
    #[serde(default = "air")]
    pub exponent: PosRatio,
    /// Clearance volume V_c.
    pub clearance: Clearance,
    /// Angle at which the suction valves open.
    #[serde(default = "suction_opens")]
    pub suction_opens: PosAngle,
    /// Angle at which the discharge valves open.
    #[serde(default = "discharge_opens")]
    pub discharge_opens: PosAngle,
}

fn suction_opens() -> PosAngle {
    quantity(0.771)
}
fn discharge_opens() -> PosAngle {
    quantity(5.362)
}

#[register_model(
    name = "angle_windows",
    summary = "compressor cylinder with valves that act at fixed crank angles, as published",
    equations = "p = p_d (V_c/V)^n | p_s | p_s (V_max/V)^n | p_d in four windows of the crank angle",
    validity = "For reproduction: right for one geometry and one pressure ratio; elsewhere the pressure jumps.",
    references = ["gomes2021"],
    example = "suction = \"101325 Pa\"\ndischarge = \"601325 Pa\"\nclearance = { compression_ratio = 17.5 }\n",
)]
impl CylinderPressureSpec for AngleWindows {
    fn build(&self, ctx: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError> {
        let space = Space::new(ctx, &self.clearance)?;
        let (suction, discharge, n) = (self.suction.si(), self.discharge.si(), self.exponent.si());
        check(suction, discharge, n, &space)?;
        let (a, b) = (self.suction_opens.si(), self.discharge_opens.si());
        if a >= space.down {
            let what = "suction opens before the lower dead centre";
            return Err(BuildError::at("suction_opens", what));
        }
        if b <= space.down || b >= TURN {
            let what = "discharge opens after the lower dead centre and before the end of the turn";
            return Err(BuildError::at("discharge_opens", what));
        }
        let mut kinks = [0.0, a, space.down, b].map(|x| reduced(space.top + x, TURN)).to_vec();
        kinks.sort_unstable_by(f64::total_cmp);
        Ok(Box::new(Windows { space, suction, discharge, n, a, b, kinks }))
    }
}

#[derive(Debug, Clone)]
struct Windows {
    space: Space,
    suction: f64,
    discharge: f64,
    n: f64,
    a: f64,
    b: f64,
    kinks: Vec<f64>,
}

impl CylinderPressure for Windows {
    fn pressure(&self, theta: f64) -> f64 {
        self.pressure_decided_at(theta, theta)
    }
    fn pressure_decided_at(&self, decided_at: f64, theta: f64) -> f64 {
        let at = self.space.since_top(decided_at);
        if at < self.a {
            self.discharge * elementary::powf(self.space.v_min / self.space.volume(theta), self.n)
        } else if at < self.space.down {
            self.suction
        } else if at < self.b {
            self.suction * elementary::powf(self.space.v_max / self.space.volume(theta), self.n)
        } else {
            self.discharge
        }
    }
    fn kinks(&self) -> &[f64] {
        &self.kinks
    }
    fn period(&self) -> f64 {
        TURN
    }
}
