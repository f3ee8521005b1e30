//! Flanks and face as laminar channels, end gaps as orifices.

use std::f64::consts::{PI, TAU};

use gudgeon_core::BuildError;
use gudgeon_core::geometry::{BackVolume, PackGeometry, RingGeometry};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::{Length, NonNegative, PosViscosity, quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::network::{Passage, channel_conductance, sutherland_viscosity};
use crate::orifice::Orifice;
use crate::orifice_network::{DEFAULT_CHAMFER_FADE, nominal};
use crate::pack::{FilmHeight, Openings, Pack, Passages, RingPassages};

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

/// Flank clearances and face leak as compressible laminar channels, end gaps as orifices.
///
/// For a passage of height `H` between parallel walls, perimeter `2π R` across and length `w` along the flow:
///
/// ```text
/// ṁ = 2π R H³ (p_a² - p_b²) / (24 μ R_g T w)
/// upper flank  H = c - s + leak_upper     R = R_p,above            w = radial thickness of the ring
/// lower flank  H = s + leak_lower         R = R_p,below            w = the same
/// face         H = leak_face              R = liner radius         w = axial length of the running face
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
        }
    }
}

impl NarrowChannel {
    fn pack(&self, pack: &PackGeometry) -> Result<Pack<Channels>, BuildError> {
        let law = self.orifice.build(pack.gamma, pack.gas_constant).map_err(|e| e.within("orifice"))?;
        let conductance = |perimeter: f64, length: f64, t_a: f64, t_b: f64| {
            let t = 0.5 * (t_a + t_b);
            let mu = match self.gas_viscosity {
                GasViscosity::Sutherland => sutherland_viscosity(t),
                GasViscosity::Constant => self.viscosity.si(),
            };
            channel_conductance(perimeter, 1.0, length, mu, pack.gas_constant * t)
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
                break; // Pack::new reports the missing land.
            };
            let behind = match ring.back {
                BackVolume::Geometric | BackVolume::Fixed(_) => ring.back_temperature,
                BackVolume::Drained | BackVolume::Sealed => below.temperature,
            };
            let (upper, lower) = (TAU * ring.piston_radius_above, TAU * ring.piston_radius_below);
            per_ring.push(RingConductances {
                upper: conductance(upper, ring.width, above.temperature, behind),
                lower: conductance(lower, ring.width, behind, below.temperature),
                face: conductance(
                    2.0 * PI * pack.bore_radius,
                    ring.face.length(),
                    above.temperature,
                    below.temperature,
                ),
            });
        }
        let film = nominal(self.film_height, self.nominal_film);
        let bore_circumference = 2.0 * PI * pack.bore_radius;
        Pack::new(Channels { per_ring, bore_circumference }, pack, law, film, DEFAULT_CHAMFER_FADE)
    }
}

#[typetag::serde(name = "narrow_channel")]
impl GasFlowSpec for NarrowChannel {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        Ok(Box::new(self.pack(ctx.pack)?))
    }
}

gudgeon_core::register_model! {
    NarrowChannel,
    kind: "gas_flow",
    name: "narrow_channel",
    summary: "flanks and face as compressible laminar channels, end gaps as orifices",
    equations: "dm_i/dt = sum of flows;  p_i = m_i R T_i / V_i;  gap: m' = C_d A p_u / sqrt(R T_u) psi(p_d/p_u);  \
                channel: m' = 2 pi R H^3 (p_a^2 - p_b^2) / (24 mu R_g T w), limited by the orifice of area 2 pi R H",
    validity: "Laminar, isothermal, inertia-free flow in the channels, which holds up to heights of about 10 to 20 um; wider passages pass over \
               to the orifice law. Flanks parallel, dry.",
    references: ["tian1996", "kuo1989", "sutherland1893", "furuhama1961"],
    example: "gas_viscosity = \"sutherland\"\n",
}

/// Channel conductances of one ring for a height of 1 m.
#[derive(Debug, Clone, Copy)]
struct RingConductances {
    upper: f64,
    lower: f64,
    face: f64,
}

struct Channels {
    per_ring: Vec<RingConductances>,
    bore_circumference: f64,
}

impl Passages for Channels {
    const NAME: &'static str = "narrow_channel";
    const FACE: bool = true;

    fn passages(&self, i: usize, ring: &RingGeometry, o: &Openings) -> RingPassages {
        let k = self.per_ring[i];
        let channel = |unit: f64, perimeter: f64, height: f64| {
            if height > 0.0 {
                Passage::LimitedChannel {
                    conductance: unit * height * height * height,
                    area: perimeter * height,
                }
            } else {
                Passage::Closed
            }
        };
        let (upper, lower) = if ring.back == BackVolume::Sealed {
            (Passage::Closed, Passage::Closed)
        } else {
            (
                channel(k.upper, TAU * ring.piston_radius_above, o.upper + ring.leak_upper),
                channel(k.lower, TAU * ring.piston_radius_below, o.lower + ring.leak_lower),
            )
        };
        RingPassages {
            upper,
            lower,
            gap: Passage::Orifice { area: o.gap },
            face: channel(k.face, self.bore_circumference, ring.leak_face),
        }
    }

    fn uses_film_height(&self, _: &RingGeometry) -> bool {
        false
    }
}
