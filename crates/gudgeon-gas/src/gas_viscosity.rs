//! Viscosity of the gas in narrow passages.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::channel::{burnt_gas_viscosity, sutherland_viscosity};

/// How viscous the gas is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GasViscosity {
    /// That of air at the temperature of the channel, by Sutherland's law.
    #[default]
    Sutherland,
    /// That of stoichiometric combustion products at the temperature of the channel, by Heywood's fit: 6 to 7 % below that of air from 300 K to
    /// 600 K.
    BurntGas,
    /// The constant `viscosity`.
    Constant,
}

impl GasViscosity {
    /// Viscosity \[Pa s\] at a temperature \[K\]; `constant` where that is asked for.
    #[must_use]
    pub fn at(self, temperature: f64, constant: f64) -> f64 {
        match self {
            Self::Sutherland => sutherland_viscosity(temperature),
            Self::BurntGas => burnt_gas_viscosity(temperature),
            Self::Constant => constant,
        }
    }
}
