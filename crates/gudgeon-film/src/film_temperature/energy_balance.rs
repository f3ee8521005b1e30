use gudgeon_core::kinds::{FilmHeat, FilmTemperature, FilmTemperatureCtx, FilmTemperatureSpec};
use gudgeon_core::quantity::{PosRatio, PosTemperature, quantity};
use gudgeon_core::states::{Signals, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

/// The mean temperature of each film from its heat: friction heats it, ring and liner cool or heat it, and oil of the liner's temperature comes in as it
/// slides.
///
/// ```text
/// ρ c h dT/dt = P/A + 6 k/h (T_ring - T) + 6 k/h (T_liner - T) + ρ c |u| h/(2 L) (T_liner - T)        A = π D L
/// ```
///
/// `h` is the film thickness at the narrowest place, `P` the friction power of the ring, `L` the length of its faces, `T_liner` linear along the stroke as in
/// `liner_linear`. `6 k/h` is what a wall takes from a film of parabolic temperature profile, whose heat is set free evenly across it. Without sliding the
/// film rests at `(T_ring + T_liner)/2 + P h/(12 k A)`; it gets there within `ρ c h²/(12 k)`, microseconds. A film thinner than 10 nm counts as 10 nm.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EnergyBalance {
    /// Temperature of the running face of each ring, ring 1 first.
    pub rings: Vec<PosTemperature>,
    /// Liner temperature where ring 1 is at top dead centre.
    pub tdc: PosTemperature,
    /// Liner temperature where ring 1 is at bottom dead centre.
    pub bdc: PosTemperature,
    /// Thermal conductivity k of the oil, in W/(m K) (a plain number).
    #[serde(default = "conductivity")]
    pub conductivity: PosRatio,
    /// Heat capacity ρ c of the oil per volume, in MJ/(m³ K) (a plain number).
    #[serde(default = "heat_capacity")]
    pub heat_capacity: PosRatio,
}

fn conductivity() -> PosRatio {
    quantity(0.13)
}
fn heat_capacity() -> PosRatio {
    quantity(1.9)
}

#[register_model(
    name = "energy_balance",
    summary = "heat of each film: friction, conduction to ring and liner, oil that comes in",
    equations = "rho c h dT/dt = P/(pi D L) + 6 k/h (T_ring - T) + 6 k/h (T_liner - T) + rho c |u| h/(2 L) (T_liner - T)",
    validity = "One temperature a film, walls of given temperature: they do not flash where they rub. All friction power of the ring heats the film, that of solid contact too.",
    references = ["morris2013"],
    example = "rings = [\"200 degC\", \"170 degC\", \"140 degC\"]\ntdc = \"180 degC\"\nbdc = \"110 degC\"\n",
)]
impl FilmTemperatureSpec for EnergyBalance {
    fn build(&self, ctx: &FilmTemperatureCtx<'_>) -> Result<Box<dyn FilmTemperature>, BuildError> {
        let rings: Vec<f64> = self.rings.iter().map(|t| t.si()).collect();
        let n = ctx.face_lengths.len();
        if rings.len() != n || n == 0 {
            return Err(BuildError::at("rings", format!("{} temperatures for {n} rings", rings.len()))
                .help("give one temperature for each ring, ring 1 first"));
        }
        let all = [ctx.stroke, ctx.circumference, ctx.omega];
        if all.iter().chain(ctx.face_lengths).any(|v| !(v.is_finite() && *v > 0.0)) {
            return Err(BuildError::new(
                "stroke, bore, speed and the faces of the rings must be known and positive",
            ));
        }
        let states = (1..=n).map(|i| {
            StateInfo::new(format!("film temperature of ring{i} over 100 K")).changes(Signals::TEMPERATURE)
        });
        let (tdc, bdc) = (self.tdc.si(), self.bdc.si());
        Ok(Box::new(Films {
            states: states.collect(),
            tdc,
            slope: (bdc - tdc) / ctx.stroke,
            rings,
            lengths: ctx.face_lengths.to_vec(),
            circumference: ctx.circumference,
            omega: ctx.omega,
            conductivity: self.conductivity.si(),
            heat_capacity: 1e6 * self.heat_capacity.si(),
        }))
    }
}

/// Unit of the states \[K\].
const UNIT: f64 = 100.0;
/// Thinnest film of the balance \[m\].
const THINNEST: f64 = 1e-8;

#[derive(Debug)]
struct Films {
    states: Vec<StateInfo>,
    tdc: f64,
    /// Change of the liner's temperature per metre of travel \[K/m\].
    slope: f64,
    rings: Vec<f64>,
    /// Lengths of the faces \[m\].
    lengths: Vec<f64>,
    circumference: f64,
    omega: f64,
    /// \[W/(m K)\].
    conductivity: f64,
    /// \[J/(m³ K)\].
    heat_capacity: f64,
}

impl Films {
    fn wall(&self, travel: f64) -> f64 {
        self.tdc + self.slope * travel
    }
}

impl Stateful for Films {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
    fn reads(&self) -> Signals {
        Signals::TEMPERATURE | Signals::FILM_FORCE | Signals::FILM_THICKNESS
    }
    fn initial(&mut self, y: &mut [f64]) {
        for (y, ring) in y.iter_mut().zip(&self.rings) {
            *y = 0.5 * (ring + self.tdc) / UNIT;
        }
    }
}

impl FilmTemperature for Films {
    fn temperature(&self, ring: usize, travel: f64, y: &[f64]) -> f64 {
        // Schemes without states have the mean of both walls.
        y.get(ring).map_or_else(
            || 0.5 * (self.rings[ring.min(self.rings.len() - 1)] + self.wall(travel)),
            |y| UNIT * y,
        )
    }
    fn liner(&self, travel: f64) -> Option<f64> {
        Some(self.wall(travel))
    }
    fn is_constant(&self) -> bool {
        false
    }
    fn rates(&mut self, ring: usize, y: &[f64], heat: &FilmHeat, dy: &mut [f64]) -> Result<(), EvalError> {
        let (h, t) = (heat.h.max(THINNEST), UNIT * y[ring]);
        let (liner, length) = (self.wall(heat.travel), self.lengths[ring]);
        let wall = 6.0 * self.conductivity / h;
        let carried = 0.5 * self.heat_capacity * heat.speed * h / length;
        let flux = heat.power / (self.circumference * length)
            + wall * (self.rings[ring] - t)
            + (wall + carried) * (liner - t);
        dy[ring] = flux / (self.heat_capacity * h) / (self.omega * UNIT);
        Ok(())
    }
}
