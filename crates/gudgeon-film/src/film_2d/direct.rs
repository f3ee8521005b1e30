use gudgeon_core::kinds::{Film2d, Film2dCtx, Film2dSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::linalg::{Banded, Singular, SymmetricBanded};
use gudgeon_numerics::multigrid::{FivePoint, Role};
use serde::{Deserialize, Serialize};

use super::cavitation::Cavitation;
use super::checks::{check_tolerance, tolerance};
use super::complementarity::{Linear, Solver};
use super::flux::Flux;
use super::problem::Problem;

/// Film by finite volumes, its linear systems solved by elimination within the band.
///
/// The same equations as `multigrid`. Work and storage grow with the square and the first power of the shorter side of the grid times the number of nodes:
/// for small grids, and as a check.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Direct {
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

impl Default for Direct {
    fn default() -> Self {
        Self { cavitation: Cavitation::default(), flux: Flux::default(), tolerance: tolerance() }
    }
}

/// Most entries of the band: 1 GB.
const MAX_ENTRIES: usize = 1 << 27;

#[register_model(
    name = "direct",
    summary = "finite volumes with banded elimination, mass-conserving or other cavitation",
    equations = "d/dx(phi_x h^3/(12 mu) dp/dx) + d/dy(phi_y h^3/(12 mu) dp/dy) = d/dx(u h_T theta/2) + d/dt(h_T theta);  \
                mass_conserving: min(p - p_cav, 1 - theta) = 0, theta carried from upstream;  \
                swift_stieber: p >= p_cav, residual >= 0, one of them an equality;  half_sommerfeld: max(p, p_cav);  \
                load = int (p - p_cav) dA;  shear = int (theta mu u/h -+ h/2 dp/dx) dA",
    validity = "As multigrid. Grids whose band needs more than 1 GB are refused.",
    references = ["reynolds1886", "jakobsson1957", "hintermuller2003"],
    example = "cavitation = \"swift_stieber\"\nflux = \"face\"\ntolerance = 1e-9\n",
)]
impl Film2dSpec for Direct {
    fn build(&self, ctx: &Film2dCtx<'_>) -> Result<Box<dyn Film2d>, BuildError> {
        check_tolerance(self.tolerance)?;
        let problem = Problem::new(ctx.grid, self.flux)?;
        if !Elimination::fits(&problem.m) {
            let what = format!("{} x {} nodes are too many for banded elimination", problem.nx, problem.ny);
            return Err(BuildError::new(what).help("use the model `multigrid`"));
        }
        let linear = Elimination::new(&problem.m, self.cavitation == Cavitation::MassConserving);
        Ok(Box::new(Solver::new("direct", problem, linear, self.cavitation, self.tolerance)))
    }
}

pub(super) struct Elimination {
    /// Where each node stands among the unknowns.
    place: Vec<usize>,
    symmetric: SymmetricBanded,
    general: Option<Banded>,
    is_symmetric: bool,
    work: Vec<f64>,
    block: Vec<[f64; 4]>,
}

impl Elimination {
    /// Sub-diagonals: the shorter side of the grid, twice over when a ring is folded so that its neighbours stand two columns apart.
    fn half(m: &FivePoint) -> usize {
        if m.periodic { 2 * m.ny } else { m.nx.min(m.ny) }
    }

    pub fn fits(m: &FivePoint) -> bool {
        (m.nx * m.ny).saturating_mul(4 * Self::half(m) + 2) <= MAX_ENTRIES
    }

    /// Work space; `general` for matrices that are not symmetric.
    pub fn new(m: &FivePoint, general: bool) -> Self {
        let (nx, ny, n) = (m.nx, m.ny, m.nx * m.ny);
        let column = |i: usize| {
            if !m.periodic {
                i
            } else if 2 * i < nx {
                2 * i
            } else {
                2 * (nx - 1 - i) + 1
            }
        };
        let by_line = !m.periodic && nx <= ny;
        let half = Self::half(m);
        Self {
            place: (0..n).map(|k| if by_line { k } else { column(k % nx) * ny + k / nx }).collect(),
            symmetric: SymmetricBanded::new(n, half),
            general: general.then(|| Banded::new(n, half, half)),
            is_symmetric: true,
            work: vec![0.0; n],
            block: vec![[0.0; 4]; n],
        }
    }
}

impl Linear for Elimination {
    fn takes_leaks(&self) -> bool {
        true
    }

    fn factor(&mut self, m: &FivePoint, symmetric: bool) -> Result<(), Singular> {
        let (nx, ny) = (m.nx, m.ny);
        self.is_symmetric = symmetric;
        self.symmetric.clear();
        if let (false, Some(general)) = (symmetric, self.general.as_mut()) {
            general.clear();
        }
        for j in 0..ny {
            for i in 0..nx {
                let k = j * nx + i;
                let row = self.place[k];
                let mut put = |column: usize, value: f64| match self.general.as_mut() {
                    Some(general) if !symmetric => general.add(row, column, value),
                    _ if column <= row => self.symmetric.add(row, column, value),
                    _ => {}
                };
                if m.role[k] == Role::Fixed {
                    put(row, 1.0);
                    continue;
                }
                let r = m.row(i, j);
                put(row, r.c);
                let mut couple = |to: usize, value: f64| {
                    if to != k && m.role[to] != Role::Fixed && value != 0.0 {
                        put(self.place[to], -value);
                    }
                };
                couple(m.before(i, k), r.w);
                couple(m.after(i, k), r.e);
                if j > 0 {
                    couple(k - nx, r.s);
                }
                if j + 1 < ny {
                    couple(k + nx, r.n);
                }
            }
        }
        match self.general.as_mut() {
            Some(general) if !symmetric => general.factor(),
            _ => self.symmetric.factor(),
        }
    }

    fn solve(&mut self, m: &FivePoint, b: &[f64], z: &mut [f64], _: f64) -> (usize, f64) {
        for (k, &row) in self.place.iter().enumerate() {
            self.work[row] = if m.role[k] == Role::Fixed { 0.0 } else { b[k] };
        }
        match self.general.as_ref() {
            Some(general) if !self.is_symmetric => general.solve(&mut self.work),
            _ => self.symmetric.solve(&mut self.work),
        }
        for (z, &row) in z.iter_mut().zip(&self.place) {
            *z = self.work[row];
        }
        (1, m.residual(b, z))
    }
    fn solve_block(&mut self, m: &FivePoint, b: &mut [f64]) -> bool {
        if !self.is_symmetric {
            return false;
        }
        for column in b.chunks_exact_mut(self.place.len()) {
            for (k, &row) in self.place.iter().enumerate() {
                self.work[row] = if m.role[k] == Role::Fixed { 0.0 } else { column[k] };
            }
            column.copy_from_slice(&self.work);
        }
        self.symmetric.solve_block(b, &mut self.block);
        for column in b.chunks_exact_mut(self.place.len()) {
            self.work.copy_from_slice(column);
            column.iter_mut().zip(&self.place).for_each(|(z, &row)| *z = self.work[row]);
        }
        true
    }
}
