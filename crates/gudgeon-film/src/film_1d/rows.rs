//! The balance of oil at each node when it depends on what the film stores, solved for all nodes together.
//!
//! Row `i`, with `s` what a full node holds at the end of the step and `b` what it held before, both over the step,
//!
//! ```text
//! (s_i + c_i) θ_i + g_i (p_i - p_{i+1}) + g_{i-1} (p_i - p_{i-1}) - c_{i-1} θ_{i-1} = b_i
//! ```
//!
//! and at each node one of three: `p_i` free and `θ_i = 1` (film), `p_i` at its floor and `θ_i` free (void), or both fixed and
//! the row an inequality, what arrives being too little to leave any oil (dry). Diagonals are positive, all else is negative
//! and no larger in sum over each column: the rows have one solution, and pressures only rise with `b`.

use gudgeon_core::EvalError;

use super::complementarity::LineSolver;
use super::line::{Change, Line};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Node {
    Film,
    Void,
    Dry,
}

/// Newton steps before the search node by node.
const STEPS: usize = 60;

#[derive(Debug)]
pub(super) struct Rows {
    s: Vec<f64>,
    b: Vec<f64>,
    floor: Vec<f64>,
    state: Vec<Node>,
    /// Diagonal, coupling to the node before and behind, right-hand side, solution.
    diag: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    rhs: Vec<f64>,
    p: Vec<f64>,
    theta: Vec<f64>,
    r: Vec<f64>,
    dp: Vec<f64>,
    dr: Vec<f64>,
    /// The states are those of a film that was found.
    warm: bool,
    turned: bool,
    /// First row: 0 when the inlet is a node like all others, else 1.
    first: usize,
}

impl Rows {
    pub fn new(nodes: usize) -> Self {
        let v = || vec![0.0; nodes];
        Self {
            s: v(),
            b: v(),
            floor: v(),
            state: vec![Node::Film; nodes],
            diag: v(),
            lower: v(),
            upper: v(),
            rhs: v(),
            p: v(),
            theta: v(),
            r: v(),
            dp: v(),
            dr: v(),
            warm: false,
            turned: false,
            first: 1,
        }
    }

    /// Solves for the mass-conserving film. Returns the passes over the line.
    pub fn solve(&mut self, line: &mut Line, solver: LineSolver) -> Result<usize, EvalError> {
        let n = line.n;
        for i in 0..=n {
            (self.s[i], self.b[i]) = match line.change {
                Change::Steady => (0.0, 0.0),
                Change::Rates => (0.0, -line.rate[i]),
                Change::Step(dt) => (line.volume[i] / dt, line.before[i] / dt),
            };
        }
        self.floor.fill(0.0);
        line.lead = 0;
        line.starved = false;
        // A bath first: what it would have to give says whether the layer that arrives is enough.
        self.first = 1;
        self.p[0] = line.p_in;
        self.theta[0] = 1.0;
        self.state[0] = Node::Film;
        if self.turned != line.turned() || !self.warm {
            self.warm = false;
            self.state.fill(Node::Film);
            self.turned = line.turned();
        }
        let warm = std::mem::take(&mut self.warm);
        let mut passes = self.find(line, solver, warm)?;
        if let Some(supply) = line.supply {
            let asked = line.c[0] + line.g[0] * (self.p[0] - self.p[1]) + self.s[0] - self.b[0];
            if supply < asked {
                line.starved = true;
                self.first = 0;
                self.b[0] += supply;
                passes += self.find(line, solver, true)?;
                if line.p_in > 0.0 {
                    // Before the first node with the pressure of the gas there is gas; that only raises pressures, so that the
                    // node keeps it out.
                    line.lead = self.p[..n].iter().position(|p| *p >= line.p_in).unwrap_or(n);
                    if line.lead == n {
                        // Nowhere sealed: the gas reaches the other end.
                        line.p_out = line.p_out.max(line.p_in);
                    }
                    self.floor[..line.lead].fill(line.p_in);
                    passes += self.find(line, solver, true)?;
                }
            }
        }
        self.warm = true;
        line.p[..n].copy_from_slice(&self.p[..n]);
        line.p[n] = line.p_out;
        for i in 0..n {
            line.film[i] = self.state[i] == Node::Film;
            line.fill[i] = if line.film[i] { 1.0 } else { self.theta[i] };
            line.q[i] = line.c[i] * line.fill[i] + line.g[i] * (line.p[i] - line.p[i + 1]);
        }
        line.outlet();
        line.store();
        if line.change == Change::Rates {
            for i in self.first.max(1)..n {
                if self.state[i] == Node::Dry {
                    line.rate[i] = line.q[i - 1] - line.q[i];
                }
            }
        }
        Ok(passes)
    }

    fn find(&mut self, line: &Line, solver: LineSolver, warm: bool) -> Result<usize, EvalError> {
        self.p[line.n] = line.p_out;
        let mut passes = 0;
        if solver == LineSolver::FischerBurmeister {
            passes += self.fischer_burmeister(line, warm);
        }
        for _ in 0..STEPS {
            passes += 1;
            self.step(line)?;
            if !self.switch(line) {
                return Ok(passes);
            }
        }
        self.node_by_node(line)?;
        self.step(line)?;
        if self.p.iter().chain(&self.theta).all(|x| x.is_finite()) {
            Ok(passes + line.n)
        } else {
            Err(line.recoverable("no film fits these inputs"))
        }
    }

    /// Solves the rows for the states as they are.
    fn step(&mut self, line: &Line) -> Result<(), EvalError> {
        self.solve_between(line, self.first, line.n)
    }

    /// Solves rows `from..to` for the states as they are, with the pressures of the nodes beside them.
    fn solve_between(&mut self, line: &Line, from: usize, to: usize) -> Result<(), EvalError> {
        let (g, c) = (&line.g, &line.c);
        for i in from..to {
            let (before, behind) = (if i > 0 { g[i - 1] } else { 0.0 }, g[i]);
            let hold = self.s[i] + c[i];
            let mut rhs = self.b[i];
            let (mut lower, mut upper) = (0.0, 0.0);
            let known = match self.state[i] {
                Node::Film => {
                    self.diag[i] = before + behind;
                    rhs -= hold;
                    0.0
                }
                Node::Void => {
                    self.diag[i] = hold;
                    self.floor[i]
                }
                Node::Dry => {
                    (self.diag[i], self.lower[i], self.upper[i], self.rhs[i]) = (1.0, 0.0, 0.0, 0.0);
                    continue;
                }
            };
            if i > 0 {
                let film = self.state[i - 1] == Node::Film;
                let outside = i == from;
                if film {
                    rhs += c[i - 1];
                    if outside {
                        rhs += before * (self.p[i - 1] - known);
                    } else {
                        lower = -before;
                        rhs -= before * known;
                    }
                } else {
                    rhs += before * (self.floor[i - 1] - known);
                    if outside {
                        rhs += c[i - 1] * self.theta[i - 1];
                    } else if self.state[i - 1] == Node::Void {
                        lower = -c[i - 1];
                    }
                }
            }
            if i + 1 == to {
                rhs += behind * (self.p[i + 1] - known);
            } else if self.state[i + 1] == Node::Film {
                upper = -behind;
                rhs -= behind * known;
            } else {
                rhs += behind * (self.floor[i + 1] - known);
            }
            (self.lower[i], self.upper[i], self.rhs[i]) = (lower, upper, rhs);
        }
        // Elimination without pivots: columns are dominated by their diagonals.
        for i in from + 1..to {
            let w = self.lower[i] / self.diag[i - 1];
            self.diag[i] -= w * self.upper[i - 1];
            self.rhs[i] -= w * self.rhs[i - 1];
        }
        let mut next = 0.0;
        for i in (from..to).rev() {
            next = (self.rhs[i] - self.upper[i] * next) / self.diag[i];
            if !next.is_finite() {
                return Err(line.recoverable("film out of range"));
            }
            (self.p[i], self.theta[i]) = match self.state[i] {
                Node::Film => (next, 1.0),
                _ => (self.floor[i], next),
            };
        }
        Ok(())
    }

    /// What row `i` has to hold at `p_i` at its floor: oil that arrives less oil that pressure drives away.
    fn offered(&self, line: &Line, i: usize) -> f64 {
        let (g, c) = (&line.g, &line.c);
        let mut sum = self.b[i] - g[i] * (self.floor[i] - self.p[i + 1]);
        if i > 0 {
            sum += c[i - 1] * self.theta[i - 1] + g[i - 1] * (self.p[i - 1] - self.floor[i]);
        }
        sum
    }

    /// Corrects the states that the solution contradicts. `false` when there are none.
    fn switch(&mut self, line: &Line) -> bool {
        let mut changed = false;
        for i in self.first..line.n {
            let hold = self.s[i] + line.c[i];
            let now = self.state[i];
            let next = match now {
                Node::Film if self.p[i] < self.floor[i] => {
                    if hold > 0.0 {
                        Node::Void
                    } else {
                        Node::Dry
                    }
                }
                Node::Void if self.theta[i] > 1.0 => Node::Film,
                Node::Void if self.theta[i] < 0.0 => Node::Dry,
                Node::Dry => {
                    let offered = self.offered(line, i);
                    if offered > hold {
                        Node::Film
                    } else if offered > 0.0 {
                        Node::Void
                    } else {
                        Node::Dry
                    }
                }
                same => same,
            };
            changed |= next != now;
            self.state[i] = next;
        }
        changed
    }

    /// The states, found from node to node along the line. What has been found of the nodes up to `i`, with node `i + 1` at its
    /// floor, can only gain film when node `i + 1` is let go: films grow, first by the next node, then upstream, and nothing
    /// is ever taken back. Not more than n² rows are solved.
    fn node_by_node(&mut self, line: &Line) -> Result<(), EvalError> {
        let n = line.n;
        let first = self.first;
        self.state[first..n].fill(Node::Dry);
        for i in first..n {
            self.p[i + 1] = if i + 1 == n { line.p_out } else { self.floor[i + 1] };
            // The node before the film that reaches up to i; at first i itself, and there is none.
            let mut k = i;
            loop {
                let hold = self.s[k] + line.c[k];
                let mut full = false;
                if hold > 0.0 {
                    self.state[k] = Node::Void;
                    self.solve_between(line, k, i + 1)?;
                    full = self.theta[k] > 1.0;
                }
                if !full && (hold <= 0.0 || self.theta[k] < 0.0) {
                    self.state[k] = Node::Dry;
                    self.solve_between(line, k, i + 1)?;
                    full = hold <= 0.0 && self.offered(line, k) > 0.0;
                }
                if !full {
                    break;
                }
                self.state[k] = Node::Film;
                let mut from = k;
                while from > first && self.state[from - 1] == Node::Film {
                    from -= 1;
                }
                if from == first {
                    self.solve_between(line, first, i + 1)?;
                    break;
                }
                k = from - 1;
            }
        }
        Ok(())
    }

    /// Newton's method on `p + r - √(p² + r²) = 0`, pressures over their scale; sets the states. Returns the steps.
    fn fischer_burmeister(&mut self, line: &Line, warm: bool) -> usize {
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
    fn settle(&mut self, n: usize, scale: f64) {
        for i in self.first..n {
            let film = (self.p[i] - self.floor[i]) / scale > self.r[i];
            self.state[i] = if film { Node::Film } else { Node::Void };
            self.theta[i] = 1.0 - self.r[i];
        }
    }
}

#[cfg(test)]
mod tests {
    use gudgeon_core::kinds::{Film1dCtx, Film1dIn, FilmEnd, FilmTime};

    use super::*;

    /// Numbers between 0 and 1 that look like chance.
    struct Chance(u64);

    impl Chance {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    /// What the rows miss, over the largest term of each, and whether states and solution contradict each other.
    fn misfit(rows: &Rows, line: &Line) -> f64 {
        let mut worst: f64 = 0.0;
        for i in rows.first..line.n {
            let hold = rows.s[i] + line.c[i];
            let terms = [
                hold * rows.theta[i],
                line.g[i] * (rows.p[i] - rows.p[i + 1]),
                line.g[i - 1] * (rows.p[i] - rows.p[i - 1]),
                -line.c[i - 1] * rows.theta[i - 1],
                -rows.b[i],
            ];
            let size = terms.iter().fold(line.g[i] * rows.p[i], |s, t| s.max(t.abs()));
            let sum: f64 = terms.iter().sum();
            assert!((0.0..=1.0).contains(&rows.theta[i]) && rows.p[i] >= 0.0);
            assert!(rows.p[i] == 0.0 || rows.theta[i] == 1.0, "pressure in a void");
            // Where there is no oil more may arrive at than is there: nothing.
            let off = if rows.state[i] == Node::Dry { (-sum).max(0.0) } else { sum.abs() };
            if off > 0.0 {
                worst = worst.max(off / size);
            }
        }
        worst
    }

    #[test]
    fn newton_and_node_by_node_find_the_same_film_in_any_line() {
        let mut r = Chance(7);
        let (mut films, mut voids, mut dry) = (0, 0, 0);
        for case in 0..3000 {
            let n = 2 + (r.next() * 40.0) as usize;
            let x: Vec<f64> = (0..=n).map(|i| i as f64 + 0.5 * r.next()).collect();
            let h_a: Vec<f64> = (0..n).map(|_| 0.2 + r.next()).collect();
            let h_b: Vec<f64> = (0..n).map(|_| 0.2 + r.next()).collect();
            let mu = vec![1.0; n];
            let content: Vec<f64> = (0..=n).map(|_| 1.2 * r.next()).collect();
            let v: Vec<f64> = (0..n).map(|_| 2.0 * (r.next() - 0.5)).collect();
            let time = match case % 3 {
                0 => FilmTime::Steady,
                1 => FilmTime::Squeeze(&v),
                _ => FilmTime::Step { dt: 10.0_f64.powf(4.0 * (r.next() - 0.5)), content: &content },
            };
            let inp = Film1dIn {
                h_a: &h_a,
                h_b: &h_b,
                mu: &mu,
                factors: None,
                u: if case % 7 == 0 { 0.0 } else { 3.0 * (r.next() - 0.5) },
                ends: [FilmEnd::Flooded { p: (r.next() - 0.3).max(0.0) }, FilmEnd::Flooded { p: r.next() }],
                p_cav: 0.0,
                time,
            };
            let mut line = Line::new("test", &Film1dCtx { x: &x });
            line.enter(&inp, true).expect("a line");
            let mut rows = Rows::new(n + 1);
            rows.solve(&mut line, LineSolver::Direct).expect("a film");
            let newton = rows.p.clone();
            // Rounding, through rows whose terms differ by the cube of the gap.
            let off = misfit(&rows, &line);
            assert!(off < 1e-11, "case {case}: {off:e}");
            for s in &rows.state[1..n] {
                match s {
                    Node::Film => films += 1,
                    Node::Void => voids += 1,
                    Node::Dry => dry += 1,
                }
            }
            rows.node_by_node(&line).expect("states");
            rows.step(&line).expect("a film");
            let off = misfit(&rows, &line);
            assert!(off < 1e-11, "case {case}, node by node: {off:e}");
            let top = newton.iter().copied().fold(0.0, f64::max);
            for (a, b) in rows.p.iter().zip(&newton) {
                assert!((a - b).abs() <= 1e-10 * top, "case {case}: {a} and {b}");
            }
        }
        assert!(films > 1000 && voids > 1000 && dry > 300, "{films} films, {voids} voids, {dry} dry");
    }
}
