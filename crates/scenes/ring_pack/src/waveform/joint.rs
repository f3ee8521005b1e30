//! Steps of one side with what the other did over them, as steps of the whole pack.

use std::cell::{Cell, RefCell};

use gudgeon_numerics::ode::{Flow, StepView};

use super::super::pack::Pack;
use super::track::Track;

/// The states and the quadratures of a side, by their places in the pack.
#[derive(Debug, Clone)]
pub struct Part {
    pub states: Vec<usize>,
    pub quads: Vec<usize>,
}

impl Part {
    /// Number of states and quadratures.
    pub const fn width(&self) -> usize {
        self.states.len() + self.quads.len()
    }

    /// The row of a state or a quadrature of the pack, whose states are `n`, among the states and quadratures of this side.
    pub fn row(&self, row: usize, n: usize) -> Option<usize> {
        if row < n {
            self.states.iter().position(|k| *k == row)
        } else {
            self.quads.iter().position(|k| *k == row - n).map(|k| self.states.len() + k)
        }
    }
}

/// Ends of steps that are one within this \[rad\].
const SLACK: f64 = 1e-9;

/// A step of one side, or what lies of it in one step of the other.
pub struct Joint<'a> {
    beside: &'a Track,
    parts: [&'a Part; 2],
    t: [f64; 2],
    /// States and quadratures of the pack at both ends.
    y: [Vec<f64>; 2],
    q: [Vec<f64>; 2],
    /// Values of the other side, and of the one that steps, at an instant of the step.
    own: RefCell<[Vec<f64>; 2]>,
    known: Cell<f64>,
}

/// A piece of a step as it is seen.
struct Piece<'j, 'a> {
    joint: &'j Joint<'a>,
    step: &'j dyn StepView,
}

impl<'a> Joint<'a> {
    /// For steps of one side beside what the other did; `parts` are that of the other and its own.
    pub fn new(beside: &'a Track, parts: [&'a Part; 2], pack: &Pack) -> Self {
        let y = || vec![0.0; pack.layout.n];
        let q = || vec![0.0; pack.layout.quads()];
        let own = parts.map(|p| vec![0.0; p.width()]);
        Self {
            beside,
            parts,
            t: [0.0; 2],
            y: [y(), y()],
            q: [q(), q()],
            own: RefCell::new(own),
            known: Cell::new(f64::NAN),
        }
    }

    /// Has each piece of the step looked at, until one stops.
    pub fn pieces(&mut self, step: &dyn StepView, mut look: impl FnMut(&dyn StepView) -> Flow) -> Flow {
        let first = self.beside.ends().partition_point(|t| *t <= step.t0() + SLACK);
        let inner = self.beside.ends()[first..].iter().copied().take_while(|t| *t < step.t1() - SLACK);
        self.known.set(f64::NAN);
        self.end(step, step.t0());
        for to in inner.chain([step.t1()]) {
            // A piece begins where the one before ends.
            self.t[0] = self.t[1];
            self.y.swap(0, 1);
            self.q.swap(0, 1);
            self.end(step, to);
            if matches!(look(&Piece { joint: self, step }), Flow::Stop) {
                return Flow::Stop;
            }
        }
        Flow::Continue
    }

    /// Puts the end of the piece at `t`.
    fn end(&mut self, step: &dyn StepView, t: f64) {
        self.t[1] = t;
        let (mut y, mut q) = (std::mem::take(&mut self.y[1]), std::mem::take(&mut self.q[1]));
        self.at(step, t, Some(&mut y), Some(&mut q));
        (self.y[1], self.q[1]) = (y, q);
    }

    /// The end of the piece that `t` is.
    fn is_end(&self, t: f64) -> Option<usize> {
        self.t.iter().position(|end| *end == t)
    }

    /// States and quadratures of both sides at `t`.
    fn look(&self, step: &dyn StepView, t: f64, [beside, stepping]: &mut [Vec<f64>; 2]) {
        self.beside.eval(t, beside);
        let (states, quads) = stepping.split_at_mut(self.parts[1].states.len());
        if t >= step.t1() {
            states.copy_from_slice(step.y1());
            quads.copy_from_slice(step.q1());
        } else {
            step.interpolate(t, states);
            step.interpolate_quad(t, quads);
        }
    }

    /// States and quadratures of the pack at `t`.
    fn at(&self, step: &dyn StepView, t: f64, y: Option<&mut [f64]>, q: Option<&mut [f64]>) {
        let mut own = self.own.borrow_mut();
        if self.known.replace(t) != t {
            self.look(step, t, &mut own);
        }
        let put = |to: &mut [f64], places: &[usize], values: &[f64]| {
            places.iter().zip(values).for_each(|(&k, v)| to[k] = *v);
        };
        if let Some(y) = y {
            self.parts.iter().zip(&*own).for_each(|(p, own)| put(y, &p.states, own));
        }
        if let Some(q) = q {
            self.parts.iter().zip(&*own).for_each(|(p, own)| put(q, &p.quads, &own[p.states.len()..]));
        }
    }
}

impl StepView for Piece<'_, '_> {
    fn t0(&self) -> f64 {
        self.joint.t[0]
    }
    fn t1(&self) -> f64 {
        self.joint.t[1]
    }
    fn y0(&self) -> &[f64] {
        &self.joint.y[0]
    }
    fn y1(&self) -> &[f64] {
        &self.joint.y[1]
    }
    fn q0(&self) -> &[f64] {
        &self.joint.q[0]
    }
    fn q1(&self) -> &[f64] {
        &self.joint.q[1]
    }
    fn interpolate(&self, t: f64, y: &mut [f64]) {
        match self.joint.is_end(t) {
            Some(end) => y.copy_from_slice(&self.joint.y[end]),
            None => self.joint.at(self.step, t, Some(y), None),
        }
    }
    fn interpolate_quad(&self, t: f64, q: &mut [f64]) {
        match self.joint.is_end(t) {
            Some(end) => q.copy_from_slice(&self.joint.q[end]),
            None => self.joint.at(self.step, t, None, Some(q)),
        }
    }
}
