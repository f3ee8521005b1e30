//! End gaps as orifices, flanks that open only when the ring leaves its seat.

use std::f64::consts::PI;

use gudgeon_core::geometry::{BackVolume, RingGeometry};
use gudgeon_core::kinds::{GasFlow, GasFlowCtx, GasFlowSpec};
use gudgeon_core::quantity::{PosTime, quantity};
use gudgeon_core::{BuildError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::orifice::Orifice;
use crate::pack_network::{PackOptions, with_orifice_law};
use crate::passage::Passage;
use crate::ring_passages::{Openings, PassageModel, RingPassages};

/// Whether the space behind a seated ring is a volume of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BackVolumes {
    /// Joined to the land it faces by the open side of the groove.
    #[default]
    Separate,
    /// One volume with the land it faces.
    Merged,
}

/// End gaps that are always open, flanks that leak only while the ring is off its seat.
///
/// ```text
/// A_gap          = given area, or (g + 2πδ) (R_c + δ - R_p,above)          land above  -> land below
/// A_upper(1 - e) = π D c (1 - e)                                           land above  -> space behind
/// A_lower(e)     = π D c e                                                 space behind -> land below
/// ```
///
/// `e` is the position in the groove (0 on the lower flank, 1 on the upper one), `c` the axial clearance, `D` the bore. At the three
/// positions of the published model this is what it says: a seated ring opens the space behind it to one land through the whole
/// clearance and lets nothing past the seated flank; a ring in mid-groove opens both sides with half of the clearance area each.
/// Face and seated flanks leak nothing, so the film thickness has no influence: gap area, clearance and geometric volumes are taken
/// without a film.
///
/// A groove that is vented lets `A_upper` flow straight to the crankcase. A sealed ring has its gap only.
///
/// With `back_volumes = "merged"` the space behind a seated ring and the land it faces are one volume: a linear leak of conductance
/// `V/(R T τ)` beside the open flank makes their pressures equal within the time `merge_time` `τ`. The leak goes with `1 - 2e`
/// upwards and `2e - 1` downwards, so it vanishes in mid-groove, where both sides are open alike.
///
/// Source: tomanik1993 (models II and I), furuhama1961 (discharge coefficient).
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GapOrifice {
    /// Orifice law.
    #[serde(default)]
    pub orifice: Orifice,
    /// Whether the space behind a seated ring is a volume of its own (`separate`) or one with the land it faces (`merged`).
    #[serde(default)]
    pub back_volumes: BackVolumes,
    /// Time within which merged volumes have the same pressure. Far below the time of a degree of crank angle (28 µs at
    /// 6000 rpm); smaller values only make the system stiffer.
    #[serde(default = "default_merge_time")]
    pub merge_time: PosTime,
}

fn default_merge_time() -> PosTime {
    quantity(1e-7)
}

impl Default for GapOrifice {
    fn default() -> Self {
        Self {
            orifice: Orifice::default(),
            back_volumes: BackVolumes::default(),
            merge_time: default_merge_time(),
        }
    }
}

#[register_model(
    name = "gap_orifice",
    summary = "end gaps as orifices; flanks leak only while the ring is off its seat",
    equations = "dm_i/dt = sum of flows;  p_i = m_i R T_i / V_i;  m' = C_d A p_u / sqrt(R T_u) psi(p_d/p_u);  \
                A_gap given or gap x land clearance;  A_upper = pi D c (1 - e);  A_lower = pi D c e",
    validity = "Needs no film. Leaves out leaks past face and seated flanks, so it is a lower bound: models of this kind compute 2 to 6 times \
               less blow-by than is measured. Near the speed where rings start to float it has two periodic solutions.",
    references = ["tomanik1993", "furuhama1961", "smith1999"],
    example = "back_volumes = \"separate\"\n",
)]
impl GasFlowSpec for GapOrifice {
    fn build(&self, ctx: &GasFlowCtx<'_>) -> Result<Box<dyn GasFlow>, BuildError> {
        let pack = ctx.pack;
        let merge = (self.back_volumes == BackVolumes::Merged).then(|| self.merge_time.si());
        let leak = |t: f64| merge.map_or(0.0, |tau| 1.0 / (pack.gas_constant * t * tau));
        let areas = Areas {
            circumference: 2.0 * PI * pack.bore_radius,
            leak_per_volume: pack.rings.iter().map(|r| leak(r.back_temperature)).collect(),
            merge_time: merge,
        };
        // Face and seated flanks leak nothing: without a film.
        let options = PackOptions { nominal_film: Some(0.0), ..PackOptions::default() };
        Ok(Box::new(with_orifice_law("gap_orifice", areas, &self.orifice, pack, options)?))
    }
}

struct Areas {
    circumference: f64,
    /// `1 / (R T τ)`; 0 when volumes are separate.
    leak_per_volume: Vec<f64>,
    /// `τ`, of merged volumes.
    merge_time: Option<f64>,
}

impl PassageModel<Passage> for Areas {
    fn drain(&self, area: f64) -> Option<Passage> {
        Some(Passage::Orifice { area })
    }

    fn merge_time(&self) -> Option<f64> {
        self.merge_time
    }

    fn ring_passages(&self, i: usize, ring: &RingGeometry, o: &Openings) -> RingPassages<Passage> {
        let gap = Passage::Orifice { area: o.gap };
        if ring.back == BackVolume::Sealed {
            return RingPassages { gap, ..RingPassages::default() };
        }
        let flank = |height: f64, leak: f64| {
            let area = self.circumference * height;
            if leak > 0.0 { Passage::Tied { area, leak } } else { Passage::Orifice { area } }
        };
        let leak = self.leak_per_volume[i] * o.back_volume;
        RingPassages {
            upper: flank(o.upper.narrowest(), leak * (1.0 - 2.0 * o.lift_fraction)),
            lower: flank(o.lower.narrowest(), leak * (2.0 * o.lift_fraction - 1.0)),
            gap,
            face: Passage::Closed,
        }
    }

    fn uses_film_height(&self, _: &RingGeometry) -> bool {
        false
    }
}
