//! The oil that both sides of the skirt keep.

use gudgeon_core::{BuildError, EvalError};

use super::forces::Piston;
use crate::body::Instant;
use crate::side::{Filling, OilMoved, OilWay, Side};

impl Piston {
    /// From now on the films of both sides keep the oil they have.
    ///
    /// # Errors
    /// As [`Side::keep_oil`].
    pub fn keep_oil(&mut self) -> Result<(), BuildError> {
        self.sides.iter_mut().try_for_each(Side::keep_oil)
    }

    /// Number of values that say what both sides hold.
    #[must_use]
    pub fn contents(&self) -> usize {
        self.sides.iter().map(|s| s.content().len()).sum()
    }

    /// Oil per area at all nodes \[m\], into `out`.
    pub fn content(&self, out: &mut [f64]) {
        let (thrust, other) = out.split_at_mut(self.sides[0].content().len());
        thrust.copy_from_slice(self.sides[0].content());
        other.copy_from_slice(self.sides[1].content());
    }

    /// Takes the oil per area at all nodes \[m\].
    pub fn set_content(&mut self, content: &[f64]) {
        let (thrust, other) = content.split_at(self.sides[0].content().len());
        self.sides[0].set_content(thrust);
        self.sides[1].set_content(other);
    }

    /// Oil in both gaps \[m³\].
    #[must_use]
    pub fn held(&self) -> f64 {
        self.sides.iter().map(Side::held).sum()
    }

    /// Begins to follow the oil at the coordinates `x`; `first` is the film \[m\] with which the very first cycle begins, or what there is room for.
    ///
    /// # Errors
    /// A gap that is none.
    pub fn begin_oil(&mut self, now: &Instant, x: &[f64], first: Option<f64>) -> Result<(), EvalError> {
        (0..2).try_for_each(|side| {
            let q = &x[self.own(side)];
            self.sides[side].begin_oil([x[0], x[1]], q, now.speed, first)
        })
    }

    /// What every node of both sides has during a step.
    #[must_use]
    pub fn filling(&self) -> [Filling; 2] {
        [0, 1].map(|side: usize| self.sides[side].filling())
    }

    /// Takes what every node of both sides has during a step.
    pub fn set_filling(&mut self, filling: &[Filling; 2]) {
        self.sides.iter_mut().zip(filling).for_each(|(side, own)| side.set_filling(own));
    }

    /// Foresees what every node will hold at the end of a step of `dt` \[s\] to the instant `then` and the coordinates `x`, when films `arriving` \[m\] lie on
    /// the liner above and below each side.
    ///
    /// # Errors
    /// As [`Side::foresee`].
    pub fn foresee_oil(
        &mut self,
        then: &Instant,
        x: &[f64],
        dt: f64,
        arriving: [[f64; 2]; 2],
    ) -> Result<(), EvalError> {
        (0..2).try_for_each(|side| {
            let q = &x[self.own(side)];
            self.sides[side].foresee(&way(then, x, q, dt, arriving[side]))
        })
    }

    /// Moves the oil of both sides over a step that was taken, to the instant `then` and the coordinates `x`.
    ///
    /// # Errors
    /// As [`Side::move_oil`].
    pub fn move_oil(
        &mut self,
        then: &Instant,
        x: &[f64],
        dt: f64,
        arriving: [[f64; 2]; 2],
    ) -> Result<[OilMoved; 2], EvalError> {
        let mut moved = [OilMoved::default(); 2];
        for (side, moved) in moved.iter_mut().enumerate() {
            let q = &x[self.own(side)];
            *moved = self.sides[side].move_oil(&way(then, x, q, dt, arriving[side]))?;
        }
        Ok(moved)
    }
}

fn way<'a>(then: &Instant, x: &[f64], q: &'a [f64], dt: f64, arriving: [f64; 2]) -> OilWay<'a> {
    OilWay { e: [x[0], x[1]], q, speed: then.speed, mu: then.mu, dt, arriving }
}
