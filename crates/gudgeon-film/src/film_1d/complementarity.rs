use gudgeon_core::kinds::{Film1d, Film1dCtx, Film1dIn, Film1dOut, Film1dScope, Film1dSpec, FilmField};
use gudgeon_core::{BuildError, EvalError, register_model};
use serde::{Deserialize, Serialize};

use super::cavity_shear::{LineCavityShear, Shear};
use super::line::{Change, Line};
use super::line_solver::LineSolver;
use super::rows::Rows;
use crate::cavitation::Cavitation;

/// Film along a line as a complementarity problem on its nodes: pressure or void, never both.
///
/// The flux through a panel whose gap is linear from `h_a` to `h_b` is exact when the film is full,
///
/// `q = c θ_a + g (p_a - p_b)`, `1/g = 6 μ Δx (h_a + h_b)/(φ_p h_a² h_b²)`, `c = u φ_s h_a h_b/(h_a + h_b)`,
///
/// `θ_a` the filled fraction at the upstream node, and the balance of the oil at each node, with `V` the volume of the halves
/// of the panels beside it,
///
/// `d(V θ)/dt = q_before - q_behind`, `p - p_cav ≥ 0`, `1 - θ ≥ 0`, `(p - p_cav)(1 - θ) = 0`.
///
/// Nodal pressures of a steady full film are exact; with a cavity the error falls with the square of the spacing.
///
/// A steady film with the pressures `p_0` and `p_n` above `p_cav` needs no iteration. Counted back from the last node the
/// pressure is `p_i = max(0, p_{i+1} + (q - c_i)/g_i)`, so that `p_0` is the largest of functions linear in `q`, and
///
/// `q = min_k (p_0 - p_k + Σ_{i<k} c_i/g_i)/(Σ_{i<k} 1/g_i)`, `p_k = 0` for `k < n`.
///
/// In time the same problem has one piecewise linear equation for each node, solved by Newton's method (semi-smooth, or on
/// Fischer-Burmeister functions), and node by node with certainty should that not settle.
#[derive(Debug, Clone, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Complementarity {
    /// What happens where the pressure would fall below `p_cav`.
    #[serde(default)]
    pub cavitation: Cavitation,
    /// Friction of the oil that is left in the cavity.
    #[serde(default)]
    pub cavity_shear: LineCavityShear,
    /// How the complementarity problem of `mass_conserving` is solved. The answer does not depend on it.
    #[serde(default)]
    pub solver: LineSolver,
}

const MODEL: &str = "complementarity";

#[register_model(
    name = "complementarity",
    summary = "mass-conserving film along a line: pressure or void at each node, steady without iteration",
    equations = "q_i = c_i theta_i + g_i (p_i - p_(i+1)),  1/g = 12 mu/phi_p int dx/h^3,  c = u phi_s/2 int dx/h^2 / int dx/h^3;  \
                d(V theta)/dt = q_(i-1) - q_i;  p - p_cav >= 0, 1 - theta >= 0, (p - p_cav)(1 - theta) = 0;  \
                steady: q = min_k (p_0 - p_k + sum c/g)/(sum 1/g), p_i = max(0, p_(i+1) + (q - c_i)/g_i);  \
                swift_stieber: p = p_cav from the rupture to the trailing end;  half_sommerfeld: max(p, p_cav);  \
                load = int (p - p_cav) dx;  shear = int (mu u/h -+ h p'/2) dx, in the cavity weighted with the filled fraction",
    validity = "Narrow gap, no flow across the line, viscosity constant across the gap and in each panel, incompressible oil. \
               Steady films with a profile linear in each panel are exact but for the place of the fronts; steps in time are of \
               first order.",
    references = ["reynolds1886", "jakobsson1957", "elrod1981", "giacopini2010", "woloszynski2015"],
    example = "cavitation = \"mass_conserving\"\ncavity_shear = \"streamers\"\nsolver = \"direct\"\n",
)]
impl Film1dSpec for Complementarity {
    fn scope(&self) -> Film1dScope {
        let starved = self.cavitation == Cavitation::MassConserving;
        Film1dScope { starved, squeeze: true, steps: true }
    }
    /// `front_tracking` knows no other condition, and steady films alone.
    fn same_equations(&self) -> &'static [&'static str] {
        if self.cavitation == Cavitation::MassConserving { &["front_tracking"] } else { &[] }
    }
    fn build(&self, ctx: &Film1dCtx<'_>) -> Result<Box<dyn Film1d>, BuildError> {
        ctx.check()?;
        Ok(Box::new(Film {
            line: Line::new(MODEL, ctx),
            rows: Rows::new(ctx.x.len()),
            cavitation: self.cavitation,
            solver: self.solver,
            shear: self.cavity_shear.decided(self.cavitation),
        }))
    }
}

struct Film {
    line: Line,
    rows: Rows,
    cavitation: Cavitation,
    solver: LineSolver,
    shear: Shear,
}

impl Film1d for Film {
    fn solve(&mut self, inp: &Film1dIn<'_>) -> Result<Film1dOut, EvalError> {
        let line = &mut self.line;
        line.enter(inp, self.cavitation != Cavitation::FullSommerfeld)?;
        if line.supply.is_some() && self.cavitation != Cavitation::MassConserving {
            return Err(line.fatal("a starved inlet needs a film that conserves mass"));
        }
        match self.cavitation {
            Cavitation::FullSommerfeld | Cavitation::HalfSommerfeld => {
                full(line);
                let clip = self.cavitation == Cavitation::HalfSommerfeld;
                line.finish(self.shear, clip, 1)
            }
            // Without sliding no end is the trailing one: both keep their films.
            Cavitation::SwiftStieber if line.u > 0.0 => {
                swift_stieber(line);
                line.finish(self.shear, false, 1)
            }
            Cavitation::MassConserving | Cavitation::SwiftStieber => {
                let direct = self.solver == LineSolver::Direct
                    && matches!(line.change, Change::Steady | Change::Rates)
                    && steady(line);
                let passes = if direct { 1 } else { self.rows.solve(line, self.solver)? };
                line.finish(self.shear, false, passes)
            }
        }
    }

    fn field(&self) -> FilmField<'_> {
        self.line.field()
    }

    fn full_content(&self, h_a: &[f64], h_b: &[f64], content: &mut [f64]) {
        self.line.full_content(h_a, h_b, content);
    }
}

/// Writes into `line.q` what flows through each panel above the flux of the first, all of it stored on the way.
fn drained(line: &mut Line) {
    let mut sum = 0.0;
    for i in 0..line.n {
        if i > 0 {
            sum += line.rate[i];
        }
        line.q[i] = -sum;
    }
}

/// Flux of the full film through the first panel. With `ruptured` the largest that leaves no node below zero instead, and
/// the node that it leaves at zero; the last node when the film is full.
fn flux(line: &mut Line, ruptured: bool) -> (f64, usize) {
    let n = line.n;
    let (mut resistance, mut rise) = (0.0, line.p_in);
    // The smallest of the quotients, without dividing for each.
    let (mut smallest, mut over, mut at) = (f64::INFINITY, 1.0, n);
    let changing = line.change != Change::Steady;
    if changing {
        drained(line);
    }
    for i in 0..n {
        let d = line.d[i];
        let extra = if changing { line.q[i] } else { 0.0 };
        resistance += d;
        rise += (line.c[i] - extra) * d;
        let end = if i + 1 == n { rise - line.p_out } else { rise };
        if (ruptured || i + 1 == n)
            && (end * over < smallest * resistance || at == n && smallest == f64::INFINITY)
        {
            (smallest, over, at) = (end, resistance, i + 1);
        }
    }
    (smallest / over, at)
}

/// The film without cavitation.
fn full(line: &mut Line) {
    line.fill.fill(1.0);
    line.film.fill(true);
    line.store();
    let n = line.n;
    let (q, _) = flux(line, false);
    line.p[0] = line.p_in;
    line.p[n] = line.p_out;
    let changing = line.change != Change::Steady;
    for i in (0..n).rev() {
        line.q[i] = if changing { q + line.q[i] } else { q };
        if i > 0 {
            line.p[i] = line.p[i + 1] + (line.q[i] - line.c[i]) * line.d[i];
        }
    }
    meet(line, n, f64::NEG_INFINITY);
}

/// The film up to the rupture where pressure and gradient vanish, and `p_cav` from there on.
fn swift_stieber(line: &mut Line) {
    line.fill.fill(1.0);
    line.store();
    let n = line.n;
    let (q, k) = flux(line, true);
    let changing = line.change != Change::Steady;
    for i in 0..n {
        line.q[i] = if changing { q + line.q[i] } else { q };
    }
    line.film.fill(true);
    line.p[0] = line.p_in;
    line.p[k] = if k == n { line.p_out } else { 0.0 };
    for i in (1..k).rev() {
        line.p[i] = (line.p[i + 1] + (line.q[i] - line.c[i]) * line.d[i]).max(0.0);
    }
    meet(line, k, 0.0);
    for i in k..=n {
        if k < n {
            line.p[i] = 0.0;
            line.film[i] = false;
            let c = line.c[i.min(n - 1)];
            line.fill[i] = if c > 0.0 { (line.q[i.min(n - 1)] / c).clamp(0.0, 1.0) } else { 0.0 };
        }
    }
}

/// The mass-conserving film when the oil stored along the line changes at known rates. `false` when it does not, because
/// a cavity runs dry.
fn steady(line: &mut Line) -> bool {
    let n = line.n;
    let (mut q, k) = flux(line, true);
    let changing = line.change != Change::Steady;
    line.starved = false;
    if let Some(supply) = line.supply {
        let arrives = supply - if changing { line.rate[0] } else { 0.0 };
        if arrives < q {
            line.starved = true;
            q = arrives;
        }
    }
    if changing {
        line.q.iter_mut().for_each(|x| *x += q);
    } else {
        line.q.fill(q);
    }
    line.p[n] = line.p_out;
    back(line, n, 0.0);
    if line.starved {
        // Before the film there is gas.
        line.lead = line.p.iter().position(|p| *p >= line.p_in).unwrap_or(n);
        if line.p_in > 0.0 {
            // A film that nowhere reaches the pressure of the gas lets it through to the end.
            line.p[n] = line.p_out.max(if line.lead == n { line.p_in } else { 0.0 });
            back(line, line.lead, line.p_in);
        }
    } else {
        line.p[0] = line.p_in;
        meet(line, k, 0.0);
    }
    let gas = if line.lead > 0 { line.p_in } else { 0.0 };
    for i in 0..n {
        let floor = if i < line.lead { gas } else { 0.0 };
        let film = line.p[i] > floor || (i == 0 && !line.starved);
        line.film[i] = film;
        line.fill[i] = 1.0;
        if !film {
            let carried = line.q[i] + line.g[i] * (line.p[i + 1] - line.p[i]);
            // Without sliding nothing flows through a void. A tiny part of the balance is rounding.
            if carried < -1e-13 * (line.q[i].abs() + line.g[i] * line.p[i + 1])
                || (line.c[i] == 0.0 && carried > 0.0)
            {
                return false;
            }
            line.fill[i] = if line.c[i] > 0.0 { (carried / line.c[i]).clamp(0.0, 1.0) } else { 0.0 };
        }
    }
    line.outlet();
    true
}

/// Counts the pressures of the film at the inlet, which ends at node `k`, from the inlet up to the highest: the sums from the
/// other end have left the rounding of that behind them, which a wide gap would turn into a flux.
fn meet(line: &mut Line, k: usize, floor: f64) {
    let mut top = 0;
    for (i, p) in line.p[..=k].iter().enumerate() {
        if p.abs() > line.p[top].abs() {
            top = i;
        }
    }
    let mut p = line.p_in;
    for i in 0..top.saturating_sub(1) {
        p = (p + (line.c[i] - line.q[i]) * line.d[i]).max(floor);
        line.p[i + 1] = p;
    }
}

/// Pressures of the nodes before `from`, counted back from there.
fn back(line: &mut Line, from: usize, floor: f64) {
    let mut p = line.p[from];
    let (c, d, q) = (&line.c[..from], &line.d[..from], &line.q[..from]);
    for (((p_i, c), d), q) in line.p[..from].iter_mut().zip(c).zip(d).zip(q).rev() {
        p = (p + (q - c) * d).max(floor);
        *p_i = p;
    }
}
