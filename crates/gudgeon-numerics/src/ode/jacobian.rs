//! Jacobians by grouped finite differences.

use gudgeon_core::EvalError;

use super::driver::Core;
use super::{OdeSystem, Options, Stats};

/// A partition of the columns of a Jacobian into groups whose columns share no row, and the rows of each column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnGroups {
    groups: Vec<Vec<usize>>,
    rows: Vec<Vec<usize>>,
}

impl ColumnGroups {
    /// Groups the columns greedily, in order, given the rows (states, then quadratures) that each column may touch.
    ///
    /// Greedy colouring is optimal for banded patterns and within one or two groups of it for the sparse ones met here.
    #[must_use]
    pub fn from_pattern(rows_of_column: Vec<Vec<usize>>) -> Self {
        let n_rows = rows_of_column.iter().flatten().max().map_or(0, |r| r + 1);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut taken: Vec<Vec<bool>> = Vec::new();
        for (c, rows) in rows_of_column.iter().enumerate() {
            let free = taken.iter().position(|t| rows.iter().all(|&r| !t[r]));
            let g = free.unwrap_or_else(|| {
                groups.push(Vec::new());
                taken.push(vec![false; n_rows]);
                groups.len() - 1
            });
            groups[g].push(c);
            for &r in rows {
                taken[g][r] = true;
            }
        }
        Self { groups, rows: rows_of_column }
    }

    /// Number of groups: right-hand sides per Jacobian.
    #[must_use]
    pub fn len(&self) -> usize {
        self.groups.len()
    }

    /// Whether there are no columns.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    pub(crate) fn groups(&self) -> &[Vec<usize>] {
        &self.groups
    }

    pub(crate) fn rows(&self, column: usize) -> &[usize] {
        &self.rows[column]
    }

    pub(crate) fn fits(&self, n: usize, m: usize) -> bool {
        self.rows.len() == n && self.rows.iter().flatten().all(|&r| r < m)
    }
}

/// Difference quotient increments: about the square root of the rounding error.
const SQRT_EPS: f64 = 1.490_116_119_384_765_6e-8;

impl Core {
    /// Fills `jac` and (when `with_time`) `dfdt` at `(t, x0)`, with `f0` already there. `h` is the coming step.
    pub(crate) fn eval_jacobian<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        h: f64,
        opts: &Options<'_>,
        with_time: bool,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let (n, m) = (self.n, self.m);
        stats.jacobians += 1;
        self.jac.fill(0.0);
        self.dfdt.fill(0.0);
        let te = self.clamp_time(t);
        let analytic = sys.jacobian(te, &self.x0[..n], &self.f0, &mut self.jac, &mut self.dfdt)?;
        if analytic {
            return Ok(());
        }
        self.jac.fill(0.0);
        self.dfdt.fill(0.0);
        self.y_tmp[..n].copy_from_slice(&self.x0[..n]);
        for j in 0..n {
            let typical = match opts.typical {
                [] => pick(opts.atol, j) / opts.rtol.max(1e-12),
                s => pick(s, j),
            };
            let size = self.x0[j].abs().max(typical).max(f64::MIN_POSITIVE / SQRT_EPS);
            // Towards where the solution goes: that side is more likely to be admissible.
            let d = if self.f0[j] < 0.0 { -SQRT_EPS * size } else { SQRT_EPS * size };
            // The increment that y + d really makes.
            self.fd[j] = (self.x0[j] + d) - self.x0[j];
        }
        let groups = sys.column_groups().map_or(n, ColumnGroups::len);
        for g in 0..groups {
            let mut tries = 0;
            loop {
                for_columns(sys.column_groups(), g, |j| self.y_tmp[j] = self.x0[j] + self.fd[j]);
                stats.rhs += 1;
                let answer = sys.rhs(te, &self.y_tmp[..n], &mut self.f_tmp);
                let bad = match answer {
                    Ok(()) if self.f_tmp.iter().all(|v| v.is_finite()) => None,
                    Ok(()) => Some(EvalError::recoverable("jacobian", "a perturbed rate is not finite")),
                    Err(e) if e.is_recoverable() => Some(e),
                    Err(e) => return Err(e),
                };
                for_columns(sys.column_groups(), g, |j| self.y_tmp[j] = self.x0[j]);
                match bad {
                    None => break,
                    Some(e) if tries == 1 => return Err(e),
                    Some(_) => {
                        tries += 1;
                        for_columns(sys.column_groups(), g, |j| {
                            self.fd[j] = (self.x0[j] - self.fd[j]) - self.x0[j];
                        });
                    }
                }
            }
            match sys.column_groups() {
                None => {
                    let inv = 1.0 / self.fd[g];
                    for r in 0..m {
                        self.jac[r * n + g] = (self.f_tmp[r] - self.f0[r]) * inv;
                    }
                }
                Some(cg) => {
                    for &j in &cg.groups()[g] {
                        let inv = 1.0 / self.fd[j];
                        for &r in cg.rows(j) {
                            self.jac[r * n + j] = (self.f_tmp[r] - self.f0[r]) * inv;
                        }
                    }
                }
            }
        }
        if with_time && !sys.is_autonomous() {
            // Small beside the step, large beside the resolution of t (what a rate computed from t loses to rounding).
            let d = (1e-5 * h).max((0.1 * h).min(SQRT_EPS * t.abs()));
            let t2 = self.clamp_time(te + d);
            let d = t2 - te;
            if d != 0.0 {
                stats.rhs += 1;
                match sys.rhs(t2, &self.x0[..n], &mut self.f_tmp) {
                    Ok(()) if self.f_tmp.iter().all(|v| v.is_finite()) => {
                        for r in 0..m {
                            self.dfdt[r] = (self.f_tmp[r] - self.f0[r]) / d;
                        }
                    }
                    Ok(()) => return Err(EvalError::recoverable("jacobian", "a later rate is not finite")),
                    Err(e) => return Err(e),
                }
            }
        }
        // c·f = 0 holds for the differences only up to (rounding of f) / increment; make it hold to rounding.
        for inv in sys.invariants() {
            let cp: f64 = inv.terms.iter().filter(|t| t.0 == inv.pivot).map(|t| t.1).sum();
            for j in 0..n {
                let s: f64 = inv.terms.iter().filter(|t| t.0 != inv.pivot).map(|t| t.1 * self.jac[t.0 * n + j]).sum();
                self.jac[inv.pivot * n + j] = -s / cp;
            }
            let s: f64 = inv.terms.iter().filter(|t| t.0 != inv.pivot).map(|t| t.1 * self.dfdt[t.0]).sum();
            self.dfdt[inv.pivot] = -s / cp;
        }
        Ok(())
    }
}

fn for_columns(groups: Option<&ColumnGroups>, g: usize, mut f: impl FnMut(usize)) {
    match groups {
        None => f(g),
        Some(cg) => cg.groups()[g].iter().for_each(|&j| f(j)),
    }
}

/// Entry `i` of a per-component setting, or the one for all.
pub(crate) fn pick(s: &[f64], i: usize) -> f64 {
    if s.len() == 1 { s[0] } else { s[i] }
}
