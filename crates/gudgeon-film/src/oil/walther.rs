use gudgeon_core::kinds::{Oil, OilSpec};
use gudgeon_core::quantity::{Expansion, NonNegative, PosRatio, PosTemperature, quantity};
use gudgeon_core::sets::Sets;
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

/// An oil by its data sheet: the Walther equation, as ASTM D341 has it, between two kinematic viscosities.
///
/// ```text
/// log10 log10(ν + 0.7) = A - B log10 T        ν in mm²/s, T in kelvin; A and B from the two viscosities
/// ρ = ρ15 (1 - α (T - 288.15 K))              μ = ν ρ
/// ```
///
/// The viscosity at 100 °C belongs to the SAE class of the oil (SAE J300, mm²/s): 16: 6.1 to 8.2, 20: 6.9 to 9.3, 30: 9.3 to 12.5, 40: 12.5 to 16.3,
/// 50: 16.3 to 21.9, 60: 21.9 to 26.1. What a data sheet calls HTHS, at 150 °C and 1e6 1/s, is lower than μ(150 °C) where the oil thins with shear:
/// that is a matter of `shear_thinning`.
///
/// Extrapolation stays finite: ν above 0.3 mm²/s however hot, `log10(ν + 0.7)` up to 12 however cold, the density not below a tenth of that at 15 °C.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("walther.json")))]
pub struct Walther {
    /// Kinematic viscosity at the lower temperature, in mm²/s (a plain number).
    pub nu_cold: PosRatio,
    /// Kinematic viscosity at the higher temperature, in mm²/s (a plain number).
    pub nu_hot: PosRatio,
    /// Lower temperature; data sheets give 40 degC.
    #[serde(default = "cold")]
    pub cold: PosTemperature,
    /// Higher temperature; data sheets give 100 degC.
    #[serde(default = "hot")]
    pub hot: PosTemperature,
    /// Density at 15 degC, in kg/m³ (a plain number).
    #[serde(default = "density")]
    pub density: PosRatio,
    /// Thermal expansion α of the oil's volume at 15 degC: 6.3e-4 to 7.5e-4 1/K for mineral oils.
    #[serde(default = "expansion")]
    pub expansion: Expansion<NonNegative>,
}

fn cold() -> PosTemperature {
    quantity(313.15)
}
fn hot() -> PosTemperature {
    quantity(373.15)
}
fn density() -> PosRatio {
    quantity(880.0)
}
fn expansion() -> Expansion<NonNegative> {
    quantity(7e-4)
}

#[register_model(
    name = "walther",
    summary = "Walther equation (ASTM D341) through two kinematic viscosities of a data sheet, with density",
    equations = "log10 log10(nu + 0.7) = A - B log10 T,  nu in mm2/s;  rho = rho15 (1 - alpha (T - 288.15 K));  mu = nu rho",
    validity = "Mineral and most synthetic oils from about 0 degC to 200 degC, nu above 2 mm2/s; low shear rate, ambient pressure.",
    references = ["walther1931", "astmd341", "saej300"],
    example = "nu_cold = 95.0\nnu_hot = 10.7\n",
)]
impl OilSpec for Walther {
    fn build(&self) -> Result<Box<dyn Oil>, BuildError> {
        let (t1, t2) = (self.cold.si(), self.hot.si());
        if t2 <= t1 {
            return Err(BuildError::at(
                "hot",
                format!("{t2} K is not above the lower temperature of {t1} K"),
            ));
        }
        let w = |nu: f64| elementary::log10(elementary::log10(nu + SHIFT));
        let (w1, w2) = (w(self.nu_cold.si()), w(self.nu_hot.si()));
        // log10 log10 exists for nu + 0.7 > 1 only.
        for (field, nu, w) in [("nu_cold", self.nu_cold, w1), ("nu_hot", self.nu_hot, w2)] {
            if !w.is_finite() {
                return Err(BuildError::at(
                    field,
                    format!("{} mm2/s is not the viscosity of an oil", nu.si()),
                )
                .help("the Walther equation holds above 0.3 mm2/s"));
            }
        }
        if w2 >= w1 {
            return Err(BuildError::at("nu_hot", "an oil is thinner at the higher temperature"));
        }
        let b = (w1 - w2) / (elementary::log10(t2) - elementary::log10(t1));
        let a = w1 + b * elementary::log10(t1);
        Ok(Box::new(WaltherOil { a, b, density: self.density.si(), expansion: self.expansion.si() }))
    }
}

/// Added to the viscosity in the equation \[mm²/s\].
const SHIFT: f64 = 0.7;
/// mm²/s to m²/s.
const SQUARE_MM: f64 = 1e-6;
/// Temperature of the density \[K\].
const T_DENSITY: f64 = 288.15;
/// Largest `log10(ν + 0.7)`: 1e12 mm²/s is a solid, and nothing overflows.
const SOLID: f64 = 12.0;
/// Least fraction of the density that extrapolation may reach, so that μ stays positive.
const LIGHTEST: f64 = 0.1;

#[derive(Debug)]
struct WaltherOil {
    a: f64,
    b: f64,
    density: f64,
    expansion: f64,
}

impl Oil for WaltherOil {
    fn viscosity(&self, temperature: f64) -> f64 {
        let w = elementary::powf(10f64, self.a - self.b * elementary::log10(temperature)).min(SOLID);
        // `w` is positive, so ν stays above 0.3 mm²/s however hot the oil is.
        let nu = elementary::powf(10f64, w) - SHIFT;
        let density = self.density * (1.0 - self.expansion * (temperature - T_DENSITY)).max(LIGHTEST);
        nu * SQUARE_MM * density
    }
}
