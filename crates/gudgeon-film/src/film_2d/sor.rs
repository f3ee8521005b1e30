use gudgeon_core::kinds::{
    Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec, FilmMode, Superposition,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use serde::{Deserialize, Serialize};

use super::cavitation::Cavitation;
use super::checks::{check_modes, check_tolerance, tolerance};
use super::flux::Flux;
use super::problem::Problem;

/// Film by finite volumes, solved node by node with over-relaxation.
///
/// Every sweep visits all nodes and sets each pressure to what its neighbours ask for, times the relaxation: the solver of most published
/// programs. Where a pressure would fall below `p_cav` the cavitation condition is imposed on the spot (projected relaxation,
/// Cryer 1971; with the filling as second unknown, Ausas et al. 2009). The number of sweeps grows with the number of nodes along a side,
/// without the best relaxation with its square: for comparison with published schemes.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-renamed" = { "most_sweeps": "max_sweeps" }))]
pub struct Sor {
    /// What happens where the pressure would fall below `p_cav`.
    #[serde(default)]
    pub cavitation: Cavitation,
    /// Which film thickness counts for the flow between two nodes.
    #[serde(default)]
    pub flux: Flux,
    /// Largest imbalance of a control volume over the largest flow between two or into one, from 1e-14 to 0.1.
    #[serde(default = "tolerance")]
    #[schemars(range(min = 1e-14, max = 0.1), extend("x-refine" = { "group": "film tolerance", "factor": 0.1 }))]
    pub tolerance: f64,
    /// Over-relaxation, above 0 and below 2. By default `2/(1 + √(1 - ρ²))` with `ρ` the spectral radius of Jacobi's iteration for a film of uniform
    /// thickness.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 2.0))]
    pub relaxation: Option<f64>,
    /// Maximum number of sweeps, 1 or more.
    #[serde(default = "max_sweeps")]
    #[schemars(range(min = 1, max = 100_000_000))]
    pub max_sweeps: usize,
}

fn max_sweeps() -> usize {
    100_000
}

impl Default for Sor {
    fn default() -> Self {
        Self {
            cavitation: Cavitation::default(),
            flux: Flux::default(),
            tolerance: tolerance(),
            relaxation: None,
            max_sweeps: max_sweeps(),
        }
    }
}

const MODEL: &str = "sor";

#[register_model(
    name = "sor",
    summary = "finite volumes with projected successive over-relaxation",
    equations = "p := p + omega (p* - p), p* from the balance of the node;  swift_stieber: p := max(p, p_cav);  \
                mass_conserving: where p* < p_cav, theta from the balance;  half_sommerfeld: max(p, p_cav) at the end;  \
                omega = 2/(1 + sqrt(1 - rho^2))",
    validity = "As multigrid, at many times its cost.",
    references = ["reynolds1886", "cryer1971", "ausas2009", "loureiro2009"],
    example = "cavitation = \"half_sommerfeld\"\nflux = \"face\"\ntolerance = 1e-9\nmax_sweeps = 100000\n",
)]
impl Film2dSpec for Sor {
    fn build(&self, ctx: &Film2dCtx<'_>) -> Result<Box<dyn Film2d>, BuildError> {
        check_tolerance(self.tolerance)?;
        if let Some(w) = self.relaxation.filter(|w| !(*w > 0.0 && *w < 2.0)) {
            return Err(BuildError::at("relaxation", format!("must be between 0 and 2, not {w}")));
        }
        if self.max_sweeps == 0 {
            return Err(BuildError::at("max_sweeps", "must be 1 or more"));
        }
        let problem = Problem::new(ctx.grid, self.flux)?;
        let n = problem.len();
        Ok(Box::new(Relaxation {
            spec: self.clone(),
            problem,
            p: vec![0.0; n],
            void: vec![0.0; n],
            b: vec![0.0; n],
            pressure: vec![0.0; n],
            fill: vec![1.0; n],
            warm: false,
        }))
    }
}

struct Relaxation {
    spec: Sor,
    problem: Problem,
    p: Vec<f64>,
    void: Vec<f64>,
    b: Vec<f64>,
    pressure: Vec<f64>,
    fill: Vec<f64>,
    warm: bool,
}

impl Relaxation {
    /// The best relaxation of a rectangle of uniform film.
    fn relaxation(&self) -> f64 {
        if let Some(w) = self.spec.relaxation {
            return w;
        }
        let p = &self.problem;
        let (gx, gy) = (p.m.gx.iter().sum::<f64>(), p.m.gy.iter().sum::<f64>());
        let cosine = |n: usize, edges: [gudgeon_core::kinds::Edge; 2]| {
            let given = edges.iter().filter(|e| **e == gudgeon_core::kinds::Edge::Pressure).count();
            // Half a wave between two given edges, a quarter from a given edge to a wall, none otherwise.
            elementary::cos(std::f64::consts::PI * 0.5 * given as f64 / (n - 1) as f64)
        };
        let e = p.grid.edges;
        let rho = (gx * cosine(p.nx, [e[0], e[1]]) + gy * cosine(p.ny, [e[2], e[3]])) / (gx + gy);
        2.0 / (1.0 + (1.0 - rho * rho).max(0.0).sqrt())
    }

    /// Sweeps until the balances close. `signed` pressures may fall below that of the cavity.
    fn sweep(&mut self, signed: bool, carried: bool) -> Result<usize, EvalError> {
        let omega = self.relaxation();
        let n = self.problem.len();
        // Fillings travel along with the oil; sweeps to and fro would settle pressures half as fast.
        let forward = signed || self.problem.m.qx.iter().sum::<f64>() >= 0.0;
        for sweep in 1..=self.spec.max_sweeps {
            for step in 0..n {
                let k = if forward { step } else { n - 1 - step };
                if self.problem.edge[k] == 4 {
                    self.visit(k, omega, signed, carried);
                }
            }
            if sweep % 10 == 0 || sweep == self.spec.max_sweeps {
                self.problem.balance(&self.p, &self.void, &mut self.b);
                let mut worst = 0.0_f64;
                for k in 0..n {
                    // At p_cav a surplus is what the condition asks for, unless it is kept account of.
                    let allowed = !signed && !carried && self.p[k] <= 0.0 && self.b[k] > 0.0;
                    if self.problem.edge[k] == 4 && !allowed {
                        let r = self.b[k].abs();
                        worst = if r <= worst { worst } else { r };
                    }
                }
                let (flow, rounding) = self.problem.largest_flow(&self.p, &self.void);
                if worst <= rounding.max(self.spec.tolerance * flow) {
                    return Ok(sweep);
                }
                if !worst.is_finite() {
                    break;
                }
            }
        }
        Err(EvalError::recoverable(MODEL, format!("no convergence in {} sweeps", self.spec.max_sweeps)))
    }

    #[inline]
    fn visit(&mut self, k: usize, omega: f64, signed: bool, carried: bool) {
        let pr = &self.problem;
        let (nx, i) = (pr.nx, k % pr.nx);
        let (west, east) = (pr.before(i, k), pr.after(i, k));
        let (mut c, mut inflow, mut out) = (0.0, -pr.fixed[k], pr.m.hold[k]);
        if west != k {
            let q = pr.m.qx[west];
            c += pr.m.gx[west];
            inflow += pr.m.gx[west] * self.p[west] + q.max(0.0) * (1.0 - self.void[west]);
            out -= q.min(0.0);
        }
        if east != k {
            let q = pr.m.qx[k];
            c += pr.m.gx[k];
            inflow += pr.m.gx[k] * self.p[east] - q.min(0.0) * (1.0 - self.void[east]);
            out += q.max(0.0);
        }
        if k >= nx {
            c += pr.m.gy[k - nx];
            inflow += pr.m.gy[k - nx] * self.p[k - nx];
        }
        if k + nx < pr.len() {
            c += pr.m.gy[k];
            inflow += pr.m.gy[k] * self.p[k + nx];
        }
        let target = (inflow - out) / c;
        let p = self.p[k] + omega * (target - self.p[k]);
        if signed {
            self.p[k] = p;
        } else if target > 0.0 || !carried {
            self.p[k] = p.max(0.0);
            self.void[k] = 0.0;
        } else {
            self.p[k] = 0.0;
            self.void[k] = if out > 0.0 { (1.0 - inflow / out).clamp(0.0, 1.0) } else { 0.0 };
        }
    }
}

impl Film2d for Relaxation {
    fn grid(&self) -> &Film2dGrid {
        &self.problem.grid
    }

    fn solve(&mut self, inp: &Film2dIn<'_>) -> Result<Film2dOut, EvalError> {
        let cavitation = self.spec.cavitation;
        let conserves = cavitation == Cavitation::MassConserving;
        if inp.history.is_some() && !conserves {
            return Err(EvalError::fatal(MODEL, "only the mass-conserving condition has a history"));
        }
        self.problem.assemble(MODEL, inp)?;
        self.problem.drive(inp, inp.u, inp.dhdt, conserves);
        if !self.warm {
            self.p.fill(0.0);
            self.void.fill(0.0);
        }
        let cavitates = cavitation != Cavitation::FullSommerfeld;
        self.problem.set_edges(inp, cavitates, &mut self.p, &mut self.void);
        if !conserves {
            self.void.fill(0.0);
        }
        let signed = matches!(cavitation, Cavitation::FullSommerfeld | Cavitation::HalfSommerfeld);
        self.warm = false;
        let sweeps = self.sweep(signed, conserves)?;
        self.warm = true;
        for k in 0..self.p.len() {
            let p = if cavitates { self.p[k].max(0.0) } else { self.p[k] };
            self.pressure[k] = inp.p_cav + p;
            self.b[k] = p;
        }
        let shown = std::mem::take(&mut self.b);
        if conserves {
            self.problem.fill_sides(inp, &shown, &mut self.void);
        }
        let mut out = self.problem.result(inp, &shown, &self.void, cavitation, &mut self.fill);
        self.b = shown;
        for (f, v) in self.fill.iter_mut().zip(&self.void) {
            *f = 1.0 - v;
        }
        (out.iterations, out.cycles) = (1, sweeps);
        Ok(out)
    }

    fn pressure(&self) -> &[f64] {
        &self.pressure
    }

    fn fill(&self) -> &[f64] {
        &self.fill
    }

    fn solve_many(
        &mut self,
        inp: &Film2dIn<'_>,
        modes: &[FilmMode<'_>],
        p: &mut [f64],
    ) -> Result<usize, EvalError> {
        let n = self.p.len();
        check_modes(MODEL, n, modes, p.len())?;
        self.problem.assemble(MODEL, inp)?;
        self.warm = false;
        let mut sweeps = 0;
        for (mode, out) in modes.iter().zip(p.chunks_exact_mut(n)) {
            self.problem.cause(inp, mode, &mut self.p, &mut self.void);
            // Most often these are the pressures of a film close by.
            if out.iter().all(|p| p.is_finite()) {
                let inner = self.problem.edge.iter().map(|e| *e == 4);
                let known = self.p.iter_mut().zip(&*out).zip(inner).filter(|(_, inner)| *inner);
                known.for_each(|((p, out), _)| *p = *out);
            }
            sweeps += self.sweep(true, false)?;
            out.copy_from_slice(&self.p);
        }
        Ok(sweeps)
    }

    fn superposition(&self) -> Superposition {
        self.spec.cavitation.superposition()
    }

    fn reset(&mut self) {
        self.warm = false;
    }
}
