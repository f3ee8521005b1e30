//! What is searched for: rates at which forces are in balance, at a place or at the end of a step.

use gudgeon_core::EvalError;

use super::forces::Piston;
use crate::body::Instant;
use crate::side::Slopes;

/// Inertia of the edges in a step: mass matrix \[kg\], and the velocities \[m/s\] with which the step begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Momentum {
    /// Mass matrix of the displacements of both edges \[kg\].
    pub mass: [[f64; 2]; 2],
    /// Velocities of both edges \[m/s\].
    pub v: [f64; 2],
}

/// What is wanted of the rates `w`.
pub(super) enum Equation<'a> {
    /// Forces in balance at the place `x`.
    Rates { x: &'a [f64] },
    /// Forces in balance, with inertia where there is some, at `x = from + dt w`.
    Step { from: &'a [f64], momentum: Option<Momentum>, dt: f64, x: &'a mut [f64] },
}

impl Piston {
    /// Forces left over at the rates `w`.
    pub(super) fn forces(
        &mut self,
        now: &Instant,
        equation: &mut Equation<'_>,
        w: &[f64],
    ) -> Result<(), EvalError> {
        match equation {
            Equation::Rates { x } => self.residual(now, x, w, Slopes::None),
            Equation::Step { from, momentum, dt, x } => {
                for (k, x) in x.iter_mut().enumerate() {
                    *x = from[k] + *dt * w[k];
                }
                if let Some(Momentum { mass, v }) = momentum {
                    let a = [(w[0] - v[0]) / *dt, (w[1] - v[1]) / *dt];
                    self.inertia = [0, 1].map(|k| mass[k][0] * a[0] + mass[k][1] * a[1]);
                }
                self.place(now, x)?;
                self.residual(now, x, w, Slopes::None)
            }
        }
    }

    /// Derivatives of the forces that [`Piston::forces`] just found with respect to the rates; of full films those at a place that stays.
    pub(super) fn forces_slope(
        &mut self,
        now: &Instant,
        equation: &Equation<'_>,
        w: &[f64],
        slopes: Slopes,
    ) -> Result<(), EvalError> {
        let at = match equation {
            Equation::Rates { x } => x,
            Equation::Step { x, .. } => &**x,
        };
        self.tangent(now, at, w, slopes)?;
        let Equation::Step { momentum, dt, x, .. } = equation else { return Ok(()) };
        let n = self.n;
        if slopes == Slopes::Film {
            let mut by_place = std::mem::take(&mut self.lu);
            let outcome = self.by_place(now, x, w, &mut by_place);
            self.slope.iter_mut().zip(&by_place).for_each(|(s, p)| *s += *dt * p);
            self.lu = by_place;
            outcome?;
        }
        if let Some(Momentum { mass, .. }) = momentum {
            for (k, row) in mass.iter().enumerate() {
                for (column, m) in row.iter().enumerate() {
                    self.slope[k * n + column] -= m / dt;
                }
            }
        }
        Ok(())
    }

    /// Derivatives of the forces that were just found with respect to the coordinates, row after row, into `out`.
    pub(super) fn by_place(
        &mut self,
        now: &Instant,
        x: &[f64],
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvalError> {
        let n = self.n;
        self.look_beside(now, x, w)?;
        let mut work = std::mem::take(&mut self.work);
        work.base.copy_from_slice(&self.r);
        for column in 0..n {
            self.change_beside(now, x, w, column, &work.base, &mut work.dr);
            work.dr.iter().enumerate().for_each(|(k, d)| out[k * n + column] = *d);
        }
        self.work = work;
        Ok(())
    }
}
