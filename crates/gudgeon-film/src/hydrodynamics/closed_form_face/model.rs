use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceCtx, Hydrodynamics, HydrodynamicsSpec, Rheology, RheologyScope};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::cavity_shear::CavityShear;
use super::film::Film;
use super::parabola::Parabola;
use super::table::Table;
use crate::cavitation::Cavitation;
use crate::hydrodynamics::averaged::Averaged;
use crate::hydrodynamics::check_face::check_face;

/// Exact film under a ring face: Reynolds' equation integrated in closed form, without a grid.
///
/// With `h(x) = h + drop(x)`, `u` the velocity of the liner along `+x` seen from the ring and `ḣ` the squeeze velocity, the
/// flux per metre of circumference and the pressure of a full film are
///
/// `q(x) = u h/2 - h³ p'/(12 μ) = q0 - ḣ x`,  `p' = 12 μ (u h/2 + ḣ x - q0)/h³`,
///
/// and on a parabola or a straight line every integral of that is elementary. Load and friction are
///
/// `W = ∫ (p - p_cav) dx`,  `F_ring = ∫ (μu/h - h p'/2) dx`,  `F_liner = ∫ (μu/h + h p'/2) dx`,
///
/// `F_slope = -∫ (p - p_cav) h' dx`, with `F_ring + F_slope = F_liner - [(p - p_cav) h]` over the two edges.
///
/// Fully flooded: both edges are covered with oil at the gas pressure next to them. An edge pressure below `p_cav` counts
/// as `p_cav`, except with `full_sommerfeld`. What happens where oil would have to pull is the choice of `cavitation`.
///
/// With `roughness` or `shear_thinning` the pressures have one viscosity `μ_p` and one sliding speed `t u`, the drags factors of their own, such that a film
/// that is squeezed and one that slides press and drag as with the values of every place: `μ_p = S/S_0`, `t = W/(μ_p W_0)`, with
/// `S = ∫ r x (Y - Ȳ) dx`, `W = ∫ max(0, ±∫ r (h_c - h̄_c) dx') dx`, `r = μ(γ̇)/(φ_x h_p³)`, `γ̇ = u/h_p`, over those of the smooth film; `φ_s` is in `h_c`, `φ_fs`
/// in the drags. `gridded_face` has the values of every place. Beside it loads and drags of sliding barrels and tapers are within 1 % from 1.3 roughness heights
/// on, within 2 % at two thirds of one and within 12 % at a third; a taper behind a land is within 3, 15 and 30 %. Where squeeze and a face that draws the film
/// apart act together so near to contact, the little load that is left is not known.
///
/// Good to 12 digits for a film that covers a fair part of the face; the load of a sliver at an edge to 12 digits of the
/// edge pressure times the face length.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClosedFormFace {
    /// What happens where the pressure would fall below `p_cav`.
    #[serde(default)]
    pub cavitation: Cavitation,
    /// Friction of the oil that is left in the cavity.
    #[serde(default)]
    pub cavity_shear: CavityShear,
}

#[register_model(
    name = "closed_form_face",
    summary = "exact Reynolds film on parabola or straight pieces, with a choice of cavitation conditions",
    equations = "q = u h/2 - h^3 p'/(12 mu) = q0 - hdot x;  p' = 12 mu (u h/2 + hdot x - q0)/h^3, integrated in closed form;  \
                mass_conserving: p = p' = 0 at rupture, flux carried through the cavity u h_r/2 - hdot (x - x_r) >= 0, \
                same flux at reformation;  swift_stieber: p = p_cav from the rupture to the trailing edge;  \
                half_sommerfeld: max(p, p_cav);  load = int (p - p_cav) dx;  shear = int (mu u/h -+ h p'/2) dx, \
                in the cavity weighted with the filled fraction",
    validity = "Fully flooded, narrow face (no flow along the circumference), one viscosity: flow factors and shear thinning as averages over the face. \
               A face that waves up and down has one film under swift_stieber, the one at the leading edge. \
               The cavity has no history: transients shorter than the passage over the face are not resolved.",
    references = ["reynolds1886", "jakobsson1957", "cameron1966", "dowson1979"],
    example = "cavitation = \"mass_conserving\"\ncavity_shear = \"streamers\"\n",
)]
impl HydrodynamicsSpec for ClosedFormFace {
    fn build(&self, ctx: &FaceCtx<'_>) -> Result<Box<dyn Hydrodynamics>, BuildError> {
        check_face(ctx.face)?;
        let shear = match (self.cavity_shear, self.cavitation) {
            (CavityShear::Auto, Cavitation::HalfSommerfeld | Cavitation::FullSommerfeld) => CavityShear::Full,
            (CavityShear::Auto, _) => CavityShear::Streamers,
            (s, _) => s,
        };
        if let FaceProfile::Parabola { length, curvature, apex } = ctx.face {
            let up = Parabola::new(*length, *curvature, *apex);
            let down = up.mirrored();
            return Ok(Box::new(Film::new(up, down, self.cavitation, shear)));
        }
        let up = Table::new(&ctx.face.nodes().unwrap_or_default());
        let down = up.mirrored();
        Ok(Box::new(Film::new(up, down, self.cavitation, shear)))
    }
    fn scope(&self) -> RheologyScope {
        RheologyScope { roughness: true, shear_thinning: true, ..RheologyScope::default() }
    }

    fn build_with(
        &self,
        ctx: &FaceCtx<'_>,
        rheology: &Rheology,
    ) -> Result<Box<dyn Hydrodynamics>, BuildError> {
        let film = self.build(ctx)?;
        match rheology.beyond(self.scope()) {
            Some(kind) => Err(BuildError::new(format!("this film has no `{kind}`"))),
            None if rheology.is_plain() => Ok(film),
            None => Ok(Box::new(Averaged::new(film, ctx.face, rheology))),
        }
    }
}
