//! The coefficients of a coarse grid from those of the next finer one.

use super::five_point::Role;
use super::level::Level;

impl Level {
    /// The grid of the even lines. An odd line is eliminated as if every node of it saw its two neighbours across alone, which is exact where diffusion
    /// across is strong; what the line diffuses along itself is handed to the neighbours by the same weights.
    pub fn coarsen(&self, to: &mut Self, carries: bool) {
        let (nx, ny) = (self.nx, self.ny);
        let cn = to.ny;
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
        for k in 0..ny - self.even {
            self.fold(k, to, carries);
        }
    }

    /// Hands odd line `k` over to the even lines below and above it.
    fn fold(&self, k: usize, to: &mut Self, carries: bool) {
        let (nx, ny, cn) = (self.nx, self.ny, to.ny);
        let low = to.place(k);
        let high = (k + 1 < cn).then(|| to.place(k + 1));
        // Weights of a node: how much of it the neighbours below and above determine.
        let weights = |i: usize| {
            let o = i * ny + self.even + k;
            let below = self.gy[i * ny + k];
            let above = if high.is_some() { self.gy[o] } else { 0.0 };
            let sum = below + above + self.oy[o];
            if self.role[o] == Role::Diffused && sum > 0.0 { (below / sum, above / sum) } else { (0.0, 0.0) }
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
                } else if diffused && to.role[b] != Role::Diffused || other && to.role[a] != Role::Diffused {
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

    /// Couplings from what is diffused and carried between neighbours.
    pub fn couple(&mut self, carries: bool) {
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
