//! Squeeze films between ring and groove flanks.

use gudgeon_core::geometry::FlankOil;
use gudgeon_core::kinds::{Flank, FlankCtx, FlankFilm, FlankLaw, FlankResistance, FlankSpec};
use gudgeon_core::quantity::{Fraction, PosLength, PosPressure, Ratio, quantity};
use gudgeon_core::states::Stateful;
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::{check_fill, check_oil};

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

pub(super) fn default_roughness() -> PosLength {
    quantity(0.4e-6)
}
pub(super) fn default_separation() -> Ratio<Fraction> {
    quantity(0.1)
}
pub(super) fn default_tension() -> PosPressure {
    quantity(1e5)
}

impl Default for SqueezeFilm {
    fn default() -> Self {
        Self { roughness: default_roughness(), separation: default_separation(), tension: default_tension() }
    }
}

#[register_model(
    name = "squeeze_film",
    summary = "oil squeezed out between ring and both groove flanks, with cavitation when drawn apart; gas passes beside it",
    equations = "approach: F = mu A w^2 f^3 v / (h + sigma)^3;  separation: X/(1 + X/(p_t f A)), X = chi mu A w^2 f^3 v / (h + sigma)^3;  \
                h = s and c - s",
    validity = "Parallel flanks, the same oil-filled strip on both at all times, thin compared with its width; no oil transport, no twist. Thicker oil holds a ring \
               off its seat and does not close the gap there: blow-by rises with viscosity; `wetted_strip` has one oil for both. \
               Sensitive to the oil fill (cube) and, for seated rings, to the roughness distance (inverse cube).",
    references = ["reynolds1886", "cameron1966"],
    example = "roughness = \"0.4 um\"\nseparation = 0.1\n",
)]
impl FlankSpec for SqueezeFilm {
    fn build(&self, ctx: &FlankCtx) -> Result<Box<dyn Flank>, BuildError> {
        check_fill(ctx)?;
        check_oil(ctx)?;
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

#[derive(Clone, Copy)]
struct Runtime {
    /// Damping per area times height cubed \[Pa s m²\].
    strip: f64,
    roughness: f64,
    separation: f64,
    /// Greatest tension per flank area \[Pa\].
    tension: f64,
}

impl Runtime {
    /// The film on a flank of the annulus `area` \[m²\] at the distance `h` \[m\].
    fn film(&self, h: f64, area: f64) -> FlankFilm {
        let gap = h.max(0.0) + self.roughness;
        let approach = area * self.strip / (gap * gap * gap);
        FlankFilm { approach, apart: self.separation * approach, tension: area * self.tension }
    }

    fn resist(&self, s: f64, clearance: f64, area: f64) -> FlankResistance {
        let [lower, upper] = [s, clearance - s].map(|h| [self.film(h, area), FlankFilm::default()]);
        FlankResistance { lower, upper }
    }
}

impl Stateful for Runtime {}

impl Flank for Runtime {
    fn law(&self) -> Box<dyn FlankLaw> {
        Box::new(*self)
    }
}

impl FlankLaw for Runtime {
    fn force(&self, _: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> f64 {
        self.resist(s, clearance, area).force(v)
    }

    fn resistance(&self, _: &FlankOil, s: f64, clearance: f64, area: f64) -> Option<FlankResistance> {
        Some(self.resist(s, clearance, area))
    }
}
