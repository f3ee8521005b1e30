//! Partial derivatives of what a piston answers to its lateral motion.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::LateralPartials;

use super::forces::Piston;
use super::linear::Linear;
use crate::body::Instant;
use crate::side::Slopes;

/// Partial derivatives of what a piston answered: of the velocities of both edges \[m/s\] or, where these are given, of the forces on both edges \[N\],
/// and of the rates of the elastic shapes \[m/s\].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Partials {
    /// Of the answer with respect to every coordinate, per metre: both edges, then the shapes.
    pub answer: Vec<[f64; 2]>,
    /// Of the rates of the shapes with respect to every coordinate \[1/s\], coordinate after coordinate.
    pub shapes: Vec<f64>,
    /// Of the answer with respect to the velocity of each edge, per m/s; zero where velocities are what was answered.
    pub answer_by_v: [[f64; 2]; 2],
    /// Of the rates of the shapes with respect to the velocity of each edge.
    pub shapes_by_v: [Vec<f64>; 2],
    /// Of the answer with respect to an added force on each edge, per newton.
    pub answer_by_force: [[f64; 2]; 2],
    /// Of the rates of the shapes with respect to an added force on each edge \[m/(N s)\].
    pub shapes_by_force: [Vec<f64>; 2],
}

impl Partials {
    /// Room for a piston with `n` coordinates.
    #[must_use]
    pub fn new(n: usize) -> Self {
        let shapes = || vec![0.0; n - 2];
        Self {
            answer: vec![[0.0; 2]; n],
            shapes: vec![0.0; n * (n - 2)],
            shapes_by_v: [shapes(), shapes()],
            shapes_by_force: [shapes(), shapes()],
            ..Self::default()
        }
    }

    /// Those of the answer, as a lateral motion takes them.
    #[must_use]
    pub fn of_answer(&self) -> LateralPartials<'_> {
        let by_e = [self.answer[0], self.answer[1]];
        LateralPartials::new(by_e, self.answer_by_v, self.answer_by_force, &self.answer[2..])
    }

    /// Those of the rates of the shapes with respect to coordinate `k` \[1/s\].
    #[must_use]
    pub fn of_shapes(&self, k: usize) -> &[f64] {
        let m = self.answer.len() - 2;
        &self.shapes[k * m..(k + 1) * m]
    }
}

impl Piston {
    /// Partial derivatives of what the piston just answered at the coordinates `x` and the rates `w`; `given`: for velocities of both edges that were
    /// given.
    ///
    /// # Errors
    /// A film beside the present place that cannot be solved, nothing that resists.
    pub fn partials(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        given: bool,
        out: &mut Partials,
    ) -> Result<(), EvalError> {
        self.linearised(now, x, w, given, |piston, work| {
            let (n, m) = (piston.n, piston.n - 2);
            piston.look_beside(now, x, w)?;
            for k in 0..n {
                piston.change_beside(now, x, w, k, &work.base, &mut work.dr);
                out.answer[k] = work.respond(&mut out.shapes[k * m..(k + 1) * m]);
            }
            for k in 0..2 {
                if given {
                    work.move_rate(k);
                    out.answer_by_v[k] = work.respond(&mut out.shapes_by_v[k]);
                }
                work.push(k);
                out.answer_by_force[k] = work.respond(&mut out.shapes_by_force[k]);
            }
            Ok(())
        })
    }

    /// Derivatives of the same with respect to time at fixed coordinates, given the instant `later` by `dt`: of the answer, and of the rates of the shapes
    /// into `shapes`. The unit of time is that of `dt`.
    ///
    /// # Errors
    /// A film that cannot be solved, nothing that resists.
    #[allow(clippy::too_many_arguments, reason = "arguments of one function and its derivative")]
    pub fn time_partials(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        given: bool,
        (later, dt): (&Instant, f64),
        shapes: &mut [f64],
    ) -> Result<[f64; 2], EvalError> {
        self.linearised(now, x, w, given, |piston, work| {
            piston.residual_at(later, x, w, &mut work.dr)?;
            work.dr.iter_mut().zip(&work.base).for_each(|(r, b)| *r = (*r - b) / dt);
            Ok(work.respond(shapes))
        })
    }

    /// Goes on with the linear answer of the piston at the present place.
    fn linearised<T>(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        given: bool,
        go_on: impl FnOnce(&mut Self, &mut Linear) -> Result<T, EvalError>,
    ) -> Result<T, EvalError> {
        let first = if given { 2 } else { 0 };
        self.residual(now, x, w, Slopes::Film)?;
        let mut work = std::mem::take(&mut self.work);
        let mut outcome = work.prepare(&self.r, &self.slope, first);
        if outcome.is_err() {
            // Nothing but cavities: the answer of full films stands for theirs.
            outcome = self
                .residual(now, x, w, Slopes::Full)
                .and_then(|()| work.prepare(&self.r, &self.slope, first));
        }
        let outcome = outcome.and_then(|()| go_on(self, &mut work));
        self.work = work;
        outcome
    }

    /// Loads of both sides at places beside the present one `x`, each coordinate moved a little.
    pub(super) fn look_beside(&mut self, now: &Instant, x: &[f64], w: &[f64]) -> Result<(), EvalError> {
        for k in 0..self.n {
            // The difference of what is then added, to the last digit.
            self.moves[k] = (x[k] + self.increment(w, k)) - x[k];
        }
        for side in 0..2 {
            let own = self.own(side);
            let rates = &mut self.own_rates[side];
            rates[..2].copy_from_slice(&w[..2]);
            rates[2..].copy_from_slice(&w[own.clone()]);
            let moves = &mut self.own_moves[side];
            moves[..2].copy_from_slice(&self.moves[..2]);
            moves[2..].copy_from_slice(&self.moves[own.clone()]);
            let (e, out) = ([x[0], x[1]], &mut self.beside[side]);
            self.sides[side].loads_beside(e, &x[own], moves, now.speed, now.mu, rates, out)?;
        }
        Ok(())
    }

    /// Change of the forces left over per change of the coordinate `column`, from what [`Piston::look_beside`] found, into `dr`; `base` is what is left
    /// over at `x`.
    pub(super) fn change_beside(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        column: usize,
        base: &[f64],
        dr: &mut [f64],
    ) {
        for side in 0..2 {
            let own = self.own(side);
            let from = if column < 2 {
                &self.beside[side][column]
            } else if own.contains(&column) {
                &self.beside[side][2 + column - own.start]
            } else {
                &self.loads[side]
            };
            let to = &mut self.trial[side];
            (to.film, to.contact) = (from.film, from.contact);
            to.elastic.clone_from(&from.elastic);
        }
        let mut moved = std::mem::take(&mut self.moved);
        moved.copy_from_slice(x);
        moved[column] += self.moves[column];
        self.left_over(now, &moved, w, true, dr);
        self.moved = moved;
        for (dr, base) in dr.iter_mut().zip(base) {
            *dr = (*dr - base) / self.moves[column];
        }
    }

    /// Forces left over at another instant, at the place and the rates of now.
    fn residual_at(&mut self, at: &Instant, x: &[f64], w: &[f64], r: &mut [f64]) -> Result<(), EvalError> {
        for side in 0..2 {
            let own = self.own(side);
            let rates = &mut self.own_rates[side];
            rates[..2].copy_from_slice(&w[..2]);
            rates[2..].copy_from_slice(&w[own]);
            self.sides[side].loads(at.speed, at.mu, rates, Slopes::None, &mut self.trial[side])?;
        }
        self.left_over(at, x, w, true, r);
        Ok(())
    }

    /// Change of a coordinate for a difference quotient: a small part of the gap, in the direction of motion.
    fn increment(&self, w: &[f64], column: usize) -> f64 {
        let d = DIFFERENCE * self.smallest_gap().abs().max(1e-8);
        if w[column] < 0.0 { -d } else { d }
    }
}

/// Part of the gap by which a coordinate is changed for a difference quotient: the forces change by three times as much, the films are
/// solved to 1e-9.
const DIFFERENCE: f64 = 1e-5;
