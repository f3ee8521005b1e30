use std::fmt::Debug;

use dyn_clone::DynClone;

use crate::{BuildError, EvalError, register_kind};

/// What an edge of a two-dimensional film does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Edge {
    /// The pressure is given: [`Film2dIn::edge_pressure`].
    #[default]
    Pressure,
    /// No flow across: a wall, or a plane of symmetry. Nothing slides across it either.
    Wall,
    /// The film closes on itself. Both edges of x, or none.
    Periodic,
}

/// Rectangular grid of a film, with nodes on its edges. The surface moves along `x`; `y` lies across.
///
/// Fields over the grid hold node `(i, j)` at `j * x.len() + i`. Around each node lies a control volume whose sides stand
/// halfway to the neighbours.
#[derive(Debug, Clone, PartialEq)]
pub struct Film2dGrid {
    /// Positions of the nodes along `x` \[m\], increasing, three or more; of a periodic film those of one period without
    /// the node that repeats the first.
    pub x: Vec<f64>,
    /// Positions of the nodes along `y` \[m\], increasing, three or more.
    pub y: Vec<f64>,
    /// Edges at the lowest `x`, the highest `x`, the lowest `y` and the highest `y`. At least one is [`Edge::Pressure`].
    pub edges: [Edge; 4],
    /// Length of one period of `x` \[m\], from the first node to where it repeats; read only when `x` is periodic.
    pub period: f64,
}

impl Film2dGrid {
    /// `nx` × `ny` equally spaced nodes over `length` × `width` \[m\], the first node at the origin, a pressure on every edge.
    #[must_use]
    pub fn uniform(nx: usize, ny: usize, length: f64, width: f64) -> Self {
        let line = |n: usize, l: f64| (0..n).map(|i| l * (i as f64 / (n.max(2) - 1) as f64)).collect();
        Self { x: line(nx, length), y: line(ny, width), edges: [Edge::Pressure; 4], period: length }
    }

    /// `nx` × `ny` equally spaced nodes round a full turn of length `period` \[m\] and over `width` \[m\], a pressure on both
    /// edges of `y`.
    #[must_use]
    pub fn journal(nx: usize, ny: usize, period: f64, width: f64) -> Self {
        let mut grid = Self::uniform(nx, ny, period, width);
        grid.x = (0..nx).map(|i| period * (i as f64 / nx.max(1) as f64)).collect();
        grid.edges = [Edge::Periodic, Edge::Periodic, Edge::Pressure, Edge::Pressure];
        grid
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.x.len() * self.y.len()
    }

    /// Whether there is no node.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether `x` closes on itself.
    #[must_use]
    pub fn is_periodic(&self) -> bool {
        self.edges[0] == Edge::Periodic
    }

    /// Weights of the nodes along `x` and along `y` \[m\]: `∫ f dA = Σ wx[i] wy[j] f(i, j)`.
    ///
    /// Between two nodes the mean of the parabolas through the next node on either side is integrated (of uniform nodes: 3/8, 7/6, 23/24, 1, …
    /// times the spacing from an edge on). The error falls with the fourth power of the spacing where `f` is smooth. Behind a
    /// wall `f` continues as its mirror image.
    #[must_use]
    pub fn weights(&self) -> (Vec<f64>, Vec<f64>) {
        let period = self.is_periodic().then_some(self.period);
        (
            weights(&self.x, self.edges[0], self.edges[1], period),
            weights(&self.y, self.edges[2], self.edges[3], None),
        )
    }

    /// Whether a film on this grid is its own mirror image in `y`, to a relative deviation `tolerance` of every one of
    /// `fields` (film thickness, squeeze velocity, …; an empty field is one that is zero or uniform). Such a film can be
    /// solved on its upper half alone, with [`Edge::Wall`] on the line of symmetry.
    #[must_use]
    pub fn is_symmetric_in_y(&self, edge_pressure: &[f64; 4], fields: &[&[f64]], tolerance: f64) -> bool {
        let (nx, ny) = (self.x.len(), self.y.len());
        let (Some(&first), Some(&last)) = (self.y.first(), self.y.last()) else { return false };
        if self.edges[2] != self.edges[3] || edge_pressure[2] != edge_pressure[3] {
            return false;
        }
        let width = last - first;
        let mirrored =
            (0..ny).all(|j| (self.y[j] - first - (last - self.y[ny - 1 - j])).abs() <= tolerance * width);
        mirrored
            && fields.iter().all(|f| {
                let scale = f.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
                f.is_empty()
                    || f.len() == nx * ny
                        && (0..ny / 2).all(|j| {
                            let (low, high) =
                                (&f[j * nx..(j + 1) * nx], &f[(ny - 1 - j) * nx..(ny - j) * nx]);
                            low.iter().zip(high).all(|(a, b)| (a - b).abs() <= tolerance * scale)
                        })
            })
    }
}

/// See [`Film2dGrid::weights`].
fn weights(line: &[f64], low: Edge, high: Edge, period: Option<f64>) -> Vec<f64> {
    let n = line.len();
    let mut weights = vec![0.0; n];
    if n < 3 {
        return weights;
    }
    // Neighbours of the line: what they stand for, and where they are.
    let before = match (low, period) {
        (_, Some(period)) => Some((n - 1, line[n - 1] - period)),
        (Edge::Wall, _) => Some((1, 2.0 * line[0] - line[1])),
        _ => None,
    };
    let after = |k: usize| match (high, period) {
        (_, Some(period)) => Some((k, line[k] + period)),
        (Edge::Wall, _) if k == 0 => Some((n - 2, 2.0 * line[n - 1] - line[n - 2])),
        _ => None,
    };
    // An interval from b to c, and the parabola through a third node beyond b.
    let mut add = |a: (usize, f64), b: (usize, f64), c: (usize, f64), share: f64| {
        let (beyond, own) = ((b.1 - a.1).abs(), (c.1 - b.1).abs());
        weights[a.0] -= share * own.powi(3) / (6.0 * beyond * (beyond + own));
        weights[b.0] += share * own * (own + 3.0 * beyond) / (6.0 * beyond);
        weights[c.0] += share * own * (2.0 * own + 3.0 * beyond) / (6.0 * (beyond + own));
    };
    let intervals = if period.is_some() { n } else { n - 1 };
    for i in 0..intervals {
        let node = |k: usize| if k < n { Some((k, line[k])) } else { after(k - n) };
        let left = if i > 0 { node(i - 1) } else { before };
        let (Some(b), Some(c)) = (node(i), node(i + 1)) else { continue };
        let right = node(i + 2);
        let share = if left.is_some() && right.is_some() { 0.5 } else { 1.0 };
        if let Some(a) = left {
            add(a, b, c, share);
        }
        if let Some(d) = right {
            add(d, c, b, share);
        }
    }
    weights
}

/// What a [`Film2dSpec`] is built for.
#[derive(Debug, Clone, Copy)]
pub struct Film2dCtx<'a> {
    /// The grid.
    pub grid: &'a Film2dGrid,
}

/// Configuration of a solver of the Reynolds equation in two dimensions.
#[register_kind(
    name = "film_2d",
    summary = "oil film between two surfaces, resolved along and across the motion"
)]
pub trait Film2dSpec: Debug + DynClone + Send + Sync {
    /// Builds the running solver for one grid.
    ///
    /// # Errors
    /// A grid that is none (too few nodes, not increasing, no edge with a pressure), or options that contradict each other.
    fn build(&self, ctx: &Film2dCtx<'_>) -> Result<Box<dyn Film2d>, BuildError>;
}

/// Viscosity of a film.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viscosity<'a> {
    /// One value for the whole film \[Pa s\].
    Uniform(f64),
    /// One value per node \[Pa s\].
    Nodes(&'a [f64]),
}

/// What roughness or rheology does to the flow through a node, one value per node; an empty slice stands for the smooth
/// film.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlowFactors<'a> {
    /// Factor of the pressure flow along `x`.
    pub pressure_x: &'a [f64],
    /// Factor of the pressure flow along `y`.
    pub pressure_y: &'a [f64],
    /// Film thickness that the sliding surface carries along \[m\], `h_T + σ φ_s`: the flux is half the velocity times it. Between
    /// nodes its mean, or where [`Film2dIn::h_face_x`] is given that and the mean of what it is above the film thickness of the nodes.
    pub transport: &'a [f64],
    /// Oil that the full gap holds per area \[m\], the mean gap `h_T`. Its rate stands in [`Film2dIn::dhdt`]; here it is what
    /// a filling of 1 means in [`History`].
    pub content: &'a [f64],
}

/// The film one time step ago.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct History<'a> {
    /// Length of the step \[s\].
    pub dt: f64,
    /// Oil per area that every node held then \[m\]: film thickness times filling.
    pub content: &'a [f64],
}

/// How far the nodes of a film are filled at an instant, as a film with a history knows. Those that are not stand at `p_cav`, and what the surface carries from
/// them to the next node counts by their filling.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unfilled<'a> {
    /// How much of a full film's pressure a node takes: 1 where it is full, 0 where it stands at `p_cav`. Between, with `s`, it loses `(1/s - 1) G p` of a
    /// pressure `p`, `G` being the sum of its conductances.
    pub engaged: &'a [f64],
    /// Filling of the nodes, 0 to 1.
    pub fill: &'a [f64],
}

/// A film at an instant. The upper surface stands still in `x`, the lower one slides along `+x` with `u`.
///
/// `∂x(φx h³/(12 μ) ∂x p) + ∂y(φy h³/(12 μ) ∂y p) = ∂x(u h θ/2) + ∂t(h θ)`, with `θ` the filling: 1 where `p > p_cav`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Film2dIn<'a> {
    /// Film thickness at the nodes \[m\].
    pub h: &'a [f64],
    /// Film thickness on the sides between a node and the next one along `x` \[m\], at the index of the lower node, for profiles with steps
    /// between nodes; empty: the mean of the two nodes.
    pub h_face_x: &'a [f64],
    /// The same along `y`.
    pub h_face_y: &'a [f64],
    /// Squeeze velocity `∂h/∂t` at the nodes \[m/s\]; empty: zero. Not read with a [`History`].
    pub dhdt: &'a [f64],
    /// Velocity of the lower surface along `+x`, seen from the upper one \[m/s\].
    pub u: f64,
    /// Dynamic viscosity.
    pub mu: Viscosity<'a>,
    /// Absolute pressure below which the film cavitates \[Pa\].
    pub p_cav: f64,
    /// Absolute pressures of the edges \[Pa\] in the order of [`Film2dGrid::edges`]; a corner of two has that of `x`. One below `p_cav`
    /// counts as `p_cav`, but for a full film that does not cavitate.
    pub edge_pressure: [f64; 4],
    /// Filling of the oil that arrives at an edge whose pressure is `p_cav`, 0 to 1: below 1 the inlet is starved. Read by the
    /// mass-conserving condition alone.
    pub edge_fill: [f64; 4],
    /// Effects of roughness and rheology.
    pub factors: FlowFactors<'a>,
    /// The film before this step, for a transient mass-conserving film; none: `∂t(h θ)` follows from `dhdt`.
    pub history: Option<History<'a>>,
    /// Film \[m\] that lies on the sliding surface where it comes in over the lowest and over the highest `x`, for a step of a film with a history whose edges
    /// stand at `p_cav` ([`Film2d::keeps_fill`]). The nodes on those edges then hold what reaches them, and what they have no room for leaves. None: the fillings
    /// of the edges are given.
    pub arriving: Option<[f64; 2]>,
    /// Nodes that are not filled, for [`Film2d::solve_many`] and [`Film2d::imbalance`] of a model that says [`Film2d::keeps_fill`]; none: all are.
    pub unfilled: Option<Unfilled<'a>>,
}

impl<'a> Film2dIn<'a> {
    /// A smooth, fully flooded steady film with zero pressure on all edges and cavitation at zero pressure.
    #[must_use]
    pub const fn new(h: &'a [f64], u: f64, mu: f64) -> Self {
        Self {
            h,
            h_face_x: &[],
            h_face_y: &[],
            dhdt: &[],
            u,
            mu: Viscosity::Uniform(mu),
            p_cav: 0.0,
            edge_pressure: [0.0; 4],
            edge_fill: [1.0; 4],
            factors: FlowFactors { pressure_x: &[], pressure_y: &[], transport: &[], content: &[] },
            history: None,
            arriving: None,
            unfilled: None,
        }
    }
}

/// What a film does. Integrals are sums with the weights of [`Film2dGrid::weights`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Film2dOut {
    /// `∫ (p - p_cav) dA` \[N\].
    pub load: f64,
    /// `∫ (p - p_cav) x dA` \[N m\].
    pub moment_x: f64,
    /// `∫ (p - p_cav) y dA` \[N m\].
    pub moment_y: f64,
    /// Viscous force on the upper surface along `+x`, `∫ (θ μu/h - h/2 ∂x p) dA` \[N\].
    pub shear_upper: f64,
    /// Viscous force on the lower surface along `-x`, `∫ (θ μu/h + h/2 ∂x p) dA` \[N\].
    pub shear_lower: f64,
    /// Highest absolute pressure \[Pa\].
    pub p_max: f64,
    /// Area that is not filled, or at `p_cav` where the condition knows no filling \[m²\].
    pub cavity: f64,
    /// Volume that leaves through each edge \[m³/s\], in the order of [`Film2dGrid::edges`]. What a mirrored half would add is not
    /// in it.
    pub outflow: [f64; 4],
    /// What the film takes up, `∫ ∂t(h θ) dA` \[m³/s\].
    pub storage: f64,
    /// Largest imbalance of a control volume over the largest flow between two.
    pub residual: f64,
    /// Newton steps or changes of the set of cavitated nodes; 1 when nothing had to be repeated.
    pub iterations: usize,
    /// Sweeps, multigrid cycles or factorisations.
    pub cycles: usize,
}

/// One cause of pressure in a film that does not cavitate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FilmMode<'a> {
    /// Sliding velocity \[m/s\].
    pub u: f64,
    /// Squeeze velocity at the nodes \[m/s\]; empty: zero.
    pub dhdt: &'a [f64],
    /// Pressures of the edges \[Pa\].
    pub edge_pressure: [f64; 4],
}

/// Whether a film follows from the pressures that [`Film2d::solve_many`] finds for its causes one by one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Superposition {
    /// It does not: cavitation changes the equations.
    #[default]
    None,
    /// Their sum, raised to `p_cav` where it is below.
    CutOff,
    /// Their sum.
    Full,
}

/// A running solver of one film.
///
/// It may start from the film it found last; what it finds depends on that by no more than its tolerance.
pub trait Film2d: Send {
    /// The grid it was built for.
    fn grid(&self) -> &Film2dGrid;

    /// Finds the film.
    ///
    /// # Errors
    /// No convergence or surfaces that touch (Recoverable); inputs that are not numbers, fields of the wrong length, a
    /// viscosity that is not positive (Fatal).
    fn solve(&mut self, inp: &Film2dIn<'_>) -> Result<Film2dOut, EvalError>;

    /// Absolute pressure at the nodes \[Pa\] of the film found last.
    fn pressure(&self) -> &[f64];

    /// Filling at the nodes of the film found last, 0 to 1; 1 everywhere for conditions that know no filling.
    fn fill(&self) -> &[f64];

    /// Pressures of a full film for several causes with one setup: without cavitation the pressure is linear in `u`, `dhdt` and
    /// the pressures of the edges. Film thickness, viscosity and factors are those of `inp`, whose `u`, `dhdt`, pressures and history are not
    /// read. `p` takes the pressures \[Pa\] mode after mode; what it holds before may be where iterations start. Returns the cycles of all modes together.
    ///
    /// # Errors
    /// As [`Film2d::solve`], and a `p` of the wrong length (Fatal).
    fn solve_many(
        &mut self,
        inp: &Film2dIn<'_>,
        modes: &[FilmMode<'_>],
        p: &mut [f64],
    ) -> Result<usize, EvalError>;

    /// Flow that the pressures `p` \[Pa\] leave over in a full film, into `r` \[m³/s\]: what reaches each node less what leaves it and what it takes up;
    /// at a node on an edge that gives a pressure, the flow out over that edge. Of `inp` is read what [`Film2d::solve_many`] reads, and its set-up
    /// stays. Returns whether the model can tell; `r` is untouched when it cannot.
    ///
    /// # Errors
    /// As [`Film2d::solve`], and fields of the wrong length (Fatal).
    fn imbalance(
        &mut self,
        _inp: &Film2dIn<'_>,
        _mode: &FilmMode<'_>,
        _p: &[f64],
        _r: &mut [f64],
    ) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// The same of the film that [`Film2d::solve_many`] set up last, whose input was `inp`: nothing need be set up again.
    ///
    /// # Errors
    /// As [`Film2d::imbalance`].
    fn imbalance_here(
        &mut self,
        inp: &Film2dIn<'_>,
        mode: &FilmMode<'_>,
        p: &[f64],
        r: &mut [f64],
    ) -> Result<bool, EvalError> {
        self.imbalance(inp, mode, p, r)
    }

    /// Pressures \[Pa\] that take up flows left over, field after field in place: the solutions of the matrix that [`Film2d::solve_many`] set up last. With
    /// [`Film2d::imbalance`] this is one step of Newton's method from a film to one beside it. Flows on edges that give a pressure do not count.
    ///
    /// # Errors
    /// Nothing is set up, or no solution (Recoverable); a length that is no multiple of the nodes (Fatal).
    fn respond(&mut self, _r: &mut [f64]) -> Result<(), EvalError> {
        Err(EvalError::recoverable("film_2d", "this model does not tell how a film answers to flows"))
    }

    /// Changes of the film that [`Film2d::solve`] found last per change of its squeeze velocity, field after field: `p` holds changes of `dhdt` \[m/s\] and
    /// takes those of the pressure \[Pa\], `fill` takes those of the filling. Cavities keep their nodes. Returns whether the model can tell; `p` is untouched
    /// when it cannot.
    ///
    /// # Errors
    /// Fields of the wrong length (Fatal), no solution (Recoverable).
    fn answer(&mut self, _p: &mut [f64], _fill: &mut [f64]) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// Whether the film can keep its filling from step to step: it takes steps with a [`History`] and with what arrives ([`Film2dIn::arriving`]), and tells its
    /// pressures while some nodes are not filled ([`Film2dIn::unfilled`]).
    fn keeps_fill(&self) -> bool {
        false
    }

    /// Whether the film is the sum of what [`Film2d::solve_many`] finds.
    fn superposition(&self) -> Superposition {
        Superposition::None
    }

    /// Forgets the film found last: the next search starts from nothing.
    fn reset(&mut self);
}
