use gudgeon_core::kinds::{Film2d, Film2dCtx, Film2dSpec};
use gudgeon_core::{BuildError, register_model};
use gudgeon_numerics::linalg::{BLOCK, Banded, Singular, SymmetricBanded};
use gudgeon_numerics::multigrid::{FivePoint, Role};
use gudgeon_numerics::vectors::{Vectorised, widest};
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
        let linear = Elimination::of(&problem.m, self.cavitation == Cavitation::MassConserving, |k| {
            problem.edge[k] == 4
        });
        Ok(Box::new(Solver::new("direct", problem, linear, self.cavitation, self.tolerance)))
    }
}

/// Place of a node that is no unknown.
const NONE: usize = usize::MAX;

/// What an unknown exchanges with one further on.
#[derive(Clone, Copy)]
struct Coupling {
    row: usize,
    /// How many rows further.
    further: usize,
    /// The node that holds the conductance.
    node: usize,
}

pub(super) struct Elimination {
    /// Where each node stands among the unknowns; [`NONE`] for those whose value is always given.
    place: Vec<usize>,
    /// The node of every unknown.
    nodes: Vec<usize>,
    /// Nodes that are no unknowns.
    given: Vec<usize>,
    /// What unknowns exchange with others further on, along lines and across.
    couplings: [Vec<Coupling>; 2],
    symmetric: SymmetricBanded,
    general: Option<Banded>,
    is_symmetric: bool,
    /// Whether every unknown of the symmetric matrix is diffused.
    is_whole: bool,
    /// What every node lets through to all others and loses.
    diagonal: Vec<f64>,
    work: Vec<f64>,
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
        Self::of(m, general, |_| true)
    }

    /// The same where nodes that are not `solved` have the role [`Role::Fixed`] in every matrix: they take no part.
    pub fn of(m: &FivePoint, general: bool, solved: impl Fn(usize) -> bool) -> Self {
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
        let mut order: Vec<usize> = (0..n).filter(|k| solved(*k)).collect();
        if !by_line {
            order.sort_by_key(|k| column(k % nx) * ny + k / nx);
        }
        let mut place = vec![NONE; n];
        order.iter().enumerate().for_each(|(row, k)| place[*k] = row);
        let couplings = Coupling::all(m, &place, &order);
        let half = couplings.iter().flatten().map(|c| c.further).fold(1, usize::max);
        Self {
            symmetric: SymmetricBanded::new(order.len(), half),
            general: general.then(|| Banded::new(order.len(), half, half)),
            is_symmetric: true,
            is_whole: false,
            diagonal: vec![0.0; n],
            work: vec![0.0; order.len()],
            given: (0..n).filter(|k| place[*k] == NONE).collect(),
            place,
            nodes: order,
            couplings,
        }
    }

    /// Sets up a matrix of diffusion alone, all of whose unknowns are diffused.
    fn assemble_whole(&mut self, m: &FivePoint) {
        widest(Diagonal { m, out: &mut self.diagonal });
        let Self { nodes, symmetric, diagonal, couplings: [along, across], .. } = self;
        symmetric.write_diagonal(nodes.iter().map(|k| diagonal[*k]));
        for (couplings, conductances) in [(along, &m.gx), (across, &m.gy)] {
            for c in couplings {
                symmetric.couple(c.row, c.further, -conductances[c.node]);
            }
        }
    }

    /// Sets up a matrix of diffusion alone, side by side of its nodes.
    fn assemble_symmetric(&mut self, m: &FivePoint) {
        let (nx, place, a) = (m.nx, &self.place, &mut self.symmetric);
        a.clear();
        let free = |k: usize| m.role[k] != Role::Fixed;
        for (k, &row) in place.iter().enumerate().filter(|(_, row)| **row != NONE) {
            a.add(row, row, if free(k) { m.leak[k] } else { 1.0 });
        }
        let mut side = |k: usize, to: usize, g: f64| {
            for k in [k, to].into_iter().filter(|k| free(*k)) {
                a.add(place[k], place[k], g);
            }
            if free(k) && free(to) {
                a.add(place[k].max(place[to]), place[k].min(place[to]), -g);
            }
        };
        for j in 0..m.ny {
            for i in 0..nx {
                let k = j * nx + i;
                let after = m.after(i, k);
                if after != k {
                    side(k, after, m.gx[k]);
                }
                if j + 1 < m.ny {
                    side(k, k + nx, m.gy[k]);
                }
            }
        }
    }

    /// Takes the unknowns of a field over all nodes into `work`; those that are fixed are zero.
    fn gather(&mut self, m: &FivePoint, field: &[f64]) {
        for (own, k) in self.work.iter_mut().zip(&self.nodes) {
            *own = if m.role[*k] == Role::Fixed { 0.0 } else { field[*k] };
        }
    }

    /// Gives the unknowns in `work` to a field over all nodes; what is no unknown is zero.
    fn spread(&self, field: &mut [f64]) {
        field.fill(0.0);
        for (own, k) in self.work.iter().zip(&self.nodes) {
            field[*k] = *own;
        }
    }

    /// Solves for `C` fields at once, up to [`BLOCK`].
    fn solve_group<const C: usize>(&mut self, m: &FivePoint, group: &mut [f64]) {
        let nodes = self.place.len();
        let mut fields = group.chunks_exact(nodes);
        let own: [&[f64]; C] = std::array::from_fn(|_| fields.next().unwrap_or_default());
        let (block, is_whole) = (self.symmetric.block(), self.is_whole);
        for (row, k) in block.iter_mut().zip(&self.nodes) {
            *row = [0.0; BLOCK];
            if is_whole || m.role[*k] != Role::Fixed {
                for c in 0..C {
                    row[c] = own[c][*k];
                }
            }
        }
        self.symmetric.solve_block();
        let mut fields = group.chunks_exact_mut(nodes);
        let mut own: [&mut [f64]; C] = std::array::from_fn(|_| fields.next().unwrap_or_default());
        for field in &mut own {
            self.given.iter().for_each(|k| field[*k] = 0.0);
        }
        for (row, k) in self.symmetric.block().iter().zip(&self.nodes) {
            for c in 0..C {
                own[c][*k] = row[c];
            }
        }
    }
}

impl Coupling {
    /// All those along lines, and those across, of the unknowns whose nodes are in `order`, each node being at `place`.
    fn all(m: &FivePoint, place: &[usize], order: &[usize]) -> [Vec<Self>; 2] {
        let mut all = [Vec::new(), Vec::new()];
        for (row, &k) in order.iter().enumerate() {
            let (before, after) = (m.before(k % m.nx, k), m.after(k % m.nx, k));
            for (way, to, node) in [(0, before, before), (0, after, k), (1, k + m.nx, k)] {
                if let Some(other) = place.get(to).filter(|other| **other != NONE && **other > row) {
                    all[way].push(Self { row, further: other - row, node });
                }
            }
        }
        all
    }
}

/// What every node of a matrix of diffusion lets through to all others and loses.
struct Diagonal<'a> {
    m: &'a FivePoint,
    out: &'a mut [f64],
}

impl Vectorised for Diagonal<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { m, out } = self;
        let (nx, n) = (m.nx, out.len());
        let (gx, gy, leak) = (&m.gx[..n], &m.gy[..n], &m.leak[..n]);
        for k in 0..nx {
            out[k] = leak[k] + (gx[k.saturating_sub(1)] + gx[k]) + gy[k];
        }
        let (before, below) = (&gx[nx - 1..n - 1], &gy[..n - nx]);
        let own = gx[nx..].iter().zip(&gy[nx..]).zip(&leak[nx..]);
        for ((out, ((gx, gy), leak)), (before, below)) in
            out[nx..].iter_mut().zip(own).zip(before.iter().zip(below))
        {
            *out = leak + (before + gx) + (below + gy);
        }
        if m.periodic {
            for start in (0..n).step_by(nx) {
                let (before, below) = (gx[start + nx - 1], if start > 0 { gy[start - nx] } else { 0.0 });
                out[start] = leak[start] + (before + gx[start]) + (below + gy[start]);
            }
        } else {
            out[0] = leak[0] + gx[0] + gy[0];
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
        if symmetric || self.general.is_none() {
            self.is_whole = self.nodes.iter().all(|k| m.role[*k] == Role::Diffused);
            if self.is_whole {
                self.assemble_whole(m);
            } else {
                self.assemble_symmetric(m);
            }
            return self.symmetric.factor();
        }
        let Some(general) = self.general.as_mut() else { return Ok(()) };
        general.clear();
        for j in 0..ny {
            for i in 0..nx {
                let k = j * nx + i;
                let row = self.place[k];
                if row == NONE {
                    continue;
                }
                if m.role[k] == Role::Fixed {
                    general.add(row, row, 1.0);
                    continue;
                }
                let r = m.row(i, j);
                general.add(row, row, r.c);
                let mut couple = |to: usize, value: f64| {
                    if to != k && m.role[to] != Role::Fixed && value != 0.0 {
                        general.add(row, self.place[to], -value);
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
        general.factor()
    }

    fn solve(&mut self, m: &FivePoint, b: &[f64], z: &mut [f64], _: f64) -> (usize, f64) {
        self.gather(m, b);
        match self.general.as_ref() {
            Some(general) if !self.is_symmetric => general.solve(&mut self.work),
            _ => self.symmetric.solve(&mut self.work),
        }
        self.spread(z);
        (1, m.residual(b, z))
    }

    fn solve_block(&mut self, m: &FivePoint, b: &mut [f64]) -> bool {
        if !self.is_symmetric {
            return false;
        }
        let nodes = self.place.len();
        for group in b.chunks_mut(BLOCK * nodes) {
            match group.len() / nodes {
                2 => self.solve_group::<2>(m, group),
                3 => self.solve_group::<3>(m, group),
                BLOCK => self.solve_group::<BLOCK>(m, group),
                _ => {
                    self.gather(m, group);
                    self.symmetric.solve(&mut self.work);
                    self.spread(group);
                }
            }
        }
        true
    }
}
