//! Solution of the rows for given states of the nodes, and the states that the solution asks for.

use gudgeon_core::EvalError;

use super::line::Line;
use super::rows::{Node, Rows};

impl Rows {
    /// Solves rows `from..to` for the states as they are, with the pressures of the nodes beside them.
    pub(super) fn solve_between(&mut self, line: &Line, from: usize, to: usize) -> Result<(), EvalError> {
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
        if !self.eliminate(from, to) {
            return Err(line.recoverable("film out of range"));
        }
        for i in from..to {
            (self.p[i], self.theta[i]) = match self.state[i] {
                Node::Film => (self.rhs[i], 1.0),
                _ => (self.floor[i], self.rhs[i]),
            };
        }
        Ok(())
    }

    /// Solves the tridiagonal rows `from..to` in place of their right-hand sides: `false` when the solution is not finite. Needs no pivots,
    /// for columns are dominated by their diagonals.
    pub(super) fn eliminate(&mut self, from: usize, to: usize) -> bool {
        for i in from + 1..to {
            let w = self.lower[i] / self.diag[i - 1];
            self.diag[i] -= w * self.upper[i - 1];
            self.rhs[i] -= w * self.rhs[i - 1];
        }
        let mut next = 0.0;
        for i in (from..to).rev() {
            next = (self.rhs[i] - self.upper[i] * next) / self.diag[i];
            if !next.is_finite() {
                return false;
            }
            self.rhs[i] = next;
        }
        true
    }

    /// What row `i` has to hold at `p_i` at its floor: oil that arrives less oil that pressure drives away.
    pub(super) fn offered(&self, line: &Line, i: usize) -> f64 {
        let (g, c) = (&line.g, &line.c);
        let mut sum = self.b[i] - g[i] * (self.floor[i] - self.p[i + 1]);
        if i > 0 {
            sum += c[i - 1] * self.theta[i - 1] + g[i - 1] * (self.p[i - 1] - self.floor[i]);
        }
        sum
    }

    /// Corrects the states that the solution contradicts. `false` when there are none.
    pub(super) fn switch(&mut self, line: &Line) -> bool {
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
    pub fn node_by_node(&mut self, line: &Line) -> Result<(), EvalError> {
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
}
