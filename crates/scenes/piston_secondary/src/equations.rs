//! Rates of all states at an instant, and their partial derivatives: the equations of motion as an initial-value problem in crank angle.

use gudgeon_core::EvalError;
use gudgeon_numerics::ode::OdeSystem;
use gudgeon_skirt::{Instant, Partials};

use super::assembly::Assembly;

/// Work arrays of the equations.
pub struct Work {
    /// Coordinates \[m\]: displacements of both edges, then the amplitudes of the elastic shapes.
    pub x: Vec<f64>,
    /// Their rates found last \[m/s\]: the guess for the next ones.
    pub w: Vec<f64>,
    /// Rates of the states by crank angle, where nobody asks for them.
    unused: Vec<f64>,
    partials: Partials,
    shapes: Vec<f64>,
    moves: Vec<Move>,
}

/// How a state of the lateral motion moves the piston, per unit of the state.
#[derive(Debug, Clone, Copy, Default)]
struct Move {
    /// Displacements in clearances.
    e: [f64; 2],
    /// Velocities in clearances per radian.
    v: [f64; 2],
    /// Added forces \[N\].
    force: [f64; 2],
}

impl Work {
    /// Room for the equations of an assembly.
    #[must_use]
    pub fn new(a: &Assembly) -> Self {
        let n = a.piston.coordinates();
        Self {
            x: vec![0.0; n],
            w: vec![0.0; n],
            unused: vec![0.0; a.layout.n],
            partials: Partials::new(n),
            shapes: vec![0.0; n - 2],
            moves: moves(a),
        }
    }
}

/// The pose is an affine function of the states: what a unit of each changes.
fn moves(a: &Assembly) -> Vec<Move> {
    let own = a.layout.motion.len();
    let (c, speed) = (a.clearance, a.clearance * a.omega());
    let mut y = vec![0.0; own];
    let look = |y: &[f64]| {
        let pose = a.motion.pose(y);
        (pose.e, pose.v.unwrap_or_default(), a.motion.added(y).constant)
    };
    let (e0, v0, f0) = look(&y);
    (0..own)
        .map(|k| {
            y[k] = 1.0;
            let (e, v, f) = look(&y);
            y[k] = 0.0;
            Move {
                e: [0, 1].map(|j| (e[j] - e0[j]) / c),
                v: [0, 1].map(|j| (v[j] - v0[j]) / speed),
                force: [0, 1].map(|j| f[j] - f0[j]),
            }
        })
        .collect()
}

/// The equations of motion of an assembly. Lengths count in clearances, velocities in clearances per radian.
pub struct Equations<'a> {
    /// The piston and what drives it.
    pub a: &'a mut Assembly,
    /// Work arrays.
    pub work: &'a mut Work,
}

impl Equations<'_> {
    /// Rates of the states at `t` \[rad\] into `work.unused`, or into `f`.
    fn look_at(&mut self, t: f64, y: &[f64], f: Option<&mut [f64]>) -> Result<Instant, EvalError> {
        self.a.go_on()?;
        let Work { x, w, unused, .. } = &mut *self.work;
        let f = f.unwrap_or(unused);
        self.a.coordinates(y, x);
        let now = self.a.instant(t);
        let speed = self.a.clearance * self.a.omega();
        let (motion, piston, layout) = (&mut self.a.motion, &mut self.a.piston, &self.a.layout);
        let own = &y[layout.motion.clone()];
        piston.add(motion.added(own));
        let mut asked = piston.ask(&now, x, w);
        motion.rates(own, &mut asked, &mut f[layout.motion.clone()])?;
        asked.end(motion.pose(own).v.unwrap_or_default())?;
        for (f, w) in f[layout.shapes.clone()].iter_mut().zip(&w[2..]) {
            *f = w / speed;
        }
        Ok(now)
    }

    /// Whether the states give the velocities of both edges.
    fn given(&self, y: &[f64]) -> bool {
        self.a.motion.pose(&y[self.a.layout.motion.clone()]).v.is_some()
    }

    /// Rows of the elastic shapes.
    fn rows_of_shapes(&self, jac: &mut [f64]) {
        let (layout, omega) = (&self.a.layout, self.a.omega());
        let speed = self.a.clearance * omega;
        let Work { partials, moves, .. } = &*self.work;
        for (s, row) in layout.shapes.clone().enumerate() {
            let row = &mut jac[row * layout.n..(row + 1) * layout.n];
            // Rates by coordinates are per second, by velocities pure numbers.
            let by = |k: usize| partials.of_shapes(k)[s] / omega;
            for (value, m) in row.iter_mut().zip(moves) {
                *value = 0.0;
                for k in 0..2 {
                    let by_force = partials.shapes_by_force[k][s] / speed;
                    *value += by(k) * m.e[k] + partials.shapes_by_v[k][s] * m.v[k] + by_force * m.force[k];
                }
            }
            for (k, column) in layout.shapes.clone().enumerate() {
                row[column] = by(2 + k);
            }
        }
    }
}

impl OdeSystem for Equations<'_> {
    fn dim(&self) -> usize {
        self.a.layout.n
    }

    fn rhs(&mut self, t: f64, y: &[f64], f: &mut [f64]) -> Result<(), EvalError> {
        self.look_at(t, y, Some(f)).map(|_| ())
    }

    fn jacobian(&mut self, t: f64, y: &[f64], _: &[f64], jac: &mut [f64]) -> Result<bool, EvalError> {
        let now = self.look_at(t, y, None)?;
        let given = self.given(y);
        let Work { x, w, partials, .. } = &mut *self.work;
        self.a.piston.partials(&now, x, w, given, partials)?;
        let motion = self.a.layout.motion.clone();
        let rows = &mut jac[..motion.len() * self.a.layout.n];
        if !self.a.motion.partials(&y[motion], &partials.of_answer(), rows) {
            return Ok(false);
        }
        self.rows_of_shapes(jac);
        Ok(true)
    }

    fn time_derivative(&mut self, t: f64, y: &[f64], _: &[f64], dfdt: &mut [f64]) -> Result<bool, EvalError> {
        let now = self.look_at(t, y, None)?;
        let given = self.given(y);
        let later = self.a.instant(t + LATER);
        let Work { x, w, shapes, .. } = &mut *self.work;
        let by_time = self.a.piston.time_partials(&now, x, w, given, (&later, LATER), shapes)?;
        let layout = &self.a.layout;
        if !self.a.motion.time_partials(by_time, &mut dfdt[layout.motion.clone()]) {
            return Ok(false);
        }
        let speed = self.a.clearance * self.a.omega();
        for (d, s) in dfdt[layout.shapes.clone()].iter_mut().zip(shapes) {
            *d = *s / speed;
        }
        Ok(true)
    }

    fn tolerances(&mut self, t: f64, y: &[f64], atol: &mut [f64]) {
        if self.look_at(t, y, None).is_err() {
            return;
        }
        // Forces go with the cube of the gap: a position matters by its distance from the wall.
        let part = (self.a.piston.smallest_gap() / self.a.clearance).clamp(LEAST_GAP, 1.0);
        for (k, a) in atol.iter_mut().enumerate() {
            if self.a.layout.changes_gap(k) {
                *a *= part;
            }
        }
    }
}

/// Time of a difference quotient \[rad\].
const LATER: f64 = 1e-6;
/// Gap, in clearances, below which tolerances shrink no further.
pub(super) const LEAST_GAP: f64 = 0.02;
