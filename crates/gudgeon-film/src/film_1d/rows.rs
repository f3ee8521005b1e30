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

use super::line::{Change, Line};
use super::line_solver::LineSolver;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Node {
    Film,
    Void,
    Dry,
}

/// Newton steps before the search node by node.
pub(super) const STEPS: usize = 60;

#[derive(Debug)]
pub struct Rows {
    pub s: Vec<f64>,
    pub b: Vec<f64>,
    pub floor: Vec<f64>,
    pub state: Vec<Node>,
    /// Diagonal, coupling to the node before and behind, right-hand side, solution.
    pub diag: Vec<f64>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    pub rhs: Vec<f64>,
    pub p: Vec<f64>,
    pub theta: Vec<f64>,
    pub r: Vec<f64>,
    pub dr: Vec<f64>,
    /// The states are those of a film that was found.
    pub warm: bool,
    pub turned: bool,
    /// First row: 0 when the inlet is a node like all others, else 1.
    pub first: usize,
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
            dr: v(),
            warm: false,
            turned: false,
            first: 1,
        }
    }

    /// Solves for the mass-conserving film. Returns the passes over the line.
    pub fn solve(&mut self, line: &mut Line, solver: LineSolver) -> Result<usize, EvalError> {
        self.prepare(line);
        let warm = std::mem::take(&mut self.warm);
        let mut passes = self.find(line, solver, warm)?;
        passes += self.starve(line, solver)?;
        self.warm = true;
        self.write(line);
        Ok(passes)
    }

    /// Coefficients of the rows, and the states to start from.
    fn prepare(&mut self, line: &mut Line) {
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
        // A bath first: what it would have to give shows whether the layer that arrives is enough.
        self.first = 1;
        self.p[0] = line.p_in;
        self.theta[0] = 1.0;
        self.state[0] = Node::Film;
        if self.turned != line.turned() || !self.warm {
            self.warm = false;
            self.state.fill(Node::Film);
            self.turned = line.turned();
        }
    }

    /// The film of a starved inlet, when the layer that arrives is less than a bath would have to give. Returns the passes over the line.
    fn starve(&mut self, line: &mut Line, solver: LineSolver) -> Result<usize, EvalError> {
        let n = line.n;
        let asked = line.c[0] + line.g[0] * (self.p[0] - self.p[1]) + self.s[0] - self.b[0];
        let Some(supply) = line.supply.filter(|s| *s < asked) else { return Ok(0) };
        line.starved = true;
        self.first = 0;
        self.b[0] += supply;
        let mut passes = self.find(line, solver, true)?;
        if line.p_in > 0.0 {
            // Before the first node with the pressure of the gas there is gas; that only raises pressures, so that the node keeps it out.
            line.lead = self.p[..n].iter().position(|p| *p >= line.p_in).unwrap_or(n);
            if line.lead == n {
                // Nowhere sealed: the gas reaches the other end.
                line.p_out = line.p_out.max(line.p_in);
            }
            self.floor[..line.lead].fill(line.p_in);
            passes += self.find(line, solver, true)?;
        }
        Ok(passes)
    }

    /// Hands the film that was found to the line.
    fn write(&self, line: &mut Line) {
        let n = line.n;
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
    }

    pub fn find(&mut self, line: &Line, solver: LineSolver, warm: bool) -> Result<usize, EvalError> {
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
    pub fn step(&mut self, line: &Line) -> Result<(), EvalError> {
        self.solve_between(line, self.first, line.n)
    }
}
