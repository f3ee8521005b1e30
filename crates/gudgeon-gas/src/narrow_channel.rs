//! Flanks and face as laminar channels, end gaps as orifices.

use gudgeon_core::geometry::RingGeometry;
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::{
    Length, NonNegative, PosLength, PosRatio, PosTime, PosViscosity, Ratio, quantity,
};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::gas_temperature::GasTemperature;
use crate::gas_viscosity::GasViscosity;
use crate::options::{Elimination, FilmHeight};
use crate::orifice::Orifice;
use crate::pack_network::{PackOptions, with_orifice_law};
use crate::passage::Passage;
use crate::ring_channels::{Channel, RingChannels, ring_channels};
use crate::ring_passages::{Openings, PassageModel, RingPassages};

/// Friction in a narrow channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ChannelFriction {
    /// Laminar, whatever the Reynolds number.
    Laminar,
    /// Laminar below a Reynolds number of about 2000 (of twice the height), with Blasius' turbulent friction factor above, and a
    /// smooth passage between.
    #[default]
    Blended,
}

/// How friction in a channel and the loss at its mouth are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mouth {
    /// Both losses are added.
    #[default]
    Added,
    /// The law that lets less through governs, channel or orifice, with a smooth change between them.
    Automatic,
}

/// Flank clearances and face leak as compressible laminar channels, end gaps as orifices.
///
/// For a passage of height `H` between parallel walls, perimeter `2π R` across and length `w` along the flow:
///
/// ```text
/// ṁ = 2π R H³ (p_a² - p_b²) / (24 μ R_g T w)
/// upper flank  H = c - s + leak_upper     R = R_p,above            w = radial thickness of the ring
/// lower flank  H = s + leak_lower         R = R_p,below            w = the same
/// face         H = leak_face + x²/(x + h_o/10)   R = liner radius  w = axial length of the running face;  x = max(h - h_o, 0), h_o = face_oil
/// ```
///
/// with the mean temperature of the spaces at both ends. The end gap leads directly from land to land, as an orifice of the whole
/// gap area. No channel passes more than an orifice of its own cross section: losses by friction and at the mouth are added, see
/// [`Passage::LimitedChannel`]. With `mouth = "automatic"` each passage is an orifice or a channel instead, whichever lets less through, see
/// [`Passage::AutomaticChannel`]: a channel where `Re < 48 C_d² w/H`, an orifice above, the Reynolds number formed with `2 H`. The radial thickness is taken as the length of the flank passage; the part of it that stands out
/// over the land, a few per cent, is not taken off.
///
/// A groove that is vented lets the upper-flank flow straight to the crankcase. A sealed ring has gap and face only.
///
/// Source: tian1996 and kuo1989 describe this class of models; sutherland1893 for the viscosity; furuhama1961 for the gaps.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NarrowChannel {
    /// Orifice law of the end gaps and of the mouths of the channels.
    #[serde(default)]
    pub orifice: Orifice,
    /// Viscosity of the gas: that of air (`sutherland`) or of combustion products (`burnt_gas`) at the temperature of the channel, or `constant`.
    #[serde(default)]
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
    /// Friction in the channels: laminar whatever the Reynolds number, or turbulent above the transition.
    #[serde(default)]
    pub friction: ChannelFriction,
    /// How friction in a channel and the loss at its mouth are joined: `added`, or `automatic`, an orifice or a channel, whichever lets less through.
    #[serde(default)]
    pub mouth: Mouth,
    /// Sharpness `n` of the change between orifice and channel with `mouth = "automatic"`, at least 1: where both laws give the same flow, the
    /// passage lets through `2^(-1/n)` of it (16 % less for 4), and where one gives half as much as the other, `2^-n/n` less than that (1.5 %).
    #[serde(default = "default_sharpness")]
    pub mouth_sharpness: PosRatio,
    /// Temperature of the gas on the lands and behind the rings: that of the walls (`walls`), or from a balance of energy (`energy_balance`), whose
    /// states stand beside the masses. Gas comes from the cylinder with the temperature of the top land in both; narrow channels have that of
    /// their walls.
    #[serde(default)]
    pub gas_temperature: GasTemperature,
    /// Nusselt number of the heat between gas and walls with `gas_temperature = "energy_balance"`, formed with twice the distance of the walls. 7.54
    /// is that of developed laminar flow between parallel walls; 0: no heat.
    #[serde(default = "crate::gas_temperature::parallel_walls")]
    pub nusselt: Ratio<NonNegative>,
    /// Film thickness up to which oil fills the gap between face and liner. Gas passes the face of a ring that is further away: without that a
    /// ring that gas lifts off the liner closes its own end gap and locks in the gas that lifts it.
    #[serde(default = "crate::options::fifty_micrometres")]
    pub face_oil: PosLength,
    /// Whether spaces behind rings that fill in less than `eliminate_below` are left out of the integration.
    #[serde(default)]
    pub eliminate: Elimination,
    /// Filling time for `eliminate = "auto"`, at a pressure difference of a tenth. What a space stores is left out, so the limit is
    /// much shorter than the time that accuracy asks of the pressures: spaces that fill in the default 10 ns change the blow-by of a
    /// ring that floats between its flanks by a few millionths.
    #[serde(default = "crate::options::ten_nanoseconds")]
    pub eliminate_below: PosTime,
}

fn default_viscosity() -> PosViscosity {
    quantity(2.5e-5)
}
fn default_sharpness() -> PosRatio {
    quantity(4.0)
}
fn default_film() -> Length<NonNegative> {
    quantity(0.0)
}

impl Default for NarrowChannel {
    fn default() -> Self {
        Self {
            orifice: Orifice::default(),
            gas_viscosity: GasViscosity::default(),
            viscosity: default_viscosity(),
            film_height: FilmHeight::default(),
            nominal_film: default_film(),
            friction: ChannelFriction::default(),
            mouth: Mouth::default(),
            mouth_sharpness: default_sharpness(),
            gas_temperature: GasTemperature::default(),
            nusselt: crate::gas_temperature::parallel_walls(),
            face_oil: crate::options::fifty_micrometres(),
            eliminate: Elimination::default(),
            eliminate_below: crate::options::ten_nanoseconds(),
        }
    }
}

#[register_model(
    name = "narrow_channel",
    summary = "flanks and face as compressible laminar channels, end gaps as orifices",
    equations = "dm_i/dt = sum of flows;  p_i = m_i R T_i / V_i, T_i of the walls or from  \
                dU_i/dt = sum m' c_p T - Nu lambda V/s^2 (T_i - T_w) - p_i dV_i/dt;  gap: m' = C_d A p_u / sqrt(R T_u) psi(p_d/p_u);  \
                channel: m' = 2 pi R H^3 (p_a^2 - p_b^2) / (24 mu R_g T w), limited by the orifice of area 2 pi R H;  \
                mouth = automatic: m' = (c^-n + o^-n)^(-1/n) of channel c and orifice o;  \
                friction = blended: times [1 + (Re/2039)^3]^(-1/7), Re = m'/(pi R mu)",
    validity = "Isothermal, inertia-free flow in the channels, which holds up to heights of about 10 to \
               20 um; wider passages pass over to the orifice law. Flanks parallel, dry.",
    references = ["tian1996", "kuo1989", "sutherland1893", "heywood1988", "furuhama1961", "blasius1913", "smith1999", "jobson1955"],
    example = "gas_viscosity = \"sutherland\"\n",
)]
impl GasFlowSpec for NarrowChannel {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        if self.mouth_sharpness.si() < 1.0 {
            return Err(BuildError::at(
                "mouth_sharpness",
                format!("{} is below 1, where channel and mouth together let through less than with their losses added", self.mouth_sharpness.si()),
            )
            .help("4 changes from one law to the other within a factor of 2 of their flows"));
        }
        let channels = Channels {
            per_ring: ring_channels(ctx.pack, |t| self.gas_viscosity.at(t, self.viscosity.si()))?,
            friction: self.friction,
            mouth: self.mouth,
            sharpness: self.mouth_sharpness.si(),
            face_oil: self.face_oil.si(),
        };
        let options = PackOptions {
            nominal_film: self.film_height.nominal(self.nominal_film),
            nusselt: self.gas_temperature.nusselt(self.nusselt),
            eliminate_below: self.eliminate.below(self.eliminate_below),
            ..PackOptions::default()
        };
        Ok(Box::new(with_orifice_law("narrow_channel", channels, &self.orifice, ctx.pack, options)?))
    }
}

/// The channels of a pack and how they are closed.
struct Channels {
    per_ring: Vec<RingChannels>,
    friction: ChannelFriction,
    mouth: Mouth,
    sharpness: f64,
    face_oil: f64,
}

impl Channels {
    fn passage(&self, channel: &Channel, height: f64) -> Passage {
        let (conductance, area) = (channel.conductance(height), channel.area(height));
        let turbulent = self.friction == ChannelFriction::Blended;
        match self.mouth {
            Mouth::Automatic => Passage::AutomaticChannel {
                conductance,
                area,
                unit_flow: if turbulent { channel.unit_flow() } else { f64::INFINITY },
                sharpness: self.sharpness,
            },
            Mouth::Added if turbulent => {
                Passage::BlendedChannel { conductance, area, unit_flow: channel.unit_flow() }
            }
            Mouth::Added => channel.limited(height),
        }
    }
}

impl PassageModel<Passage> for Channels {
    const HAS_FACE: bool = true;

    fn drain(&self, area: f64) -> Option<Passage> {
        Some(Passage::Orifice { area })
    }

    fn ring_passages(&self, i: usize, ring: &RingGeometry, o: &Openings) -> RingPassages<Passage> {
        let passage = |channel: &Channel, height: f64| self.passage(channel, height);
        self.per_ring[i].passages(ring, o, self.face_oil, passage, passage)
    }

    fn uses_film_height(&self, _: &RingGeometry) -> bool {
        false
    }
}
