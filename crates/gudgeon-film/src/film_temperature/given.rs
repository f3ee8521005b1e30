use gudgeon_core::kinds::{FilmTemperature, FilmTemperatureCtx, FilmTemperatureSpec};
use gudgeon_core::quantity::PosTemperature;
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// A given film temperature for each ring, the same all along the stroke.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Given {
    /// Film temperature under each ring, ring 1 first.
    pub temperatures: Vec<PosTemperature>,
}

#[register_model(
    name = "given",
    summary = "a given film temperature for each ring",
    equations = "T = temperatures[ring]",
    validity = "Temperatures known from elsewhere; no change along the stroke.",
    references = [],
    example = "temperatures = [\"150 degC\", \"130 degC\", \"110 degC\"]\n",
)]
impl FilmTemperatureSpec for Given {
    fn build(&self, ctx: &FilmTemperatureCtx<'_>) -> Result<Box<dyn FilmTemperature>, BuildError> {
        let of_ring: Vec<f64> = self.temperatures.iter().map(|t| t.si()).collect();
        // The film of ring 1 on a liner that nothing else is known of.
        let liner = of_ring.first().copied();
        Ok(Box::new(PerRing::new(of_ring, liner, ctx, "temperatures")?))
    }
}

/// One constant temperature for each ring.
#[derive(Debug)]
pub(crate) struct PerRing {
    of_ring: Vec<f64>,
    /// Of the bare liner.
    liner: Option<f64>,
}

impl PerRing {
    /// `field` is the key of the list, for the message about its length.
    pub(crate) fn new(
        of_ring: Vec<f64>,
        liner: Option<f64>,
        ctx: &FilmTemperatureCtx<'_>,
        field: &str,
    ) -> Result<Self, BuildError> {
        let rings = ctx.land_temperatures.len().saturating_sub(1);
        if of_ring.len() != rings || rings == 0 {
            let n = of_ring.len();
            return Err(BuildError::at(field, format!("{n} temperatures for {rings} rings"))
                .help("give one temperature for each ring, ring 1 first"));
        }
        Ok(Self { of_ring, liner })
    }
}

impl Stateful for PerRing {}

impl FilmTemperature for PerRing {
    fn temperature(&self, ring: usize, _: f64, _: &[f64]) -> f64 {
        // `new` leaves no empty list; a ring below the last has no film of its own and takes the nearest.
        self.of_ring[ring.min(self.of_ring.len() - 1)]
    }
    fn liner(&self, _: f64) -> Option<f64> {
        self.liner
    }
    fn is_constant(&self) -> bool {
        true
    }
}
