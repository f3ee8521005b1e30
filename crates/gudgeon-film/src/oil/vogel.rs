use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::quantity::{PosRatio, PosViscosity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

/// The Vogel equation with constants of one's own: `μ = a exp(b / (T - 273.15 K + c))`.
///
/// Temperatures at which `T - 273.15 K + c` is less than `b/100` (far below the pour point of any oil) get the viscosity
/// of that limit, so that no temperature overflows.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vogel {
    /// Limit of the viscosity at high temperature.
    pub a: PosViscosity,
    /// Numerator of the exponent, a temperature difference in kelvin (a plain number).
    pub b: PosRatio,
    /// Added to the temperature in degrees Celsius, a temperature difference in kelvin (a plain number).
    pub c: PosRatio,
}

#[register_model(
    name = "vogel",
    summary = "Vogel equation with given constants",
    equations = "mu = a exp(b / (T_C + c)),  T_C = T - 273.15 K",
    validity = "The range of temperatures to which a, b and c were fitted, at low shear rate and ambient pressure.",
    references = ["vogel1921", "cameron1966"],
    example = "a = \"0.15014 mPa s\"\nb = 720.015\nc = 71.123\n",
)]
impl OilSpec for Vogel {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        Ok(Box::new(VogelOil::new(self.a.si(), self.b.si(), self.c.si())?))
    }
}

/// 0 °C \[K\].
const ZERO_CELSIUS: f64 = 273.15;

/// The largest exponent: e^100 times any real `a` is still a finite number, and no oil that flows comes near it.
const MAX_EXPONENT: f64 = 100.0;

#[derive(Debug)]
pub(crate) struct VogelOil {
    a: f64,
    b: f64,
    /// `c - 273.15 K`, so that the temperature enters in kelvin.
    shift: f64,
    /// `T_C + c` below which the viscosity is held.
    floor: f64,
}

impl VogelOil {
    pub(crate) fn new(a: f64, b: f64, c: f64) -> Result<Self, BuildError> {
        let oil = Self { a, b, shift: c - ZERO_CELSIUS, floor: b / MAX_EXPONENT };
        // Any temperature will do to find constants that are no oil's; 100 °C is where oils are rated.
        let at_100 = oil.viscosity(ZERO_CELSIUS + 100.0);
        if !(at_100.is_finite() && at_100 > 0.0 && 100.0 + c > oil.floor) {
            return Err(BuildError::new(format!(
                "a = {a} Pa s, b = {b} and c = {c} give no viscosity at 100 degC"
            )));
        }
        Ok(oil)
    }
}

impl Oil for VogelOil {
    fn viscosity(&self, temperature: f64) -> f64 {
        self.a * elementary::exp(self.b / (temperature + self.shift).max(self.floor))
    }
}
