use gudgeon_core::kinds::{
    Edge, Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec, FilmMode, Superposition, Viscosity,
};
use gudgeon_core::{BuildError, EvalError, register_model};
use gudgeon_numerics::elementary;
use gudgeon_numerics::linalg::Banded;
use serde::{Deserialize, Serialize};

use super::cavitation::Cavitation;
use super::checks::check_modes;
use super::flux::Flux;
use super::problem::Problem;

/// Full film by central differences of the expanded equation, cut off at `p_cav`: the film of published programs.
///
/// ```text
/// α ∂²p/∂x² + α' ∂p/∂x + γ ∂²p/∂y² + γ' ∂p/∂y = 6 μ u ∂h_c/∂x + 12 μ ∂h_T/∂t,    α = φ_x h³,  γ = φ_y h³
/// ```
///
/// at the nodes of an equally spaced grid, with `α'`, `γ'` and `∂h_c/∂x` from the five nearest nodes (exact for gaps that change by a
/// polynomial of fourth degree). Flows between nodes do not balance, as they do in the finite volumes of the other models. The
/// film between nodes (`h_face_x`, `h_face_y`) is not read.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CentralDifferences {
    /// What happens where the pressure would fall below `p_cav`: `half_sommerfeld` or `full_sommerfeld`.
    #[serde(default = "cut_off")]
    pub cavitation: Cavitation,
    /// How the linear equations are solved.
    #[serde(default)]
    pub equations: Equations,
}

/// How the equations of [`CentralDifferences`] are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Equations {
    /// Elimination within the band.
    #[default]
    Elimination,
    /// Sweeps with over-relaxation from zero pressure until a sweep changes the pressures by less than 1e-5 Pa (their Euclidean norm), at most
    /// 10 000 of them. The relaxation is that of a film of uniform thickness.
    Sweeps,
}

fn cut_off() -> Cavitation {
    Cavitation::HalfSommerfeld
}

impl Default for CentralDifferences {
    fn default() -> Self {
        Self { cavitation: cut_off(), equations: Equations::default() }
    }
}

const MODEL: &str = "central_differences";
const MAX_SWEEPS: usize = 10_000;
/// Change of the pressures in a sweep \[Pa\] at which the sweeps end.
const SETTLED: f64 = 1e-5;

#[register_model(
    name = "central_differences",
    summary = "central differences of the expanded equation, cut off at the cavitation pressure, as published programs have it",
    equations = "a d2p/dx2 + a' dp/dx + g d2p/dy2 + g' dp/dy = 6 mu u dh_c/dx + 12 mu dh_T/dt,  a = phi_x h^3,  g = phi_y h^3;  \
                half_sommerfeld: max(p, p_cav)",
    validity = "Equally spaced nodes, five or more each way, a pressure or a wall at every edge, uniform viscosity, no history. Second order, but flows between nodes do not balance.",
    references = ["loureiro2009", "zhu1992"],
    example = "cavitation = \"half_sommerfeld\"\nequations = \"elimination\"\n",
)]
impl Film2dSpec for CentralDifferences {
    fn build(&self, ctx: &Film2dCtx<'_>) -> Result<Box<dyn Film2d>, BuildError> {
        if self.cavitation.superposition() == Superposition::None {
            return Err(BuildError::at("cavitation", "must be `half_sommerfeld` or `full_sommerfeld`"));
        }
        let problem = Problem::new(ctx.grid, Flux::Node)?;
        if problem.periodic {
            return Err(BuildError::new("central differences know no film that closes on itself"));
        }
        for (name, line) in [("x", &ctx.grid.x), ("y", &ctx.grid.y)] {
            let n = line.len();
            if n < 5 {
                return Err(BuildError::new(format!(
                    "differences of fourth order need five nodes along {name}, not {n}"
                )));
            }
            let step = (line[n - 1] - line[0]) / (n - 1) as f64;
            if line.windows(2).any(|w| (w[1] - w[0] - step).abs() > 1e-6 * step) {
                return Err(BuildError::new(format!("the nodes along {name} must be equally spaced")));
            }
        }
        let n = problem.len();
        let (nx, ny) = (problem.nx, problem.ny);
        Ok(Box::new(Differences {
            spec: self.clone(),
            band: Banded::new(n, nx.min(ny), nx.min(ny)),
            by_line: nx <= ny,
            coefficient: vec![[0.0; 5]; n],
            slope: vec![0.0; n],
            problem,
            b: vec![0.0; n],
            p: vec![0.0; n],
            pressure: vec![0.0; n],
            fill: vec![1.0; n],
            void: vec![0.0; n],
        }))
    }
}

struct Differences {
    spec: CentralDifferences,
    problem: Problem,
    band: Banded,
    by_line: bool,
    /// Of every node: before, after, below, above, itself.
    coefficient: Vec<[f64; 5]>,
    /// `∂h_c/∂x`.
    slope: Vec<f64>,
    b: Vec<f64>,
    p: Vec<f64>,
    pressure: Vec<f64>,
    fill: Vec<f64>,
    void: Vec<f64>,
}

/// Weights of five equally spaced values for the derivative at the `k`-th of them, in twelfths of the spacing.
const WEIGHTS: [[f64; 5]; 5] = [
    [-25.0, 48.0, -36.0, 16.0, -3.0],
    [-3.0, -10.0, 18.0, -6.0, 1.0],
    [1.0, -8.0, 0.0, 8.0, -1.0],
    [-1.0, 6.0, -18.0, 10.0, 3.0],
    [3.0, -16.0, 36.0, -48.0, 25.0],
];

/// Derivative at node `i` of `n`, times the spacing. Behind a wall the function is its mirror image.
fn derivative(f: impl Fn(usize) -> f64, i: usize, n: usize, walls: [bool; 2]) -> f64 {
    let (low, high) = (walls[0] && i < 2, walls[1] && i + 2 >= n);
    if low || high {
        let at = |k: isize| {
            let last = n as isize - 1;
            let k = if k < 0 { -k } else { k };
            f(if k > last { 2 * last - k } else { k } as usize)
        };
        let i = i as isize;
        return (at(i - 2) - 8.0 * at(i - 1) + 8.0 * at(i + 1) - at(i + 2)) / 12.0;
    }
    let first = i.saturating_sub(2).min(n - 5);
    WEIGHTS[i - first].iter().enumerate().map(|(k, w)| w * f(first + k)).sum::<f64>() / 12.0
}

impl Differences {
    fn place(&self, k: usize) -> usize {
        if self.by_line { k } else { k % self.problem.nx * self.problem.ny + k / self.problem.nx }
    }

    /// Coefficients of the equation, and its elimination where asked for.
    fn assemble(&mut self, inp: &Film2dIn<'_>) -> Result<(), EvalError> {
        if inp.history.is_some() {
            return Err(EvalError::fatal(MODEL, "only the mass-conserving condition has a history"));
        }
        if !matches!(inp.mu, Viscosity::Uniform(_)) {
            return Err(EvalError::fatal(MODEL, "the viscosity must be uniform"));
        }
        self.problem.assemble(MODEL, inp)?;
        let (nx, ny) = (self.problem.nx, self.problem.ny);
        let grid = &self.problem.grid;
        let walls = grid.edges.map(|e| e == Edge::Wall);
        let dx = (grid.x[nx - 1] - grid.x[0]) / (nx - 1) as f64;
        let dy = (grid.y[ny - 1] - grid.y[0]) / (ny - 1) as f64;
        let cube = |phi: &[f64], k: usize| if phi.is_empty() { 1.0 } else { phi[k] } * inp.h[k].powi(3);
        let carried = if inp.factors.transport.is_empty() { inp.h } else { inp.factors.transport };
        for j in 0..ny {
            for i in 0..nx {
                let k = j * nx + i;
                if self.problem.edge[k] < 4 {
                    continue;
                }
                let (a, g) = (cube(inp.factors.pressure_x, k), cube(inp.factors.pressure_y, k));
                let da =
                    derivative(|i| cube(inp.factors.pressure_x, j * nx + i), i, nx, [walls[0], walls[1]]);
                let dg =
                    derivative(|j| cube(inp.factors.pressure_y, j * nx + i), j, ny, [walls[2], walls[3]]);
                self.slope[k] = derivative(|i| carried[j * nx + i], i, nx, [walls[0], walls[1]]) / dx;
                let (xx, yy) = (dx.powi(-2), dy.powi(-2));
                let mut c = [
                    (a - 0.5 * da) * xx,
                    (a + 0.5 * da) * xx,
                    (g - 0.5 * dg) * yy,
                    (g + 0.5 * dg) * yy,
                    -2.0 * (a * xx + g * yy),
                ];
                // What stands behind a wall is what stands before it.
                for (at_wall, from, to) in
                    [(i == 0, 0, 1), (i + 1 == nx, 1, 0), (j == 0, 2, 3), (j + 1 == ny, 3, 2)]
                {
                    if at_wall {
                        c[to] += c[from];
                        c[from] = 0.0;
                    }
                }
                self.coefficient[k] = c;
            }
        }
        if self.spec.equations == Equations::Sweeps {
            return Ok(());
        }
        self.band.clear();
        for k in 0..nx * ny {
            let row = self.place(k);
            if self.problem.edge[k] < 4 {
                self.band.add(row, row, 1.0);
                continue;
            }
            let c = self.coefficient[k];
            self.band.add(row, row, c[4]);
            for (c, to) in c.iter().zip([k.wrapping_sub(1), k + 1, k.wrapping_sub(nx), k + nx]) {
                if *c != 0.0 {
                    let column = self.place(to);
                    self.band.add(row, column, *c);
                }
            }
        }
        self.band.factor().map_err(|s| {
            EvalError::recoverable(MODEL, format!("the film is undetermined at node {}", s.column))
        })
    }

    /// Pressures of one cause into `p`; those of the edges stand there. Returns the work.
    fn find(&mut self, u: f64, dhdt: &[f64], mu: f64) -> Result<usize, EvalError> {
        let (nx, n) = (self.problem.nx, self.p.len());
        for k in 0..n {
            if self.problem.edge[k] == 4 {
                let rate = if dhdt.is_empty() { 0.0 } else { dhdt[k] };
                self.b[k] = 12.0 * mu * (0.5 * u * self.slope[k] + rate);
            }
        }
        if self.spec.equations == Equations::Elimination {
            // The order of the unknowns is that of the band.
            for k in 0..n {
                let row = self.place(k);
                self.void[row] = if self.problem.edge[k] < 4 { self.p[k] } else { self.b[k] };
            }
            self.band.solve(&mut self.void);
            for k in 0..n {
                self.p[k] = self.void[self.place(k)];
            }
            self.void.fill(0.0);
            return Ok(1);
        }
        let lines = |n: usize, edges: [Edge; 2]| {
            let given = edges.iter().filter(|e| **e == Edge::Pressure).count();
            elementary::cos(std::f64::consts::PI * 0.5 * given as f64 / (n - 1) as f64)
        };
        let e = self.problem.grid.edges;
        let weight = |at: usize| self.coefficient.iter().map(|c| c[at] + c[at + 1]).sum::<f64>();
        let (wx, wy) = (weight(0), weight(2));
        let rho = (wx * lines(nx, [e[0], e[1]]) + wy * lines(self.problem.ny, [e[2], e[3]])) / (wx + wy);
        let omega = 2.0 / (1.0 + (1.0 - rho * rho).max(0.0).sqrt());
        for sweep in 1..=MAX_SWEEPS {
            let mut moved = 0.0;
            for k in 0..n {
                if self.problem.edge[k] < 4 {
                    continue;
                }
                let c = &self.coefficient[k];
                let mut sum = self.b[k];
                for (c, to) in c.iter().zip([k.wrapping_sub(1), k + 1, k.wrapping_sub(nx), k + nx]) {
                    if *c != 0.0 {
                        sum -= c * self.p[to];
                    }
                }
                let change = omega * (sum / c[4] - self.p[k]);
                self.p[k] += change;
                moved += change * change;
            }
            if moved.sqrt() < SETTLED {
                return Ok(sweep);
            }
            if !moved.is_finite() {
                break;
            }
        }
        Err(EvalError::recoverable(MODEL, format!("no convergence in {MAX_SWEEPS} sweeps")))
    }

    /// Largest imbalance of the equations over the largest term.
    fn residual(&self) -> f64 {
        let nx = self.problem.nx;
        let (mut worst, mut size) = (0.0_f64, 0.0_f64);
        for (k, c) in self.coefficient.iter().enumerate() {
            if self.problem.edge[k] < 4 {
                continue;
            }
            let mut sum = c[4] * self.p[k] - self.b[k];
            size = size.max((c[4] * self.p[k]).abs()).max(self.b[k].abs());
            for (c, to) in c.iter().zip([k.wrapping_sub(1), k + 1, k.wrapping_sub(nx), k + nx]) {
                if *c != 0.0 {
                    sum += c * self.p[to];
                }
            }
            worst = worst.max(sum.abs());
        }
        if size > 0.0 { worst / size } else { 0.0 }
    }
}

impl Film2d for Differences {
    fn grid(&self) -> &Film2dGrid {
        &self.problem.grid
    }

    fn solve(&mut self, inp: &Film2dIn<'_>) -> Result<Film2dOut, EvalError> {
        self.assemble(inp)?;
        let Viscosity::Uniform(mu) = inp.mu else { return Err(EvalError::fatal(MODEL, "no viscosity")) };
        let cuts = self.superposition() == Superposition::CutOff;
        self.p.fill(0.0);
        self.void.fill(0.0);
        self.problem.set_edges(inp, cuts, &mut self.p, &mut self.void);
        self.void.fill(0.0);
        let cycles = self.find(inp.u, inp.dhdt, mu)?;
        let residual = self.residual();
        for k in 0..self.p.len() {
            if cuts {
                self.p[k] = self.p[k].max(0.0);
            }
            self.pressure[k] = inp.p_cav + self.p[k];
        }
        self.problem.drive(inp, inp.u, inp.dhdt, false);
        let mut out = self.problem.result(inp, &self.p, &self.void, self.spec.cavitation, &mut self.b);
        (out.iterations, out.cycles, out.residual) = (1, cycles, residual);
        if !(out.load.is_finite() && out.shear_lower.is_finite()) {
            return Err(EvalError::recoverable(MODEL, "the film overflows"));
        }
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
        self.assemble(inp)?;
        let Viscosity::Uniform(mu) = inp.mu else { return Err(EvalError::fatal(MODEL, "no viscosity")) };
        let mut cycles = 0;
        for (mode, out) in modes.iter().zip(p.chunks_exact_mut(n)) {
            let edges = Film2dIn { edge_pressure: mode.edge_pressure, p_cav: 0.0, ..*inp };
            self.p.fill(0.0);
            self.problem.set_edges(&edges, false, &mut self.p, &mut self.void);
            self.void.fill(0.0);
            cycles += self.find(mode.u, mode.dhdt, mu)?;
            out.copy_from_slice(&self.p);
        }
        Ok(cycles)
    }

    fn superposition(&self) -> Superposition {
        self.spec.cavitation.superposition()
    }

    fn reset(&mut self) {}
}
