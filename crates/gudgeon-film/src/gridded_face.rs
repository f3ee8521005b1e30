use gudgeon_core::geometry::FaceProfile;
use gudgeon_core::kinds::{FaceCtx, FaceIn, FaceOut, Hydrodynamics, HydrodynamicsSpec};
use gudgeon_core::{BuildError, EvalError};
use serde::{Deserialize, Serialize};

/// Film under a ring face from trapezoid integrals on equally spaced nodes, clipped at the cavitation pressure.
///
/// With `h(x) = h + drop(x)`, `u` the velocity of the liner along `+x` seen from the ring and `ḣ` the squeeze velocity,
/// the one-dimensional Reynolds equation
///
/// `d/dx(h³ dp/dx) = 6 μ u dh/dx + 12 μ ḣ`
///
/// with the pressures of both edges given has the solution
///
/// `p(x) = 6 μ u [I1 - (Ī1/Ī3) I3] + 12 μ ḣ [I2 - (Ī2/Ī3) I3] + (p_top - p_bottom) I3/Ī3 + p_bottom`,
///
/// `I1 = ∫dx/h²`, `I2 = ∫x dx/h³`, `I3 = ∫dx/h³` from the bottom edge to `x`, and `Ī` the same up to the top edge. What
/// falls below `p_cav` is raised to it afterwards (half-Sommerfeld or Gümbel condition). All integrals, load and friction
/// too, are trapezoid sums over the nodes; `dp/dx` and `dh/dx` are central differences, one-sided at the edges. The load
/// rate is the exact derivative of that discrete, clipped load.
///
/// This is the scheme of Zottin 1992, sections 2.4 and 3, whose program has 11 nodes: it underestimates the load of a
/// barrel by some 6 %. The error falls with the square of the node spacing; `refine = 19` leaves 0.02 %.
#[derive(Debug, Clone, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GriddedFace {
    /// Into how many panels each panel of the profile is divided, from 1 to 19: the profile between its own nodes is a
    /// straight line, only the integration is refined.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 19))]
    pub refine: usize,
    /// Nodes at which the shape of the face is sampled, from 11 to 200. A face given by a table keeps its own nodes; one
    /// with fewer than `points` has its panels divided equally until there are at least so many.
    #[serde(default = "eleven")]
    #[schemars(range(min = 11, max = 200))]
    pub points: usize,
}

fn one() -> usize {
    1
}
fn eleven() -> usize {
    11
}

impl Default for GriddedFace {
    fn default() -> Self {
        Self { refine: one(), points: eleven() }
    }
}

gudgeon_core::register_model! {
    GriddedFace, kind: "hydrodynamics", name: "gridded_face",
    summary: "Reynolds equation by trapezoid integrals on equally spaced nodes, clipped at the cavitation pressure",
    equations: "d/dx(h^3 dp/dx) = 6 mu u dh/dx + 12 mu dh/dt;  \
                p = 6 mu u [I1 - (J1/J3) I3] + 12 mu dh/dt [I2 - (J2/J3) I3] + (p_top - p_bottom) I3/J3 + p_bottom, \
                I1 = int dx/h^2, I2 = int x dx/h^3, I3 = int dx/h^3, J = I(top edge);  p := max(p, p_cav);  \
                shear = int (mu u/h -+ h/2 dp/dx) dx",
    validity: "Fully flooded, smooth, narrow face. The clip does not conserve oil and has no separated exit. \
               Second order in the node spacing: 11 nodes lose some 6 % of the load of a barrel.",
    references: ["zottin1992", "reynolds1886", "dowson1979"],
    example: "refine = 1\npoints = 11\n",
}

const MODEL: &str = "gridded_face";
/// Nodes of the published program.
const PUBLISHED: usize = 11;
/// Most nodes of a refined grid.
const MOST: usize = 400;

#[typetag::serde(name = "gridded_face")]
impl HydrodynamicsSpec for GriddedFace {
    fn build(&self, ctx: &FaceCtx<'_>) -> Result<Box<dyn Hydrodynamics>, BuildError> {
        if !(1..=19).contains(&self.refine) {
            return Err(BuildError::at("refine", format!("must be between 1 and 19, not {}", self.refine)));
        }
        if !(11..=200).contains(&self.points) {
            return Err(BuildError::at("points", format!("must be between 11 and 200, not {}", self.points)));
        }
        check_face(ctx.face)?;
        let base = match ctx.face {
            FaceProfile::Parabola { .. } => self.points - 1,
            FaceProfile::Table { drops, .. } => {
                let own = drops.len() - 1;
                own * (self.points - 1).div_ceil(own)
            }
        };
        let n = base * self.refine + 1;
        if n > MOST {
            let field = if base < MOST { "refine" } else { "points" };
            return Err(BuildError::at(field, format!("the grid has {n} nodes, at most {MOST} are possible"))
                .help("use fewer points or a smaller refine"));
        }
        Ok(Box::new(Grid::new(ctx.face, base, self.refine)))
    }
}

/// Whether a face is one at all: positive length, finite drops.
pub(crate) fn check_face(face: &FaceProfile) -> Result<(), BuildError> {
    let length = face.length();
    if !(length.is_finite() && length > 0.0) {
        return Err(BuildError::new(format!("the length of a running face must be positive, not {length} m")));
    }
    let finite = match face {
        FaceProfile::Parabola { curvature, apex, .. } => curvature.is_finite() && apex.is_finite(),
        FaceProfile::Table { drops, .. } if drops.len() < 2 => {
            return Err(BuildError::new(format!("a face profile needs two or more points, not {}", drops.len())));
        }
        FaceProfile::Table { drops, .. } => drops.iter().all(|d| d.is_finite()),
    };
    if finite { Ok(()) } else { Err(BuildError::new("the drops of a running face must be finite")) }
}

/// The nodes of one face, with work space.
struct Grid {
    length: f64,
    dx: f64,
    min_drop: f64,
    /// Drop at each node.
    drop: Vec<f64>,
    /// `(drop[j+1] - drop[j-1])/2`, at the ends half the difference to the neighbour: `∫ p h' dx = Σ p_j half_rise_j`.
    half_rise: Vec<f64>,
    /// `1/h`, then `1/h³`, at each node.
    r: Vec<f64>,
    /// Pressure above `p_cav` before the clip.
    p: Vec<f64>,
    /// `∂p/∂ḣ`.
    q: Vec<f64>,
}

impl Grid {
    /// `base` panels carry the shape of the face, each divided into `refine` equal parts.
    fn new(face: &FaceProfile, base: usize, refine: usize) -> Self {
        let length = face.length();
        let shape: Vec<f64> = (0..=base)
            .map(|i| match face {
                FaceProfile::Parabola { .. } => face.drop_at(length * (i as f64 / base as f64)),
                FaceProfile::Table { drops, .. } => {
                    // Panels of the table divide evenly into those of the grid: its own nodes stay exact.
                    let parts = base / (drops.len() - 1);
                    between(drops, i, parts)
                }
            })
            .collect();
        let n = base * refine + 1;
        let drop: Vec<f64> = (0..n).map(|i| between(&shape, i, refine)).collect();
        let half_rise = (0..n)
            .map(|j| 0.5 * (drop[(j + 1).min(n - 1)] - drop[j.saturating_sub(1)]))
            .collect();
        Self {
            length,
            dx: length / (n - 1) as f64,
            min_drop: drop.iter().copied().fold(f64::INFINITY, f64::min),
            drop,
            half_rise,
            r: vec![0.0; n],
            p: vec![0.0; n],
            q: vec![0.0; n],
        }
    }

    fn check(&self, inp: &FaceIn, hdot: f64) -> Result<(), EvalError> {
        // One test for all: a sum with a term that is not finite is not finite.
        if !(inp.h + inp.u + inp.p_bottom + inp.p_top + inp.p_cav + inp.mu + hdot).is_finite() {
            return Err(EvalError::fatal(MODEL, format!("not a number among {inp:?}, hdot = {hdot}")));
        }
        if inp.mu <= 0.0 {
            return Err(EvalError::fatal(MODEL, format!("the viscosity is {} Pa s", inp.mu)));
        }
        if inp.h + self.min_drop <= 0.0 {
            let h = inp.h + self.min_drop;
            return Err(EvalError::recoverable(MODEL, format!("the thinnest film is {h:e} m: the surfaces touch")));
        }
        Ok(())
    }

    /// Fills `p` and `q`; returns the trapezoid of `1/h`.
    fn solve(&mut self, inp: &FaceIn, hdot: f64) -> Result<f64, EvalError> {
        self.check(inp, hdot)?;
        match solve(inp, hdot, self.dx, &self.drop, &mut self.r, &mut self.p, &mut self.q) {
            Some(shear) => Ok(shear),
            None => Err(overflow(inp, hdot)),
        }
    }
}

#[cold]
fn overflow(inp: &FaceIn, hdot: f64) -> EvalError {
    EvalError::recoverable(MODEL, format!("the film pressure overflows for {inp:?}, hdot = {hdot:e}"))
}

/// Value at part `i` of a piecewise linear list whose panels are divided into `parts`.
fn between(list: &[f64], i: usize, parts: usize) -> f64 {
    let (k, rest) = (i / parts, i % parts);
    if rest == 0 { list[k] } else { list[k] + (list[k + 1] - list[k]) * (rest as f64 / parts as f64) }
}

/// Sum with half weight at both ends, in four lanes: a single running sum would wait for each addition in turn.
#[inline(always)]
fn trapezoid(n: usize, f: impl Fn(usize) -> f64) -> f64 {
    let mut lane = [0.5 * f(0), 0.5 * f(n - 1), 0.0, 0.0];
    let mut j = 1;
    while j + 4 < n {
        for (k, l) in lane.iter_mut().enumerate() {
            *l += f(j + k);
        }
        j += 4;
    }
    while j < n - 1 {
        lane[0] += f(j);
        j += 1;
    }
    (lane[0] + lane[1]) + (lane[2] + lane[3])
}

/// Pressures above `p_cav` before the clip (`p`) and their derivatives with respect to `hdot` (`q`) at the nodes. Returns
/// the trapezoid of `1/h`, or nothing when a number overflowed. All slices have the same length, at least 2.
///
/// The pressure gradient `6 μ u (1/h² - m/h³) + 12 μ ḣ (x - x̄)/h³ + Δp/(Ī3 h³)` with `m = Ī1/Ī3` and `x̄ = Ī2/Ī3` is
/// summed up once, which is the published formula with its terms collected before the sum instead of after it.
#[inline(always)]
fn solve(
    inp: &FaceIn,
    hdot: f64,
    dx: f64,
    drop: &[f64],
    r: &mut [f64],
    p: &mut [f64],
    q: &mut [f64],
) -> Option<f64> {
    let n = drop.len();
    let (r, p, q) = (&mut r[..n], &mut p[..n], &mut q[..n]);
    for (r, d) in r.iter_mut().zip(drop) {
        *r = 1.0 / (inp.h + d);
    }
    let t0 = trapezoid(n, |j| r[j]);
    let t1 = trapezoid(n, |j| r[j] * r[j]);
    // The last node of the second factor has its number, n - 1; x = j dx.
    let t2 = trapezoid(n, |j| r[j] * r[j] * r[j] * j as f64);
    let t3 = trapezoid(n, |j| r[j] * r[j] * r[j]);
    let inv3 = 1.0 / t3;
    let (mean_h, mean_j) = (t1 * inv3, t2 * inv3);
    let (bottom, top) = (inp.p_bottom - inp.p_cav, inp.p_top - inp.p_cav);
    // Half a panel of each coefficient: the trapezoid adds both ends of a panel.
    let half = 0.5 * dx * inp.mu;
    let wedge = 6.0 * half * inp.u;
    let squeeze = 12.0 * half * dx;
    let slope = squeeze * hdot;
    let constant = 0.5 * (top - bottom) * inv3 - wedge * mean_h - slope * mean_j;
    let mut before = (r[0] * r[0] * (wedge + r[0] * constant), -r[0] * r[0] * r[0] * squeeze * mean_j);
    let mut sum = (bottom, 0.0);
    p[0] = bottom;
    q[0] = 0.0;
    for j in 1..n {
        let (r1, x) = (r[j], j as f64);
        let r2 = r1 * r1;
        let now = (r2 * (wedge + r1 * (constant + slope * x)), r2 * r1 * (squeeze * (x - mean_j)));
        sum = (sum.0 + (before.0 + now.0), sum.1 + (before.1 + now.1));
        p[j] = sum.0;
        q[j] = sum.1;
        before = now;
    }
    p[n - 1] = top;
    q[n - 1] = 0.0;
    // Once a running sum has left the finite numbers it never comes back, so its end tells of every node.
    (sum.0 + sum.1 + t0).is_finite().then_some(t0)
}

/// Load, friction and extent of the solved film. All slices have the same length, at least 2.
#[inline(always)]
fn result(inp: &FaceIn, length: f64, dx: f64, t0: f64, drop: &[f64], half_rise: &[f64], p: &[f64], q: &[f64]) -> FaceOut {
    let n = drop.len();
    let (half_rise, p, q) = (&half_rise[..n], &p[..n], &q[..n]);
    let clip = |v: f64| if v > 0.0 { v } else { 0.0 };
    let load = dx * trapezoid(n, |j| clip(p[j]));
    let load_rate = dx * trapezoid(n, |j| if p[j] > 0.0 { q[j] } else { 0.0 });
    let mut p_max = 0.0;
    let mut slope_force = 0.0;
    for (p, e) in p.iter().zip(half_rise) {
        let p = clip(*p);
        p_max = if p > p_max { p } else { p_max };
        slope_force -= p * e;
    }
    // Central differences with trapezoid weights satisfy summation by parts: ∫ h p' dx = [p h] - ∫ p h' dx to the last bit
    // of arithmetic, which saves differentiating the pressure.
    let ends = clip(p[n - 1]) * (inp.h + drop[n - 1]) - clip(p[0]) * (inp.h + drop[0]);
    let half_drag = 0.5 * (ends + slope_force);
    let shear = inp.mu * inp.u * dx * t0;
    let first = p.iter().position(|p| *p > 0.0);
    let last = p.iter().rposition(|p| *p > 0.0);
    let full_film = match (first, last) {
        (Some(i), Some(k)) => {
            // Where the pressure before the clip passes through p_cav between two nodes.
            let low = if i == 0 { 0.0 } else { (i as f64 - p[i] / (p[i] - p[i - 1])) * dx };
            let high = if k == n - 1 { length } else { (k as f64 + p[k] / (p[k] - p[k + 1])) * dx };
            (low, high)
        }
        _ => (0.0, 0.0),
    };
    FaceOut {
        load,
        load_rate,
        ring_shear: shear - half_drag,
        liner_shear: shear + half_drag,
        slope_force,
        p_max: p_max + inp.p_cav,
        full_film,
    }
}

impl Hydrodynamics for Grid {
    fn evaluate(&mut self, inp: &FaceIn, hdot: f64) -> Result<FaceOut, EvalError> {
        self.check(inp, hdot)?;
        let (drop, half_rise) = (self.drop.as_slice(), self.half_rise.as_slice());
        // The published grid has a copy of the loops with their length known: no loop control, work space on the stack.
        let out = if let (Ok(drop), Ok(half_rise)) =
            (<&[f64; PUBLISHED]>::try_from(drop), <&[f64; PUBLISHED]>::try_from(half_rise))
        {
            let (mut r, mut p, mut q) = ([0.0; PUBLISHED], [0.0; PUBLISHED], [0.0; PUBLISHED]);
            solve(inp, hdot, self.dx, drop, &mut r, &mut p, &mut q)
                .map(|t0| result(inp, self.length, self.dx, t0, drop, half_rise, &p, &q))
        } else {
            solve(inp, hdot, self.dx, drop, &mut self.r, &mut self.p, &mut self.q)
                .map(|t0| result(inp, self.length, self.dx, t0, drop, half_rise, &self.p, &self.q))
        };
        match out {
            Some(o) if (o.load + o.load_rate + o.ring_shear + o.slope_force).is_finite() => Ok(o),
            _ => Err(overflow(inp, hdot)),
        }
    }

    fn squeeze_rate(&mut self, inp: &FaceIn, load: f64) -> Result<f64, EvalError> {
        if !load.is_finite() {
            return Err(EvalError::fatal(MODEL, format!("the load is {load} N/m")));
        }
        self.solve(inp, 0.0)?;
        let n = self.p.len();
        let (p, q) = (&self.p[..n], &self.q[..n]);
        // The discrete load is a convex, falling, piecewise linear function of hdot. From the root of the piece on which no
        // node is clipped, which lies at or left of the sought one, Newton's method climbs down piece by piece and is done,
        // without rounding apart, when the set of loaded nodes repeats: at most once for each node.
        let target = load / self.dx;
        let (p0, p1) = (trapezoid(n, |j| p[j]), trapezoid(n, |j| q[j]));
        let mut hdot = (target - p0) / p1;
        for _ in 0..=n {
            let above = |j: usize| p[j] + hdot * q[j] > 0.0;
            let sum = trapezoid(n, |j| if above(j) { p[j] } else { 0.0 });
            let rate = trapezoid(n, |j| if above(j) { q[j] } else { 0.0 });
            // Rounding of the sums: what a node at the clip, or the subtraction, may leave.
            let noise = 1e-13 * (sum.abs() + (hdot * rate).abs() + target.abs());
            let excess = sum + hdot * rate - target;
            if !excess.is_finite() {
                return Err(overflow(inp, hdot));
            }
            if excess.abs() <= noise {
                return Ok(hdot);
            }
            if rate >= 0.0 || excess < 0.0 {
                break;
            }
            hdot -= excess / rate;
        }
        let edges = 0.5 * self.dx * (p[0].max(0.0) + p[n - 1].max(0.0));
        Err(EvalError::recoverable(
            MODEL,
            format!("no squeeze velocity gives the load {load:e} N/m; the edge pressures alone carry {edges:e} N/m"),
        ))
    }

    fn profile(&mut self, inp: &FaceIn, hdot: f64, out: &mut [(f64, f64, f64)]) -> Result<(), EvalError> {
        self.solve(inp, hdot)?;
        let panels = self.p.len() - 1;
        let parts = out.len().saturating_sub(1).max(1) as f64;
        for (i, o) in out.iter_mut().enumerate() {
            let part = i as f64 / parts;
            let k = ((part * panels as f64) as usize).min(panels - 1);
            let f = part * panels as f64 - k as f64;
            let at = |a: f64, b: f64| (1.0 - f) * a + f * b;
            let p = at(self.p[k].max(0.0), self.p[k + 1].max(0.0));
            *o = (part * self.length, inp.h + at(self.drop[k], self.drop[k + 1]), inp.p_cav + p);
        }
        Ok(())
    }
}
