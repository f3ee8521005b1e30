//! Flanks and face as laminar channels, end gaps as orifices.

use std::f64::consts::{PI, TAU};

use gudgeon_core::geometry::{BackVolume, PackGeometry, RingGeometry};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::{Length, NonNegative, PosLength, PosTime, PosViscosity, quantity};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::channel::{channel_conductance, sutherland_viscosity};
use crate::options::{Elimination, FilmHeight};
use crate::orifice::Orifice;
use crate::pack_network::{PackOptions, with_orifice_law};
use crate::passage::Passage;
use crate::ring_passages::{Openings, PassageModel, RingPassages};
use crate::spaces::lifted;

/// How viscous the gas is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GasViscosity {
    /// That of air at the temperature of the channel, by Sutherland's law.
    #[default]
    Sutherland,
    /// The constant `viscosity`.
    Constant,
}

/// Friction in a narrow channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ChannelFriction {
    /// Laminar, whatever the Reynolds number.
    #[default]
    Laminar,
    /// Laminar below a Reynolds number of about 2000 (of twice the height), with Blasius' turbulent friction factor above, and a
    /// smooth passage between.
    Blended,
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
/// [`Passage::LimitedChannel`]. The radial thickness is taken as the length of the flank passage; the part of it that stands out
/// over the land, a few per cent, is not taken off.
///
/// A drained groove lets the upper-flank flow straight to the land below. A sealed ring has gap and face only.
///
/// Source: tian1996 and kuo1989 describe this class of models; sutherland1893 for the viscosity; furuhama1961 for the gaps.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NarrowChannel {
    /// Orifice law of the end gaps and of the mouths of the channels.
    #[serde(default)]
    pub orifice: Orifice,
    /// Viscosity of the gas: that of air at the temperature of the channel (`sutherland`) or `constant`.
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
            face_oil: crate::options::fifty_micrometres(),
            eliminate: Elimination::default(),
            eliminate_below: crate::options::ten_nanoseconds(),
        }
    }
}

impl NarrowChannel {
    /// The channels of a pack, but for their heights.
    fn channels(&self, pack: &PackGeometry) -> Result<Channels, BuildError> {
        let channel = |perimeter: f64, length: f64, t_a: f64, t_b: f64| {
            let t = 0.5 * (t_a + t_b);
            let mu = match self.gas_viscosity {
                GasViscosity::Sutherland => sutherland_viscosity(t),
                GasViscosity::Constant => self.viscosity.si(),
            };
            Channel {
                perimeter,
                conductance: channel_conductance(perimeter, 1.0, length, mu, pack.gas_constant * t),
                unit_flow: 0.5 * perimeter * mu,
            }
        };
        let mut per_ring = Vec::with_capacity(pack.rings.len());
        for (i, ring) in pack.rings.iter().enumerate() {
            for (length, what) in [(ring.width, "radial thickness"), (ring.face.length(), "face length")] {
                if !(length > 0.0 && length.is_finite()) {
                    return Err(BuildError::new(format!("ring {} has the {what} {length:e} m", i + 1)));
                }
            }
            let Some([above, below]) = pack.lands.get(i..i + 2).and_then(|s| <&[_; 2]>::try_from(s).ok())
            else {
                break; // The network reports the missing land.
            };
            let behind = match ring.back {
                BackVolume::Geometric | BackVolume::Fixed(_) => ring.back_temperature,
                BackVolume::Drained | BackVolume::Sealed => below.temperature,
            };
            let (upper, lower) = (TAU * ring.piston_radius_above, TAU * ring.piston_radius_below);
            per_ring.push(RingChannels {
                upper: channel(upper, ring.width, above.temperature, behind),
                lower: channel(lower, ring.width, behind, below.temperature),
                face: channel(
                    2.0 * PI * pack.bore_radius,
                    ring.face.length(),
                    above.temperature,
                    below.temperature,
                ),
            });
        }
        Ok(Channels {
            per_ring,
            blended: self.friction == ChannelFriction::Blended,
            face_oil: self.face_oil.si(),
        })
    }
}

#[register_model(
    name = "narrow_channel",
    summary = "flanks and face as compressible laminar channels, end gaps as orifices",
    equations = "dm_i/dt = sum of flows;  p_i = m_i R T_i / V_i;  gap: m' = C_d A p_u / sqrt(R T_u) psi(p_d/p_u);  \
                channel: m' = 2 pi R H^3 (p_a^2 - p_b^2) / (24 mu R_g T w), limited by the orifice of area 2 pi R H;  \
                blended friction: times [1 + (Re/2039)^3]^(-1/7), Re = m'/(pi R mu)",
    validity = "Isothermal, inertia-free flow in the channels, laminar unless `friction` says otherwise, which holds up to heights of about 10 to \
               20 um; wider passages pass over to the orifice law. Flanks parallel, dry.",
    references = ["tian1996", "kuo1989", "sutherland1893", "furuhama1961", "blasius1913", "smith1999"],
    example = "gas_viscosity = \"sutherland\"\n",
)]
impl GasFlowSpec for NarrowChannel {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        let channels = self.channels(ctx.pack)?;
        let options = PackOptions {
            nominal_film: self.film_height.nominal(self.nominal_film),
            eliminate_below: self.eliminate.below(self.eliminate_below),
            ..PackOptions::default()
        };
        Ok(Box::new(with_orifice_law("narrow_channel", channels, &self.orifice, ctx.pack, options)?))
    }
}

/// One passage but for its height.
#[derive(Debug, Clone, Copy)]
struct Channel {
    perimeter: f64,
    /// Conductance for a height of 1 m.
    conductance: f64,
    /// Flow at a Reynolds number of one.
    unit_flow: f64,
}

/// The channels of one ring.
#[derive(Debug, Clone, Copy)]
struct RingChannels {
    upper: Channel,
    lower: Channel,
    face: Channel,
}

struct Channels {
    per_ring: Vec<RingChannels>,
    blended: bool,
    face_oil: f64,
}

impl PassageModel<Passage> for Channels {
    const HAS_FACE: bool = true;

    fn ring_passages(&self, i: usize, ring: &RingGeometry, o: &Openings) -> RingPassages<Passage> {
        let k = self.per_ring[i];
        let channel = |Channel { perimeter, conductance, unit_flow }: Channel, height: f64| {
            let (conductance, area) = (conductance * height * height * height, perimeter * height);
            if height <= 0.0 {
                Passage::Closed
            } else if self.blended {
                Passage::BlendedChannel { conductance, area, unit_flow }
            } else {
                Passage::LimitedChannel { conductance, area }
            }
        };
        let (upper, lower) = if ring.back == BackVolume::Sealed {
            (Passage::Closed, Passage::Closed)
        } else {
            (channel(k.upper, o.upper.laminar() + o.leak[1]), channel(k.lower, o.lower.laminar() + o.leak[0]))
        };
        RingPassages {
            upper,
            lower,
            gap: Passage::Orifice { area: o.gap },
            face: channel(k.face, ring.leak_face + lifted(o.h, self.face_oil)),
        }
    }

    fn uses_film_height(&self, _: &RingGeometry) -> bool {
        false
    }
}
