use gudgeon_core::kinds::{
    Film1d, Film1dCtx, Film1dIn, Film1dOut, Film1dScope, Film1dSpec, FilmEnd, FilmField,
};
use gudgeon_core::quantity::PosPressure;
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::cavity_shear::{LineCavityShear, Shear};
use super::line::{Change, Line};
use crate::cavitation::Cavitation;

/// Elrod and Adams' algorithm: one unknown for each node, the content `θ` of the gap, which is the filled fraction in a
/// cavity and the density over that at `p_cav` in the film.
///
/// `p - p_cav = β g (θ - 1)`, `g = 1` where `θ ≥ 1` and else `0`, and through each panel
///
/// `q = c θ_a + G [β g_a (θ_a - 1) - β g_b (θ_b - 1)]`,
///
/// `c` and `G` the sliding flux and the conductance of the full panel, `θ_a` upstream. For given switches `g` the balances of
/// the nodes are linear; solve, set the switches, repeat until they stay.
///
/// The method of the textbooks, kept for comparison. The oil is compressible: what slides along carries `1 + p/β` of the flux of an incompressible film,
/// and a pressure that comes of a difference `Δh` of the gap feels that against `Δh/h`. The flux is wrong by some `p/β`, the pressure and the
/// load by some `(p/β) h/Δh`: 0.4 `p/β` in a wedge of 2 to 1, 15 `p/β` in a pocket between lands that converge by 5 %, in proportion to `1/β` once that is
/// small. A large `β` leaves fewer digits of `θ - 1` (its rounding times `β` is an error of pressure). Switches may flip for ever, which is an
/// error here. A gap that changes at given rates and ends without a bath are not known to it.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ElrodAdams {
    /// β: bulk modulus of the oil.
    #[serde(default = "oil")]
    pub bulk_modulus: PosPressure,
    /// Maximum number of rounds of setting switches.
    #[serde(default = "rounds")]
    #[schemars(range(min = 1, max = 100_000))]
    pub rounds: usize,
    /// Friction of the oil that is left in the cavity.
    #[serde(default)]
    pub cavity_shear: LineCavityShear,
}

fn oil() -> PosPressure {
    gudgeon_core::quantity::quantity(1.5e9)
}
fn rounds() -> usize {
    200
}

impl Default for ElrodAdams {
    fn default() -> Self {
        Self { bulk_modulus: oil(), rounds: rounds(), cavity_shear: LineCavityShear::Auto }
    }
}

const MODEL: &str = "elrod_adams";

#[register_model(
    name = "elrod_adams",
    summary = "universal variable with switch function and bulk modulus, along a line",
    equations = "p - p_cav = beta g (theta - 1),  g = 1 where theta >= 1 else 0;  \
                q_i = c_i theta_i + G_i beta [g_i (theta_i - 1) - g_(i+1) (theta_(i+1) - 1)];  d(V theta)/dt = q_(i-1) - q_i;  \
                linear for given g, repeated until g stays",
    validity = "As complementarity, with compressible oil: errors of the order of p/beta in flux and of (p/beta) h/(change of h) in pressure \
               and load, large in films that hardly converge. Flooded ends, steady or steps in time. \
               Switches that never settle are an error.",
    references = ["elrod1981", "jakobsson1957"],
    example = "bulk_modulus = \"1.5 GPa\"\nrounds = 200\ncavity_shear = \"streamers\"\n",
)]
impl Film1dSpec for ElrodAdams {
    fn scope(&self) -> Film1dScope {
        Film1dScope { starved: false, squeeze: false, steps: true }
    }
    fn build(&self, ctx: &Film1dCtx<'_>) -> Result<Box<dyn Film1d>, BuildError> {
        ctx.check()?;
        if !(1..=100_000).contains(&self.rounds) {
            return Err(BuildError::at(
                "rounds",
                format!("must be between 1 and 100000, not {}", self.rounds),
            ));
        }
        let v = || vec![0.0; ctx.x.len()];
        Ok(Box::new(Film {
            line: Line::new(MODEL, ctx),
            beta: self.bulk_modulus.si(),
            rounds: self.rounds,
            shear: self.cavity_shear.decided(Cavitation::MassConserving),
            excess: v(),
            diag: v(),
            rhs: v(),
            upper: v(),
            full: vec![true; ctx.x.len()],
        }))
    }
}

struct Film {
    line: Line,
    beta: f64,
    rounds: usize,
    shear: Shear,
    /// `θ - 1`, which keeps the digits that `θ` would lose.
    excess: Vec<f64>,
    diag: Vec<f64>,
    rhs: Vec<f64>,
    upper: Vec<f64>,
    /// Switches.
    full: Vec<bool>,
}

impl Film1d for Film {
    fn solve(&mut self, inp: &Film1dIn<'_>) -> Result<Film1dOut, EvalError> {
        if inp.ends.iter().any(|e| matches!(e, FilmEnd::Starved { .. })) {
            return Err(self.line.fatal("ends must be flooded"));
        }
        self.line.enter(inp, true)?;
        if self.line.change == Change::Rates {
            return Err(self.line.fatal("a gap that changes must be solved in steps of time"));
        }
        let n = self.line.n;
        self.full.fill(true);
        self.excess[0] = self.line.p_in / self.beta;
        self.excess[n] = self.line.p_out / self.beta;
        let mut settled = None;
        for round in 1..=self.rounds {
            self.balance();
            let mut flips = false;
            for (e, full) in self.excess[1..n].iter().zip(&mut self.full[1..n]) {
                if !e.is_finite() {
                    return Err(self.line.recoverable("film out of range"));
                }
                let now = *e >= 0.0;
                flips |= now != *full;
                *full = now;
            }
            if !flips {
                settled = Some(round);
                break;
            }
        }
        let Some(rounds) = settled else {
            return Err(self
                .line
                .recoverable(format!("the switches do not settle in {} rounds", self.rounds)));
        };
        let line = &mut self.line;
        for i in 0..=n {
            let e = self.excess[i];
            line.film[i] = self.full[i];
            line.p[i] = if self.full[i] { self.beta * e } else { 0.0 };
            line.fill[i] = if e < -1.0 { 0.0 } else { 1.0 + e };
        }
        (line.p[0], line.p[n]) = (line.p_in, line.p_out);
        for i in 0..n {
            line.q[i] = line.c[i] * line.fill[i] + line.g[i] * (line.p[i] - line.p[i + 1]);
        }
        line.outlet();
        line.fill[n] = line.fill[n].max(1.0 + if line.film[n] { self.excess[n] } else { -1.0 });
        line.store();
        line.finish(self.shear, false, rounds)
    }

    fn field(&self) -> FilmField<'_> {
        self.line.field()
    }

    fn full_content(&self, h_a: &[f64], h_b: &[f64], content: &mut [f64]) {
        self.line.full_content(h_a, h_b, content);
    }
}

impl Film {
    /// Solves the balances of the nodes for the switches as they are.
    fn balance(&mut self) {
        let line = &self.line;
        let n = line.n;
        for i in 1..n {
            let on = |i: usize| if self.full[i] { self.beta } else { 0.0 };
            let (before, behind) = (line.g[i - 1], line.g[i]);
            let (hold, held) = match line.change {
                Change::Step(dt) => (line.volume[i] / dt, line.before[i] / dt),
                _ => (0.0, 0.0),
            };
            // In θ - 1: a constant 1 flows as the difference of the sliding fluxes.
            let mut rhs = held - hold + line.c[i - 1] - line.c[i];
            let mut diag = hold + line.c[i] + on(i) * (before + behind);
            let lower = -line.c[i - 1] - on(i - 1) * before;
            if i == 1 {
                rhs -= lower * self.excess[0];
            } else {
                let w = lower / self.diag[i - 1];
                diag -= w * self.upper[i - 1];
                rhs -= w * self.rhs[i - 1];
            }
            self.upper[i] = -on(i + 1) * behind;
            (self.diag[i], self.rhs[i]) = (diag, rhs);
        }
        for i in (1..n).rev() {
            self.excess[i] = (self.rhs[i] - self.upper[i] * self.excess[i + 1]) / self.diag[i];
        }
    }
}
