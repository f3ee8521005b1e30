//! No oil in the groove.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{Flank, FlankCtx, FlankFilm, FlankLaw, FlankResistance, FlankSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, PosPressure, Viscosity};
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::check_width;
use super::gas_gap::{GasGap, default_gas_viscosity};
use super::squeeze_film::{default_roughness, default_tension};

/// The ring moves in a dry groove, of which it squeezes the gas out.
///
/// The gas between the ring and a flank, `w` wide, resists as a film that is thin against its width (Reynolds), per circumference
///
/// ```text
/// approach with v:  f = μ_g w³ v/H³         separation:  f = X/(1 + X/(p_t w)),  X = μ_g w³ v/H³         H = h + σ
/// ```
///
/// Valid while the gas has time to leave: `12 μ_g w² v/(p H³)` well below one, which is so for all but the last micrometres before a hard landing.
///
/// Source: reynolds1886.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Dry {
    /// Dynamic viscosity `μ_g` of the gas in the gaps; 0: nothing resists.
    #[serde(default = "default_gas_viscosity")]
    pub gas_viscosity: Viscosity<NonNegative>,
    /// Distance `σ` at which roughness peaks hold seated flanks apart: combined roughness of ring and groove flank.
    #[serde(default = "default_roughness")]
    pub roughness: PosLength,
    /// Greatest mean tension `p_t` in a gap that gas cannot fill fast enough: at most the pressure around it.
    #[serde(default = "default_tension")]
    pub tension: PosPressure,
}

impl Default for Dry {
    fn default() -> Self {
        Self {
            gas_viscosity: default_gas_viscosity(),
            roughness: default_roughness(),
            tension: default_tension(),
        }
    }
}

#[register_model(
    name = "dry",
    summary = "dry groove: only gas resists, where the ring squeezes it out; gas passes the whole gap",
    equations = "approach: F = mu_g A w^2 v / (h + sigma)^3;  separation: X/(1 + X/(p_t A)), X = mu_g A w^2 v / (h + sigma)^3;  h = s and c - s",
    validity = "Upper bound of ring mobility. Parallel flanks; the gas is not compressed as it leaves. With `gas_viscosity = 0` nothing resists, and rings \
               flutter between their flanks.",
    references = ["reynolds1886"],
    example = "gas_viscosity = \"0.027 mPa s\"\n",
)]
impl FlankSpec for Dry {
    fn build(&self, ctx: &FlankCtx) -> Result<Box<dyn Flank>, BuildError> {
        check_width(ctx)?;
        Ok(Box::new(Runtime {
            gas: GasGap { viscosity: self.gas_viscosity.si(), tension: self.tension.si() },
            width: ctx.width,
            roughness: self.roughness.si(),
        }))
    }
}

#[derive(Clone, Copy)]
struct Runtime {
    gas: GasGap,
    width: f64,
    roughness: f64,
}

impl Stateful for Runtime {}

impl Flank for Runtime {
    fn law(&self) -> Box<dyn FlankLaw> {
        Box::new(*self)
    }
}

impl Runtime {
    fn resist(&self, s: f64, clearance: f64, area: f64) -> FlankResistance {
        let circumference = area / self.width;
        let [lower, upper] = [s, clearance - s].map(|h| {
            [
                self.gas.film(self.width, 1.0 / (h.max(0.0) + self.roughness), circumference),
                FlankFilm::default(),
            ]
        });
        FlankResistance { lower, upper }
    }
}

impl FlankLaw for Runtime {
    fn force(&self, _: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> f64 {
        self.resist(s, clearance, area).force(v)
    }

    fn resistance(&self, _: &FlankOil, s: f64, clearance: f64, area: f64) -> Option<FlankResistance> {
        Some(self.resist(s, clearance, area))
    }
}
