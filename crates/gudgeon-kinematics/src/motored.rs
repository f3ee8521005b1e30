use std::f64::consts::PI;

use gudgeon_core::elementary;
use gudgeon_core::kinds::{CylinderPressure, CylinderPressureCtx, CylinderPressureSpec};
use gudgeon_core::quantity::{PosAngle, PosPressure, PosRatio, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use crate::chamber::Chamber;
use crate::periodic::{FOUR_STROKE, reduced};
use crate::polytropic_burn::check_order;

/// A motored engine: polytropic compression and expansion between an intake and an exhaust plateau.
///
/// ```text
/// ln p = ln p_i + s_c n ln(V_ic/V)             intake stroke, compression, expansion
/// ln p = (1 - s_o) (that) + s_o ln p_e         from exhaust_open, until the same blend leads back to p_i after 720°
/// ```
///
/// Each blend `s` runs from 0 to 1 over the angle `transition` as `6u⁵ - 15u⁴ + 10u³`: pressure, slope and curvature are
/// continuous over the whole cycle, so that there is no kink for an integrator to stop at.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motored {
    /// Ratio of the largest to the smallest volume.
    pub compression_ratio: PosRatio,
    /// Pressure p_i during intake.
    #[serde(default = "one_bar")]
    pub intake_pressure: PosPressure,
    /// Pressure p_e during exhaust.
    #[serde(default = "one_bar")]
    pub exhaust_pressure: PosPressure,
    /// Polytropic exponent n.
    #[serde(default = "exponent")]
    pub polytropic_exponent: PosRatio,
    /// Crank angle at which the intake valve begins to close.
    #[serde(default = "bottom")]
    pub intake_close: PosAngle,
    /// Crank angle at which the exhaust valve begins to open.
    #[serde(default = "second_bottom")]
    pub exhaust_open: PosAngle,
    /// Angle over which a valve event takes effect.
    #[serde(default = "transition")]
    pub transition: PosAngle,
}

fn one_bar() -> PosPressure {
    quantity(1e5)
}
fn exponent() -> PosRatio {
    quantity(1.35)
}
fn bottom() -> PosAngle {
    quantity(PI)
}
fn second_bottom() -> PosAngle {
    quantity(3.0 * PI)
}
fn transition() -> PosAngle {
    quantity(30_f64.to_radians())
}

#[register_model(
    name = "motored",
    summary = "motored engine: polytropic compression and expansion, smooth valve events",
    equations = "ln p = ln p_i + s n ln(V_ic/V) while the valves are closed, blended to ln p_e and back over `transition`",
    validity = "Motored operation without heat loss: expansion retraces compression. No gas exchange dynamics.",
    references = ["heywood1988"],
    example = "compression_ratio = 10\nintake_pressure = \"1 bar\"\nexhaust_pressure = \"1.05 bar\"\n",
)]
impl CylinderPressureSpec for Motored {
    fn build(&self, ctx: &CylinderPressureCtx<'_>) -> Result<Box<dyn CylinderPressure>, BuildError> {
        let chamber = Chamber::new(ctx, self.compression_ratio.si())?;
        let (close, open, width) = (self.intake_close.si(), self.exhaust_open.si(), self.transition.si());
        check_order(&[("intake_close", close), ("exhaust_open", open)])?;
        for (name, room) in [
            ("intake_close", close),
            ("exhaust_open", open - 2.0 * PI),
            ("exhaust_open", FOUR_STROKE - open),
            ("intake_close", 2.0 * PI - close),
        ] {
            if room < width {
                let what = format!(
                    "{name} leaves {:.6} deg for a valve transition of {:.6} deg: transitions follow 0 deg, intake_close and exhaust_open and end before the next dead centre of gas exchange or firing",
                    room.to_degrees(),
                    width.to_degrees()
                );
                return Err(BuildError::at(name, what));
            }
        }
        let volume_at_close = chamber.volume(close);
        let n = self.polytropic_exponent.si();
        // The highest pressure, at the dead centre, must be a number.
        if !(self.intake_pressure.si() * elementary::powf(volume_at_close / chamber.clearance, n)).is_finite()
        {
            return Err(BuildError::at("polytropic_exponent", "the exponent makes the pressure infinite"));
        }
        Ok(Box::new(Smooth {
            volume_at_close,
            chamber,
            intake: self.intake_pressure.si(),
            exhaust: elementary::ln(self.exhaust_pressure.si() / self.intake_pressure.si()),
            n,
            close,
            open,
            width,
        }))
    }
}

#[derive(Debug, Clone)]
struct Smooth {
    chamber: Chamber,
    volume_at_close: f64,
    intake: f64,
    /// ln(p_e/p_i)
    exhaust: f64,
    n: f64,
    close: f64,
    open: f64,
    width: f64,
}

fn step(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

impl CylinderPressure for Smooth {
    fn pressure(&self, theta: f64) -> f64 {
        let theta = reduced(theta, FOUR_STROKE);
        let ln_ratio = if theta < self.close {
            (1.0 - step(theta / self.width)) * self.exhaust
        } else if theta >= self.open + self.width {
            self.exhaust
        } else {
            let rise = self.n * elementary::ln(self.volume_at_close / self.chamber.volume(theta));
            let trapped = step((theta - self.close) / self.width) * rise;
            trapped + step((theta - self.open) / self.width) * (self.exhaust - trapped)
        };
        self.intake * elementary::exp(ln_ratio)
    }
    fn kinks(&self) -> &[f64] {
        &[]
    }
    fn period(&self) -> f64 {
        FOUR_STROKE
    }
}
