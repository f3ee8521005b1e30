use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, PosPressure, PosRatio, Ratio, quantity};
use gudgeon_core::sets::Sets;
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

/// Elastic contact of the crests of triangular machining grooves with a plane.
///
/// ```text
/// P_w = δ E' / 1.077        δ = max(Ω - h, 0)        line load of one crest
/// p   = P_w / λ             mean pressure
/// 1/E' = (1-ν1²)/E1 + (1-ν2²)/E2
/// ```
///
/// Ω is the amplitude of the waviness, λ its pitch, `h` the separation of the mean planes. A wedge on an elastic half-plane carries
/// `P_w = q E' cot α` over the half width `q`, and its load deflects the half-plane by `1.0779 P_w/E'`, whatever its angle. In two
/// dimensions a deflection is known only up to a constant that depends on how far away it is measured from; the factor stands for
/// that choice. The modulus is that of Greenwood and Tripp, as everywhere here ([`composite_modulus`](crate::composite_modulus)).
///
/// A skirt may have the crests as lines of their own: `P_w = p λ`.
///
/// Source: Loureiro 2009, after Johnson's wedge.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = Sets(include_str!("crest_wedge.json")))]
pub struct CrestWedge {
    /// Amplitude Ω of the waviness: half the distance from trough to crest.
    pub amplitude: PosLength,
    /// Pitch λ of the waviness.
    pub pitch: PosLength,
    /// Composite modulus E' with `1/E' = Σ (1-ν²)/E`: about 45 GPa for aluminium on cast iron.
    pub composite_modulus: PosPressure,
    /// Deflection of a crest over its line load over E'.
    #[serde(default = "published")]
    pub deflection: PosRatio,
    /// Coefficient of friction of the load that the crests carry.
    #[serde(default = "boundary")]
    pub friction_coefficient: Ratio<NonNegative>,
}

fn published() -> PosRatio {
    quantity(1.077)
}
fn boundary() -> Ratio<NonNegative> {
    quantity(0.15)
}

#[register_model(
    name = "crest_wedge",
    summary = "elastic wedges: crests of machining grooves on a plane",
    equations = "p = max(Omega - h, 0) E' / (1.077 lambda);  1/E' = sum (1-nu^2)/E",
    validity = "Elastic crests, contact much narrower than the pitch. The slope of the pressure jumps where the crests touch, at h = Omega.",
    references = ["loureiro2009", "johnson1985"],
    example = "amplitude = \"4 um\"\npitch = \"0.25 mm\"\ncomposite_modulus = \"44.52 GPa\"\n",
)]
impl ContactSpec for CrestWedge {
    fn build(&self) -> Result<Box<dyn Contact>, BuildError> {
        let stiffness = self.composite_modulus.si() / (self.deflection.si() * self.pitch.si());
        if !(stiffness.is_normal() && (stiffness * self.amplitude.si()).is_normal()) {
            return Err(BuildError::new(format!(
                "the crests have the stiffness {stiffness:e} Pa/m, no pressure can be computed with it"
            )));
        }
        Ok(Box::new(Wedges {
            amplitude: self.amplitude.si(),
            stiffness,
            friction_coefficient: self.friction_coefficient.si(),
        }))
    }
}

#[derive(Debug)]
struct Wedges {
    amplitude: f64,
    /// Mean pressure per approach \[Pa/m\].
    stiffness: f64,
    friction_coefficient: f64,
}

impl Contact for Wedges {
    fn pressure(&self, separation: &[f64], pressure: &mut [f64]) {
        for (p, &h) in pressure.iter_mut().zip(separation) {
            // The bound keeps the pressure of an absurd approach a number.
            *p = (self.stiffness * (self.amplitude - h).max(0.0)).min(f64::MAX);
        }
    }
    fn range(&self) -> f64 {
        self.amplitude
    }
    /// Of triangular waves, whose heights are spread evenly from trough to crest.
    fn mean_gap(&self, separation: f64) -> f64 {
        let over_trough = (separation + self.amplitude).max(0.0);
        if separation < self.amplitude {
            over_trough * over_trough / (4.0 * self.amplitude)
        } else {
            separation
        }
    }
    fn floor(&self) -> Option<f64> {
        None
    }
    fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }
}
