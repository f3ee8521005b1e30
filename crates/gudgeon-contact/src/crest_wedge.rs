use gudgeon_core::kinds::{Contact, ContactSpec};
use gudgeon_core::quantity::{NonNegative, PosLength, PosPressure, PosRatio, Ratio, quantity};
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::composite_modulus;

    fn skirt() -> Box<dyn Contact> {
        let spec = CrestWedge {
            amplitude: quantity(4e-6),
            pitch: quantity(0.25e-3),
            composite_modulus: quantity(44.52e9),
            deflection: published(),
            friction_coefficient: boundary(),
        };
        spec.build().expect("builds")
    }

    fn pressure(m: &dyn Contact, h: f64) -> f64 {
        let mut p = [f64::NAN];
        m.pressure(&[h], &mut p);
        p[0]
    }

    #[test]
    fn line_load_of_a_crest() {
        let m = skirt();
        // 1 µm of 44.52 GPa over 1.077; three roundings, and that of Ω - h.
        assert!((pressure(&*m, 3e-6) * 0.25e-3 / (44.52e3 / 1.077) - 1.0).abs() < 1e-14);
        assert_eq!((pressure(&*m, 4e-6), pressure(&*m, 1.0), m.range(), m.floor()), (0.0, 0.0, 4e-6, None));
        // Linear on, through overlapping mean planes.
        assert!((pressure(&*m, -4e-6) / pressure(&*m, 0.0) - 2.0).abs() < 1e-15);
    }

    #[test]
    fn mean_gap_of_triangular_waves() {
        let m = skirt();
        // Half the waves are above their mean: (Ω/2)/2 is left where the mean planes touch; nothing where crests fill the troughs.
        for (h, gap) in
            [(0.0, 1e-6), (-2e-6, 0.25e-6), (-4e-6, 0.0), (-5e-6, 0.0), (4e-6, 4e-6), (7e-6, 7e-6)]
        {
            assert!((m.mean_gap(h) - gap).abs() < 1e-20, "{h}: {}", m.mean_gap(h));
        }
    }

    #[test]
    fn published_modulus_and_constant() {
        // Aluminium skirt 68.6 GPa, 0.34 on a cast iron block 98.0 GPa, 0.25: printed 44.52 GPa, cut after the fourth digit.
        assert!((composite_modulus([68.6e9, 98.0e9], [0.34, 0.25]) / 1e9 - 44.527).abs() < 0.0005);
        // -(2/π²) ∫_0^1 ln s ln{[1+√(1-s²)]/[1-√(1-s²)]} ds = 1.0779, the integral 5.3192: with s = 1/cosh t it is (4/π²) ∫ t ln cosh t sinh t/cosh² t dt,
        // by the trapezoidal rule on a function that is even in t and falls as t² exp(-t).
        let f = |t: f64| t * t.cosh().ln() * t.sinh() / (t.cosh() * t.cosh());
        let step = 1.0 / 64.0;
        let sum: f64 = (1..64 * 60).map(|i| step * f(step * f64::from(i))).sum();
        let exact = 4.0 / (std::f64::consts::PI * std::f64::consts::PI) * sum;
        assert!((0.5 * std::f64::consts::PI.powi(2) * exact - 5.3192).abs() < 5e-5, "{exact}");
        // The published 1.077 is that, cut.
        assert!((published().si() / exact - 1.0).abs() < 1e-3);
    }

    #[test]
    fn skirt_touching_at_its_lower_end() {
        // Loureiro's skirt: radius 38.24 mm, half angle 0.6213, height 30.3 mm, clearance 10 µm, eccentricities -1 µm on top and -6.2 µm
        // below; grooves down to 30.25 mm. A static point of another implementation, twenty steps in angle by the trapezoidal rule:
        // 230.65 N and, at 0.15, a friction of 34.763 N from five crests.
        let m = skirt();
        let (radius, half_angle, height, pitch) = (0.03824, 0.6213, 0.0303, 0.25e-3);
        let (mut force, mut friction, mut crests) = (0.0, 0.0, 0);
        for k in 0..=121 {
            let e = -1.0 - 5.2 * pitch * f64::from(k) / height;
            let mut touched = false;
            for i in 0..=20 {
                let angle = half_angle * (f64::from(i) / 10.0 - 1.0);
                let weight = if i == 0 || i == 20 { 0.05 } else { 0.1 } * half_angle;
                let line = pitch * pressure(&*m, (10.0 + e * angle.cos()) * 1e-6);
                touched |= line > 0.0;
                force += radius * weight * line * angle.cos();
                friction += radius * weight * line * m.friction_coefficient();
            }
            crests += i32::from(touched);
        }
        // Half a unit of the last digit printed.
        assert!((force - 230.65).abs() < 0.005 && (friction - 34.763).abs() < 0.0005, "{force} {friction}");
        assert_eq!(crests, 5);
    }
}
