//! Five-point matrices on a rectangular grid.

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
/// The last `gx` and `qx` of a line join it to its first node when lines are periodic, and are zero otherwise; so are the `gy` of the last line.
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
    /// What a diffused unknown loses on the spot; counted by [`FivePoint::row`] and [`FivePoint::residual`], not by the multigrid.
    pub leak: Vec<f64>,
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
        Self {
            nx,
            ny,
            periodic,
            role: vec![Role::Diffused; nx * ny],
            gx: v(),
            gy: v(),
            qx: v(),
            hold: v(),
            leak: v(),
        }
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
            c: if carried(k) {
                -(qe.max(0.0) - qw.min(0.0) + self.hold[k])
            } else {
                gw + ge + gs + gn + self.leak[k]
            },
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
        let mut largest = 0.0_f64;
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
                largest = larger(largest, r.abs());
            }
        }
        largest
    }
}

/// The larger of two, or the second when it is not a number.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b <= a { a } else { b }
}

/// Largest magnitude in `v`; not a number when one is none.
pub(super) fn max_abs(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |a, b| larger(a, b.abs()))
}
