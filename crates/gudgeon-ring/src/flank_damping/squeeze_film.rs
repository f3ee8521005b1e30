//! Squeeze films between ring and groove flanks.

use gudgeon_core::kinds::{FlankDamping, FlankDampingCtx, FlankDampingSpec};
use gudgeon_core::quantity::{Fraction, PosLength, PosPressure, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Oil squeezed out between the ring and the two groove flanks.
///
/// Reynolds' equation for a strip of the radial width `L = f_o w`, wetted on both flanks, gives per length of circumference
/// `f = -μ L³ h'/h³`, so a flank at the distance `h` resists an approach with the velocity `v_a` by
///
/// ```text
/// F_approach = μ A w² f_o³ v_a / (h + σ)³
/// ```
///
/// with `h = s` below and `h = c - s` above the ring and the flank annulus `A`. The distance `σ` in which the roughness
/// peaks keep the flanks apart makes the force finite: a ring lands in a finite time and lifts off again.
///
/// A film that is drawn apart cannot hold tension: it cavitates and sucks in gas. With the same linear law `X = χ μ A w² f_o³ |v| / (h + σ)³`,
/// of which the fraction `χ` (`separation`) stays liquid, and the greatest tension `p_t`,
///
/// ```text
/// F_separate = X / (1 + X / (p_t f_o A))      opposing the separation
/// ```
///
/// Source: reynolds1886 (squeeze film), cameron1966.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SqueezeFilm {
    /// Distance `σ` at which roughness peaks hold seated flanks apart: combined roughness of ring and groove flank.
    #[serde(default = "default_roughness")]
    pub roughness: PosLength,
    /// Fraction `χ` of the film that stays liquid while the flanks are drawn apart. 0: a separating flank does not resist.
    #[serde(default = "default_separation")]
    pub separation: Ratio<Fraction>,
    /// Greatest mean tension `p_t` of a film that is drawn apart: the pressure around it less the cavitation pressure.
    #[serde(default = "default_tension")]
    pub tension: PosPressure,
}

fn default_roughness() -> PosLength {
    quantity(0.4e-6)
}
fn default_separation() -> Ratio<Fraction> {
    quantity(0.1)
}
fn default_tension() -> PosPressure {
    quantity(1e5)
}

impl Default for SqueezeFilm {
    fn default() -> Self {
        Self { roughness: default_roughness(), separation: default_separation(), tension: default_tension() }
    }
}

#[register_model(
    name = "squeeze_film",
    summary = "physical: oil squeezed out between ring and both groove flanks, with cavitation when drawn apart",
    equations = "approach: F = mu A w^2 f^3 v / (h + sigma)^3;  separation: X/(1 + X/(p_t f A)), X = chi mu A w^2 f^3 v / (h + sigma)^3;  \
                h = s and c - s",
    validity = "Parallel flanks, the same oil-filled strip on both at all times, thin compared with its width; no oil transport, no twist. \
               Sensitive to the oil fill (cube) and, for seated rings, to the roughness distance (inverse cube).",
    references = ["reynolds1886", "cameron1966"],
    example = "roughness = \"0.4 um\"\nseparation = 0.1\n",
)]
impl FlankDampingSpec for SqueezeFilm {
    fn build(&self, ctx: &FlankDampingCtx) -> Result<Box<dyn FlankDamping>, BuildError> {
        crate::check_fill(ctx)?;
        crate::check_oil(ctx)?;
        let wetted = ctx.oil_fill * ctx.width;
        Ok(Box::new(Runtime {
            // μ A w² f³, per area.
            strip: ctx.mu * wetted * wetted * ctx.oil_fill,
            roughness: self.roughness.si(),
            separation: self.separation.si(),
            tension: self.tension.si() * ctx.oil_fill,
        }))
    }
}

struct Runtime {
    /// Damping per area times height cubed \[Pa s m²\].
    strip: f64,
    roughness: f64,
    separation: f64,
    /// Greatest tension per flank area \[Pa\].
    tension: f64,
}

impl Runtime {
    /// Force per area against the motion of a flank that approaches with `rate` (negative: separates).
    fn pressure(&self, h: f64, rate: f64) -> f64 {
        let gap = h.max(0.0) + self.roughness;
        let linear = self.strip * rate / (gap * gap * gap);
        if linear >= 0.0 || self.tension <= 0.0 {
            linear
        } else {
            let x = self.separation * linear;
            x / (1.0 - x / self.tension)
        }
    }
}

impl FlankDamping for Runtime {
    fn force(&self, s: f64, v: f64, clearance: f64, area: f64) -> f64 {
        area * (self.pressure(s, -v) - self.pressure(clearance - s, v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const C: f64 = 1e-4;
    const A: f64 = 1.8e-3;

    fn ctx() -> FlankDampingCtx {
        FlankDampingCtx { ring: 0, rings: 3, oil_fill: 0.6, width: 5e-3, mu: 0.01 }
    }

    fn built(spec: &SqueezeFilm) -> Box<dyn FlankDamping> {
        spec.build(&ctx()).expect("builds")
    }

    #[test]
    fn mirrored_passive_and_continuous() {
        let m = built(&SqueezeFilm::default());
        for k in -2..=52 {
            let s = C * k as f64 / 50.0;
            for v in [1e-9, 1e-6, 1e-3, 1.0] {
                let up = m.force(s, v, C, A);
                let down = m.force(s, -v, C, A);
                assert!(up < 0.0 && down > 0.0, "opposes the motion");
                let mirrored = -m.force(C - s, -v, C, A);
                // C - s is off by 1e-20 m, against the smallest gap of 0.4 µm, cubed.
                assert!((up - mirrored).abs() <= 1e-12 * up.abs(), "{up} {mirrored}");
            }
            assert_eq!(m.force(s, 0.0, C, A), 0.0);
        }
    }

    #[test]
    fn tension_is_limited_approach_is_not() {
        let m = built(&SqueezeFilm::default());
        // Drawn off the lower flank: 1 bar on the wetted 60 % of 18 cm² is 108 N, and the upper film 0.1 mm away adds
        // μ A w² f³ v/c³ = 9.7e-11/1e-12·v, at 1e-3 m/s 0.1 N.
        let pull = -m.force(0.0, 1e-3, C, A);
        assert!(pull > 107.0 && pull < 108.2, "{pull}");
        assert!(m.force(0.0, -1e-3, C, A) > 1e4);
        // Without separation the film above the ring is the only resistance.
        let free = built(&SqueezeFilm { separation: quantity(0.0), ..SqueezeFilm::default() });
        let expected = 0.01 * A * 25e-6 * 0.216 * 1e-3 / (C + 0.4e-6).powi(3);
        assert!((-free.force(0.0, 1e-3, C, A) / expected - 1.0).abs() < 1e-12);
    }

    #[test]
    fn massless_fall_follows_the_closed_form() {
        // W = μ L³ (A/w) h'/h³ integrates to t = μ A w² f³/(2 W) (1/h2² - 1/h1²), h = s + σ. A massless ring far from the upper flank;
        // the separating film above is off.
        let spec = SqueezeFilm { separation: quantity(0.0), ..SqueezeFilm::default() };
        let m = built(&spec);
        let (load, sigma) = (50.0, 0.4e-6);
        let k = 0.01 * A * 25e-6 * 0.216;
        let (h1, h2): (f64, f64) = (2e-5, 1e-6);
        let exact = k / (2.0 * load) * (h2.powi(-2) - h1.powi(-2));
        // Integrate dt = dh / v in ln h by Simpson's rule, v from the model's force (linear while approaching).
        let n = 4000;
        let (a, b) = (h2.ln(), h1.ln());
        let step = (b - a) / n as f64;
        let f = |x: f64| {
            let h = x.exp();
            h * m.force(h - sigma, -1.0, C, A) / load
        };
        let t: f64 = (0..=n)
            .map(|i| {
                let w = if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                };
                w * f(a + step * i as f64)
            })
            .sum::<f64>()
            * step
            / 3.0;
        // Simpson's error for exp(-2x) over steps of 7.5e-4 is (2·7.5e-4)^4/180 ~ 3e-14; the rest is rounding of h - σ + σ.
        assert!((t / exact - 1.0).abs() < 1e-11, "{t} {exact}");
    }
}
