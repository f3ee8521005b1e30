//! Five-point matrices on a rectangular grid, and a multigrid solver for them.

use crate::linalg::{Singular, dot};

/// What the unknown of a node is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Role {
    /// Diffuses to all neighbours.
    #[default]
    Diffused,
    /// Is carried along a line of `x` and has no part in diffusion.
    Carried,
    /// Is none: the solution is zero here, whatever the right-hand side.
    Fixed,
}

/// A matrix that couples every node of a grid with its four neighbours: the balance of what is diffused and carried between them.
///
/// Node `k = j nx + i`; a [`Role::Diffused`] unknown `v` sends `gx[k] (v[k] - v[k+1])` to the next node of its line and
/// `gy[k] (v[k] - v[k+nx])` to the line above; a [`Role::Carried`] one sends `-qx[k] v[k]` to the next node where `qx[k] > 0`, to the one
/// before where `qx[k-1] < 0`, and loses `-hold[k] v[k]`; nodes that are not diffused are zero to diffusion. A row is the sum of what leaves.
/// The last `gx` and `qx` of a line join it to its first node when lines are periodic, and are not read otherwise.
#[derive(Debug, Clone)]
pub struct FivePoint {
    /// Nodes along a line.
    pub nx: usize,
    /// Lines.
    pub ny: usize,
    /// Whether lines close on themselves.
    pub periodic: bool,
    /// What each unknown is.
    pub role: Vec<Role>,
    /// Diffusion between a node and the next one of its line.
    pub gx: Vec<f64>,
    /// Diffusion between a node and that of the line above.
    pub gy: Vec<f64>,
    /// What is carried from a node to the next one of its line; negative: the reverse.
    pub qx: Vec<f64>,
    /// What a carried unknown loses on the spot.
    pub hold: Vec<f64>,
}

/// A row of a [`FivePoint`]: the diagonal, and minus the entries of the node before, after, below and above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Diagonal.
    pub c: f64,
    /// Coupling to the node before.
    pub w: f64,
    /// Coupling to the node after.
    pub e: f64,
    /// Coupling to the node of the line below.
    pub s: f64,
    /// Coupling to the node of the line above.
    pub n: f64,
}

impl FivePoint {
    /// A zero matrix.
    #[must_use]
    pub fn new(nx: usize, ny: usize, periodic: bool) -> Self {
        let v = || vec![0.0; nx * ny];
        Self { nx, ny, periodic, role: vec![Role::Diffused; nx * ny], gx: v(), gy: v(), qx: v(), hold: v() }
    }

    /// The row of node `(i, j)`, whatever its own role.
    #[must_use]
    pub fn row(&self, i: usize, j: usize) -> Row {
        let k = j * self.nx + i;
        let (west, east) = (self.before(i, k), self.after(i, k));
        let carried = |m: usize| self.role[m] == Role::Carried;
        let (has_west, has_east) = (west != k, east != k);
        let (gw, qw) = if has_west { (self.gx[west], self.qx[west]) } else { (0.0, 0.0) };
        let (ge, qe) = if has_east { (self.gx[k], self.qx[k]) } else { (0.0, 0.0) };
        let gs = if j > 0 { self.gy[k - self.nx] } else { 0.0 };
        let gn = if j + 1 < self.ny { self.gy[k] } else { 0.0 };
        Row {
            c: if carried(k) { -(qe.max(0.0) - qw.min(0.0) + self.hold[k]) } else { gw + ge + gs + gn },
            w: if has_west && carried(west) { -qw.max(0.0) } else { gw },
            e: if has_east && carried(east) { qe.min(0.0) } else { ge },
            s: if j > 0 && carried(k - self.nx) { 0.0 } else { gs },
            n: if j + 1 < self.ny && carried(k + self.nx) { 0.0 } else { gn },
        }
    }

    /// Index of the node before `k` on its line `j`; `k` itself at the first node of a line that is not periodic.
    #[inline]
    #[must_use]
    pub fn before(&self, i: usize, k: usize) -> usize {
        if i > 0 {
            k - 1
        } else if self.periodic {
            k + self.nx - 1
        } else {
            k
        }
    }

    /// Index of the node after `k`; `k` itself at the last node of a line that is not periodic.
    #[inline]
    #[must_use]
    pub fn after(&self, i: usize, k: usize) -> usize {
        if i + 1 < self.nx {
            k + 1
        } else if self.periodic {
            k + 1 - self.nx
        } else {
            k
        }
    }

    /// Largest residual `|b - A v|` over the nodes that are not fixed.
    #[must_use]
    pub fn residual(&self, b: &[f64], v: &[f64]) -> f64 {
        let nx = self.nx;
        let mut worst = 0.0_f64;
        for j in 0..self.ny {
            for i in 0..nx {
                let k = j * nx + i;
                if self.role[k] == Role::Fixed {
                    continue;
                }
                let row = self.row(i, j);
                let mut r = b[k] - row.c * v[k];
                r += row.w * v[self.before(i, k)] + row.e * v[self.after(i, k)];
                if j > 0 {
                    r += row.s * v[k - nx];
                }
                if j + 1 < self.ny {
                    r += row.n * v[k + nx];
                }
                worst = larger(worst, r.abs());
            }
        }
        worst
    }
}

/// The larger of two, or the second when it is not a number.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b }
}

fn largest(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |a, b| larger(a, b.abs()))
}

/// `own = b + f0 x0 + f1 x1 + f2 x2`.
#[inline(always)]
fn forward(own: &mut [f64], b: &[f64], f: [&[f64]; 3], x: [&[f64]; 3]) {
    let n = own.len();
    let (b, f, x) = (&b[..n], f.map(|f| &f[..n]), x.map(|x| &x[..n]));
    for k in 0..n {
        own[k] = b[k] + f[0][k] * x[0][k] + f[1][k] * x[1][k] + f[2][k] * x[2][k];
    }
}

/// `own = d (own + e next)`.
#[inline(always)]
fn backward(own: &mut [f64], d: &[f64], e: &[f64], next: &[f64]) {
    let n = own.len();
    let (d, e, next) = (&d[..n], &e[..n], &next[..n]);
    for k in 0..n {
        own[k] = d[k] * (own[k] + e[k] * next[k]);
    }
}

/// How a [`LineMultigrid::solve`] ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycles {
    /// Cycles done.
    pub cycles: usize,
    /// Largest residual at the end.
    pub residual: f64,
    /// Largest residual at the end over that at the start, to the power of one over the cycles: the mean convergence factor.
    pub rate: f64,
}

/// One grid of the hierarchy. Node `i` of line `j` stands at `i ny + place(j)`, lines of even number before those of odd number: all
/// lines of one parity are solved together, side by side.
#[derive(Debug, Clone)]
struct Level {
    nx: usize,
    ny: usize,
    /// Lines of even number.
    even: usize,
    periodic: bool,
    /// Elimination along the lines: multiplier, inverse pivot, and coupling to the node after.
    l: Vec<f64>,
    d: Vec<f64>,
    e: Vec<f64>,
    s: Vec<f64>,
    n: Vec<f64>,
    /// Response of a line to its last node and the inverse pivot of that node, for periodic lines.
    z: Vec<f64>,
    /// What the row of the last node of a periodic line asks of both its neighbours.
    wl: Vec<f64>,
    /// Set up: coupling to the node before, diagonal.
    w: Vec<f64>,
    c: Vec<f64>,
    /// Diffusion between neighbours, to the outside along x and along y, and whether a node takes part.
    gx: Vec<f64>,
    gy: Vec<f64>,
    ox: Vec<f64>,
    oy: Vec<f64>,
    /// What is carried along the lines; not read when nothing is.
    qx: Vec<f64>,
    hold: Vec<f64>,
    role: Vec<Role>,
    b: Vec<f64>,
    v: Vec<f64>,
}

impl Level {
    fn new(nx: usize, ny: usize, periodic: bool) -> Self {
        let f = || vec![0.0; nx * ny];
        let p = || if periodic { vec![0.0; nx * ny] } else { Vec::new() };
        Self {
            nx,
            ny,
            even: ny.div_ceil(2),
            periodic,
            l: f(),
            d: f(),
            e: f(),
            s: f(),
            n: f(),
            z: p(),
            wl: if periodic { vec![0.0; ny] } else { Vec::new() },
            w: f(),
            c: f(),
            gx: f(),
            gy: f(),
            ox: f(),
            oy: f(),
            qx: f(),
            hold: f(),
            role: vec![Role::Fixed; nx * ny],
            b: f(),
            v: f(),
        }
    }

    /// Where line `j` stands.
    #[inline(always)]
    fn place(&self, j: usize) -> usize {
        if j.is_multiple_of(2) { j / 2 } else { self.even + j / 2 }
    }

    /// Eliminates along the lines. Fixed nodes keep the value 0.
    fn eliminate(&mut self) -> Result<(), Singular> {
        let (nx, ny) = (self.nx, self.ny);
        // The last node of a periodic line is left for the end.
        let ends = if self.periodic { nx - 1 } else { nx };
        for i in 0..ends {
            for j in 0..ny {
                let k = i * ny + j;
                if self.role[k] == Role::Fixed {
                    self.l[k] = 0.0;
                    self.d[k] = 0.0;
                    continue;
                }
                let (mut c, mut l) = (self.c[k], 0.0);
                if i > 0 {
                    l = self.w[k] * self.d[k - ny];
                    c -= l * self.e[k - ny];
                }
                self.l[k] = l;
                self.d[k] = 1.0 / c;
                if !self.d[k].is_finite() {
                    return Err(Singular { column: k });
                }
            }
        }
        if !self.periodic {
            return Ok(());
        }
        // T z = coupling to the last node.
        let last = (nx - 1) * ny;
        for j in 0..ny {
            for i in 0..ends {
                let k = i * ny + j;
                let mut f = if i == 0 { self.w[k] } else { self.l[k] * self.z[k - ny] };
                if i + 1 == ends {
                    f += self.e[k];
                }
                self.z[k] = f;
            }
            for i in (0..ends).rev() {
                let k = i * ny + j;
                let next = if i + 1 == ends { 0.0 } else { self.e[k] * self.z[k + ny] };
                self.z[k] = self.d[k] * (self.z[k] + next);
            }
            let m = last + j;
            self.wl[j] = self.w[m];
            self.l[m] = 0.0;
            self.d[m] = if self.role[m] != Role::Fixed {
                1.0 / (self.c[m] - self.w[m] * self.z[m - ny] - self.e[m] * self.z[j])
            } else {
                0.0
            };
            if !self.d[m].is_finite() {
                return Err(Singular { column: m });
            }
        }
        Ok(())
    }

    /// Solves all lines of one parity for the present values of their neighbours.
    fn relax(&mut self, odd: bool) {
        let (nx, ny, even) = (self.nx, self.ny, self.even);
        let (from, to) = if odd { (even, ny) } else { (0, even) };
        let count = to - from;
        if count == 0 {
            return;
        }
        let ends = if self.periodic { nx - 1 } else { nx };
        // Lines with a neighbour on both sides; odd line k lies between the even lines k and k + 1, even line k between the odd ones k - 1
        // and k.
        let (first, both) = if odd { (0, count.min(even - 1)) } else { (1, count.min(ny - even)) };
        for i in 0..nx {
            let row = i * ny;
            let (done, rest) = self.v.split_at_mut(row);
            let (low, high) = rest[..ny].split_at_mut(even);
            let (own, other): (&mut [f64], &[f64]) = if odd { (high, low) } else { (low, high) };
            let b = &self.b[row + from..row + to];
            let s = &self.s[row + from..row + to];
            let n = &self.n[row + from..row + to];
            // Zeros at the start of a line, whose multipliers are zero too.
            let l = &self.l[row + from..row + to];
            let before = if i > 0 && i < ends { &done[row - ny + from..row - ny + to] } else { b };
            if both > first {
                let lines = first..both;
                let m = both - first;
                forward(
                    &mut own[lines.clone()],
                    &b[lines.clone()],
                    [&s[lines.clone()], &n[lines.clone()], &l[lines.clone()]],
                    [&other[..m], &other[1..][..m], &before[lines]],
                );
            }
            for k in (0..first.min(count)).chain(both.max(first)..count) {
                own[k] = b[k] + l[k] * before[k];
                // The outermost lines have one neighbour or none.
                let (below, above) = if odd { (Some(k), k + 1) } else { (k.checked_sub(1), k) };
                if let Some(x) = below.and_then(|m| other.get(m)) {
                    own[k] += s[k] * x;
                }
                if let Some(x) = other.get(above) {
                    own[k] += n[k] * x;
                }
            }
        }
        for i in (0..ends).rev() {
            let row = i * ny;
            let (head, tail) = self.v.split_at_mut(row + ny);
            let own = &mut head[row + from..row + to];
            let d = &self.d[row + from..row + to];
            if i + 1 < ends {
                backward(own, d, &self.e[row + from..row + to], &tail[from..to]);
            } else {
                for (o, d) in own.iter_mut().zip(d) {
                    *o *= d;
                }
            }
        }
        if self.periodic {
            let last = (nx - 1) * ny;
            for j in from..to {
                let m = last + j;
                let x = self.d[m] * (self.v[m] + self.wl[j] * self.v[m - ny] + self.e[m] * self.v[j]);
                self.v[m] = x;
            }
            for i in 0..ends {
                let row = i * ny;
                let (head, tail) = self.v.split_at_mut(last);
                let own = &mut head[row + from..row + to];
                for ((o, z), x) in own.iter_mut().zip(&self.z[row + from..row + to]).zip(&tail[from..to]) {
                    *o += z * x;
                }
            }
        }
    }

    /// The matrix times `v`; zero at fixed nodes.
    fn apply(&self, v: &[f64], out: &mut [f64]) {
        let (nx, ny, even) = (self.nx, self.ny, self.even);
        let odds = ny - even;
        for i in 0..nx {
            let row = i * ny..(i + 1) * ny;
            let own = &v[row.clone()];
            let o = &mut out[row.clone()];
            for ((o, c), v) in o.iter_mut().zip(&self.c[row.clone()]).zip(own) {
                *o = c * v;
            }
            let before = if i > 0 { Some(i - 1) } else { self.periodic.then_some(nx - 1) };
            if let Some(w) = before {
                for ((o, c), v) in o.iter_mut().zip(&self.w[row.clone()]).zip(&v[w * ny..(w + 1) * ny]) {
                    *o -= c * v;
                }
            }
            let after = if i + 1 < nx { Some(i + 1) } else { self.periodic.then_some(0) };
            if let Some(e) = after {
                for ((o, c), v) in o.iter_mut().zip(&self.e[row.clone()]).zip(&v[e * ny..(e + 1) * ny]) {
                    *o -= c * v;
                }
            }
            let (s, n) = (&self.s[row.clone()], &self.n[row.clone()]);
            for k in 0..odds {
                o[k] -= n[k] * own[even + k];
                o[even + k] -= s[even + k] * own[k];
            }
            for k in 1..even {
                o[k] -= s[k] * own[even + k - 1];
                o[even + k - 1] -= n[even + k - 1] * own[k];
            }
            for (o, r) in o.iter_mut().zip(&self.role[row]) {
                if *r == Role::Fixed {
                    *o = 0.0;
                }
            }
        }
    }

    /// Residual of even line `k` at node `i`, after the odd lines were solved.
    #[inline(always)]
    fn even_residual(&self, i: usize, k: usize) -> f64 {
        let (ny, m) = (self.ny, i * self.ny + k);
        let v = &self.v;
        let mut r = self.b[m] - self.c[m] * v[m];
        if i > 0 {
            r += self.w[m] * v[m - ny];
        } else if self.periodic {
            r += self.w[m] * v[m + (self.nx - 1) * ny];
        }
        if i + 1 < self.nx {
            r += self.e[m] * v[m + ny];
        } else if self.periodic {
            r += self.e[m] * v[k];
        }
        if k > 0 {
            r += self.s[m] * v[m + self.even - 1];
        }
        if k < ny - self.even {
            r += self.n[m] * v[m + self.even];
        }
        r
    }

    /// The grid of the even lines. An odd line is eliminated as if every node of it saw its two neighbours across alone, which is exact where diffusion
    /// across is strong; what the line diffuses along itself is handed to the neighbours by the same weights.
    fn coarsen(&self, to: &mut Self, carries: bool) {
        let (nx, ny) = (self.nx, self.ny);
        let (cn, odds) = (to.ny, ny - self.even);
        for i in 0..nx {
            for k in 0..cn {
                let (m, t) = (i * ny + k, i * cn + to.place(k));
                to.gx[t] = self.gx[m];
                to.gy[t] = 0.0;
                to.ox[t] = self.ox[m];
                to.oy[t] = self.oy[m];
                to.role[t] = self.role[m];
                if carries {
                    to.qx[t] = self.qx[m];
                    to.hold[t] = self.hold[m];
                }
            }
        }
        for k in 0..odds {
            let low = to.place(k);
            let high = (k + 1 < cn).then(|| to.place(k + 1));
            // Weights of a node: how much of it the neighbours below and above determine.
            let weights = |i: usize| {
                let o = i * ny + self.even + k;
                let below = self.gy[i * ny + k];
                let above = if high.is_some() { self.gy[o] } else { 0.0 };
                let sum = below + above + self.oy[o];
                if self.role[o] == Role::Diffused && sum > 0.0 {
                    (below / sum, above / sum)
                } else {
                    (0.0, 0.0)
                }
            };
            let (mut ws, mut wn) = weights(0);
            let first = (ws, wn);
            for i in 0..nx {
                let o = i * ny + self.even + k;
                let below = self.gy[i * ny + k];
                let above = if high.is_some() { self.gy[o] } else { 0.0 };
                let t = i * cn + low;
                let diffused = self.role[o] == Role::Diffused;
                // A node that does not diffuse takes all that reaches it.
                let lost = if diffused { 1.0 - ws - wn } else { 1.0 };
                to.gy[t] = below * wn;
                to.oy[t] += below * lost;
                to.ox[t] += ws * self.ox[o];
                if let Some(h) = high {
                    to.oy[i * cn + h] += above * lost;
                    to.ox[i * cn + h] += wn * self.ox[o];
                }
                if carries {
                    to.qx[t] += 0.5 * self.qx[o];
                    to.hold[t] += 0.5 * self.hold[o];
                    if let Some(h) = high {
                        to.qx[i * cn + h] += 0.5 * self.qx[o];
                        to.hold[i * cn + h] += 0.5 * self.hold[o];
                    }
                }
                if i + 1 == nx && !self.periodic {
                    break;
                }
                let next = if i + 1 < nx { i + 1 } else { 0 };
                let (es, en) = if next > 0 { weights(next) } else { first };
                let (g, other) = (self.gx[o], self.role[next * ny + self.even + k] == Role::Diffused);
                let mut hand = |line: usize, from: f64, to_next: f64| {
                    let (a, b) = (i * cn + line, next * cn + line);
                    if diffused && other {
                        to.gx[a] += 0.5 * (from + to_next) * g;
                    } else if diffused && to.role[b] != Role::Diffused
                        || other && to.role[a] != Role::Diffused
                    {
                        to.gx[a] += if diffused { from } else { to_next } * g;
                    } else if diffused {
                        to.ox[a] += from * g;
                    } else if other {
                        to.ox[b] += to_next * g;
                    }
                };
                hand(low, ws, es);
                if let Some(h) = high {
                    hand(h, wn, en);
                }
                (ws, wn) = (es, en);
            }
        }
    }

    /// Couplings from what is diffused and carried between neighbours.
    fn couple(&mut self, carries: bool) {
        let (nx, ny) = (self.nx, self.ny);
        for i in 0..nx {
            let before = if i > 0 { i - 1 } else { nx - 1 };
            let after = if i + 1 < nx { i + 1 } else { 0 };
            let (has_west, has_east) = (self.periodic || i > 0, self.periodic || i + 1 < nx);
            for j in 0..ny {
                let place = self.place(j);
                let k = i * ny + place;
                let (west, east) = (before * ny + place, after * ny + place);
                let (gw, ge) =
                    (if has_west { self.gx[west] } else { 0.0 }, if has_east { self.gx[k] } else { 0.0 });
                let gn = if j + 1 < ny { self.gy[k] } else { 0.0 };
                let gs = if j > 0 { self.gy[i * ny + self.place(j - 1)] } else { 0.0 };
                (self.w[k], self.e[k], self.s[k], self.n[k]) = (gw, ge, gs, gn);
                self.c[k] = gw + ge + gs + gn + self.ox[k] + self.oy[k];
                if carries {
                    let carried = |m: usize| self.role[m] == Role::Carried;
                    let qw = if has_west { self.qx[west] } else { 0.0 };
                    let qe = if has_east { self.qx[k] } else { 0.0 };
                    if carried(k) {
                        self.c[k] = -(qe.max(0.0) - qw.min(0.0) + self.hold[k]);
                    }
                    if carried(west) {
                        self.w[k] = -qw.max(0.0);
                    }
                    if carried(east) {
                        self.e[k] = qe.min(0.0);
                    }
                    if j > 0 && carried(i * ny + self.place(j - 1)) {
                        self.s[k] = 0.0;
                    }
                    if j + 1 < ny && carried(i * ny + self.place(j + 1)) {
                        self.n[k] = 0.0;
                    }
                }
                // A node without any coupling takes no part; what it holds does not matter.
                if self.c[k] == 0.0 {
                    self.role[k] = Role::Fixed;
                }
            }
        }
    }
}

/// Multigrid for [`FivePoint`] matrices: whole lines along `x` are solved exactly, odd ones and even ones in turn, and every grid keeps the
/// even lines of the one before, down to a single line.
///
/// Lines take care of strong diffusion along `x`, coarsening across of strong diffusion along `y`: the convergence does not depend on the
/// ratio of the two, nor on jumps of the coefficients across lines. Unknowns that are carried along the lines
/// ([`Role::Carried`]) are solved with them.
///
/// After Schaffer 1998 (semicoarsening with line relaxation), with the coefficients of the coarse grids lumped to five points.
#[derive(Debug, Clone)]
pub struct LineMultigrid {
    levels: Vec<Level>,
    /// Whether the matrix carries unknowns along lines.
    carries: bool,
    krylov: Krylov,
}

/// Search directions kept by the minimisation of residuals.
const DIRECTIONS: usize = 10;

/// Work space of the generalised conjugate residual method.
#[derive(Debug, Clone)]
struct Krylov {
    /// Directions, what the matrix makes of them, and the squares of the latter.
    z: Vec<Vec<f64>>,
    q: Vec<Vec<f64>>,
    square: [f64; DIRECTIONS],
    /// What each direction shares with the ones before, and how far to go along it once that is taken out.
    share: [[f64; DIRECTIONS]; DIRECTIONS],
    step: [f64; DIRECTIONS],
    v: Vec<f64>,
    r: Vec<f64>,
}

impl Krylov {
    /// Adds the first `count` directions to the solution, each with its own step less what later ones took of it.
    fn move_along(&mut self, count: usize) {
        for d in (0..count).rev() {
            let later: f64 = (d + 1..count).map(|e| self.share[e][d] * self.step[e]).sum();
            self.step[d] -= later;
            let step = self.step[d];
            for (v, z) in self.v.iter_mut().zip(&self.z[d]) {
                *v += step * z;
            }
        }
    }
}

impl LineMultigrid {
    /// Work space for a grid of `ny` lines of `nx` nodes: some 60 values per node.
    #[must_use]
    pub fn new(nx: usize, ny: usize, periodic: bool) -> Self {
        let mut levels = vec![Level::new(nx, ny, periodic)];
        let mut lines = ny;
        while lines > 1 {
            lines = lines.div_ceil(2);
            levels.push(Level::new(nx, lines, periodic));
        }
        let field = || vec![0.0; nx * ny];
        let krylov = Krylov {
            z: vec![field(); DIRECTIONS],
            q: vec![field(); DIRECTIONS],
            square: [0.0; DIRECTIONS],
            share: [[0.0; DIRECTIONS]; DIRECTIONS],
            step: [0.0; DIRECTIONS],
            v: field(),
            r: field(),
        };
        Self { levels, carries: false, krylov }
    }

    /// Prepares the solution of systems with this matrix.
    ///
    /// # Errors
    /// [`Singular`] when a line has no solution of its own.
    ///
    /// # Panics
    /// When the matrix is not of the size this was made for.
    pub fn setup(&mut self, m: &FivePoint) -> Result<(), Singular> {
        let fine = &mut self.levels[0];
        let (nx, ny) = (fine.nx, fine.ny);
        assert!(m.nx == nx && m.ny == ny && m.periodic == fine.periodic, "another grid");
        let carries = m.role.contains(&Role::Carried);
        // Eight columns at a time: each side of the transposition stays in the cache.
        for block in (0..nx).step_by(8) {
            for j in 0..ny {
                let place = fine.place(j);
                for i in block..nx.min(block + 8) {
                    let (k, t) = (j * nx + i, i * ny + place);
                    fine.gx[t] = m.gx[k];
                    fine.gy[t] = m.gy[k];
                    fine.role[t] = m.role[k];
                    if carries {
                        fine.qx[t] = m.qx[k];
                        fine.hold[t] = m.hold[k];
                    }
                }
            }
        }
        self.carries = carries;
        fine.couple(carries);
        fine.eliminate()?;
        for l in 1..self.levels.len() {
            let (fine, coarse) = self.levels.split_at_mut(l);
            fine[l - 1].coarsen(&mut coarse[0], carries);
            coarse[0].couple(carries);
            coarse[0].eliminate()?;
        }
        Ok(())
    }

    /// Improves `v` until no residual is larger than `target`, for at most `most` cycles, or until they stop helping. Where unknowns are
    /// carried, or cycles alone are slow, the cycles precondition a minimisation of the residual (GCR, Eisenstat, Elman and Schultz 1983).
    pub fn solve(&mut self, b: &[f64], v: &mut [f64], target: f64, most: usize) -> Cycles {
        if self.carries {
            return self.minimise(b, v, target, most);
        }
        let plain = self.repeat(b, v, target, most);
        if plain.residual <= target || plain.cycles >= most || !plain.residual.is_finite() {
            return plain;
        }
        let more = self.minimise(b, v, target, most - plain.cycles);
        Cycles { cycles: plain.cycles + more.cycles, ..more }
    }

    /// Cycles alone.
    fn repeat(&mut self, b: &[f64], v: &mut [f64], target: f64, most: usize) -> Cycles {
        let fine = &mut self.levels[0];
        let (nx, ny) = (fine.nx, fine.ny);
        for j in 0..ny {
            let place = fine.place(j);
            for i in 0..nx {
                fine.b[i * ny + place] = b[j * nx + i];
                fine.v[i * ny + place] = v[j * nx + i];
            }
        }
        let (mut start, mut out) = (f64::NAN, Cycles { cycles: 0, residual: f64::INFINITY, rate: 0.0 });
        loop {
            let worst = Self::descend(&mut self.levels, 0);
            if start.is_nan() {
                start = worst;
            }
            let slow = out.cycles > 4 && worst > 0.5 * out.residual;
            out.residual = worst;
            if worst <= target || out.cycles >= most || slow || !worst.is_finite() {
                break;
            }
            Self::correct(&mut self.levels, 0);
            out.cycles += 1;
        }
        if out.cycles > 0 && start > 0.0 {
            out.rate = (out.residual / start).powf(1.0 / out.cycles as f64);
        }
        let fine = &self.levels[0];
        for j in 0..ny {
            let place = fine.place(j);
            for i in 0..nx {
                v[j * nx + i] = fine.v[i * ny + place];
            }
        }
        out
    }

    fn minimise(&mut self, b: &[f64], v: &mut [f64], target: f64, most: usize) -> Cycles {
        let mut out = Cycles { cycles: 0, residual: f64::INFINITY, rate: 0.0 };
        let (nx, ny) = (self.levels[0].nx, self.levels[0].ny);
        let k = &mut self.krylov;
        let fixed = |level: &Level, m: usize| level.role[m] == Role::Fixed;
        for j in 0..ny {
            let place = self.levels[0].place(j);
            for i in 0..nx {
                let m = i * ny + place;
                k.v[m] = if fixed(&self.levels[0], m) { 0.0 } else { v[j * nx + i] };
                k.r[m] = b[j * nx + i];
            }
        }
        self.levels[0].apply(&k.v, &mut k.q[0]);
        for m in 0..k.r.len() {
            k.r[m] = if fixed(&self.levels[0], m) { 0.0 } else { k.r[m] - k.q[0][m] };
        }
        let start = largest(&k.r);
        out.residual = start;
        let mut last = start;
        let mut kept = 0;
        while out.residual > target && out.cycles < most && out.residual.is_finite() {
            let now = out.cycles % DIRECTIONS;
            // A round of all directions that brought less than a tenth is the end of what can be had.
            if now == 0 && out.cycles > 0 {
                if out.residual > 0.9 * last {
                    break;
                }
                last = out.residual;
            }
            let fine = &mut self.levels[0];
            fine.b.copy_from_slice(&k.r);
            fine.v.fill(0.0);
            Self::descend(&mut self.levels, 0);
            Self::correct(&mut self.levels, 0);
            k.z[now].copy_from_slice(&self.levels[0].v);
            let (q_done, q_now) = k.q.split_at_mut(now);
            let q_now = &mut q_now[0];
            self.levels[0].apply(&k.z[now], q_now);
            for (d, qd) in q_done.iter().enumerate() {
                let share = dot(qd, q_now) / k.square[d];
                k.share[now][d] = share;
                for (x, y) in q_now.iter_mut().zip(qd) {
                    *x -= share * y;
                }
            }
            k.square[now] = dot(q_now, q_now);
            out.cycles += 1;
            if k.square[now] <= 0.0 {
                break;
            }
            let step = dot(q_now, &k.r) / k.square[now];
            k.step[now] = step;
            kept = now + 1;
            for (r, q) in k.r.iter_mut().zip(&*q_now) {
                *r -= step * q;
            }
            out.residual = largest(&k.r);
            if kept == DIRECTIONS {
                k.move_along(kept);
                kept = 0;
            }
        }
        k.move_along(kept);
        if out.cycles > 0 && start > 0.0 {
            out.rate = (out.residual / start).powf(1.0 / out.cycles as f64);
        }
        for j in 0..ny {
            let place = self.levels[0].place(j);
            for i in 0..nx {
                v[j * nx + i] = k.v[i * ny + place];
            }
        }
        out
    }

    /// Solves the odd lines of a level, and hands the residual of the even ones to the next. Returns the largest of them.
    fn descend(levels: &mut [Level], l: usize) -> f64 {
        let (head, tail) = levels.split_at_mut(l + 1);
        let level = &mut head[l];
        level.relax(true);
        let Some(coarse) = tail.first_mut() else { return 0.0 };
        let mut worst = 0.0_f64;
        for i in 0..level.nx {
            for k in 0..level.even {
                let m = i * level.ny + k;
                // Rows of fixed nodes have no inverse pivot.
                let r = if level.d[m] == 0.0 { 0.0 } else { level.even_residual(i, k) };
                worst = larger(worst, r.abs());
                let t = i * coarse.ny + coarse.place(k);
                coarse.b[t] = r;
            }
        }
        worst
    }

    /// Coarse correction and the lines once more, odd ones first: they carry the correction to where the coarse grid has no node.
    fn correct(levels: &mut [Level], l: usize) {
        if l + 1 < levels.len() {
            let coarsest = l + 2 == levels.len();
            let next = &mut levels[l + 1];
            next.v.fill(0.0);
            if !coarsest {
                next.relax(false);
                Self::descend(levels, l + 1);
            }
            Self::correct(levels, l + 1);
            let (head, tail) = levels.split_at_mut(l + 1);
            let (level, coarse) = (&mut head[l], &tail[0]);
            for i in 0..level.nx {
                for k in 0..level.even {
                    level.v[i * level.ny + k] += coarse.v[i * coarse.ny + coarse.place(k)];
                }
            }
        }
        let level = &mut levels[l];
        level.relax(true);
        level.relax(false);
    }
}
