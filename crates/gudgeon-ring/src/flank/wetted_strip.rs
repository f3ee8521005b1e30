//! A strip of oil of finite volume between the ring and each groove flank, and the gas beside it.

use gudgeon_core::geometry::{FlankOil, RingPlace};
use gudgeon_core::kinds::{
    FLANK_FILMS, Flank, FlankCtx, FlankFilm, FlankFlow, FlankIn, FlankLaw, FlankResistance, FlankSpec,
};
use gudgeon_core::quantity::{
    Fraction, NonNegative, PosLength, PosPressure, PosTime, Ratio, Viscosity, quantity,
};
use gudgeon_core::states::{Signals, StateInfo, Stateful};
use gudgeon_core::{BuildError, EvalError, register_model};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checks::{check_fill, check_oil};
use super::gas_gap::{GasGap, default_gas_viscosity};
use super::squeeze_film::{default_roughness, default_separation, default_tension};

/// A strip of oil of finite volume between the ring and each of the two groove flanks: it resists the motion of the ring and keeps gas out.
///
/// The oil on a flank has the volume `a` per circumference (a state) and bridges the gap `H = h + σ` over the width `b`, as far as it reaches:
///
/// ```text
/// b = x w/(1 + x⁴)^(1/4)      x = a/(w H)
/// ```
///
/// The ring feels Reynolds' squeeze film of that width, per circumference, and the gas finds the share `ψ` of the gap open:
///
/// ```text
/// approach with v:  f = μ b³ v/H³         separation:  f = X/(1 + X/(p_t b)),  X = χ μ b³ v/H³
/// ψ = 1/(1 + (b/H)²)
/// ```
///
/// The gas beside the strip, `w - b` wide, is squeezed out too. With the strip in the middle of the flank it resists by
///
/// ```text
/// approach with v:  f_g = μ_g (w - b)³ v/H³         separation:  f_g = X/(1 + X/(p_t (w - b))),  X = μ_g (w - b)³ v/H³
/// ```
///
/// which is what damps a ring between its flanks: a gap of gas is a hundred times wider than a strip that is drawn out.
///
/// A strip is closed while it is much wider than it is high. Drawn out, it becomes narrow (`b = a/H`), gives way (`f ~ H⁻⁶`) and opens. Gas of the
/// pressure difference `Δp` drives it out, and groove and lands replace what is missing within the time `τ`; a ring that comes down gathers the oil
/// that was left on the walls:
///
/// ```text
/// da/dt = (a_s - a) (1/τ + 4 σ² v/H³) - (1 - ψ) |Δp| H³ b/(12 μ (b + H + ℓ)²)     v: approach, 0 when it separates
/// ```
///
/// The supply `a_s = f_o w σ` is the oil that wets the fraction `f_o` (`oil_fill`) of the width under a seated ring. The last term is the flow of a
/// strip `b` wide between parallel walls, `|Δp| H³/(12 μ b)`, for the share that bridges the gap: what hangs on the walls beside open gas stays. A strip narrower than the raggedness `ℓ` of its edges is broken
/// through here and there, and what is left of it leaves the slower. An approach from far away to `H` leaves the share
/// `exp(-2 (σ/H)²)` of the missing oil behind.
///
/// Source: reynolds1886 (squeeze film, flow between parallel walls), cameron1966; the balance of the strip is this program's own.
#[derive(Debug, Clone, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WettedStrip {
    /// Distance `σ` at which roughness peaks hold seated flanks apart: combined roughness of ring and groove flank.
    #[serde(default = "default_roughness")]
    pub roughness: PosLength,
    /// Fraction `χ` of the strip that stays liquid while the flanks are drawn apart. 0: a separating flank does not resist.
    #[serde(default = "default_separation")]
    pub separation: Ratio<Fraction>,
    /// Greatest mean tension `p_t` of a strip that is drawn apart: the pressure around it less the cavitation pressure. Gas that cannot follow a
    /// separating ring has no more either.
    #[serde(default = "default_tension")]
    pub tension: PosPressure,
    /// Time `τ` in which groove and lands replace what a strip has lost.
    #[serde(default = "default_renewal")]
    pub renewal: PosTime,
    /// Raggedness `ℓ` of the edges of a strip. The narrower it lets a strip become, the stiffer the balance of its oil: below 10 µm runs may stall.
    #[serde(default = "default_edge")]
    pub edge: PosLength,
    /// Dynamic viscosity `μ_g` of the gas beside the strip; 0: the gas does not resist.
    #[serde(default = "default_gas_viscosity")]
    pub gas_viscosity: Viscosity<NonNegative>,
}

fn default_renewal() -> PosTime {
    quantity(0.05)
}

fn default_edge() -> PosLength {
    quantity(1e-4)
}

impl Default for WettedStrip {
    fn default() -> Self {
        Self {
            roughness: default_roughness(),
            separation: default_separation(),
            tension: default_tension(),
            renewal: default_renewal(),
            edge: default_edge(),
            gas_viscosity: default_gas_viscosity(),
        }
    }
}

#[register_model(
    name = "wetted_strip",
    summary = "physical: oil of finite volume on each flank that resists, ruptures, and keeps gas out while it bridges the gap",
    equations = "b = a/H up to w;  approach: f = mu b^3 v/H^3;  open share of the gap 1/(1 + (b/H)^2);  \
                gas: f = mu_g (w - b)^3 v/H^3;  da/dt = (f_o w sigma - a)(1/tau + 4 sigma^2 v/H^3) - (1 - psi) |dp| H^3 b/(12 mu (b + H + l)^2), psi the open share;  H = h + sigma",
    validity = "Parallel flanks, oil at the temperature of the groove, the same around the ring; groove and lands have oil to replace what is lost. \
               The supply and the time of renewal are inputs that are seldom measured. The gas is not compressed as it is squeezed out.",
    references = ["reynolds1886", "cameron1966"],
    example = "roughness = \"0.4 um\"\nrenewal = \"50 ms\"\n",
)]
impl FlankSpec for WettedStrip {
    fn build(&self, ctx: &FlankCtx) -> Result<Box<dyn Flank>, BuildError> {
        check_fill(ctx)?;
        check_oil(ctx)?;
        let strip = Strip {
            mu: ctx.mu,
            width: ctx.width,
            per_width: ctx.width.recip(),
            roughness: self.roughness.si(),
            separation: self.separation.si(),
            tension: self.tension.si(),
            supply: ctx.oil_fill * ctx.width * self.roughness.si(),
            per_renewal: self.renewal.si().recip(),
            edge: self.edge.si(),
            gas: GasGap { viscosity: self.gas_viscosity.si(), tension: self.tension.si() },
        };
        let state = |flank: &str| {
            StateInfo::new(format!("oil on the {flank} flank of ring{}", ctx.ring + 1))
                .absolute(1.0)
                .within(0.0, f64::INFINITY)
                .changes(Signals::FLANK_OIL)
        };
        // Without crank there is nothing to integrate by.
        let wet = strip.supply > 0.0 && ctx.omega > 0.0;
        let states = if wet { vec![state("lower"), state("upper")] } else { Vec::new() };
        Ok(Box::new(Runtime { strip, per_supply: (strip.supply * ctx.omega).recip(), states }))
    }

    fn follows_oil(&self) -> bool {
        true
    }
}

/// The law of a strip.
#[derive(Debug, Clone, Copy)]
struct Strip {
    mu: f64,
    width: f64,
    /// One over the width.
    per_width: f64,
    roughness: f64,
    separation: f64,
    tension: f64,
    /// Volume per circumference \[m²\] that groove and lands supply.
    supply: f64,
    per_renewal: f64,
    edge: f64,
    gas: GasGap,
}

impl Strip {
    /// Distance of the mean surfaces \[m\] for a ring `h` \[m\] above a flank.
    fn gap(&self, h: f64) -> f64 {
        h.max(0.0) + self.roughness
    }

    /// Width of the strip of `oil` \[m²\] in a gap \[m\], odd in the oil: a dry flank is no corner; and the share of the gap that it leaves open,
    /// `H²/(H² + b²)`.
    fn wetted(&self, oil: f64, gap: f64) -> (f64, f64) {
        // Of volumes, not of their ratio, no power overflows. Roots and quotients that do not wait for each other: this is asked at every look at a ring.
        let room = self.width * gap;
        let (square, whole) = (oil * oil, room * room);
        let size = (square * square + whole * whole).sqrt();
        let wide = self.width * oil * (size.sqrt() * (1.0 / size));
        let free = gap * gap * size;
        // What fills the gap may round up.
        let bridged = if wide > self.width { self.width } else { wide };
        (bridged, free / (free + self.width * self.width * square))
    }

    /// Oil and gas between a flank and a ring, over a `circumference` \[m\]; `per_gap` one over the gap \[1/m\].
    fn films(&self, wetted: f64, per_gap: f64, circumference: f64) -> [FlankFilm; FLANK_FILMS] {
        // A state that is extrapolated may hold less than nothing, which resists nothing.
        let bridged = wetted.max(0.0);
        let slenderness = bridged * per_gap;
        let approach = circumference * self.mu * slenderness * slenderness * slenderness;
        let tension = circumference * self.tension * bridged;
        [
            FlankFilm { approach, apart: self.separation * approach, tension },
            self.gas.film(self.width - wetted, per_gap, circumference),
        ]
    }

    fn resist(&self, oil: &FlankOil, s: f64, clearance: f64, area: f64) -> FlankResistance {
        let circumference = area * self.per_width;
        // One quotient for oil and gas, before it is known where the oil is: this is asked at every look at a ring.
        let per_gap = [s, clearance - s].map(|h| self.gap(h)).map(|gap| 1.0 / gap);
        let [lower, upper] = [0, 1].map(|k| self.films(oil.wetted[k], per_gap[k], circumference));
        FlankResistance { lower, upper }
    }

    /// What comes to a strip of `oil` \[m²\] and leaves it, while the flank approaches with `rate` under a pressure difference.
    fn flow(&self, oil: f64, wetted: f64, h: f64, rate: f64, dp: f64) -> FlankFlow {
        let gap = self.gap(h);
        let cube = gap * gap * gap;
        let gathered = 4.0 * self.roughness * self.roughness * rate.max(0.0) / cube;
        let missing = self.supply - oil;
        let reach = wetted.abs() + gap + self.edge;
        // The share that is closed is b²/(b² + H²).
        let bridge = wetted * wetted;
        let blown =
            bridge * wetted * cube * dp.abs() / (12.0 * self.mu * (bridge + gap * gap) * reach * reach);
        FlankFlow { fed: missing * (self.per_renewal + gathered), lost: blown }
    }
}

struct Runtime {
    strip: Strip,
    /// One over the flow \[m²/s\] that brings the supply in a radian.
    per_supply: f64,
    /// Oil on the lower and the upper flank, over the supply.
    states: Vec<StateInfo>,
}

impl Runtime {
    /// Oil \[m²\] on both flanks.
    fn volumes(&self, y: &[f64]) -> [f64; 2] {
        match *y {
            [lower, upper] => [lower, upper].map(|v| v * self.strip.supply),
            // Where nothing is integrated the supply stays.
            _ => [self.strip.supply; 2],
        }
    }
}

/// Distances from the lower and the upper flank \[m\].
fn distances(place: &RingPlace) -> [f64; 2] {
    [place.s, place.clearance - place.s]
}

impl Stateful for Runtime {
    fn states(&self) -> &[StateInfo] {
        &self.states
    }
    fn initial(&mut self, y: &mut [f64]) {
        y.fill(1.0);
    }
    fn reads(&self) -> Signals {
        Signals::LIFT
            | Signals::AXIAL_VELOCITY
            | Signals::FILM_THICKNESS
            | Signals::PRESSURE
            | Signals::FLANK_OIL
    }
}

impl Flank for Runtime {
    fn law(&self) -> Box<dyn FlankLaw> {
        Box::new(self.strip)
    }

    fn oil(&self, y: &[f64], place: &RingPlace) -> FlankOil {
        let (oil, h) = (self.volumes(y), distances(place));
        let [lower, upper] = [0, 1].map(|k| self.strip.wetted(oil[k], self.strip.gap(h[k])));
        FlankOil { wetted: [lower.0, upper.0], open: [lower.1, upper.1] }
    }

    fn rates(&mut self, y: &[f64], at: &FlankIn<'_>, dy: &mut [f64]) -> Result<FlankFlow, EvalError> {
        let (place, [above, behind, below]) = (at.place, at.pressure);
        let (oil, h) = (self.volumes(y), distances(place));
        let (rate, dp) = ([-place.v, place.v], [behind - below, above - behind]);
        let mut sum = FlankFlow::default();
        for (k, dy) in dy.iter_mut().enumerate() {
            let flow = self.strip.flow(oil[k], place.flank.wetted[k], h[k], rate[k], dp[k]);
            *dy = (flow.fed - flow.lost) * self.per_supply;
            sum.fed += flow.fed;
            sum.lost += flow.lost;
        }
        Ok(sum)
    }

    fn volume(&self, y: &[f64]) -> f64 {
        if self.states.is_empty() { 0.0 } else { self.volumes(y).iter().sum() }
    }
}

impl FlankLaw for Strip {
    fn force(&self, oil: &FlankOil, s: f64, v: f64, clearance: f64, area: f64) -> f64 {
        self.resist(oil, s, clearance, area).force(v)
    }

    fn resistance(&self, oil: &FlankOil, s: f64, clearance: f64, area: f64) -> Option<FlankResistance> {
        Some(self.resist(oil, s, clearance, area))
    }
}
