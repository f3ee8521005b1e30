//! The pack as a labyrinth: one throttling a ring.

use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::{
    Bound as _, Fraction, Length, NonNegative, PosLength, PosRatio, Ratio, quantity,
};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::options::FilmHeight;
use crate::orifice_network::OrificeAreas;
use crate::pack_network::{PackNetwork, PackOptions};
use crate::throttling_law::ThrottlingLaw;

/// Every ring is one throttling of a labyrinth.
///
/// ```text
/// ṁ = C_d A p_u sqrt( (1 - r²) / (R_g T_u (1 - ln r)) )      r = p_d/p_u, not below 0.4711
/// ```
///
/// with the whole end gap as the area `A` of a seated ring, from land to land. In the steady state `n` rings of equal gaps at one temperature pass
/// what Martin's formula for a labyrinth says, `C_d A p_0 sqrt((1 - r²)/(R_g T (n - ln r)))` with `r = p_n/p_0`. Lands store gas as in the other
/// models, so it also holds for a cycle, for unequal gaps and temperatures. Flanks and face are throttlings likewise, of the areas of
/// [`OrificeNetwork`](crate::OrificeNetwork) with `gap_split = 0`.
///
/// Source: martin1908.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Labyrinth {
    /// Discharge coefficient `C_d`: effective over geometric area. 0.86 was measured for piston-ring gaps (0.8 to 0.9).
    #[serde(default = "default_discharge")]
    pub discharge: PosRatio,
    /// `ε` of the laminar branch: below a relative pressure difference of about `ε` the flow is proportional to the pressure difference instead of
    /// its square root.
    #[serde(default = "default_laminar")]
    pub laminar: Ratio<NonNegative>,
    /// Whether the areas and the volume behind the ring follow the film thickness or take it as `nominal_film`.
    #[serde(default)]
    pub film_height: FilmHeight,
    /// Film thickness for `film_height = "nominal"`.
    #[serde(default = "default_film")]
    pub nominal_film: Length<NonNegative>,
    /// Film thickness up to which oil fills the gap between face and liner. Gas passes the face of a ring that is further away.
    #[serde(default = "crate::options::fifty_micrometres")]
    pub face_oil: PosLength,
}

fn default_discharge() -> PosRatio {
    quantity(0.86)
}
fn default_laminar() -> Ratio<NonNegative> {
    quantity(1e-3)
}
fn default_film() -> Length<NonNegative> {
    quantity(0.0)
}

impl Default for Labyrinth {
    fn default() -> Self {
        Self {
            discharge: default_discharge(),
            laminar: default_laminar(),
            film_height: FilmHeight::default(),
            nominal_film: default_film(),
            face_oil: crate::options::fifty_micrometres(),
        }
    }
}

#[register_model(
    name = "labyrinth",
    summary = "every ring one throttling of a labyrinth (Martin), between lands that store gas",
    equations = "dm_i/dt = sum of flows;  p_i = m_i R T_i / V_i;  m' = C_d A p_u sqrt((1 - r^2) / (R T_u (1 - ln r)));  \
                n equal rings, steady: m' = C_d A p_0 sqrt((1 - r^2) / (R T (n - ln r)))",
    validity = "Isothermal flow through each throttling, whose velocity is lost behind it. Choked at a pressure ratio of 0.47 with 0.666 C_d A p/sqrt(R T), \
               3 % below the isentropic orifice of air. Ring flanks are openings, not channels (see narrow_channel).",
    references = ["martin1908", "furuhama1961"],
    example = "discharge = 0.86\n",
)]
impl GasFlowSpec for Labyrinth {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        if !Fraction::admits(self.discharge.si()) {
            return Err(BuildError::at(
                "discharge",
                format!("the discharge coefficient {} is greater than 1", self.discharge.si()),
            )
            .help("measured values for ring gaps lie between 0.6 and 0.9"));
        }
        let law = ThrottlingLaw::new(self.discharge.si(), self.laminar.si());
        let areas = OrificeAreas { gap_split: 0.0, face_oil: self.face_oil.si() };
        let options = PackOptions {
            nominal_film: self.film_height.nominal(self.nominal_film),
            ..PackOptions::default()
        };
        Ok(Box::new(PackNetwork::new("labyrinth", areas, law, ctx.pack, options)?))
    }
}
