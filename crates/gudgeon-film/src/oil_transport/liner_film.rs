use gudgeon_core::kinds::{OilTransport, OilTransportCtx, OilTransportSpec};
use gudgeon_core::quantity::{Fraction, Length, NonNegative, PosDensity, PosLength, Ratio, quantity};
use gudgeon_core::{BuildError, register_model};
use serde::{Deserialize, Serialize};

use super::carried::Carried;
use super::law::Law;
use crate::roughness::GaussianGap;

/// Every face holds the oil it has, takes up what lies on the liner before it and leaves a film behind it.
///
/// A face holds a volume of oil per circumference below and above its narrowest place, `V_b` and `V_a`. They tell how far the
/// full film reaches to both sides, `V_b = ∫_a^x0 h dx` and `V_a = ∫_x0^b h dx`; oil that the face has no room for stands before
/// its edge as a wave. The film between the menisci `a` and `b` obeys the Reynolds equation with the gas pressures of the two
/// sides at its ends, and
///
/// `dV_b/dt = in_b - out_b - q(x0)`,  `dV_a/dt = in_a - out_a + q(x0)`
///
/// with `q` the flux of the film along `+x`, and of the oil in the valleys of rough surfaces, `u (h_T - h)/2` with the mean gap `h_T` of
/// Gaussian surfaces. At the leading side `in = |u| h_liner`, the film that an earlier ring or stroke left
/// there. At the trailing side `out = |u| h_left`, `h_left = split h_T(meniscus)`: with `split` = 1/2 the meniscus comes to rest where
/// the pressure gradient vanishes, which is the condition of a separated film (Swift-Stieber), and gets there within the time the
/// ring takes to pass over its own face. Near dead centre, where nothing is taken up, the oil held carries the ring by its
/// squeeze: the film keeps its history.
///
/// A ring scrapes off what rises beyond the room before an edge: below the lowest ring and between the lands of an oil ring into the crankcase, elsewhere onto
/// the land there. What lies before the end gap of a ring, the share `φ` of its circumference, passes it and is scraped onto the land behind by the next ring, whose gap
/// stands elsewhere; above ring 1 it stays on the liner. From the lands, whose oil is a film `δ`
/// on the piston, inertia and gas move it on, with the density `ρ`, the viscosity `μ` at the ring and the acceleration `a` of the piston:
///
/// `q = ρ |a| δ³/(3 μ)`,  `q = τ δ²/(2 μ)`,  `τ = 0.008 min(Δp, 0.47 p)`
///
/// per open circumference: `φ` at an end gap, all of it at the crown, where it goes into the combustion chamber, and at the groove of an oil ring that drains. The shear
/// stress `τ` is that of turbulent gas in a smooth gap. Oil on the lands does not come back to the liner.
///
/// The film above ring 1 lies bare under the gas of the cylinder. Where the case has a model of `evaporation`, it thins there, place by place, until ring 1 is back; below
/// ring 1 nothing evaporates. Above the place of ring 1 at top dead centre the liner is then dry from the start.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LinerFilm {
    /// Film that splash and skirt leave on the liner below the ring pack.
    pub supply: Length<NonNegative>,
    /// Part of the gap at a trailing meniscus that stays on the liner.
    pub split: Ratio<Fraction>,
    /// Composite roughness σ: surfaces that touch still hold the oil of their valleys. Zero for smooth ones.
    pub roughness: Length<NonNegative>,
    /// Highest wave of oil that stands before an edge, at most the clearance of the land.
    pub wave: PosLength,
    /// Axial spacing of the film on the liner, at most; half the shortest face or gap between faces if that is less.
    #[schemars(extend("x-refine" = { "group": "liner grid", "factor": 0.5 }))]
    pub spacing: PosLength,
    /// Film on the liner at the start of the first cycle; 0.4 times the roughness when absent, and 0.04 um at least. No result depends on it, but the number of cycles until they
    /// repeat does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub initial: Option<Length<NonNegative>>,
    /// Density of the oil, which inertia acts on and which turns volumes into masses.
    pub density: PosDensity,
}

/// About what rings in contact leave on the liner \[m\], by what the valleys of a roughness \[m\] hold. A search that begins with a fifth to a third of it ends before the oil ring has
/// filled, 1 to 2 % off in friction.
fn left_in_contact(roughness: f64) -> f64 {
    (0.4 * roughness).max(0.04e-6)
}

impl Default for LinerFilm {
    fn default() -> Self {
        Self {
            supply: quantity(10e-6),
            split: quantity(0.5),
            roughness: quantity(0.4e-6),
            wave: quantity(50e-6),
            spacing: quantity(0.25e-3),
            initial: None,
            density: quantity(850.0),
        }
    }
}

#[register_model(
    name = "liner_film",
    summary = "starved faces fed by the film that earlier rings and strokes left on the liner; oil mass is conserved",
    equations = "V_b = int_a^x0 h dx, V_a = int_x0^b h dx;  dV_b/dt = in_b - out_b - q(x0);  dV_a/dt = in_a - out_a + q(x0);  \
                in = |u| h_liner at the leading side, out = |u| split h(meniscus) at the trailing side;  \
                Reynolds equation between the menisci, at their ends the gas pressures;  \
                on the lands, of height H: H d(delta)/dt = scraped + passed - rho |a| delta^3/(3 mu) - tau delta^2/(2 mu), per open circumference",
    validity = "Axisymmetric films. Oil moves with the liner, the faces and their waves, along the lands and through the end gaps: none in the \
               grooves and past the flanks, none from a land back to the liner, no mist; what evaporates from the liner is told by a model of the kind `evaporation`. What leaves \
               upwards is therefore a lower limit of the oil that an engine consumes. All the oil that passes a meniscus stays on the liner.",
    references = ["reynolds1886", "tomanik1993", "przesmitzki2005", "wang2012"],
    example = "supply = \"10 um\"\nsplit = 0.5\nroughness = \"0.4 um\"\nwave = \"50 um\"\nspacing = \"0.25 mm\"\ninitial = \"0.1 um\"\ndensity = \"850 kg/m3\"\n",
)]
impl OilTransportSpec for LinerFilm {
    fn build(&self, ctx: &OilTransportCtx<'_>) -> Result<Option<Box<dyn OilTransport>>, BuildError> {
        if self.split.si() <= 0.0 {
            return Err(BuildError::at(
                "split",
                "a meniscus that leaves nothing behind would fill without end",
            ));
        }
        if self.spacing.si() < 1e-6 {
            return Err(BuildError::at("spacing", "a liner is not resolved below 1 um"));
        }
        let law = Law {
            supply: self.supply.si(),
            split: self.split.si(),
            roughness: self.roughness.si(),
            mean_gap: GaussianGap::new(),
            wave: self.wave.si(),
            spacing: self.spacing.si(),
            initial: self.initial.map_or_else(|| left_in_contact(self.roughness.si()), |film| film.si()),
            density: self.density.si(),
        };
        Ok(Some(Box::new(Carried::new(law, ctx))))
    }
}
