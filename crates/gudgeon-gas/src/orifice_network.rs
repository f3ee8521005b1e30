//! Orifices everywhere, their areas from the geometry of the instant.

use std::f64::consts::TAU;

use gudgeon_core::geometry::{BackVolume, RingGeometry};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::{Fraction, Length, NonNegative, PosLength, PosTime, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::gas_temperature::GasTemperature;
use crate::options::{Elimination, FilmHeight};
use crate::orifice::Orifice;
use crate::pack_network::{PackOptions, with_orifice_law};
use crate::passage_law::Area;
use crate::ring_passages::{Openings, PassageModel, RingPassages};
use crate::spaces::lifted;

/// Every passage around a ring is an orifice whose area follows from where the ring is.
///
/// Per ring, with the film thickness `h`, the height `s` above the lower groove flank, the axial clearance `c`, the liner radius
/// `R_c + δ`, the piston radii `R_p` above and below the groove, the running gap `g + 2πδ` and the chamfer area `A_ch`:
///
/// ```text
/// A_gap   = (g + 2πδ) (R_c + δ - R_p,above - h) + A_ch
/// A_upper = 2π R_p,above (c - s + ε_upper) + split A_gap        land above  -> space behind
/// A_lower = 2π R_p,below (s + ε_lower)     + split A_gap        space behind -> land below
/// A_face  = 2π (R_c + δ - h) (ε_face + x²/(x + h_o/10)) + (1 - split) A_gap        land above  -> land below
/// x       = max(h - h_o, 0)       h_o = face_oil
/// ```
///
/// With the published split of ½ a ring that seals at its flanks still leaks through one whole gap: half of it through the groove,
/// half directly. A groove that is vented, or open to the land below (above) it, has no volume of its own: its paths end in the crankcase, or its upper
/// (lower) one in that land.
/// A sealed ring has no flank paths, and its whole gap is direct.
///
/// `s` is kept within 0 and `c`, and `A_gap` above zero, but for the scheme `substep_march`, which takes them as they come, as published.
///
/// Gas temperatures are those of the walls (isothermal volumes); the flow in an orifice is adiabatic.
///
/// Source: zottin1992 (areas and network), furuhama1961 (orifices between rings, discharge coefficient).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OrificeNetwork {
    /// Orifice law.
    #[serde(default)]
    pub orifice: Orifice,
    /// Share of the end-gap area that leads through the groove (in at the upper flank, out at the lower one); the rest leads
    /// directly from land to land.
    #[serde(default = "default_split")]
    pub gap_split: Ratio<Fraction>,
    /// Whether the areas and the volume behind the ring follow the film thickness or take it as `nominal_film`. With `nominal` the
    /// gas flow is independent of the films. With given gap areas, given volumes, no face leak and straight grooves it is so anyway.
    #[serde(default)]
    pub film_height: FilmHeight,
    /// Film thickness for `film_height = "nominal"`.
    #[serde(default = "default_film")]
    pub nominal_film: Length<NonNegative>,
    /// Lift, as a fraction of the axial clearance, over which the leak of a groove-edge chamfer fades away linearly. 0 closes it at
    /// the moment of lift-off, as published, which makes the flow discontinuous there.
    #[serde(default = "default_fade")]
    pub chamfer_fade: Ratio<Fraction>,
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

fn default_split() -> Ratio<Fraction> {
    quantity(0.5)
}
fn default_film() -> Length<NonNegative> {
    quantity(0.0)
}
fn default_fade() -> Ratio<Fraction> {
    quantity(PackOptions::default().chamfer_fade)
}

impl Default for OrificeNetwork {
    fn default() -> Self {
        Self {
            orifice: Orifice::default(),
            gap_split: default_split(),
            film_height: FilmHeight::default(),
            nominal_film: default_film(),
            chamfer_fade: default_fade(),
            gas_temperature: GasTemperature::default(),
            nusselt: crate::gas_temperature::parallel_walls(),
            face_oil: crate::options::fifty_micrometres(),
            eliminate: Elimination::default(),
            eliminate_below: crate::options::ten_nanoseconds(),
        }
    }
}

#[register_model(
    name = "orifice_network",
    summary = "orifices at gap, flanks and face, their areas from the ring positions of the instant",
    equations = "dm_i/dt = sum of flows;  p_i = m_i R T_i / V_i, T_i of the walls or from  \
                dU_i/dt = sum m' c_p T - Nu lambda V/s^2 (T_i - T_w) - p_i dV_i/dt;  m' = C_d A p_u / sqrt(R T_u) psi(p_d/p_u);  \
                A_gap = (g + 2 pi delta)(R_c + delta - R_p - h) + A_ch;  A_upper = 2 pi R_p (c - s + leak) + A_gap/2;  \
                A_lower = 2 pi R_p (s + leak) + A_gap/2;  A_direct = 2 pi (R_c + delta - h) (leak_face + what h exceeds face_oil by) + A_gap/2",
    validity = "Gas at wall temperature unless `gas_temperature` says otherwise; one-dimensional adiabatic flow through each opening. The narrow flank passages are longer than they \
               are high: as orifices they pass more than as laminar channels (see narrow_channel). Leak heights of seated flanks and face \
               are the least known inputs; 0.4 um instead of 0.02 um doubles the blow-by of a truck engine.",
    references = ["zottin1992", "furuhama1961", "smith1999"],
    example = "gap_split = 0.5\nfilm_height = \"instantaneous\"\norifice = { discharge = 0.86, law = \"isentropic\", laminar = 1e-3 }\n",
)]
impl GasFlowSpec for OrificeNetwork {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        let areas = OrificeAreas { gap_split: self.gap_split.si(), face_oil: self.face_oil.si() };
        let options = PackOptions {
            nominal_film: self.film_height.nominal(self.nominal_film),
            nusselt: self.gas_temperature.nusselt(self.nusselt),
            chamfer_fade: self.chamfer_fade.si(),
            eliminate_below: self.eliminate.below(self.eliminate_below),
        };
        Ok(Box::new(with_orifice_law("orifice_network", areas, &self.orifice, ctx.pack, options)?))
    }
}

/// The areas of [`OrificeNetwork`], for any law of a passage that is described by an [`Area`].
///
/// For the equations see there. The defaults are those of the model: half of the end gap leads through the groove, and oil fills the
/// gap between face and liner up to 50 µm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrificeAreas {
    /// Share of the end-gap area that leads through the groove, 0 to 1.
    pub gap_split: f64,
    /// Film thickness \[m\] up to which oil fills the gap between face and liner, above zero.
    pub face_oil: f64,
}

impl Default for OrificeAreas {
    fn default() -> Self {
        Self { gap_split: default_split().si(), face_oil: crate::options::fifty_micrometres().si() }
    }
}

impl<P: From<Area> + Default> PassageModel<P> for OrificeAreas {
    const SIGNED: bool = true;
    const GAP_HOLDS_FACE: bool = true;

    fn ring_passages(&self, _: usize, ring: &RingGeometry, o: &Openings) -> RingPassages<P> {
        let face = TAU * (o.liner_radius - o.h) * (ring.leak_face + lifted(o.h, self.face_oil));
        let orifice = |area| P::from(Area(area));
        if ring.back == BackVolume::Sealed {
            return RingPassages { gap: orifice(face + o.gap), ..RingPassages::default() };
        }
        let through_groove = self.gap_split * o.gap;
        RingPassages {
            upper: orifice(
                TAU * ring.piston_radius_above * (o.upper.narrowest() + o.leak[1]) + through_groove,
            ),
            lower: orifice(
                TAU * ring.piston_radius_below * (o.lower.narrowest() + o.leak[0]) + through_groove,
            ),
            gap: orifice(face + (o.gap - through_groove)),
            face: P::default(),
        }
    }

    fn drain(&self, area: f64) -> Option<P> {
        Some(P::from(Area(area)))
    }

    fn uses_film_height(&self, ring: &RingGeometry) -> bool {
        ring.leak_face > 0.0
    }
}
