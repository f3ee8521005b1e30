//! The piston as its lateral motion asks it.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::LateralLoads;

use super::forces::Piston;
use crate::body::Instant;
use crate::side::Slopes;

/// A piston at an instant and at coordinates, which answers to its lateral motion.
pub struct Asked<'a> {
    piston: &'a mut Piston,
    now: &'a Instant,
    x: &'a [f64],
    /// Rates of all coordinates: a guess, then those found.
    w: &'a mut [f64],
    answered: bool,
}

impl Piston {
    /// The piston at the coordinates `x` \[m\], for questions of its lateral motion; `w` holds a guess of the rates and takes them \[m/s\].
    pub fn ask<'a>(&'a mut self, now: &'a Instant, x: &'a [f64], w: &'a mut [f64]) -> Asked<'a> {
        Asked { piston: self, now, x, w, answered: false }
    }
}

impl Asked<'_> {
    /// Ends the questions. When there was none, the edges move at `v` \[m/s\], and the shapes as the balance of their forces says.
    ///
    /// # Errors
    /// A film that cannot be solved, no balance of the shapes.
    pub fn end(self, v: [f64; 2]) -> Result<(), EvalError> {
        if self.answered {
            return Ok(());
        }
        self.w[..2].copy_from_slice(&v);
        self.piston.place(self.now, self.x)?;
        self.piston.balance(self.now, self.x, self.w, 2)
    }
}

impl LateralLoads for Asked<'_> {
    fn balance(&mut self) -> Result<[f64; 2], EvalError> {
        self.answered = true;
        self.piston.place(self.now, self.x)?;
        self.piston.balance(self.now, self.x, self.w, 0)?;
        Ok([self.w[0], self.w[1]])
    }

    fn balance_against(&mut self, force: [f64; 2]) -> Result<[f64; 2], EvalError> {
        self.answered = true;
        self.piston.place(self.now, self.x)?;
        self.piston.inertia = force;
        let outcome = self.piston.balance(self.now, self.x, self.w, 0);
        self.piston.inertia = [0.0; 2];
        outcome.map(|()| [self.w[0], self.w[1]])
    }

    fn forces(&mut self, v: [f64; 2]) -> Result<[f64; 2], EvalError> {
        self.answered = true;
        self.piston.place(self.now, self.x)?;
        self.w[..2].copy_from_slice(&v);
        if self.piston.n > 2 {
            self.piston.balance(self.now, self.x, self.w, 2)?;
        } else {
            self.piston.residual(self.now, self.x, self.w, Slopes::None)?;
        }
        Ok([self.piston.r[0], self.piston.r[1]])
    }

    fn skirt_forces(&self) -> [f64; 2] {
        [0, 1].map(|k| self.piston.loads.iter().map(|l| l.film[k] + l.contact[k]).sum())
    }
}
