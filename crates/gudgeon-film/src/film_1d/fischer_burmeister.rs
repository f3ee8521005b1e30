//! Newton's method on Fischer-Burmeister functions for the rows of a line.

use super::line::Line;
use super::rows::{Node, Rows, STEPS};

impl Rows {
    /// Newton's method on `p + r - √(p² + r²) = 0`, pressures over their scale; sets the states. Returns the steps.
    pub(super) fn fischer_burmeister(&mut self, line: &Line, warm: bool) -> usize {
        let (n, first) = (line.n, self.first);
        let (g, c) = (&line.g, &line.c);
        // Pressure that sliding, squeezing or the ends make.
        let mut scale = line.p_in.abs().max(line.p_out.abs());
        let resistance: f64 = line.d.iter().sum();
        for i in first..n {
            scale = scale.max(resistance * (self.s[i] + c[i]).max(self.b[i].abs()));
        }
        if scale.is_nan() || scale <= 0.0 {
            return 0;
        }
        for i in 0..=n {
            let film = self.state[i] == Node::Film;
            self.r[i] = if film || i == n { 0.0 } else { (1.0 - self.theta[i]).clamp(0.0, 1.0) };
            if !warm && i >= first && i < n {
                self.p[i] = self.floor[i];
            }
        }
        for step in 1..=STEPS {
            let mut worst: f64 = 0.0;
            for i in first..n {
                // The reduced unknown of each node: δp where that decides, else δr.
                let (y, r) = ((self.p[i] - self.floor[i]) / scale, self.r[i]);
                let root = y.hypot(r);
                let (fy, fr) = if root > 0.0 {
                    (1.0 - y / root, 1.0 - r / root)
                } else {
                    (1.0 - std::f64::consts::FRAC_1_SQRT_2, 1.0 - std::f64::consts::FRAC_1_SQRT_2)
                };
                let f = y + r - root;
                worst = worst.max(f.abs());
                // δr = (-f - fy δy)/fr, or δy = (-f - fr δr)/fy.
                (self.dp[i], self.dr[i]) = (f, if fr > fy { fy / fr } else { -fr / fy });
                self.state[i] = if fr > fy { Node::Film } else { Node::Void };
                self.theta[i] = if fr > fy { f / fr } else { f / fy };
            }
            let mut off: f64 = 0.0;
            for i in first..n {
                let before = if i > 0 { g[i - 1] } else { 0.0 };
                let hold = self.s[i] + c[i];
                let mut row = hold * (1.0 - self.r[i]) - self.b[i] + g[i] * (self.p[i] - self.p[i + 1]);
                let mut size = hold.max(g[i] * scale);
                if i > 0 {
                    row += before * (self.p[i] - self.p[i - 1]) - c[i - 1] * (1.0 - self.r[i - 1]);
                    size = size.max(before * scale).max(c[i - 1]);
                }
                off = off.max(row.abs() / size);
                let mut rhs = -row;
                // δy_j and δr_j of a node by its unknown: coefficient and constant.
                let parts = |j: usize| {
                    let (ratio, constant) = (self.dr[j], self.theta[j]);
                    if self.state[j] == Node::Film {
                        ((1.0, 0.0), (-ratio, -constant))
                    } else {
                        ((ratio, -constant), (1.0, 0.0))
                    }
                };
                let (y, r) = parts(i);
                let (ky, kr) = ((before + g[i]) * scale, -hold);
                self.diag[i] = ky * y.0 + kr * r.0;
                rhs -= ky * y.1 + kr * r.1;
                self.lower[i] = 0.0;
                if i > first {
                    let (y, r) = parts(i - 1);
                    let (ky, kr) = (-before * scale, c[i - 1]);
                    self.lower[i] = ky * y.0 + kr * r.0;
                    rhs -= ky * y.1 + kr * r.1;
                }
                self.upper[i] = 0.0;
                if i + 1 < n {
                    let (y, _) = parts(i + 1);
                    let ky = -g[i] * scale;
                    self.upper[i] = ky * y.0;
                    rhs -= ky * y.1;
                }
                self.rhs[i] = rhs;
            }
            if worst <= 1e-11 && off <= 1e-11 {
                self.settle(n, scale);
                return step;
            }
            for i in first + 1..n {
                let w = self.lower[i] / self.diag[i - 1];
                self.diag[i] -= w * self.upper[i - 1];
                self.rhs[i] -= w * self.rhs[i - 1];
            }
            let mut next = 0.0;
            for i in (first..n).rev() {
                next = (self.rhs[i] - self.upper[i] * next) / self.diag[i];
                if !next.is_finite() {
                    self.state.fill(Node::Film);
                    return step;
                }
                self.rhs[i] = next;
            }
            for i in first..n {
                let (own, ratio, constant) = (self.rhs[i], self.dr[i], self.theta[i]);
                let (dy, dr) = if self.state[i] == Node::Film {
                    (own, -ratio * own - constant)
                } else {
                    (ratio * own - constant, own)
                };
                self.p[i] = (self.p[i] + dy * scale).max(self.floor[i]);
                self.r[i] = (self.r[i] + dr).clamp(0.0, 1.0);
            }
        }
        self.settle(n, scale);
        STEPS
    }

    /// States from the pressures and voids of [`Self::fischer_burmeister`].
    pub(super) fn settle(&mut self, n: usize, scale: f64) {
        for i in self.first..n {
            let film = (self.p[i] - self.floor[i]) / scale > self.r[i];
            self.state[i] = if film { Node::Film } else { Node::Void };
            self.theta[i] = 1.0 - self.r[i];
        }
    }
}
