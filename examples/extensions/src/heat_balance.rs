//! A film temperature with a state of its own for every ring.

use gudgeon_core::kinds::{FilmHeat, FilmTemperature, FilmTemperatureCtx, FilmTemperatureSpec};
use gudgeon_core::quantity::{PosTemperature, PosTime, quantity};
use gudgeon_core::states::{Signals, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The friction of a ring heats its film, the liner cools it:
///
/// ```text
/// dT/dt = (T_liner + R P - T)/τ,    R = resistance / (length of the face × circumference)
/// ```
///
/// with `P` the friction power of the ring and `T_liner` falling linearly from top to bottom dead centre.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HeatBalance {
    /// Liner temperature where ring 1 is at top dead centre.
    pub tdc: PosTemperature,
    /// Liner temperature where ring 1 is at bottom dead centre.
    pub bdc: PosTemperature,
    /// Rise of temperature over the heat flux into the liner \[K m²/W\].
    #[serde(default = "resistance")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub resistance: f64,
    /// Time within which film and skin of the liner follow.
    #[serde(default = "response")]
    pub response: PosTime,
}

const fn resistance() -> f64 {
    2e-6
}
fn response() -> PosTime {
    quantity(1e-3)
}

#[register_model(
    name = "heat_balance",
    summary = "films that their own friction heats and the liner cools",
    equations = "dT/dt = (T_liner(x) + R P/(L pi D) - T)/tau",
    validity = "A lumped film: one temperature a ring. Resistance and response stand for conduction into ring and liner.",
    references = [],
    example = "tdc = \"180 degC\"\nbdc = \"110 degC\"\nresistance = 2e-6\nresponse = \"1 ms\"\n",
)]
impl FilmTemperatureSpec for HeatBalance {
    fn build(&self, ctx: &FilmTemperatureCtx<'_>) -> Result<Box<dyn FilmTemperature>, BuildError> {
        if ctx.face_lengths.iter().any(|l| *l <= 0.0) || ctx.circumference <= 0.0 {
            return Err(BuildError::new("the faces of the rings must be known"));
        }
        let states = (1..=ctx.face_lengths.len()).map(|i| {
            StateInfo::new(format!("film temperature of ring{i} over 100 K")).changes(Signals::TEMPERATURE)
        });
        Ok(Box::new(Films {
            states: states.collect(),
            tdc: self.tdc.si(),
            slope: (self.bdc.si() - self.tdc.si()) / ctx.stroke,
            rise: ctx.face_lengths.iter().map(|l| self.resistance / (l * ctx.circumference)).collect(),
            rate: 1.0 / (self.response.si() * ctx.omega),
        }))
    }
}

/// Unit of the states \[K\].
const UNIT: f64 = 100.0;

#[derive(Debug)]
struct Films {
    states: Vec<StateInfo>,
    tdc: f64,
    slope: f64,
    /// Rise of each film over the friction power of its ring \[K/W\].
    rise: Vec<f64>,
    /// One over the response \[1/rad\].
    rate: f64,
}

impl Stateful for Films {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
    fn reads(&self) -> Signals {
        Signals::TEMPERATURE | Signals::FILM_FORCE
    }
    fn initial(&mut self, y: &mut [f64]) {
        y.fill(self.tdc / UNIT);
    }
}

impl FilmTemperature for Films {
    fn temperature(&self, ring: usize, travel: f64, y: &[f64]) -> f64 {
        y.get(ring).map_or(self.tdc + self.slope * travel, |y| UNIT * y)
    }
    fn is_constant(&self) -> bool {
        false
    }
    fn rates(&mut self, ring: usize, y: &[f64], heat: &FilmHeat, dy: &mut [f64]) -> Result<(), EvalError> {
        let rest = self.tdc + self.slope * heat.travel + self.rise[ring] * heat.power;
        dy[ring] = (rest / UNIT - y[ring]) * self.rate;
        Ok(())
    }
}
