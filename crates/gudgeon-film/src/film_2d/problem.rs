//! Reynolds' equation on a rectangular grid: from film thickness to flows between control volumes, and from pressures to forces.

use gudgeon_core::kinds::{Edge, Film2dGrid, Film2dIn, Film2dOut, FilmMode, Viscosity};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::multigrid::{FivePoint, Role};
use gudgeon_numerics::vectors::{Vectorised, finite_least, widest};

use super::cavitation::Cavitation;
use super::flux::Flux;
use super::sides::{Exchange, OfFaces, Sides, Slide, Squeezed, mean_of_nodes};

/// Maximum number of nodes of a grid: one field of 128 MB.
const MAX_NODES: usize = 1 << 24;

/// The control volumes of one film: how much flows between them per pressure, what the sliding surface carries, what squeezing takes up.
///
/// Volume flow from node `k` to the next along `x` is `gx (p_k - p_next) + qx θ`, with `θ` the filling of the node upstream; across it is
/// `gy (p_k - p_next)`; and the volume takes up `hold θ + fixed`. Pressures count from `p_cav`.
#[derive(Debug, Clone)]
pub(super) struct Problem {
    pub grid: Film2dGrid,
    pub flux: Flux,
    pub nx: usize,
    pub ny: usize,
    pub periodic: bool,
    /// Length and width of the control volumes.
    wx: Vec<f64>,
    wy: Vec<f64>,
    /// Width of the side to the next node over the distance to it, node by node: along `x`, across.
    slender: [Vec<f64>; 2],
    /// Width of the side to the next node along `x`, none at the end of a line; areas of the control volumes.
    width: Vec<f64>,
    areas: Vec<f64>,
    /// Flow through every side.
    flows: Vec<f64>,
    /// Weights of the nodes in integrals.
    sx: Vec<f64>,
    sy: Vec<f64>,
    /// `gx`, `gy`, `qx`, `hold`, and what is unknown at each node.
    pub m: FivePoint,
    pub fixed: Vec<f64>,
    /// Nodes whose pressure is given, and by which edge; 4 for the others.
    pub edge: Vec<u8>,
    /// Largest flow by sliding or squeezing through a side, for judging residuals \[m³/s\].
    pub scale: f64,
}

/// Values that are looked at together: maxima of four lanes do not wait for one another.
const LANES: usize = 4;

/// Largest `|g (a - b)|` and largest `|g a|` or `|g b|`.
#[derive(Default)]
struct Largest {
    flow: [f64; LANES],
    product: [f64; LANES],
}

impl Largest {
    fn look(&mut self, g: &[f64], a: &[f64], b: &[f64]) {
        let larger = |m: &mut f64, x: f64| *m = if x > *m { x } else { *m };
        let n = g.len();
        let (a, b) = (&a[..n], &b[..n]);
        let whole = n - n % LANES;
        for k in (0..whole).step_by(LANES) {
            for l in 0..LANES {
                let (x, y) = (g[k + l] * a[k + l], g[k + l] * b[k + l]);
                larger(&mut self.flow[l], (x - y).abs());
                larger(&mut self.product[l], x.abs());
                larger(&mut self.product[l], y.abs());
            }
        }
        for k in whole..n {
            let (x, y) = (g[k] * a[k], g[k] * b[k]);
            larger(&mut self.flow[0], (x - y).abs());
            larger(&mut self.product[0], x.abs().max(y.abs()));
        }
    }
}

/// What a field of an input says.
#[derive(Clone, Copy)]
enum Kind {
    /// Film thickness: positive.
    Film,
    /// Flow factor: not negative.
    Factor,
    /// Any number.
    Rate,
}

impl Problem {
    pub fn new(grid: &Film2dGrid, flux: Flux) -> Result<Self, BuildError> {
        let (nx, ny) = (grid.x.len(), grid.y.len());
        for (name, line) in [("x", &grid.x), ("y", &grid.y)] {
            if line.len() < 3 {
                return Err(BuildError::new(format!(
                    "a film needs three or more nodes along {name}, not {}",
                    line.len()
                )));
            }
            let rising = line.windows(2).all(|w| w[1] - w[0] > 0.0 && (w[1] - w[0]).is_finite());
            if !rising {
                return Err(BuildError::new(format!("the nodes along {name} must be finite and increase")));
            }
        }
        if nx.saturating_mul(ny) > MAX_NODES {
            return Err(BuildError::new(format!("{nx} x {ny} nodes are more than {MAX_NODES}")));
        }
        let e = &grid.edges;
        if (e[0] == Edge::Periodic) != (e[1] == Edge::Periodic) || e[2..].contains(&Edge::Periodic) {
            return Err(BuildError::new("a film is periodic along x at both edges, or not at all"));
        }
        if !e.contains(&Edge::Pressure) {
            return Err(BuildError::new("no edge of the film gives a pressure: its level is undetermined"));
        }
        let periodic = grid.is_periodic();
        let closing = grid.period - (grid.x[nx - 1] - grid.x[0]);
        if periodic && !(closing > 0.0 && closing.is_finite()) {
            return Err(BuildError::new(format!(
                "the period of {} m must be longer than the way from the first node to the last",
                grid.period
            )));
        }
        let mut dx: Vec<f64> = grid.x.windows(2).map(|w| w[1] - w[0]).collect();
        dx.push(if periodic { closing } else { 0.0 });
        let mut dy: Vec<f64> = grid.y.windows(2).map(|w| w[1] - w[0]).collect();
        dy.push(0.0);
        let half = |d: &[f64], around: bool| -> Vec<f64> {
            let last = d[d.len() - 1];
            (0..d.len())
                .map(|i| {
                    0.5 * (d[i]
                        + if i > 0 {
                            d[i - 1]
                        } else if around {
                            last
                        } else {
                            0.0
                        })
                })
                .collect()
        };
        let (wx, wy) = (half(&dx, periodic), half(&dy, false));
        let (sx, sy) = grid.weights();
        let edge = (0..nx * ny)
            .map(|k| {
                let (i, j) = (k % nx, k / nx);
                let at = [i == 0, i + 1 == nx, j == 0, j + 1 == ny];
                (0..4).find(|&s| at[s] && e[s] == Edge::Pressure).unwrap_or(4) as u8
            })
            .collect();
        let over = |width: f64, distance: f64| if distance > 0.0 { width / distance } else { 0.0 };
        let along = wy.iter().flat_map(|w| dx.iter().map(move |d| over(*w, *d))).collect();
        let width = wy.iter().flat_map(|w| dx.iter().map(move |d| if *d > 0.0 { *w } else { 0.0 })).collect();
        let areas = wy.iter().flat_map(|wy| wx.iter().map(move |wx| wx * wy)).collect();
        let across = dy.iter().flat_map(|d| wx.iter().map(move |w| over(*w, *d))).collect();
        Ok(Self {
            grid: grid.clone(),
            slender: [along, across],
            width,
            areas,
            flows: vec![0.0; nx * ny],
            flux,
            nx,
            ny,
            periodic,
            wx,
            wy,
            sx,
            sy,
            m: FivePoint::new(nx, ny, periodic),
            fixed: vec![0.0; nx * ny],
            edge,
            scale: 0.0,
        })
    }

    pub fn len(&self) -> usize {
        self.nx * self.ny
    }

    #[inline]
    pub fn after(&self, i: usize, k: usize) -> usize {
        self.m.after(i, k)
    }

    #[inline]
    pub fn before(&self, i: usize, k: usize) -> usize {
        self.m.before(i, k)
    }

    fn check(&self, model: &'static str, inp: &Film2dIn<'_>) -> Result<(), EvalError> {
        let n = self.len();
        let (mut thinnest, mut least_factor) = (f64::INFINITY, f64::INFINITY);
        let fields: [(&str, &[f64], bool, Kind); 8] = [
            ("h", inp.h, true, Kind::Film),
            ("h_face_x", inp.h_face_x, false, Kind::Film),
            ("h_face_y", inp.h_face_y, false, Kind::Film),
            ("dhdt", inp.dhdt, false, Kind::Rate),
            ("pressure_x", inp.factors.pressure_x, false, Kind::Factor),
            ("pressure_y", inp.factors.pressure_y, false, Kind::Factor),
            ("transport", inp.factors.transport, false, Kind::Factor),
            ("content", inp.factors.content, false, Kind::Factor),
        ];
        for (name, field, needed, kind) in fields {
            if field.len() != n && (needed || !field.is_empty()) {
                return Err(EvalError::fatal(
                    model,
                    format!("{name} has {} values, the grid {n} nodes", field.len()),
                ));
            }
            let Some(least) = finite_least(field) else {
                return Err(EvalError::fatal(model, format!("{name} holds a value that is not finite")));
            };
            match kind {
                Kind::Film => thinnest = thinnest.min(least),
                Kind::Factor => least_factor = least_factor.min(least),
                Kind::Rate => {}
            }
        }
        let scalars = inp.u + inp.p_cav + inp.edge_pressure.iter().sum::<f64>();
        if !scalars.is_finite() {
            return Err(EvalError::fatal(model, "a velocity or pressure is not finite"));
        }
        if !inp.edge_fill.iter().all(|f| (0.0..=1.0).contains(f)) {
            return Err(EvalError::fatal(
                model,
                format!("the filling of an edge must be between 0 and 1: {:?}", inp.edge_fill),
            ));
        }
        let mu = match inp.mu {
            Viscosity::Uniform(mu) => mu,
            Viscosity::Nodes(m) if m.len() == n && m.iter().sum::<f64>().is_nan() => f64::NAN,
            Viscosity::Nodes(m) if m.len() == n => m.iter().fold(f64::INFINITY, |a, &b| a.min(b)),
            Viscosity::Nodes(m) => {
                return Err(EvalError::fatal(
                    model,
                    format!("the viscosity has {} values, the grid {n} nodes", m.len()),
                ));
            }
        };
        if !(mu > 0.0 && mu.is_finite()) {
            return Err(EvalError::fatal(model, format!("the viscosity is {mu} Pa s")));
        }
        if thinnest <= 0.0 {
            return Err(EvalError::recoverable(
                model,
                format!("the thinnest film is {thinnest:e} m: the surfaces touch"),
            ));
        }
        if least_factor < 0.0 {
            return Err(EvalError::fatal(model, "a flow factor is negative"));
        }
        self.check_filling(model, inp)
    }

    /// Everything but the causes of pressure.
    pub fn assemble(&mut self, model: &'static str, inp: &Film2dIn<'_>) -> Result<(), EvalError> {
        self.check(model, inp)?;
        match self.flux {
            Flux::Face => self.conductances::<false>(inp),
            Flux::Node => self.conductances::<true>(inp),
        }
        self.engage(inp);
        Ok(())
    }

    fn conductances<const NODE: bool>(&mut self, inp: &Film2dIn<'_>) {
        let (nx, n) = (self.nx, self.len());
        let factors = &inp.factors;
        let conductivity = |sides: Sides, phi: &[f64], given: &[f64], out: &mut [f64]| {
            if NODE && given.is_empty() {
                mean_of_nodes(inp, sides, phi, out);
            } else {
                widest(OfFaces { inp, sides, phi, given, out });
            }
        };
        // All sides along lines at once: nothing flows from the end of one to the start of the next, for there is no width between them.
        let FivePoint { gx, gy, .. } = &mut self.m;
        let along = Sides { from: 0, to: 1, count: n - 1 };
        conductivity(along, factors.pressure_x, inp.h_face_x, &mut gx[..n - 1]);
        gx[n - 1] = 0.0;
        if self.periodic {
            for start in (0..n).step_by(nx) {
                let end = start + nx - 1;
                let closing = Sides { from: end, to: start, count: 1 };
                conductivity(closing, factors.pressure_x, inp.h_face_x, &mut gx[end..=end]);
            }
        }
        // All sides across: they stand one line apart.
        let (gy, last) = gy.split_at_mut(n - nx);
        conductivity(Sides { from: 0, to: nx, count: n - nx }, factors.pressure_y, inp.h_face_y, gy);
        last.fill(0.0);
        for (g, slender) in [(&mut self.m.gx[..], &self.slender[0]), (&mut self.m.gy, &self.slender[1])] {
            g.iter_mut().zip(slender).for_each(|(g, s)| *g *= s);
        }
    }

    /// What sliding and squeezing do, for a film of the given condition: where `filling` counts, an opening gap takes up oil in proportion to
    /// its filling (which stays as it is), a closing one gives all of it away (its void stays as it is).
    pub fn drive(&mut self, inp: &Film2dIn<'_>, u: f64, dhdt: &[f64], filling: bool) {
        self.slide(inp, u);
        self.squeeze(inp, dhdt, filling);
        let m = &self.m;
        let largest = |scale: f64, x: f64| if x > scale { x } else { scale };
        let by_sliding = m.qx.iter().map(|q| q.abs()).fold(0.0, largest);
        self.scale = m.hold.iter().zip(&self.fixed).map(|(h, f)| (h + f).abs()).fold(by_sliding, largest);
    }

    /// Flow that the sliding surface carries from each node to the next.
    fn slide(&mut self, inp: &Film2dIn<'_>, u: f64) {
        let (nx, n) = (self.nx, self.len());
        let film = if inp.factors.transport.is_empty() { inp.h } else { inp.factors.transport };
        let (given, carried) = match self.flux {
            Flux::Face => (inp.h_face_x, None),
            Flux::Node => (&[][..], Some(usize::from(u < 0.0))),
        };
        let half = 0.5 * u;
        let (width, out) = (&self.width[..], &mut self.m.qx[..]);
        widest(Slide { half, h: inp.h, film, given, carried, width, out: &mut out[..n - 1] });
        out[n - 1] = 0.0;
        if self.periodic {
            for start in (0..n).step_by(nx) {
                let end = start + nx - 1;
                let (h, film) = (&[inp.h[end], inp.h[start]], &[film[end], film[start]]);
                let given = given.get(end..=end).unwrap_or_default();
                Slide { half, h, film, given, carried, width: &width[end..], out: &mut out[end..=end] }.run();
            }
        }
    }

    /// What the volume of each node takes up.
    fn squeeze(&mut self, inp: &Film2dIn<'_>, dhdt: &[f64], filling: bool) {
        let nx = self.nx;
        if inp.history.is_none() && dhdt.is_empty() {
            self.m.hold.fill(0.0);
            self.fixed.fill(0.0);
            return;
        }
        let full = if inp.factors.content.is_empty() { inp.h } else { inp.factors.content };
        let rows = self.m.hold.chunks_exact_mut(nx).zip(self.fixed.chunks_exact_mut(nx));
        for (j, (hold, fixed)) in rows.enumerate() {
            let row = j * nx..(j + 1) * nx;
            let wy = self.wy[j];
            let areas = self.wx.iter().map(|wx| wx * wy);
            let places = hold.iter_mut().zip(fixed).zip(areas);
            if let Some(old) = inp.history {
                for (((hold, fixed), area), (full, held)) in
                    places.zip(full[row.clone()].iter().zip(&old.content[row]))
                {
                    (*hold, *fixed) = (full * area / old.dt, -held * area / old.dt);
                }
            } else {
                for (((hold, fixed), area), rate) in places.zip(&dhdt[row]) {
                    let taken = rate * area;
                    (*hold, *fixed) = if filling && *rate > 0.0 { (taken, 0.0) } else { (0.0, taken) };
                }
            }
        }
    }

    /// Pressures of the edges, and the void of what arrives there, into the nodes that have them.
    pub fn set_edges(&self, inp: &Film2dIn<'_>, cavitates: bool, p: &mut [f64], void: &mut [f64]) {
        for (k, &e) in self.edge.iter().enumerate() {
            if e < 4 {
                let pe = inp.edge_pressure[e as usize] - inp.p_cav;
                p[k] = if cavitates { pe.max(0.0) } else { pe };
                void[k] = if pe > 0.0 { 0.0 } else { 1.0 - inp.edge_fill[e as usize] };
            }
        }
    }

    /// Area of the control volume of node `k` \[m²\].
    pub fn area(&self, k: usize) -> f64 {
        self.wx[k % self.nx] * self.wy[k / self.nx]
    }

    /// Width of the control volume of node `k` \[m\].
    pub fn width(&self, k: usize) -> f64 {
        self.wy[k / self.nx]
    }

    /// The node beside an edge node, towards the middle of the film; the node itself elsewhere.
    fn inner(&self, k: usize) -> usize {
        let mut k = k;
        // A corner is beside a side that is an edge itself.
        for _ in 0..2 {
            k = match self.edge[k] {
                0 => k + 1,
                1 => k - 1,
                2 => k + self.nx,
                3 => k - self.nx,
                _ => k,
            };
        }
        k
    }

    /// Void along the sides, parallel to sliding, that stand at the pressure of the cavity. Nothing arrives there by sliding but what the side itself
    /// carries: a node is filled by what comes along the side and out of the film, holds what it can, and lets the rest leave. Were it taken as
    /// full, a gap that opens would draw oil in over half a volume's width: an error of first order in the flow over the side.
    pub fn fill_sides(&self, inp: &Film2dIn<'_>, p: &[f64], void: &mut [f64]) {
        let (nx, ny) = (self.nx, self.ny);
        for (edge, first) in [(2, 0), (3, (ny - 1) * nx)] {
            if self.grid.edges[edge] != Edge::Pressure || inp.edge_pressure[edge] > inp.p_cav {
                continue;
            }
            let forward = self.m.qx[first..first + nx].iter().all(|q| *q >= 0.0);
            // Around a ring twice: what the first round began with is forgotten where the side is full.
            for step in 0..if self.periodic { 2 * nx } else { nx } {
                let i = if forward { step % nx } else { nx - 1 - step % nx };
                let k = first + i;
                if usize::from(self.edge[k]) != edge {
                    continue;
                }
                let (west, east) = (self.before(i, k), self.after(i, k));
                let brought =
                    |from: usize, q: f64| if from == k { 0.0 } else { q.max(0.0) * (1.0 - void[from]) };
                let taken = |to: usize, q: f64| if to == k { 0.0 } else { q.max(0.0) };
                let (q_west, q_east) = (if west == k { 0.0 } else { self.m.qx[west] }, self.m.qx[k]);
                let inner = self.inner(k);
                let across = self.m.gy[k.min(inner)] * (p[inner] - p[k]);
                let enters = brought(west, q_west) + brought(east, -q_east) + across - self.fixed[k];
                let room = taken(east, q_east) + taken(west, -q_west) + self.m.hold[k];
                if room > 0.0 {
                    void[k] = 1.0 - (enters / room).clamp(0.0, 1.0);
                }
            }
        }
    }

    /// Volume that leaves each node less what it takes up from: the sum of the flows out of it and of its storage, which is zero for a solution.
    pub fn balance(&self, p: &[f64], void: &[f64], out: &mut [f64]) {
        let nx = self.nx;
        for k in 0..out.len() {
            out[k] = self.m.hold[k] * (1.0 - void[k]) + self.fixed[k] + self.m.leak[k] * p[k];
        }
        for j in 0..self.ny {
            let row = j * nx..(j + 1) * nx;
            let (gx, qx) = (&self.m.gx[row.clone()], &self.m.qx[row.clone()]);
            let (own, void) = (&p[row.clone()], &void[row.clone()]);
            let flow = |i: usize, next: usize| {
                let upstream = if qx[i] >= 0.0 { void[i] } else { void[next] };
                gx[i] * (own[i] - own[next]) + qx[i] * (1.0 - upstream)
            };
            let (lines, below) = out.split_at_mut((j + 1) * nx);
            let line = &mut lines[j * nx..];
            // Into a node first, out of it afterwards, and across the line last: one order of rounding, whichever the grid.
            for i in 1..nx {
                line[i] -= flow(i - 1, i);
            }
            for i in 0..nx - 1 {
                line[i] += flow(i, i + 1);
            }
            let closing = if self.periodic { flow(nx - 1, 0) } else { 0.0 };
            if self.periodic {
                line[nx - 1] += closing;
            }
            if j + 1 < self.ny {
                let (gy, beyond) = (&self.m.gy[row], &p[(j + 1) * nx..(j + 2) * nx]);
                for (i, (out, into)) in line.iter_mut().zip(below).enumerate() {
                    let flow = gy[i] * (own[i] - beyond[i]);
                    *out += flow;
                    *into -= flow;
                }
            }
            if self.periodic {
                line[0] -= closing;
            }
        }
    }

    /// Largest flow between two nodes or into one, and the residual that rounding leaves of such pressures.
    pub fn largest_flow(&self, p: &[f64], void: &[f64]) -> (f64, f64) {
        let (nx, ny) = (self.nx, self.ny);
        let mut found = Largest::default();
        for j in 0..ny {
            let row = j * nx..(j + 1) * nx;
            let (gx, own) = (&self.m.gx[row.clone()], &p[row.clone()]);
            found.look(&gx[..nx - 1], &own[..nx - 1], &own[1..]);
            if self.periodic {
                found.look(&gx[nx - 1..], &own[nx - 1..], &own[..1]);
            }
            if j + 1 < ny {
                found.look(&self.m.gy[row.clone()], own, &p[(j + 1) * nx..(j + 2) * nx]);
            }
            if void[row.clone()].iter().any(|v| *v != 0.0) {
                found.look(&self.m.qx[row.clone()], &void[row.clone()], &void[row.clone()]);
                found.look(&self.m.hold[row.clone()], &void[row.clone()], &void[row]);
            }
        }
        let top = |lanes: [f64; LANES]| lanes.into_iter().fold(0.0, f64::max);
        let (largest_flow, product) = (top(found.flow).max(self.scale), top(found.product));
        // A row sums eight such products, each rounded to 1e-16.
        (largest_flow, 2e-15 * product)
    }

    /// What is unknown at each node: the void of the nodes `cavitated`, the pressure of the others. With `carried` false, cavitated nodes have no
    /// unknown at all: their pressure is that of the cavity.
    pub fn choose(&mut self, cavitated: &[bool], carried: bool) {
        for (k, &cavitated) in cavitated.iter().enumerate() {
            self.m.role[k] = if self.edge[k] < 4 || (cavitated && !carried) {
                Role::Fixed
            } else if !cavitated {
                Role::Diffused
            } else {
                let i = k % self.nx;
                let west = self.before(i, k);
                let inwards = if west == k { 0.0 } else { self.m.qx[west] };
                // Nothing flows and nothing is held: there is no telling how full it is.
                let leaves = self.m.qx[k].max(0.0) - inwards.min(0.0) + self.m.hold[k];
                if leaves > 0.0 { Role::Carried } else { Role::Fixed }
            };
        }
    }

    /// Sets the film up for one cause of pressure and without cavitation: flows, the pressures of the edges in `p` and zero inside.
    pub fn cause(&mut self, inp: &Film2dIn<'_>, mode: &FilmMode<'_>, p: &mut [f64], void: &mut [f64]) {
        let plain = cause_of(inp, mode);
        self.drive(&plain, mode.u, mode.dhdt, false);
        p.fill(0.0);
        self.set_edges(&plain, false, p, void);
        void_of(inp, void);
    }

    /// What one cause that is [plain](is_plain) drives into the volumes: with the flow that the sliding surface brings and what the gap takes up, the
    /// right-hand side for the pressures, into `out`.
    pub fn plain_cause(&mut self, inp: &Film2dIn<'_>, mode: &FilmMode<'_>, out: &mut [f64]) {
        self.plain_flows(inp, mode, None, out);
    }

    /// The same less the flow of the pressures `p`.
    pub fn plain_imbalance(&mut self, inp: &Film2dIn<'_>, mode: &FilmMode<'_>, p: &[f64], out: &mut [f64]) {
        self.plain_flows(inp, mode, Some(p), out);
    }

    fn plain_flows(&mut self, inp: &Film2dIn<'_>, mode: &FilmMode<'_>, p: Option<&[f64]>, out: &mut [f64]) {
        let (nx, n) = (self.nx, self.len());
        if mode.dhdt.is_empty() {
            out.fill(0.0);
        } else {
            widest(Squeezed { rates: mode.dhdt, areas: &self.areas, out });
        }
        if mode.u == 0.0 && p.is_none() {
            return;
        }
        if mode.u == 0.0 {
            self.flows.fill(0.0);
        } else {
            self.slide(inp, mode.u);
            self.flows.copy_from_slice(&self.m.qx);
        }
        // The side that closes a ring leads from the end of its line to the start of it.
        for end in (nx - 1..n).step_by(nx).filter(|_| self.periodic) {
            let start = end + 1 - nx;
            let pressed = p.map_or(0.0, |p| self.m.gx[end] * (p[end] - p[start]));
            let flow = std::mem::take(&mut self.flows[end]) + pressed;
            out[end] -= flow;
            out[start] += flow;
        }
        let FivePoint { gx, gy, .. } = &self.m;
        // Lines that are no rings stand behind one another as one: nothing flows between them.
        let line = if self.periodic { nx } else { n };
        for start in (0..n).step_by(line) {
            let flows = &mut self.flows[start..start + line - 1];
            let driven = p.map(|p| (&gx[start..], &p[start..]));
            widest(Exchange { step: 1, driven, flows, out: &mut out[start..] });
        }
        if p.is_some() {
            let flows = &mut self.flows[..n - nx];
            flows.fill(0.0);
            widest(Exchange { step: nx, driven: p.map(|p| (&gy[..], p)), flows, out });
        }
    }

    /// Forces, flows and balances of a film. `balance` is overwritten.
    pub fn result(
        &self,
        inp: &Film2dIn<'_>,
        p: &[f64],
        void: &[f64],
        cavitation: Cavitation,
        balance: &mut [f64],
    ) -> Film2dOut {
        let torn = |k: usize| cavitation != Cavitation::FullSommerfeld && p[self.inner(k)] <= 0.0;
        let (nx, ny) = (self.nx, self.ny);
        let mut out = Film2dOut::default();
        let mut top = f64::NEG_INFINITY;
        let mut worst = 0.0_f64;
        self.balance(p, void, balance);
        for j in 0..ny {
            // Sums along a line first, lines afterwards: short sums lose less.
            let mut line = [0.0; 5];
            for i in 0..nx {
                let k = j * nx + i;
                let w = self.sx[i];
                let mu = match inp.mu {
                    Viscosity::Uniform(mu) => mu,
                    Viscosity::Nodes(m) => m[k],
                };
                let next = self.after(i, k);
                line[0] += w * p[k];
                line[1] += w * p[k] * self.grid.x[i];
                line[2] += w * mu * (1.0 - void[k]) / inp.h[k];
                if next != k {
                    let h = if inp.h_face_x.is_empty() {
                        0.5 * (inp.h[k] + inp.h[next])
                    } else {
                        inp.h_face_x[k]
                    };
                    line[3] += h * (p[next] - p[k]);
                }
                line[4] += w * match cavitation {
                    Cavitation::MassConserving => void[k],
                    _ => f64::from(u8::from(p[k] <= 0.0 && torn(k))),
                };
                top = top.max(p[k]);
                let e = self.edge[k] as usize;
                out.storage += self.m.hold[k] * (1.0 - void[k]) + self.fixed[k];
                if e < 4 {
                    // A side at the pressure of a cavity beside it gives nothing to a gap that opens.
                    let dry = e >= 2 && cavitation != Cavitation::MassConserving && p[k] <= 0.0 && torn(k);
                    out.outflow[e] -= if dry { balance[k].min(0.0) } else { balance[k] };
                } else {
                    worst = worst.max(balance[k].abs());
                }
            }
            let w = self.sy[j];
            out.load += w * line[0];
            out.moment_x += w * line[1];
            out.moment_y += w * line[0] * self.grid.y[j];
            out.shear_upper += w * (inp.u * line[2] - 0.5 * line[3]);
            out.shear_lower += w * (inp.u * line[2] + 0.5 * line[3]);
            out.cavity += w * line[4];
        }
        out.p_max = inp.p_cav + top;
        let (largest_flow, _) = self.largest_flow(p, void);
        out.residual = if largest_flow > 0.0 { worst / largest_flow } else { worst };
        out
    }
}

/// Void of a film whose pressures are told by causes: nodes are full but where the history says otherwise.
pub(super) fn void_of(inp: &Film2dIn<'_>, void: &mut [f64]) {
    match inp.unfilled {
        Some(unfilled) => void.iter_mut().zip(unfilled.fill).for_each(|(void, fill)| *void = 1.0 - fill),
        None => void.fill(0.0),
    }
}

/// Whether nothing but sliding and squeezing drives a film: edges are at the pressure that others count from, all nodes are full and lose nothing.
pub(super) fn is_plain(inp: &Film2dIn<'_>, mode: &FilmMode<'_>) -> bool {
    inp.unfilled.is_none() && mode.edge_pressure == [0.0; 4]
}

/// A film with one cause of pressure alone.
pub(super) fn cause_of<'a>(inp: &Film2dIn<'a>, mode: &FilmMode<'_>) -> Film2dIn<'a> {
    Film2dIn { edge_pressure: mode.edge_pressure, p_cav: 0.0, history: None, ..*inp }
}
