use gudgeon_core::elementary;
use gudgeon_core::kinds::{CylinderPressure, CylinderPressureCtx, CylinderPressureSpec};
use gudgeon_core::quantity::{
    GasConstant, PosArea, PosPressure, PosRatio, PosTemperature, Positive, quantity,
};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::compressor::{Clearance, Space, TURN, check};
use crate::ideal_valves::air;
use crate::periodic::reduced;

/// A compressor cylinder with the pressure drop of its valves.
///
/// While a valve is open the gas follows the piston through its effective flow area A_v:
///
/// ```text
/// Δp = ½ ρ (A v/A_v)²,   ρ_s = p_s/(R T_s),   ρ_d = ρ_s (p_d/p_s)^(1/n)
/// away from the head   p = max(p_s - Δp_s, p_d (V_c/V)ⁿ)
/// towards the head     p = min(p_d + Δp_d, p_s (V_max/V)ⁿ)
/// ```
///
/// A piston area, v piston speed at the mean speed of the machine. The drops vanish at the dead centres, so trapped masses are those of
/// ideal valves. With `held_open` the gas goes out and in through the suction valves all the time.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ValveLosses {
    /// Suction pressure p_s in the plenum.
    pub suction: PosPressure,
    /// Discharge pressure p_d in the plenum.
    pub discharge: PosPressure,
    /// Exponent n of compression and expansion.
    #[serde(default = "air")]
    pub exponent: PosRatio,
    /// Clearance volume V_c.
    pub clearance: Clearance,
    /// Effective flow area of the suction valves.
    pub suction_area: PosArea,
    /// Effective flow area of the discharge valves.
    pub discharge_area: PosArea,
    /// Temperature T_s of the gas in the suction plenum.
    #[serde(default = "room")]
    pub suction_temperature: PosTemperature,
    /// Specific gas constant R.
    #[serde(default = "gas")]
    pub gas_constant: GasConstant<Positive>,
    /// Whether an unloader keeps the suction valves open.
    #[serde(default)]
    pub held_open: bool,
}

fn room() -> PosTemperature {
    quantity(293.15)
}
fn gas() -> GasConstant<Positive> {
    quantity(287.05)
}

#[register_model(
    name = "valve_losses",
    summary = "compressor cylinder with clearance and the pressure drop of its valves",
    equations = "p = max(p_s - dp_s, p_d (V_c/V)^n) away from the head;  p = min(p_d + dp_d, p_s (V_max/V)^n) towards it;  dp = rho (A v/A_v)^2/2",
    validity = "Quasi-steady incompressible drop: small against the plenum pressure. No valve dynamics, no pulsation.",
    references = ["gomes2021", "heywood1988"],
    example = "suction = \"1 bar\"\ndischarge = \"6 bar\"\nclearance = { fraction = 0.1 }\nsuction_area = \"80 cm2\"\ndischarge_area = \"60 cm2\"\n",
)]
impl CylinderPressureSpec for ValveLosses {
    fn build(&self, ctx: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError> {
        let space = Space::new(ctx, &self.clearance)?;
        let (suction, discharge, n) = (self.suction.si(), self.discharge.si(), self.exponent.si());
        check(suction, discharge, n, &space)?;
        let density = suction / (self.gas_constant.si() * self.suction_temperature.si());
        let drop = |rho: f64, area: f64| 0.5 * rho * (ctx.piston_area / area).powi(2);
        let mut m = Throttled {
            suction,
            discharge,
            n,
            drops: [
                drop(density, self.suction_area.si()),
                drop(density * elementary::powf(discharge / suction, 1.0 / n), self.discharge_area.si()),
            ],
            top: discharge.min(suction * elementary::powf(space.v_max / space.v_min, n)),
            open: self.held_open,
            space,
            kinks: Vec::new(),
        };
        let (t, d) = (m.space.top, m.space.down);
        let fastest = (0..360).map(|i| m.space.speed(f64::from(i).to_radians())).fold(0.0, f64::max);
        let worst = m.drops[0] * fastest * fastest;
        if worst > 0.3 * suction {
            let what = format!(
                "the suction valves take {worst:.0} Pa of {suction:.0} Pa: the law holds for small drops (below 30 %)"
            );
            return Err(BuildError::at("suction_area", what).help("a larger flow area, or a lower speed"));
        }
        m.kinks = vec![t, t + d];
        if !m.open {
            m.kinks.push(m.space.crossing(t, t + d, |x| m.expansion(x) - m.intake(x)));
            m.kinks.push(m.space.crossing(t + d, t + TURN, |x| m.outlet(x) - m.compression(x)));
        }
        m.kinks.iter_mut().for_each(|x| *x = reduced(*x, TURN));
        m.kinks.sort_unstable_by(f64::total_cmp);
        m.kinks.dedup();
        Ok(Box::new(m))
    }
}

#[derive(Debug, Clone)]
struct Throttled {
    space: Space,
    suction: f64,
    discharge: f64,
    n: f64,
    /// Pressure drop by the square of the piston speed, suction and discharge.
    drops: [f64; 2],
    top: f64,
    open: bool,
    kinks: Vec<f64>,
}

impl Throttled {
    fn expansion(&self, theta: f64) -> f64 {
        self.top * elementary::powf(self.space.v_min / self.space.volume(theta), self.n)
    }
    fn compression(&self, theta: f64) -> f64 {
        self.suction * elementary::powf(self.space.v_max / self.space.volume(theta), self.n)
    }
    fn intake(&self, theta: f64) -> f64 {
        self.suction - self.drops[0] * self.space.speed(theta).powi(2)
    }
    fn outlet(&self, theta: f64) -> f64 {
        self.discharge + self.drops[1] * self.space.speed(theta).powi(2)
    }
}

impl CylinderPressure for Throttled {
    fn pressure(&self, theta: f64) -> f64 {
        let away = self.space.since_top(theta) < self.space.down;
        match (self.open, away) {
            (false, true) => self.expansion(theta).max(self.intake(theta)),
            (false, false) => self.compression(theta).min(self.outlet(theta)),
            (true, true) => self.intake(theta),
            (true, false) => self.suction + self.drops[0] * self.space.speed(theta).powi(2),
        }
    }
    fn kinks(&self) -> &[f64] {
        &self.kinks
    }
    fn period(&self) -> f64 {
        TURN
    }
}
