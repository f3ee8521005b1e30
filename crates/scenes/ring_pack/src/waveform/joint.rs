//! Steps of one side with what the other did over them, as steps of the whole pack.

use std::cell::RefCell;

use gudgeon_numerics::ode::{Flow, StepView};

use super::super::pack::Pack;
use super::growing::Growing;

/// The states and the quadratures of a side, by their places in the pack, ascending.
#[derive(Debug, Clone)]
pub struct Part {
    pub states: Vec<usize>,
    pub quads: Vec<usize>,
    /// The states in pieces that follow one another on both sides: first row here, first place in the pack, length.
    pieces: Vec<[usize; 3]>,
}

impl Part {
    pub fn new(states: Vec<usize>, quads: Vec<usize>) -> Self {
        let mut pieces: Vec<[usize; 3]> = Vec::new();
        for (row, &place) in states.iter().enumerate() {
            match pieces.last_mut() {
                Some([_, first, length]) if *first + *length == place => *length += 1,
                _ => pieces.push([row, place, 1]),
            }
        }
        Self { states, quads, pieces }
    }

    /// Puts the states of this side, or something of each, where the pack has them.
    pub fn put(&self, own: &[f64], all: &mut [f64]) {
        for &[row, place, length] in &self.pieces {
            all[place..][..length].copy_from_slice(&own[row..][..length]);
        }
    }

    /// Takes the states of this side, or something of each, out of those of the pack.
    pub fn take(&self, all: &[f64], own: &mut [f64]) {
        for &[row, place, length] in &self.pieces {
            own[row..][..length].copy_from_slice(&all[place..][..length]);
        }
    }

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
    beside: &'a Growing,
    parts: [&'a Part; 2],
    t: [f64; 2],
    /// States and quadratures of the pack at both ends.
    y: [Vec<f64>; 2],
    q: [Vec<f64>; 2],
    /// States or quadratures of one side at an instant, scratch.
    own: RefCell<Vec<f64>>,
}

/// A piece of a step as it is seen.
struct Piece<'j, 'a> {
    joint: &'j Joint<'a>,
    step: &'j dyn StepView,
}

impl<'a> Joint<'a> {
    /// For steps of one side beside what the other did; `parts` are that of the other and its own.
    pub fn new(beside: &'a Growing, parts: [&'a Part; 2], pack: &Pack) -> Self {
        let y = || vec![0.0; pack.layout.n];
        let q = || vec![0.0; pack.layout.quads()];
        Self { beside, parts, t: [0.0; 2], y: [y(), y()], q: [q(), q()], own: RefCell::new(Vec::new()) }
    }

    /// Has each piece of the step looked at, until one stops.
    pub fn pieces(&mut self, step: &dyn StepView, mut look: impl FnMut(&dyn StepView) -> Flow) -> Flow {
        let wave = self.beside.known();
        let first = wave.ends().partition_point(|t| *t <= step.t0() + SLACK);
        let inner = wave.ends()[first..].iter().copied().take_while(|t| *t < step.t1() - SLACK);
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
        self.states(step, t, &mut y);
        self.quads(step, t, &mut q);
        (self.y[1], self.q[1]) = (y, q);
    }

    /// The end of the piece that `t` is.
    fn is_end(&self, t: f64) -> Option<usize> {
        self.t.iter().position(|end| *end == t)
    }

    /// States of the pack at `t`.
    fn states(&self, step: &dyn StepView, t: f64, y: &mut [f64]) {
        let [beside, stepping] = self.parts;
        let mut own = self.own.borrow_mut();
        let mut of = |part: &Part, look: &dyn Fn(&mut [f64])| {
            own.resize(part.states.len(), 0.0);
            look(&mut own);
            part.put(&own, y);
        };
        of(beside, &|own| self.beside.known().eval(t, 0, own));
        of(stepping, &|own| match t {
            t if t >= step.t1() => own.copy_from_slice(step.y1()),
            t => step.interpolate(t, own),
        });
    }

    /// The first quadratures of the pack at `t`, as many as `q` holds.
    fn quads(&self, step: &dyn StepView, t: f64, q: &mut [f64]) {
        let [beside, stepping] =
            self.parts.map(|part| &part.quads[..part.quads.partition_point(|k| *k < q.len())]);
        self.put(q, beside, |own| self.beside.known().eval(t, self.parts[0].states.len(), own));
        self.put(q, stepping, |own| match t {
            t if t >= step.t1() => own.copy_from_slice(&step.q1()[..own.len()]),
            t => step.interpolate_quad(t, own),
        });
    }

    /// Puts what `look` finds where a side has it.
    fn put(&self, to: &mut [f64], places: &[usize], look: impl FnOnce(&mut [f64])) {
        if places.is_empty() {
            return;
        }
        let mut own = self.own.borrow_mut();
        own.resize(places.len(), 0.0);
        look(&mut own);
        places.iter().zip(&*own).for_each(|(&k, v)| to[k] = *v);
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
            None => self.joint.states(self.step, t, y),
        }
    }
    fn interpolate_quad(&self, t: f64, q: &mut [f64]) {
        match self.joint.is_end(t) {
            Some(end) => q.copy_from_slice(&self.joint.q[end][..q.len()]),
            None => self.joint.quads(self.step, t, q),
        }
    }
}
