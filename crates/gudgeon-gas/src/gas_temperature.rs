//! Temperature of the gas on the lands and behind the rings: that of the walls, or from a balance of energy.

use gudgeon_core::BuildError;
use gudgeon_core::elementary;
use gudgeon_core::geometry::PackGeometry;
use gudgeon_core::quantity::{NonNegative, Ratio, quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::channel::sutherland_viscosity;

/// Temperature of the gas on the lands and behind the rings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GasTemperature {
    /// That of the walls, at every instant.
    #[default]
    Walls,
    /// From a balance of energy in every space: what gas brings and takes, heat to the walls, work on the rings.
    EnergyBalance,
}

impl GasTemperature {
    /// Nusselt number of the heat to the walls; `None` when the gas has their temperature.
    pub(crate) fn nusselt(self, number: Ratio<NonNegative>) -> Option<f64> {
        (self == Self::EnergyBalance).then(|| number.si())
    }
}

/// Default of `nusselt`: developed laminar flow between parallel walls of one temperature, formed with twice their distance.
pub(crate) fn parallel_walls() -> Ratio<NonNegative> {
    quantity(7.54)
}

/// Prandtl number of air, 0.68 to 0.71 from 300 K to 1000 K.
const PRANDTL: f64 = 0.7;

/// Balance of energy of every space. With the internal energy `U = m c_v T`, the pressure `p = (γ - 1) U/V` and the enthalpy `c_p T` of the gas where
/// it comes from,
///
/// ```text
/// dU/dt = Σ ṁ c_p T - Q - p dV/dt        Q = h_c A (T - T_w)        h_c = Nu λ/(2 s)        A = 2 V/s
/// ```
///
/// for a space between walls of the distance `s`, with the conductivity `λ = μ c_p/0.7` of air at the temperature `T_w` of the walls. The state is
/// `E = U (V/V_0)^(γ-1)`, which gas keeps that is compressed without heat, so that the rate of the volume is not needed:
///
/// ```text
/// dE/dt = (V/V_0)^(γ-1) ( Σ ṁ c_p T - Q )
/// ```
#[derive(Debug, Clone)]
pub(crate) struct LandEnergy {
    /// `γ - 1`.
    excess: f64,
    spaces: Vec<EnergyOfSpace>,
}

/// One space.
#[derive(Debug, Clone, Copy)]
pub(crate) struct EnergyOfSpace {
    /// `R T_w` \[J/kg\].
    wall_rt: f64,
    /// `V_0` \[m³\].
    nominal: f64,
    /// `Nu λ/R` \[kg/(m s)\].
    conduction: f64,
    /// `(V/V_0)^(γ-1)` now.
    stretch: f64,
    /// `h_c A/R` now \[kg/s\].
    conductance: f64,
}

impl LandEnergy {
    pub fn new(pack: &PackGeometry) -> Self {
        Self { excess: pack.gamma - 1.0, spaces: Vec::new() }
    }

    /// Adds a space whose walls have a temperature \[K\], of the size \[m³\] `nominal`.
    pub fn add(&mut self, pack: &PackGeometry, nusselt: f64, temperature: f64, nominal: f64) {
        self.spaces.push(EnergyOfSpace {
            wall_rt: pack.gas_constant * temperature,
            nominal,
            conduction: nusselt * sutherland_viscosity(temperature) * self.cp_over_r() / PRANDTL,
            stretch: 1.0,
            conductance: 0.0,
        });
    }

    /// `c_p/R`.
    pub fn cp_over_r(&self) -> f64 {
        1.0 + 1.0 / self.excess
    }

    /// The state \[J\] of gas at the pressure \[Pa\] in the volume \[m³\].
    pub fn state(&self, k: usize, pressure: f64, volume: f64) -> f64 {
        pressure * volume / self.excess * self.stretch_of(k, volume)
    }

    fn stretch_of(&self, k: usize, volume: f64) -> f64 {
        elementary::powf(volume / self.spaces[k].nominal, self.excess)
    }

    /// `R T` \[J/kg\] of the mass \[kg\] with the state \[J\] in a volume \[m³\] between walls of the distance `s` \[m\].
    pub fn set(&mut self, k: usize, mass: f64, state: f64, volume: f64, s: f64) -> f64 {
        let stretch = self.stretch_of(k, volume);
        let space = &mut self.spaces[k];
        (space.stretch, space.conductance) = (stretch, space.conduction * volume / (s * s));
        self.excess * state / (stretch * mass)
    }

    /// Heat to the walls \[W\] at `rt` = `R T`.
    pub fn heat(&self, k: usize, rt: f64) -> f64 {
        let space = &self.spaces[k];
        space.conductance * (rt - space.wall_rt)
    }

    /// Rate of the state \[W\] of a space whose internal energy and work on the walls grow by `power` \[W\].
    pub fn rate(&self, k: usize, power: f64) -> f64 {
        self.spaces[k].stretch * power
    }

    /// Energy \[J\] of the gas at the pressure \[Pa\] in the volume \[m³\].
    pub fn content(&self, pressure: f64, volume: f64) -> f64 {
        pressure * volume / self.excess
    }

    /// A space as it is, for [`restore`](Self::restore).
    pub fn memo(&self, k: usize) -> EnergyOfSpace {
        self.spaces[k]
    }

    /// Puts it back.
    pub fn restore(&mut self, k: usize, memo: EnergyOfSpace) {
        self.spaces[k] = memo;
    }
}

/// Whether the walls of a space are a distance `s` \[m\] apart.
///
/// # Errors
/// They are not.
pub(crate) fn wide_enough(s: f64, what: impl Fn() -> String) -> Result<(), BuildError> {
    if s > 0.0 && s.is_finite() {
        return Ok(());
    }
    let text = format!("{} is {s:e} m wide, which leaves nothing for the heat to its walls", what());
    Err(BuildError::at("gas_temperature", text)
        .help("give piston and groove diameters that leave room, or `gas_temperature = \"walls\"`"))
}
