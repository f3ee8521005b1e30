//! Flanks as laminar channels without a loss at their mouths, end gaps as orifices: the classical crevice model.

use gudgeon_core::geometry::RingGeometry;
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::{Length, NonNegative, PosLength, PosViscosity, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::gas_temperature::GasTemperature;
use crate::gas_viscosity::GasViscosity;
use crate::options::FilmHeight;
use crate::orifice::Orifice;
use crate::pack_network::{PackOptions, with_orifice_law};
use crate::passage::Passage;
use crate::ring_channels::{Channel, RingChannels, ring_channels};
use crate::ring_passages::{Openings, PassageModel, RingPassages};

/// Flank clearances as compressible laminar channels, end gaps as orifices.
///
/// For a flank of the perimeter `W` = `2π R` around the piston, the height `h` and the length `L`, the radial thickness of the ring:
///
/// ```text
/// ṁ = W h³ (p_u² - p_d²) / (24 μ L R_g T)
/// upper flank  h = c - s + leak_upper     R = R_p,above
/// lower flank  h = s + leak_lower         R = R_p,below
/// gap          ṁ = C_d A_gap p_u / sqrt(R_g T_u) ψ(p_d/p_u)
/// ```
///
/// with the mean temperature of the spaces at both ends. There is no loss at the mouth of a flank: the law holds while the channel is narrow. An
/// open flank of some 50 µm would pass more than gas can at the speed of sound; what is behind it has the pressure of the land then, which is what
/// the law is for. The face of a ring passes nothing unless it is off the liner or leaks; what it passes then is limited by the orifice of its
/// cross section, as in [`NarrowChannel`](crate::NarrowChannel).
///
/// Source: namazian1982 (law of the flanks, orifices at the gaps); furuhama1961 (discharge coefficient); heywood1988 (viscosity).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NamazianHeywood {
    /// Orifice law of the end gaps.
    #[serde(default)]
    pub orifice: Orifice,
    /// Viscosity of the gas: that of combustion products (`burnt_gas`) or of air (`sutherland`) at the temperature of the channel, or `constant`.
    #[serde(default = "burnt")]
    pub gas_viscosity: GasViscosity,
    /// Viscosity for `gas_viscosity = "constant"`.
    #[serde(default = "default_viscosity")]
    pub viscosity: PosViscosity,
    /// Whether gap area, clearance and the volume behind the ring follow the film thickness or take it as `nominal_film`.
    #[serde(default)]
    pub film_height: FilmHeight,
    /// Film thickness for `film_height = "nominal"`.
    #[serde(default = "default_film")]
    pub nominal_film: Length<NonNegative>,
    /// Temperature of the gas on the lands and behind the rings: that of the walls (`walls`), or from a balance of energy (`energy_balance`), whose
    /// states stand beside the masses. Gas comes from the cylinder with the temperature of the top land in both; narrow channels have that of
    /// their walls.
    #[serde(default)]
    pub gas_temperature: GasTemperature,
    /// Nusselt number of the heat between gas and walls with `gas_temperature = "energy_balance"`, formed with twice the distance of the walls. 7.54
    /// is that of developed laminar flow between parallel walls; 0: no heat.
    #[serde(default = "crate::gas_temperature::parallel_walls")]
    pub nusselt: Ratio<NonNegative>,
    /// Film thickness up to which oil fills the gap between face and liner. Gas passes the face of a ring that is further away.
    #[serde(default = "crate::options::fifty_micrometres")]
    pub face_oil: PosLength,
}

const fn burnt() -> GasViscosity {
    GasViscosity::BurntGas
}
fn default_viscosity() -> PosViscosity {
    quantity(2.5e-5)
}
fn default_film() -> Length<NonNegative> {
    quantity(0.0)
}

impl Default for NamazianHeywood {
    fn default() -> Self {
        Self {
            orifice: Orifice::default(),
            gas_viscosity: burnt(),
            viscosity: default_viscosity(),
            film_height: FilmHeight::default(),
            nominal_film: default_film(),
            gas_temperature: GasTemperature::default(),
            nusselt: crate::gas_temperature::parallel_walls(),
            face_oil: crate::options::fifty_micrometres(),
        }
    }
}

#[register_model(
    name = "namazian_heywood",
    summary = "flanks as laminar channels without entrance loss, end gaps as orifices",
    equations = "dm_i/dt = sum of flows;  p_i = m_i R T_i / V_i, T_i of the walls or from  \
                dU_i/dt = sum m' c_p T - Nu lambda V/s^2 (T_i - T_w) - p_i dV_i/dt;  flank: m' = W h^3 (p_u^2 - p_d^2) / (24 mu L R_g T);  \
                gap: m' = C_d A p_u / sqrt(R T_u) psi(p_d/p_u)",
    validity = "Isothermal, inertia-free laminar flow in the flanks, up to heights of about 10 to 20 um; wider ones pass more than any gas can (see \
               narrow_channel, which adds the loss at the mouth). Flanks parallel, dry.",
    references = ["namazian1982", "furuhama1961", "heywood1988", "sutherland1893", "smith1999", "jobson1955"],
    example = "gas_viscosity = \"burnt_gas\"\n",
)]
impl GasFlowSpec for NamazianHeywood {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        let channels = Channels {
            per_ring: ring_channels(ctx.pack, |t| self.gas_viscosity.at(t, self.viscosity.si()))?,
            face_oil: self.face_oil.si(),
        };
        let options = PackOptions {
            nominal_film: self.film_height.nominal(self.nominal_film),
            nusselt: self.gas_temperature.nusselt(self.nusselt),
            ..PackOptions::default()
        };
        Ok(Box::new(with_orifice_law("namazian_heywood", channels, &self.orifice, ctx.pack, options)?))
    }
}

struct Channels {
    per_ring: Vec<RingChannels>,
    face_oil: f64,
}

impl PassageModel<Passage> for Channels {
    const HAS_FACE: bool = true;

    fn drain(&self, area: f64) -> Option<Passage> {
        Some(Passage::Orifice { area })
    }

    fn ring_passages(&self, i: usize, ring: &RingGeometry, o: &Openings) -> RingPassages<Passage> {
        let flank =
            |channel: &Channel, height: f64| Passage::Channel { conductance: channel.conductance(height) };
        self.per_ring[i].passages(ring, o, self.face_oil, flank, Channel::limited)
    }

    fn uses_film_height(&self, _: &RingGeometry) -> bool {
        false
    }
}
