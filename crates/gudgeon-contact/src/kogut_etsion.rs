use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, PosPressure, PosRatio, Ratio, quantity};
use gudgeon_core::sets::Sets;
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use crate::log_table::LogTable;
use crate::summits::{SummitHeights, Summits};

/// Elastic-plastic contact of a rough surface with a smooth one: spherical summits that follow Hertz's law until they yield, then the law that
/// Kogut and Etsion found by finite elements, and flow in the end.
///
/// ```text
/// p(h)  = (2/3) π K H (η β σ) (ω_c/σ) ∫_0^∞ g(t σ_s/ω_c) φ(d + t) dt        d = (h - h_s)/σ_s,  φ(s) = (2π)^(-1/2) exp(-s²/2)
/// A_c/A =     π (η β σ) (ω_c/σ) ∫_0^∞ a(t σ_s/ω_c) φ(d + t) dt
/// ω_c = (π K H/(2 E'))² β        K = 0.454 + 0.41 ν
///
/// x = ω/ω_c      g(x)               a(x)
/// up to 1        x^1.5              x                elastic
/// up to 6        1.03 x^1.425       0.93 x^1.136     first yield below the surface
/// up to 110      1.40 x^1.263       0.94 x^1.146     it spreads
/// beyond         3 x/K              2 x              flow under the hardness H
/// ```
///
/// The other symbols are those of [`GreenwoodWilliamson`](crate::GreenwoodWilliamson), which this model becomes for hard surfaces. The film is as thick as the
/// mean gap of the undeformed heights.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("kogut_etsion.json")))]
pub struct KogutEtsion {
    /// Composite roughness σ of the two surfaces: `√(σ1² + σ2²)` of their rms roughness.
    pub roughness: PosLength,
    /// Composite modulus E' with `1/E' = Σ (1-ν²)/E`: about 75 GPa for steel on grey cast iron, 115 GPa for steel on steel.
    pub composite_modulus: PosPressure,
    /// Hardness H of the softer surface: about 2 GPa for grey cast iron.
    pub hardness: PosPressure,
    /// Poisson's ratio ν of the softer surface.
    #[serde(default = "iron")]
    pub poisson_ratio: Ratio<NonNegative>,
    /// The product η β σ of the sum of both surfaces, usually 0.03 to 0.07.
    pub eta_beta_sigma: PosRatio,
    /// The ratio σ/β, usually 1e-4 to 1e-2.
    pub sigma_over_beta: PosRatio,
    /// Where the summits stand over the mean plane.
    #[serde(default)]
    pub summit_heights: SummitHeights,
    /// Coefficient of friction of the load that the asperities carry.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn iron() -> Ratio<NonNegative> {
    quantity(0.26)
}
fn boundary() -> Ratio<NonNegative> {
    quantity(0.10)
}

#[register_model(
    name = "kogut_etsion",
    summary = "elastic-plastic spherical summits of a rough surface on a plane",
    equations = "p = (2/3) pi K H (eta beta sigma) (omega_c/sigma) int_0^inf g(t sigma_s/omega_c) phi(d+t) dt;  omega_c = (pi K H/(2 E'))^2 beta;  K = 0.454 + 0.41 nu;  g(x) = x^1.5 | 1.03 x^1.425 | 1.40 x^1.263 | 3 x/K for x up to 1 | 6 | 110 | beyond",
    validity = "Isotropic Gaussian roughness, summits that do not touch each other: real area below a tenth; first loading, no hardening. Where each range ends the fits of the source jump, most where all flows: by about a tenth.",
    references = ["kogut2002", "kogut2003", "mccool1986"],
    example = "roughness = \"0.4 um\"\ncomposite_modulus = \"115 GPa\"\nhardness = \"2 GPa\"\neta_beta_sigma = 0.05\nsigma_over_beta = 1e-3\n",
)]
impl ContactSpec for KogutEtsion {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        let poisson = self.poisson_ratio.si();
        if poisson > 0.5 {
            let what = format!("Poisson's ratio is {poisson}, no solid has more than 0.5");
            return Err(BuildError::at("poisson_ratio", what));
        }
        let (product, ratio) = (self.eta_beta_sigma.si(), self.sigma_over_beta.si());
        let summits = Summits::new(self.roughness.si(), product, ratio, self.summit_heights)?;
        let factor = 0.454 + 0.41 * poisson;
        let bent = std::f64::consts::FRAC_PI_2 * factor * self.hardness.si() / self.composite_modulus.si();
        let yields = bent * bent * summits.radius;
        let area = std::f64::consts::PI * product * yields / summits.sigma;
        let pressure = 2.0 / 3.0 * factor * self.hardness.si() * area;
        if !(pressure.is_normal() && area.is_normal()) {
            let what =
                format!("summits yield at an overlap of {yields:e} m, no pressure can be computed with it");
            return Err(BuildError::new(what));
        }
        let critical = yields / summits.deviation;
        let kinks = RANGES.map(|x| x * critical);
        let loads = LogTable::new(&kinks, |t| pressure * load(t / critical, factor));
        Ok(Box::new(Yielding {
            range: summits.range(|d| loads.value(d)),
            areas: LogTable::new(&kinks, |t| area * contact_area(t / critical)),
            summits,
            loads,
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

/// Overlaps over the critical one at which the fits change.
const RANGES: [f64; 3] = [1.0, 6.0, 110.0];

/// Load of a summit over that at which it yields, at the overlap `x` over the critical one.
fn load(x: f64, factor: f64) -> f64 {
    let [elastic, spreads, flows] = RANGES;
    if x <= elastic {
        x * x.sqrt()
    } else if x <= spreads {
        1.03 * elementary::powf(x, 1.425)
    } else if x <= flows {
        1.40 * elementary::powf(x, 1.263)
    } else {
        3.0 / factor * x
    }
}

/// Area of contact of a summit over that at which it yields.
fn contact_area(x: f64) -> f64 {
    let [elastic, spreads, flows] = RANGES;
    if x <= elastic {
        x
    } else if x <= spreads {
        0.93 * elementary::powf(x, 1.136)
    } else if x <= flows {
        0.94 * elementary::powf(x, 1.146)
    } else {
        2.0 * x
    }
}

#[derive(Debug)]
struct Yielding {
    summits: Summits,
    loads: LogTable,
    areas: LogTable,
    range: f64,
    friction_coefficient: f64,
}

impl Contact for Yielding {
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]) {
        for (p, h) in pressure.iter_mut().zip(separation) {
            *p = self.loads.value(self.summits.distance(*h));
        }
    }
    fn range(&self) -> f64 {
        self.range
    }
    fn mean_gap(&self, separation: f64) -> f64 {
        self.summits.mean_gap(separation)
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
    /// Never above 1: summits that have grown together are no spheres any more.
    fn real_area(&self, separation: &[f64], ratio: &mut [f64]) -> bool {
        for (r, h) in ratio.iter_mut().zip(separation) {
            *r = self.areas.value(self.summits.distance(*h)).min(1.0);
        }
        true
    }
}
