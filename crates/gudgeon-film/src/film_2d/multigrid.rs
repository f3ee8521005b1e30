use gudgeon_core::kinds::{Film2d, Film2dCtx, Film2dSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::linalg::Singular;
use gudgeon_numerics::multigrid::{FivePoint, LineMultigrid};
use serde::{Deserialize, Serialize};

use super::cavitation::Cavitation;
use super::checks::{check_tolerance, tolerance};
use super::complementarity::{Linear, Solver};
use super::direct::Elimination;
use super::flux::Flux;
use super::problem::Problem;

/// Film by finite volumes, its linear systems solved by multigrid.
///
/// `∂x(φx h³/(12 μ) ∂x p) + ∂y(φy h³/(12 μ) ∂y p) = ∂x(u h_T θ/2) + ∂t(h_T θ)`
///
/// in control volumes round the nodes of a grid that may be graded. Multigrid smooths whole lines along `x`, odd and even ones in turn, and
/// coarsens across: a cycle costs some ten operations per node and leaves about a tenth of the error, whatever the size of the grid, the ratio
/// of its spacings and the film. What is cavitated is carried along the lines and solved with them. A grid of up to a thousand nodes is its own
/// coarsest grid, and solved by elimination where that can.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Multigrid {
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
}

impl Default for Multigrid {
    fn default() -> Self {
        Self { cavitation: Cavitation::default(), flux: Flux::default(), tolerance: tolerance() }
    }
}

#[register_model(
    name = "multigrid",
    summary = "finite volumes with line multigrid, mass-conserving or other cavitation",
    equations = "d/dx(phi_x h^3/(12 mu) dp/dx) + d/dy(phi_y h^3/(12 mu) dp/dy) = d/dx(u h_T theta/2) + d/dt(h_T theta);  \
                mass_conserving: min(p - p_cav, 1 - theta) = 0, theta carried from upstream;  \
                swift_stieber: p >= p_cav, residual >= 0, one of them an equality;  half_sommerfeld: max(p, p_cav);  \
                load = int (p - p_cav) dA;  shear = int (theta mu u/h -+ h/2 dp/dx) dA",
    validity = "Thin laminar film, viscosity constant through its thickness. Second order in the spacing where the film is full, first order at the ends of cavities. \
               A cavity closed in itself, without an edge that gives a pressure above p_cav, may hold any amount of oil.",
    references = ["reynolds1886", "jakobsson1957", "woloszynski2015", "hintermuller2003", "schaffer1998", "eisenstat1983"],
    example = "cavitation = \"mass_conserving\"\nflux = \"face\"\ntolerance = 1e-9\n",
)]
impl Film2dSpec for Multigrid {
    fn build(&self, ctx: &Film2dCtx<'_>) -> Result<Box<dyn Film2d>, BuildError> {
        check_tolerance(self.tolerance)?;
        let problem = Problem::new(ctx.grid, self.flux)?;
        let small = problem.nx * problem.ny <= SMALL;
        let linear = Cycling {
            small,
            eliminated: false,
            grids: LineMultigrid::new(problem.nx, problem.ny, problem.periodic),
            fallback: small.then(|| Elimination::new(&problem.m, true)),
            failed: None,
            symmetric: true,
        };
        Ok(Box::new(Solver::new("multigrid", problem, linear, self.cavitation, self.tolerance)))
    }
}

/// Nodes up to which elimination is tried first. On 378 nodes the skirt of a power cylinder takes 3 s with it, and did not end in 100 s of cycles.
const SMALL: usize = 1000;

/// Part of the largest cause that elimination may leave over.
const ROUNDING: f64 = 1e-12;

struct Cycling {
    /// Whether elimination is tried first.
    small: bool,
    /// Whether it did for the present matrix.
    eliminated: bool,
    grids: LineMultigrid,
    /// Elimination, made when it is first needed: where the film changes a thousandfold from node to node, cycles may not help.
    fallback: Option<Elimination>,
    /// Why the grids cannot be used for the present matrix.
    failed: Option<Singular>,
    symmetric: bool,
}

impl Linear for Cycling {
    fn factor(&mut self, m: &FivePoint, symmetric: bool) -> Result<(), Singular> {
        self.symmetric = symmetric;
        let own = self.fallback.as_mut().filter(|_| self.small);
        self.eliminated = own.is_some_and(|own| own.factor(m, symmetric).is_ok());
        if self.eliminated {
            return Ok(());
        }
        // What is undetermined in a closed cavity cycles leave as it is.
        self.failed = self.grids.setup(m).err();
        match self.failed {
            // Too large for elimination.
            Some(s) if self.fallback.is_none() && !Elimination::fits(m) => Err(s),
            _ => Ok(()),
        }
    }

    fn solve(&mut self, m: &FivePoint, b: &[f64], z: &mut [f64], target: f64) -> (usize, f64) {
        if let Some(own) = self.fallback.as_mut().filter(|_| self.eliminated) {
            let (steps, left) = own.solve(m, b, z, target);
            let largest = b.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
            if left <= target.max(ROUNDING * largest) {
                return (steps, left);
            }
            self.eliminated = false;
            self.failed = self.grids.setup(m).err();
        }
        let mut cycles = 0;
        let mut left = f64::INFINITY;
        if self.failed.is_none() {
            let done = self.grids.solve(b, z, target, 60);
            (cycles, left) = (done.cycles, done.residual);
        }
        if left <= target || !Elimination::fits(m) {
            return (cycles, left);
        }
        let fallback = self.fallback.get_or_insert_with(|| Elimination::new(m, true));
        if fallback.factor(m, self.symmetric).is_err() {
            return (cycles, left);
        }
        let (more, residual) = fallback.solve(m, b, z, target);
        (cycles + more, residual)
    }

    fn solve_block(&mut self, m: &FivePoint, b: &mut [f64]) -> bool {
        self.fallback.as_mut().filter(|_| self.eliminated).is_some_and(|own| own.solve_block(m, b))
    }
}
