//! The initial-value problem: rates, Jacobian, linear invariants, events.

use crate::EvalError;

/// Columns of the Jacobian that one difference quotient can serve together: no row depends on two columns of a group.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ColumnGroups {
    /// Groups of columns.
    pub groups: Vec<Vec<usize>>,
    /// For every column the rows (states, then quadratures) it may touch.
    pub rows: Vec<Vec<usize>>,
}

impl ColumnGroups {
    /// Groups the columns greedily, in order, given the rows that each column may touch.
    ///
    /// Greedy colouring is optimal for banded patterns in their natural order.
    #[must_use]
    pub fn from_pattern(rows: Vec<Vec<usize>>) -> Self {
        let n_rows = rows.iter().flatten().max().map_or(0, |r| r + 1);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut taken: Vec<Vec<bool>> = Vec::new();
        for (column, touched) in rows.iter().enumerate() {
            let free = taken.iter().position(|t| touched.iter().all(|&r| !t[r]));
            let g = free.unwrap_or_else(|| {
                groups.push(Vec::new());
                taken.push(vec![false; n_rows]);
                groups.len() - 1
            });
            groups[g].push(column);
            for &r in touched {
                taken[g][r] = true;
            }
        }
        Self { groups, rows }
    }
}

/// `Σ coefficient · (f, g)[row] = 0` for all times and states.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearInvariant {
    /// The row of the Jacobian that is rewritten by the relation; preferably a quadrature (row ≥ `dim`), which leaves the
    /// linear systems untouched. It must be one of `terms`.
    pub pivot: usize,
    /// Rows and their coefficients; rows ≥ `dim` are quadratures.
    pub terms: Vec<(usize, f64)>,
}

/// Which sign changes of an event function count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
    /// Both.
    Either,
}

/// What an event asks of the integrator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventAction {
    /// Nothing: the event was only noted. Changes to `y` are dropped.
    Continue,
    /// The state or the equations changed: the step ends here and integration goes on from the new state.
    ///
    /// When `y` was changed and the function then leaves zero on the far side without having come back (a ball that is
    /// pushed into the floor), the event happens again; 100 such repeats without progress in time are [`super::IntegrateError::Chatter`].
    Restart,
    /// The integration ends here, successfully. Changes to `y` are kept.
    Stop,
}

/// A stage of an implicit step.
#[derive(Debug, Clone, Copy)]
pub struct Stage<'a> {
    /// Which stage of the step it is, from 1 on.
    pub number: usize,
    /// What the step has made of the states before this stage.
    pub base: &'a [f64],
    /// Step times the coefficient of the stage.
    pub step: f64,
    /// Error admitted in each state.
    pub accuracy: &'a [f64],
}

/// An initial-value problem `y' = f(t, y)` with quadratures `q' = g(t, y)` that feed nothing back.
pub trait OdeSystem {
    /// Number of states.
    fn dim(&self) -> usize;

    /// Number of quadratures. They are integrated with the same method, so that every linear invariant over states and
    /// quadratures holds to round-off (see [`OdeSystem::invariants`]).
    fn quad_dim(&self) -> usize {
        0
    }

    /// Rates: `f[..dim]` of the states, `f[dim..]` of the quadratures.
    ///
    /// # Errors
    /// Recoverable: the integrator retries with a smaller step. Fatal: it stops. A rate that is not finite counts as
    /// recoverable.
    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError>;

    /// Jacobian `∂f/∂y`, row-major `(dim + quad_dim) × dim`; `f` holds the rates at `(t, y)`. `Ok(false)`: the integrator
    /// differences `rhs`.
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn jacobian(&mut self, _t: f64, _y: &[f64], _f: &[f64], _jac: &mut [f64]) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// Takes the Jacobian at `(t, y)`, rates `f`, for [`OdeSystem::factor`]: for systems whose equations have a structure that no general
    /// matrix knows (a chain, a tree). Asked by `Rodas::structured` instead of [`OdeSystem::jacobian`].
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn linearise(&mut self, _t: f64, _y: &[f64], _f: &[f64]) -> Result<(), EvalError> {
        Err(EvalError::fatal("integrator", "the system has no linear solver of its own"))
    }

    /// Prepares [`OdeSystem::solve`] for `d I - J`; false when that is singular.
    fn factor(&mut self, _d: f64) -> bool {
        false
    }

    /// Solves `(d I - J) x = b` in place, with `d` and `J` of the last [`OdeSystem::factor`].
    fn solve(&mut self, _b: &mut [f64]) {}

    /// Solves a stage of an implicit step, `y = base + step · f(t, y)`, for systems that know how: `y` comes as a guess, `accuracy` is the error admitted in each
    /// state. Leaves the rates of the quadratures at the answer in `g`. Asked by [`crate::sdirk::Sdirk`], which calls [`OdeSystem::tolerances`]
    /// right after the last stage of a step that it takes.
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn stage(
        &mut self,
        _t: f64,
        _stage: &Stage<'_>,
        _y: &mut [f64],
        _g: &mut [f64],
    ) -> Result<(), EvalError> {
        Err(EvalError::fatal("integrator", "the system does not solve stages of implicit steps"))
    }

    /// `∂f/∂t` at fixed state. `Ok(false)`: the integrator differences `rhs` (one call per step).
    ///
    /// # Errors
    /// As [`OdeSystem::rhs`].
    fn time_derivative(
        &mut self,
        _t: f64,
        _y: &[f64],
        _f: &[f64],
        _dfdt: &mut [f64],
    ) -> Result<bool, EvalError> {
        Ok(false)
    }

    /// Absolute errors per step at the state where a step begins, for systems whose accuracy depends on where they are (a
    /// position beside a wall): `atol` comes as [`super::Options::atol`] and may be changed. Taken by `Rodas`.
    fn tolerances(&mut self, _t: f64, _y: &[f64], _atol: &mut [f64]) {}

    /// Linear relations between the rates that hold for all arguments (see the module documentation).
    fn invariants(&self) -> &[LinearInvariant] {
        &[]
    }

    /// Number of event functions.
    fn n_events(&self) -> usize {
        0
    }

    /// Values of the event functions; an event happens where one goes through zero in its direction.
    ///
    /// # Errors
    /// Any error ends the integration.
    fn events(&mut self, _t: f64, _y: &[f64], _g: &mut [f64]) -> Result<(), EvalError> {
        Ok(())
    }

    /// Which crossings of event function `k` count.
    fn event_direction(&self, _k: usize) -> Direction {
        Direction::Either
    }

    /// Whether the time of event `k` matters. When it does not, the event happens at the end of the step (or at the sample) in
    /// which it was seen, and nothing is spent on its root.
    fn event_located(&self, _k: usize) -> bool {
        true
    }

    /// Event `k` happened at `t`. Changes to `y` count when the answer is [`EventAction::Restart`] or [`EventAction::Stop`].
    ///
    /// # Errors
    /// Any error ends the integration.
    fn on_event(&mut self, _k: usize, _t: f64, _y: &mut [f64]) -> Result<EventAction, EvalError> {
        Ok(EventAction::Continue)
    }
}

impl LinearInvariant {
    /// The value of the pivot row that satisfies the relation, given the other rows.
    pub(crate) fn pivot_value(&self, value: impl Fn(usize) -> f64) -> f64 {
        let (mut sum, mut pivot) = (0.0, 0.0);
        for &(row, c) in &self.terms {
            if row == self.pivot {
                pivot += c;
            } else {
                sum += c * value(row);
            }
        }
        -sum / pivot
    }
}
