//! One grid: elimination and relaxation along its lines.

use super::five_point::{Role, larger};
use crate::linalg::Singular;

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

/// One grid of the hierarchy. Node `i` of line `j` stands at `i ny + place(j)`, lines of even number before those of odd number: all
/// lines of one parity are solved together, side by side.
#[derive(Debug, Clone)]
pub(super) struct Level {
    pub nx: usize,
    pub ny: usize,
    /// Lines of even number.
    pub even: usize,
    pub periodic: bool,
    /// Elimination along the lines: multiplier, inverse pivot, and coupling to the node after.
    pub l: Vec<f64>,
    pub d: Vec<f64>,
    pub e: Vec<f64>,
    pub s: Vec<f64>,
    pub n: Vec<f64>,
    /// Response of a line to its last node and the inverse pivot of that node, for periodic lines.
    pub z: Vec<f64>,
    /// What the row of the last node of a periodic line asks of both its neighbours.
    pub wl: Vec<f64>,
    /// Set up: coupling to the node before, diagonal.
    pub w: Vec<f64>,
    pub c: Vec<f64>,
    /// Diffusion between neighbours, to the outside along x and along y, and whether a node takes part.
    pub gx: Vec<f64>,
    pub gy: Vec<f64>,
    pub ox: Vec<f64>,
    pub oy: Vec<f64>,
    /// What is carried along the lines; not read when nothing is.
    pub qx: Vec<f64>,
    pub hold: Vec<f64>,
    pub role: Vec<Role>,
    pub b: Vec<f64>,
    pub v: Vec<f64>,
}

impl Level {
    pub fn new(nx: usize, ny: usize, periodic: bool) -> Self {
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
    pub fn place(&self, j: usize) -> usize {
        if j.is_multiple_of(2) { j / 2 } else { self.even + j / 2 }
    }

    /// Takes a right-hand side and a first guess of the matrix (node `j nx + i`).
    pub fn load(&mut self, b: &[f64], v: &[f64]) {
        for j in 0..self.ny {
            let place = self.place(j);
            for i in 0..self.nx {
                let (k, t) = (j * self.nx + i, i * self.ny + place);
                (self.b[t], self.v[t]) = (b[k], v[k]);
            }
        }
    }

    /// Brings a field of the matrix (node `j nx + i`) into the order of this grid.
    pub fn scatter(&self, field: &[f64], to: &mut [f64]) {
        for j in 0..self.ny {
            let place = self.place(j);
            for i in 0..self.nx {
                to[i * self.ny + place] = field[j * self.nx + i];
            }
        }
    }

    /// The reverse of [`Level::scatter`].
    pub fn gather(&self, own: &[f64], field: &mut [f64]) {
        for j in 0..self.ny {
            let place = self.place(j);
            for i in 0..self.nx {
                field[j * self.nx + i] = own[i * self.ny + place];
            }
        }
    }

    /// Eliminates along the lines. Fixed nodes keep the value 0.
    pub fn eliminate(&mut self) -> Result<(), Singular> {
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
        if self.periodic { self.eliminate_last() } else { Ok(()) }
    }

    /// Eliminates the last node of every periodic line by the response of the others to it.
    fn eliminate_last(&mut self) -> Result<(), Singular> {
        let (nx, ny) = (self.nx, self.ny);
        let ends = nx - 1;
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
    pub fn relax(&mut self, odd: bool) {
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
            self.close(from, to);
        }
    }

    /// The last nodes of the periodic lines that stand from `from` to `to`, and what they change in the others.
    fn close(&mut self, from: usize, to: usize) {
        let (nx, ny) = (self.nx, self.ny);
        let ends = nx - 1;
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

    /// The matrix times `v`; zero at fixed nodes.
    pub fn apply(&self, v: &[f64], out: &mut [f64]) {
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

    /// Largest residual of a grid of one line.
    pub fn line_residual(&self) -> f64 {
        let nodes = (0..self.nx).filter(|&i| self.d[i * self.ny] != 0.0);
        nodes.fold(0.0, |largest, i| larger(largest, self.even_residual(i, 0).abs()))
    }

    /// Residual of even line `k` at node `i`, after the odd lines were solved.
    #[inline(always)]
    pub fn even_residual(&self, i: usize, k: usize) -> f64 {
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
}
