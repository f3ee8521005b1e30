use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::quantity::{PosTemperature, PosViscosity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use gudgeon_numerics::table::Pchip;
use serde::{Deserialize, Serialize};

/// Measured or computed viscosities over the temperature.
///
/// `ln μ` is interpolated over `1/T` by a monotone cubic, so the viscosity falls between rows in which it falls, and stays positive. Both curves are nearly
/// straight for oils: a Vogel oil is met within 3.5 % by three rows at 40, 100 and 150 °C, within 5e-4 by rows every 10 K. Beyond the first and the last row the
/// curve goes on straight (Andrade's equation), which is an extrapolation.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Temperatures, ascending.
    pub temperature: Vec<PosTemperature>,
    /// Dynamic viscosity at each.
    pub viscosity: Vec<PosViscosity>,
}

#[register_model(
    name = "table",
    summary = "measured viscosities over temperature",
    equations = "ln mu(1/T): monotone piecewise cubic through the rows, straight beyond the ends",
    validity = "As good as the rows, at least two, and within their temperatures; at low shear rate and ambient pressure.",
    references = ["fritsch1980"],
    example = "temperature = [\"40 degC\", \"100 degC\", \"150 degC\"]\nviscosity = [\"97.8 mPa s\", \"10.1 mPa s\", \"3.9 mPa s\"]\n",
)]
impl OilSpec for Table {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        let (t, mu) = (&self.temperature, &self.viscosity);
        if t.len() != mu.len() {
            let what = format!("{} values beside {} of `temperature`", mu.len(), t.len());
            return Err(BuildError::at("viscosity", what));
        }
        if t.len() < 2 {
            return Err(BuildError::at("temperature", format!("{} rows, at least 2 are needed", t.len())));
        }
        if let Some(i) = t.windows(2).position(|w| w[1].si() <= w[0].si()) {
            let what =
                format!("{} K does not follow {} K: temperatures must ascend", t[i + 1].si(), t[i].si());
            return Err(BuildError::at(format!("temperature.{}", i + 1), what));
        }
        // 1/T ascends from the last row to the first.
        let reciprocal: Vec<f64> = t.iter().rev().map(|t| 1.0 / t.si()).collect();
        let logarithm: Vec<f64> = mu.iter().rev().map(|mu| elementary::ln(mu.si())).collect();
        let ends = (reciprocal[0], reciprocal[reciprocal.len() - 1]);
        let curve = Pchip::new(reciprocal, logarithm)
            .map_err(|e| BuildError::at("temperature", format!("the curve cannot be used: {e}")))?;
        Ok(Box::new(Curve { curve, ends }))
    }
}

/// The largest `|ln μ|`: its exponential and the reciprocal of that are finite, and no oil comes near them.
const MAX_LOGARITHM: f64 = 100.0;

#[derive(Debug)]
struct Curve {
    curve: Pchip,
    ends: (f64, f64),
}

impl Oil for Curve {
    fn viscosity(&self, temperature: f64) -> f64 {
        let x = 1.0 / temperature;
        let at = x.clamp(self.ends.0, self.ends.1);
        let (y, slope) = self.curve.eval(at);
        elementary::exp((y + slope * (x - at)).clamp(-MAX_LOGARITHM, MAX_LOGARITHM))
    }
}
