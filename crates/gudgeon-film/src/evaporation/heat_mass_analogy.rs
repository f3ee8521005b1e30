use gudgeon_core::kinds::{Evaporation, EvaporationCtx, EvaporationSpec};
use gudgeon_core::quantity::{self, PosGasConstant, PosTemperature, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::petroleum::{AIR, BOILING, lewis_number, molar_mass, vapour_pressure};

/// The gas carries the vapour away as it carries heat: analogy of heat and mass transfer.
///
/// Every place of the liner above ring 1, of temperature `T` and under the cylinder pressure `p`, loses of each fraction `i` of its oil
///
/// `j_i = h/c_p Le_i^(-2/3) (M_i/M_gas) x_i p_i(T)/p`  \[kg/(m² s)\]
///
/// with the coefficient of heat transfer by Hohenberg, `h = 130 V^-0.06 p^0.8 T_gas^-0.4 (v + 1.4)^0.8` (m³, bar, K, m/s; `V` half of the swept volume, `v` the mean speed
/// of the piston), the Lewis number `Le_i` of the fraction in air, its molar mass `M_i`, its mole fraction `x_i` in the film (Raoult's law) and the vapour
/// pressure `p_i` of Maxwell and Bonnell, which follows from its boiling temperature under 1 atm. Molar mass and diffusivity are those of the normal alkane
/// that boils there. Over a step each fraction decays exponentially at the sum of moles of its beginning: a film gives no more than it holds.
///
/// The film that ring 1 leaves is fresh oil of the given fractions; while it lies bare, what is light goes first. That holds where the oil ring passes,
/// below which the crankcase renews the film in every stroke. Above the reach of the oil ring oil stays for some cycles and its light fractions deplete: the
/// model overstates what evaporates there. One fraction in place of several never runs out of what is light.
///
/// There a cycle takes nanometres of a film of tenths of a micrometre, which is slow to settle: 14 to 33 cycles on a diesel between 380 and 470 K or 1000 and 2600 rpm, 18 to 25 without evaporation.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HeatMassAnalogy {
    /// Fractions of the oil, from a simulated distillation (ASTM D2887, D6417) of the fresh oil. Their shares add up to 1. As default an assumed mineral
    /// SAE 15W-40: a tenth boils below 371 degC, half of it is heavy.
    #[schemars(length(min = 1, max = 20))]
    pub fractions: Vec<Fraction>,
    /// Temperature of the gas in the cylinder, as a mean over the cycle, in the coefficient of heat transfer: twice as hot is a quarter less.
    pub gas_temperature: PosTemperature,
    /// Heat capacity of that gas at constant pressure.
    pub heat_capacity: PosGasConstant,
}

/// A fraction of an oil.
#[derive(Debug, Clone, Copy, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fraction {
    /// Its part of the mass.
    pub share: Ratio<quantity::Fraction>,
    /// Its boiling temperature under 1 atm.
    pub boiling: PosTemperature,
}

impl Default for HeatMassAnalogy {
    fn default() -> Self {
        let fraction =
            |share, celsius: f64| Fraction { share: quantity(share), boiling: quantity(celsius + 273.15) };
        Self {
            fractions: vec![fraction(0.1, 355.0), fraction(0.4, 420.0), fraction(0.5, 490.0)],
            gas_temperature: quantity(900.0),
            heat_capacity: quantity(1150.0),
        }
    }
}

/// How far the shares of the fractions may be from 1 in sum: what rounding a table of four digits leaves.
const SUM: f64 = 1e-3;

#[register_model(
    name = "heat_mass_analogy",
    summary = "vapour pressure of the fractions of the oil, carried away by the gas as it carries heat",
    equations = "j_i = h/c_p Le_i^(-2/3) (M_i/M_gas) x_i p_i(T_liner)/p;  h = 130 V^-0.06 p^0.8 T_gas^-0.4 (v + 1.4)^0.8;  p_i by Maxwell and Bonnell, Le_i by Fuller",
    validity = "Vapour pressures far below the pressure of the gas; a film of the temperature of the liner; gas without vapour. The coefficient of heat transfer is a mean over all walls, known \
               within a third, and vapour pressures are known within a fifth. Films left by ring 1 are fresh oil: overstated above the reach of the oil ring. Nothing evaporates \
               from piston, grooves and below ring 1.",
    references = ["wahiduzzaman1992", "audette1999", "hohenberg1979", "maxwell1957", "riazi1996", "fuller1966"],
    example = "fractions = [{ share = 0.1, boiling = \"355 degC\" }, { share = 0.4, boiling = \"420 degC\" }, { share = 0.5, boiling = \"490 degC\" }]\ngas_temperature = \"900 K\"\n",
)]
impl EvaporationSpec for HeatMassAnalogy {
    fn build(&self, ctx: &EvaporationCtx) -> Result<Option<Box<dyn Evaporation>>, BuildError> {
        let sum: f64 = self.fractions.iter().map(|f| f.share.si()).sum();
        if (sum - 1.0).abs() > SUM {
            let what = format!("the shares of the fractions add up to {sum}");
            return Err(
                BuildError::at("fractions", what).help("they are parts of the whole oil: their sum is 1")
            );
        }
        let (low, high) = BOILING;
        for (k, f) in self.fractions.iter().enumerate() {
            let boiling = f.boiling.si();
            if !(low..=high).contains(&boiling) {
                let what = format!("no fraction of an oil boils at {:.1} degC under 1 atm", boiling - 273.15);
                return Err(BuildError::at(format!("fractions.{k}.boiling"), what)
                    .help("between 27 and 726 degC; engine oils boil from 300 to 600 degC"));
            }
        }
        let gas = self.gas_temperature.si();
        let speed = elementary::powf(ctx.mean_speed + 1.4, 0.8);
        let coefficient =
            130.0 * elementary::powf(0.5 * ctx.swept, -0.06) * elementary::powf(gas, -0.4) * speed;
        let per_heat = coefficient / self.heat_capacity.si();
        if !(per_heat.is_finite() && per_heat > 0.0) {
            return Err(BuildError::at(
                "gas_temperature",
                "the coefficient of heat transfer is no positive number",
            )
            .help("the gas in a cylinder has some 500 to 1500 K in the mean"));
        }
        let masses: Vec<f64> = self.fractions.iter().map(|f| molar_mass(f.boiling.si())).collect();
        Ok(Some(Box::new(Vapours {
            shares: self.fractions.iter().map(|f| f.share.si() / sum).collect(),
            boiling: self.fractions.iter().map(|f| f.boiling.si()).collect(),
            readiness: masses
                .iter()
                .map(|m| elementary::powf(lewis_number(*m), -2.0 / 3.0) * m / AIR)
                .collect(),
            masses,
            per_heat,
        })))
    }
}

#[derive(Debug, Clone)]
struct Vapours {
    /// Of the mass.
    shares: Vec<f64>,
    /// Boiling temperatures \[K\].
    boiling: Vec<f64>,
    /// Molar masses \[kg/mol\].
    masses: Vec<f64>,
    /// `Le^(-2/3) M/M_gas`.
    readiness: Vec<f64>,
    /// `h/c_p` at 1 bar \[kg/(m² s)\].
    per_heat: f64,
}

impl Evaporation for Vapours {
    fn shares(&self) -> &[f64] {
        &self.shares
    }

    /// \[Pa\].
    fn volatility(&self, temperature: f64, out: &mut [f64]) {
        for ((out, boiling), ready) in out.iter_mut().zip(&self.boiling).zip(&self.readiness) {
            *out = ready * vapour_pressure(*boiling, temperature);
        }
    }

    /// `h/(c_p p)` \[kg/(m² s Pa)\].
    fn transfer(&self, pressure: f64) -> f64 {
        let bar = 1e-5 * pressure;
        self.per_heat * elementary::powf(bar, 0.8) / pressure
    }

    fn thin(&self, volatility: &[f64], exposure: f64, masses: &mut [f64]) {
        let moles: f64 = masses.iter().zip(&self.masses).map(|(m, molar)| m / molar).sum();
        if moles <= 0.0 {
            return;
        }
        for ((m, v), molar) in masses.iter_mut().zip(volatility).zip(&self.masses) {
            *m *= elementary::exp(-v * exposure / (molar * moles));
        }
    }
}
