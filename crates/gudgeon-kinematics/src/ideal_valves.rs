use gudgeon_core::elementary;
use gudgeon_core::kinds::{CylinderPressure, CylinderPressureCtx, CylinderPressureSpec};
use gudgeon_core::quantity::{PosPressure, PosRatio, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::compressor::{Clearance, Space, TURN, check};
use crate::periodic::reduced;

/// A compressor cylinder with valves that open and close without loss.
///
/// ```text
/// away from the head   p = max(p_s, p_d (V_c/V)ⁿ)
/// towards the head     p = min(p_d, p_s (V_max/V)ⁿ)
/// ```
///
/// Work of a turn: `W = n/(n-1) p_s (V_max - V_4) ((p_d/p_s)^((n-1)/n) - 1)`, `V_4 = V_c (p_d/p_s)^(1/n)`. Where compression does not
/// reach the discharge pressure the gas is compressed and expanded along one line. With `held_open` the suction valves stay open: the
/// cylinder end is unloaded.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IdealValves {
    /// Suction pressure p_s.
    pub suction: PosPressure,
    /// Discharge pressure p_d.
    pub discharge: PosPressure,
    /// Exponent n of compression and expansion.
    #[serde(default = "air")]
    pub exponent: PosRatio,
    /// Clearance volume V_c.
    pub clearance: Clearance,
    /// Whether an unloader keeps the suction valves open.
    #[serde(default)]
    pub held_open: bool,
}

pub(crate) fn air() -> PosRatio {
    quantity(1.4)
}

#[register_model(
    name = "ideal_valves",
    summary = "compressor cylinder with ideal valves and clearance, per cylinder end",
    equations = "p = max(p_s, p_d (V_c/V)^n) away from the head;  p = min(p_d, p_s (V_max/V)^n) towards it",
    validity = "Two-stroke cycle of a compressor end; no valve losses, no leakage, constant plenum pressures.",
    references = ["gomes2021"],
    example = "suction = \"101325 Pa\"\ndischarge = \"601325 Pa\"\nclearance = { fraction = 0.05 }\n",
)]
impl CylinderPressureSpec for IdealValves {
    fn build(&self, ctx: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError> {
        let space = Space::new(ctx, &self.clearance)?;
        let (suction, discharge, n) = (self.suction.si(), self.discharge.si(), self.exponent.si());
        check(suction, discharge, n, &space)?;
        // Never reached: what is at the dead centre expands again.
        let top = discharge.min(suction * elementary::powf(space.v_max / space.v_min, n));
        let expanded = space.v_min * elementary::powf(top / suction, 1.0 / n);
        let compressed = space.v_max * elementary::powf(suction / discharge, 1.0 / n);
        let open = self.held_open;
        let mut m =
            Ideal { space, suction, discharge, n, top, expanded, compressed, open, kinks: Vec::new() };
        if !m.open {
            let (t, d) = (m.space.top, m.space.down);
            let suction_opens = m.space.crossing(t, t + d, |x| m.expansion(m.space.volume(x)) - m.suction);
            let discharge_opens =
                m.space.crossing(t + d, t + TURN, |x| m.discharge - m.compression(m.space.volume(x)));
            m.kinks = [t, suction_opens, t + d, discharge_opens].map(|x| reduced(x, TURN)).to_vec();
            m.kinks.sort_unstable_by(f64::total_cmp);
            m.kinks.dedup();
        }
        Ok(Box::new(m))
    }
}

#[derive(Debug, Clone)]
struct Ideal {
    space: Space,
    suction: f64,
    discharge: f64,
    n: f64,
    /// Pressure at the upper dead centre.
    top: f64,
    /// Volume \[m³\] at which the suction pressure is reached on the way out, and that of discharge on the way back.
    expanded: f64,
    compressed: f64,
    open: bool,
    kinks: Vec<f64>,
}

/// Part of a volume at which a valve opens within which the pressure itself tells whether it is open: many roundings of the power.
const BESIDE: f64 = 1e-9;

impl Ideal {
    /// Pressure of expansion to a volume.
    fn expansion(&self, volume: f64) -> f64 {
        self.top * elementary::powf(self.space.v_min / volume, self.n)
    }
    /// Pressure of compression to a volume.
    fn compression(&self, volume: f64) -> f64 {
        self.suction * elementary::powf(self.space.v_max / volume, self.n)
    }
    /// Pressure at an angle at which the gas has a volume.
    fn at(&self, theta: f64, volume: f64) -> f64 {
        if self.space.since_top(theta) < self.space.down {
            let is_open = volume > self.expanded * (1.0 + BESIDE);
            if is_open { self.suction } else { self.expansion(volume).max(self.suction) }
        } else {
            let is_open = volume < self.compressed * (1.0 - BESIDE);
            if is_open { self.discharge } else { self.compression(volume).min(self.discharge) }
        }
    }
}

impl CylinderPressure for Ideal {
    fn pressure(&self, theta: f64) -> f64 {
        if self.open { self.suction } else { self.at(theta, self.space.volume(theta)) }
    }
    fn pressure_at_height(&self, _: f64, theta: f64, height: f64) -> f64 {
        if self.open { self.suction } else { self.at(theta, self.space.volume_at(height)) }
    }
    fn kinks(&self) -> &[f64] {
        &self.kinks
    }
    fn period(&self) -> f64 {
        TURN
    }
    fn depends_on_speed(&self) -> bool {
        false
    }
}
