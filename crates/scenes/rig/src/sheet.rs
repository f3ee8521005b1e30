//! A film along and across the motion as benches use it: gaps at and between nodes, rough surfaces, one half of what is symmetric.

use gudgeon_core::kinds::{
    Edge, Film2d, Film2dCtx, Film2dGrid, Film2dIn, Film2dOut, Film2dSpec, FlowFactors, RigOut, RoughFlow,
    RoughShear, Roughness, RoughnessSpec,
};
use gudgeon_core::{BuildError, EvalError};

/// Maximum number of intervals along a side of the grid.
pub const MAX_INTERVALS: u32 = 2000;

/// Maximum number of intervals of a map along a side: what a screen shows.
pub const MAPPED: usize = 128;

/// The number of intervals along a side, between 2 and [`MAX_INTERVALS`].
///
/// # Errors
/// A number outside that range, at `field`.
pub fn intervals(field: &str, n: u32) -> Result<usize, BuildError> {
    if (2..=MAX_INTERVALS).contains(&n) {
        Ok(n as usize)
    } else {
        Err(BuildError::at(field, format!("must be between 2 and {MAX_INTERVALS}, not {n}")))
    }
}

/// A solver on its grid and the rough surfaces.
pub struct Sheet {
    film: Box<dyn Film2d>,
    rough: Box<dyn Roughness>,
    /// Nodes of the whole film; those of the solver may be its lower half.
    pub whole: Film2dGrid,
    half: bool,
}

/// Conditions of a film: motion, oil, pressures at its edges.
pub struct Conditions {
    /// Velocity of the lower surface along `x` \[m/s\].
    pub u: f64,
    /// Viscosity \[Pa s\].
    pub mu: f64,
    /// Cavitation pressure \[Pa\].
    pub p_cav: f64,
    /// Pressures at the edges \[Pa\]: lower and upper end of `x`, of `y`.
    pub edge_pressure: [f64; 4],
    /// Filled fractions at the edges, in the same order.
    pub edge_fill: [f64; 4],
    /// Whether the gap between the nodes is given too.
    pub between: bool,
}

/// A film, and its fields over the nodes of the whole grid.
pub struct SheetFilm {
    /// Absolute pressure \[Pa\].
    pub p: Vec<f64>,
    /// Filled fraction of the gap.
    pub fill: Vec<f64>,
    /// Gap \[m\].
    pub h: Vec<f64>,
    /// Integrals and flows of the whole film; shear stresses with the factors of the rough surfaces.
    pub out: Film2dOut,
}

/// A field over the places `x` × `y`.
fn field(x: &[f64], y: &[f64], f: &dyn Fn(f64, f64) -> f64) -> Vec<f64> {
    y.iter().flat_map(|&y| x.iter().map(move |&x| f(x, y))).collect()
}

/// Places halfway between nodes; the last is where the line ends, or halfway round to the first.
fn halfway(line: &[f64], end: f64) -> Vec<f64> {
    let last = line.last().copied().unwrap_or(0.0);
    let mut middle: Vec<f64> = line.windows(2).map(|w| 0.5 * (w[0] + w[1])).collect();
    middle.push(0.5 * (last + end));
    middle
}

/// Gaps and factors that a solution needs.
struct Gaps {
    /// Film thickness that the flows have, at and between the nodes.
    h: Vec<f64>,
    face_x: Vec<f64>,
    face_y: Vec<f64>,
    flow: RoughFlow,
    /// Shear stress per viscosity and velocity, on the lower and the upper surface.
    drag: [Vec<f64>; 2],
    /// Twice the shear stress per pressure gradient, between the nodes along `x`.
    lever: Vec<f64>,
}

impl Sheet {
    /// Builds solver and surfaces; only the lower half of the film is solved when it is `symmetric` and has a line of nodes
    /// in the middle.
    ///
    /// # Errors
    /// All that solver and surfaces refuse.
    pub fn new(
        whole: Film2dGrid,
        symmetric: bool,
        film: &dyn Film2dSpec,
        rough: &dyn RoughnessSpec,
    ) -> Result<Self, Vec<BuildError>> {
        let ny = whole.y.len();
        let half = symmetric && ny % 2 == 1 && ny >= 5;
        let mut grid = whole.clone();
        if half {
            grid.y.truncate(ny / 2 + 1);
            grid.edges[3] = Edge::Wall;
        }
        let film = film.build(&Film2dCtx { grid: &grid }).map_err(|e| e.within("film_2d"));
        let rough = rough.build().map_err(|e| e.within("roughness"));
        match (film, rough) {
            (Ok(film), Ok(rough)) => Ok(Self { film, rough, whole, half }),
            (film, rough) => Err(film.err().into_iter().chain(rough.err()).collect()),
        }
    }

    fn gaps(&self, h: &[f64], between: bool, gap: &dyn Fn(f64, f64) -> f64) -> Result<Gaps, EvalError> {
        let grid = self.film.grid();
        let (nx, n) = (grid.x.len(), h.len());
        let end = grid.x[0] + grid.period;
        let around = if grid.is_periodic() { end } else { grid.x[nx - 1] };
        let (mut face_x, mut face_y) = (Vec::new(), Vec::new());
        if between {
            face_x = field(&halfway(&grid.x, around), &grid.y, gap);
            face_y = field(&grid.x, &halfway(&grid.y, grid.y[grid.y.len() - 1]), gap);
        }
        let next = |k: usize| if k % nx + 1 < nx { k + 1 } else { k + 1 - nx };
        let mean = |f: &[f64]| -> Vec<f64> { (0..n).map(|k| 0.5 * (f[k] + f[next(k)])).collect() };
        if self.rough.is_smooth() {
            let drag: Vec<f64> = h.iter().map(|h| 1.0 / h).collect();
            let lever = if between { face_x.clone() } else { mean(h) };
            let (h, flow) = (h.to_vec(), RoughFlow::default());
            return Ok(Gaps { h, face_x, face_y, flow, drag: [drag.clone(), drag], lever });
        }
        let (mut flow, mut shear) = (RoughFlow::new(n), RoughShear::new(n));
        self.rough.flow(h, &mut flow)?;
        self.rough.shear(h, &mut shear)?;
        let drag = |sign: f64| {
            (0..n).map(|k| (shear.phi_f[k] + sign * shear.phi_fs[k]) / shear.film[k]).collect::<Vec<_>>()
        };
        let drag = [drag(1.0), drag(-1.0)];
        let lever = |s: &RoughShear| s.phi_fp.iter().zip(&s.film).map(|(f, h)| f * h).collect::<Vec<_>>();
        let mut levers = mean(&lever(&shear));
        if between {
            let mut on_face = RoughShear::new(n);
            self.rough.shear(&face_x, &mut on_face)?;
            levers = lever(&on_face);
            for face in [&mut face_x, &mut face_y] {
                let mut on_face = RoughFlow::new(n);
                self.rough.flow(face, &mut on_face)?;
                *face = on_face.film;
            }
        }
        Ok(Gaps { h: flow.film.clone(), face_x, face_y, flow, drag, lever: levers })
    }

    /// Finds the film in the `gap` at `(x, y)` whose squeeze velocity is `rate`.
    ///
    /// # Errors
    /// The solver or the surfaces refused.
    pub fn solve(
        &mut self,
        c: &Conditions,
        gap: &dyn Fn(f64, f64) -> f64,
        rate: Option<&dyn Fn(f64, f64) -> f64>,
    ) -> Result<SheetFilm, EvalError> {
        let grid = self.film.grid().clone();
        let (nx, ny) = (grid.x.len(), grid.y.len());
        let h = field(&grid.x, &grid.y, gap);
        let gaps = self.gaps(&h, c.between, gap)?;
        let mut dhdt = rate.map_or_else(Vec::new, |rate| field(&grid.x, &grid.y, rate));
        if !gaps.flow.is_empty() {
            dhdt.iter_mut().zip(&gaps.flow.content_derivative).for_each(|(v, slope)| *v *= slope);
        }
        let flow = &gaps.flow;
        let mut out = self.film.solve(&Film2dIn {
            h_face_x: &gaps.face_x,
            h_face_y: &gaps.face_y,
            dhdt: &dhdt,
            p_cav: c.p_cav,
            edge_pressure: c.edge_pressure,
            edge_fill: c.edge_fill,
            factors: FlowFactors {
                pressure_x: &flow.phi_x,
                pressure_y: &flow.phi_y,
                transport: &flow.transport,
                content: &[],
            },
            ..Film2dIn::new(&gaps.h, c.u, c.mu)
        })?;
        let (p, fill) = (self.film.pressure(), self.film.fill());
        let (wx, wy) = grid.weights();
        let around = grid.is_periodic();
        let mut shear = [0.0; 2];
        for (j, w) in wy.iter().enumerate() {
            let mut line = [0.0; 3];
            for (i, wx) in wx.iter().enumerate() {
                let k = j * nx + i;
                line[0] += wx * fill[k] * gaps.drag[0][k];
                line[1] += wx * fill[k] * gaps.drag[1][k];
                if i + 1 < nx || around {
                    line[2] += 0.5 * gaps.lever[k] * (p[j * nx + (i + 1) % nx] - p[k]);
                }
            }
            shear[0] += w * (c.mu * c.u * line[0] + line[2]);
            shear[1] += w * (c.mu * c.u * line[1] - line[2]);
        }
        [out.shear_lower, out.shear_upper] = shear;
        let mirror = |f: &[f64]| {
            let mut all = f.to_vec();
            if self.half {
                (0..ny - 1).rev().for_each(|j| all.extend_from_slice(&f[j * nx..(j + 1) * nx]));
            }
            all
        };
        let (p, fill, h) = (mirror(p), mirror(fill), mirror(&h));
        if self.half {
            for v in [
                &mut out.load,
                &mut out.moment_x,
                &mut out.shear_lower,
                &mut out.shear_upper,
                &mut out.cavity,
                &mut out.storage,
            ] {
                *v *= 2.0;
            }
            out.outflow[0] *= 2.0;
            out.outflow[1] *= 2.0;
            out.outflow[3] = out.outflow[2];
        }
        Ok(SheetFilm { p, fill, h, out })
    }

    /// Sum over all nodes of a field `f(node, x, y)` times the areas of their control volumes.
    pub fn sum(&self, f: impl Fn(usize, f64, f64) -> f64) -> f64 {
        let g = &self.whole;
        let area = |line: &[f64], period: Option<f64>| -> Vec<f64> {
            let n = line.len();
            let gap = |i: usize| match period {
                _ if i + 1 < n => line[i + 1] - line[i],
                Some(period) => line[0] + period - line[n - 1],
                None => 0.0,
            };
            let before = |i: usize| match i {
                0 if period.is_some() => gap(n - 1),
                0 => 0.0,
                i => gap(i - 1),
            };
            (0..n).map(|i| 0.5 * (before(i) + gap(i))).collect()
        };
        self.total(&area(&g.x, g.is_periodic().then_some(g.period)), &area(&g.y, None), f)
    }

    /// Integral over the film of a field that is smooth, with the weights of the solver.
    pub fn integral(&self, f: impl Fn(usize, f64, f64) -> f64) -> f64 {
        let (wx, wy) = self.whole.weights();
        self.total(&wx, &wy, f)
    }

    fn total(&self, wx: &[f64], wy: &[f64], f: impl Fn(usize, f64, f64) -> f64) -> f64 {
        let g = &self.whole;
        let nx = g.x.len();
        wy.iter()
            .enumerate()
            .map(|(j, wy)| {
                let line = wx.iter().enumerate().map(|(i, wx)| wx * f(j * nx + i, g.x[i], g.y[j]));
                wy * line.sum::<f64>()
            })
            .sum()
    }

    /// Number of nodes that are solved.
    pub fn nodes(&self) -> usize {
        self.film.grid().len()
    }

    /// Which line of nodes along `x` has the largest value; the middle one where none has more.
    pub fn through_top(&self, of: &[f64]) -> usize {
        let nx = self.whole.x.len();
        let top = |j: usize| of[j * nx..(j + 1) * nx].iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
        let middle = (self.whole.y.len() - 1) / 2;
        (0..self.whole.y.len()).fold(middle, |best, j| if top(j) > top(best) { j } else { best })
    }

    /// The middle line, or the mean of the two beside the middle.
    pub fn middle(&self, f: &[f64]) -> Vec<f64> {
        let (nx, ny) = (self.whole.x.len(), self.whole.y.len());
        let (a, b) = ((ny - 1) / 2 * nx, ny / 2 * nx);
        (0..nx).map(|i| 0.5 * (f[a + i] + f[b + i])).collect()
    }
}

/// Some of `n` nodes, the first and the last among them, for a map.
pub fn drawn(n: usize) -> Vec<usize> {
    let mut nodes: Vec<usize> = (0..n).step_by((n - 1).div_ceil(MAPPED).max(1)).collect();
    if nodes.last() != Some(&(n - 1)) {
        nodes.push(n - 1);
    }
    nodes
}

/// Work and quality of a solution.
pub fn account(o: &Film2dOut, nodes: usize, out: &mut RigOut) {
    out.result("residual", o.residual, "", "largest imbalance of a control volume over the largest flow");
    out.counters.insert("iterations".into(), o.iterations as u64);
    out.counters.insert("cycles".into(), o.cycles as u64);
    out.counters.insert("nodes".into(), nodes as u64);
}

/// Whether every number is one: inputs near the ends of what a number holds may overflow.
///
/// # Errors
/// A result or a column that is not finite (Fatal).
pub fn finite(model: &'static str, out: &RigOut) -> Result<(), EvalError> {
    let columns = out.tables.values().chain([&out.series]).flat_map(|t| t.columns.iter().chain([&t.axis]));
    let bad = columns.filter(|c| c.values.iter().any(|v| !v.is_finite())).map(|c| &c.name);
    let results = out.results.iter().filter(|(_, v)| !v.value.is_finite()).map(|(n, _)| n);
    match results.chain(bad).next() {
        Some(name) => Err(EvalError::fatal(model, format!("{name} is too large or too small to compute"))),
        None => Ok(()),
    }
}
