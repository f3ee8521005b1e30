//! Newton's method on Fischer-Burmeister functions for the rows of a line.

use std::f64::consts::FRAC_1_SQRT_2;

use super::line::Line;
use super::rows::{Node, Rows, STEPS};
use gudgeon_numerics::elementary;

/// Residual of functions and rows, beside their terms, at which the iteration ends.
const TOLERANCE: f64 = 1e-11;

impl Rows {
    /// Newton's method on `y + r - √(y² + r²) = 0`, with `y` the pressure above its floor over a scale and `r = 1 - θ`; sets the
    /// states. Returns the steps.
    ///
    /// Each node has one unknown, the change of `y` or that of `r`, whichever its function depends on more; the other one follows. During
    /// the iteration `dr` holds the ratio of the two and `theta` the constant, and the state `Film` marks nodes whose unknown is `δy`.
    pub(super) fn fischer_burmeister(&mut self, line: &Line, warm: bool) -> usize {
        let n = line.n;
        let scale = self.pressure_scale(line);
        if scale.is_nan() || scale <= 0.0 {
            return 0;
        }
        self.begin(n, warm);
        for step in 1..=STEPS {
            let residual = self.reduce(n, scale);
            let imbalance = self.linearise(line, scale);
            if residual <= TOLERANCE && imbalance <= TOLERANCE {
                self.settle(n, scale);
                return step;
            }
            if !self.eliminate(self.first, n) {
                self.state.fill(Node::Film);
                return step;
            }
            self.advance(n, scale);
        }
        self.settle(n, scale);
        STEPS
    }

    /// Pressure that sliding, squeezing or the ends make.
    fn pressure_scale(&self, line: &Line) -> f64 {
        let mut scale = line.p_in.abs().max(line.p_out.abs());
        let resistance: f64 = line.d.iter().sum();
        for i in self.first..line.n {
            scale = scale.max(resistance * (self.s[i] + line.c[i]).max(self.b[i].abs()));
        }
        scale
    }

    /// Voids from the states; pressures at their floors unless the last film is the start.
    fn begin(&mut self, n: usize, warm: bool) {
        for i in 0..=n {
            let film = self.state[i] == Node::Film;
            self.r[i] = if film || i == n { 0.0 } else { (1.0 - self.theta[i]).clamp(0.0, 1.0) };
            if !warm && i >= self.first && i < n {
                self.p[i] = self.floor[i];
            }
        }
    }

    /// Chooses the unknown of each node. Returns the largest residual of the functions.
    fn reduce(&mut self, n: usize, scale: f64) -> f64 {
        let mut largest: f64 = 0.0;
        for i in self.first..n {
            let (y, r) = ((self.p[i] - self.floor[i]) / scale, self.r[i]);
            let root = elementary::hypot(y, r);
            let (fy, fr) = if root > 0.0 {
                (1.0 - y / root, 1.0 - r / root)
            } else {
                (1.0 - FRAC_1_SQRT_2, 1.0 - FRAC_1_SQRT_2)
            };
            let f = y + r - root;
            largest = largest.max(f.abs());
            // δr = (-f - fy δy)/fr, or δy = (-f - fr δr)/fy.
            let film = fr > fy;
            self.state[i] = if film { Node::Film } else { Node::Void };
            self.dr[i] = if film { fy / fr } else { -fr / fy };
            self.theta[i] = if film { f / fr } else { f / fy };
        }
        largest
    }

    /// `δy` and `δr` of node `j` by its unknown: coefficient and constant of each.
    #[inline]
    fn changes(&self, j: usize) -> ((f64, f64), (f64, f64)) {
        let (ratio, constant) = (self.dr[j], self.theta[j]);
        if self.state[j] == Node::Film {
            ((1.0, 0.0), (-ratio, -constant))
        } else {
            ((ratio, -constant), (1.0, 0.0))
        }
    }

    /// Balances of the nodes in the unknowns. Returns the largest imbalance, beside the terms of its row.
    fn linearise(&mut self, line: &Line, scale: f64) -> f64 {
        let (n, first) = (line.n, self.first);
        let (g, c) = (&line.g, &line.c);
        let mut largest: f64 = 0.0;
        for i in first..n {
            let before = if i > 0 { g[i - 1] } else { 0.0 };
            let hold = self.s[i] + c[i];
            let mut row = hold * (1.0 - self.r[i]) - self.b[i] + g[i] * (self.p[i] - self.p[i + 1]);
            let mut size = hold.max(g[i] * scale);
            if i > 0 {
                row += before * (self.p[i] - self.p[i - 1]) - c[i - 1] * (1.0 - self.r[i - 1]);
                size = size.max(before * scale).max(c[i - 1]);
            }
            largest = largest.max(row.abs() / size);
            let mut rhs = -row;
            let (y, r) = self.changes(i);
            let (ky, kr) = ((before + g[i]) * scale, -hold);
            self.diag[i] = ky * y.0 + kr * r.0;
            rhs -= ky * y.1 + kr * r.1;
            self.lower[i] = 0.0;
            if i > first {
                let (y, r) = self.changes(i - 1);
                let (ky, kr) = (-before * scale, c[i - 1]);
                self.lower[i] = ky * y.0 + kr * r.0;
                rhs -= ky * y.1 + kr * r.1;
            }
            self.upper[i] = 0.0;
            if i + 1 < n {
                let (y, _) = self.changes(i + 1);
                let ky = -g[i] * scale;
                self.upper[i] = ky * y.0;
                rhs -= ky * y.1;
            }
            self.rhs[i] = rhs;
        }
        largest
    }

    /// Adds the step found in `rhs`.
    fn advance(&mut self, n: usize, scale: f64) {
        for i in self.first..n {
            let own = self.rhs[i];
            let (y, r) = self.changes(i);
            let (dy, dr) =
                if self.state[i] == Node::Film { (own, r.0 * own + r.1) } else { (y.0 * own + y.1, own) };
            self.p[i] = (self.p[i] + dy * scale).max(self.floor[i]);
            self.r[i] = (self.r[i] + dr).clamp(0.0, 1.0);
        }
    }

    /// States from the pressures and voids that were found.
    fn settle(&mut self, n: usize, scale: f64) {
        for i in self.first..n {
            let film = (self.p[i] - self.floor[i]) / scale > self.r[i];
            self.state[i] = if film { Node::Film } else { Node::Void };
            self.theta[i] = 1.0 - self.r[i];
        }
    }
}
