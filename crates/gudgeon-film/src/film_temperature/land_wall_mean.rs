use gudgeon_core::kinds::{FilmTemperature, FilmTemperatureCtx, FilmTemperatureSpec};
use gudgeon_core::quantity::{PosTemperature, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::given::PerRing;

/// The mean of the temperature of the land above a ring and of a uniform liner wall: `T = (T_land + T_wall)/2`.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LandWallMean {
    /// Temperature of the liner wall.
    #[serde(default = "hundred_celsius")]
    pub wall: PosTemperature,
    /// Temperature of the land above each ring, ring 1 first; the gas temperatures of the lands when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lands: Option<Vec<PosTemperature>>,
}

fn hundred_celsius() -> PosTemperature {
    quantity(373.15)
}

#[register_model(
    name = "land_wall_mean",
    summary = "mean of the land above the ring and a uniform liner wall",
    equations = "T = (T_land + T_wall) / 2",
    validity = "An estimate where neither surface temperature is known along the stroke.",
    references = ["tomanik1993"],
    example = "wall = \"100 degC\"\nlands = [\"200 degC\", \"160 degC\", \"120 degC\"]\n",
)]
impl FilmTemperatureSpec for LandWallMean {
    fn build(&self, ctx: &FilmTemperatureCtx<'_>) -> Result<Box<dyn FilmTemperature>, BuildError> {
        let lands: Vec<f64> = match &self.lands {
            Some(l) => l.iter().map(|t| t.si()).collect(),
            None => ctx.land_temperatures.split_last().map_or(Vec::new(), |(_, above)| above.to_vec()),
        };
        let wall = self.wall.si();
        let of_ring = lands.iter().map(|t| 0.5 * (t + wall)).collect();
        Ok(Box::new(PerRing::new(of_ring, Some(wall), ctx, "lands")?))
    }
}
