use gudgeon_core::kinds::{FilmTemperature, FilmTemperatureCtx, FilmTemperatureSpec};
use gudgeon_core::quantity::PosTemperature;
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// The film has the temperature of the liner, which changes linearly along the stroke.
///
/// `T = T_tdc + (T_bdc - T_tdc) travel/stroke`, where `travel` is the distance of the face below the place of ring 1 at top
/// dead centre. Below the place of ring 1 at bottom dead centre, where the lower rings run, the line goes on.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinerLinear {
    /// Liner temperature where ring 1 is at top dead centre.
    pub tdc: PosTemperature,
    /// Liner temperature where ring 1 is at bottom dead centre.
    pub bdc: PosTemperature,
}

#[register_model(
    name = "liner_linear",
    summary = "liner temperature, linear along the stroke",
    equations = "T = T_tdc + (T_bdc - T_tdc) travel / stroke, extrapolated below bottom dead centre",
    validity = "Films that take the liner temperature at once; measured liners are hotter near top dead centre than a line.",
    references = ["zottin1992"],
    example = "tdc = \"180 degC\"\nbdc = \"110 degC\"\n",
)]
impl FilmTemperatureSpec for LinerLinear {
    fn build(&self, ctx: &FilmTemperatureCtx<'_>) -> Result<Box<dyn FilmTemperature>, BuildError> {
        if !(ctx.stroke.is_finite() && ctx.stroke > 0.0) {
            return Err(BuildError::new(format!("the stroke must be positive, not {} m", ctx.stroke)));
        }
        let (tdc, bdc) = (self.tdc.si(), self.bdc.si());
        Ok(Box::new(Line { tdc, slope: (bdc - tdc) / ctx.stroke }))
    }
}

#[derive(Debug)]
struct Line {
    tdc: f64,
    /// Change per metre of travel \[K/m\].
    slope: f64,
}

impl Stateful for Line {}

impl FilmTemperature for Line {
    fn temperature(&self, _: usize, travel: f64, _: &[f64]) -> f64 {
        self.tdc + self.slope * travel
    }
    fn liner(&self, travel: f64) -> Option<f64> {
        Some(self.tdc + self.slope * travel)
    }
    fn is_constant(&self) -> bool {
        self.slope == 0.0
    }
}
