//! Variational equations: how the solution of an initial-value problem changes with its initial state and with parameters.
//!
//! Along a solution of `y' = f(t, y, p)` a derivative `S = ∂y/∂c` by one quantity `c` (a component of the initial state, a parameter) obeys
//!
//! ```text
//! S' = f_y(t, y(t)) S + f_c(t, y(t)),
//! ```
//!
//! which is linear. [`Tangent`] integrates several columns of `S` side by side on the steps that an integrator took for `y`, by the Radau IIA method of order
//! 5 (hairer1996, section IV.5): three stages, L-stable, stiffly accurate. Its collocation equations are linear here, so a step is one factorisation and no
//! iteration. Nothing asks for derivatives of the matrix `f_y`, as the derivative of a Rosenbrock step would.
//!
//! # Events
//! Where an event `g(t, y, p) = 0` changes the state to `R(y, p)` or the rates from `f⁻` to `f⁺`, derivatives jump, because the event comes earlier or later
//! by `τ' = -(g_y S⁻ + g_c)/(g_y f⁻ + g_t)`:
//!
//! ```text
//! S⁺ = R_y S⁻ + R_c + (R_y f⁻ - f⁺) τ'        (R_y: without the quadratures, which an event leaves as they are)
//! ```
//!
//! ([`Tangent::jump`]; leine2004, section 7.)

use crate::linalg::{Singular, lu_factor, lu_solve_rows};
use crate::radau::{C, SQRT_6};

/// Stages.
const STAGES: usize = 3;

/// Places in a step, from 0 to 1, at which [`Tangent::node`] wants the linearised equations.
pub const NODES: [f64; STAGES] = C;

/// `A` of the method, and its inverse.
const A: [[f64; STAGES]; STAGES] = [
    [(88.0 - 7.0 * SQRT_6) / 360.0, (296.0 - 169.0 * SQRT_6) / 1800.0, (-2.0 + 3.0 * SQRT_6) / 225.0],
    [(296.0 + 169.0 * SQRT_6) / 1800.0, (88.0 + 7.0 * SQRT_6) / 360.0, (-2.0 - 3.0 * SQRT_6) / 225.0],
    [(16.0 - SQRT_6) / 36.0, (16.0 + SQRT_6) / 36.0, 1.0 / 9.0],
];
const INVERSE: [[f64; STAGES]; STAGES] = [
    [3.224_744_871_391_589, 1.167_840_084_690_405_5, -0.253_197_264_742_180_8],
    [-3.567_840_084_690_405_5, 0.775_255_128_608_411, 1.053_197_264_742_180_8],
    [5.531_972_647_421_808, -7.531_972_647_421_808, 5.0],
];

/// The start of a step and its nodes, through which the derivatives in between are interpolated.
const KNOTS: [f64; STAGES + 1] = [0.0, NODES[0], NODES[1], NODES[2]];

/// The linearised equations at a node of a step.
#[derive(Debug, Clone)]
pub struct Linearised {
    /// `∂(f, g)/∂y`, row-major, a row for each state and each quadrature, a column for each state.
    pub jacobian: Vec<f64>,
    /// `∂(f, g)/∂c`, row-major, a row for each state and each quadrature, a column for each quantity; 0 for components of the initial state.
    pub forcing: Vec<f64>,
}

/// What happens to the derivatives at an event; see the [module](self).
#[derive(Debug, Clone, Copy)]
pub struct Jump<'a> {
    /// `R_y`, row-major, square over the states.
    pub reset: &'a [f64],
    /// `R_c`, a row for each state, a column for each quantity; empty: zero.
    pub moved: &'a [f64],
    /// Rates of states and quadratures before the event.
    pub before: &'a [f64],
    /// And behind it.
    pub after: &'a [f64],
    /// `τ'`, by how much later the event comes, one for each quantity; empty: its time is fixed.
    pub delay: &'a [f64],
}

/// Derivatives of states and quadratures by several quantities along a trajectory, with the work arrays of a step.
#[derive(Debug, Clone)]
pub struct Tangent {
    n: usize,
    rows: usize,
    columns: usize,
    /// Derivatives at the end of the last step.
    now: Vec<f64>,
    /// Derivatives at its start and at its nodes.
    knots: [Vec<f64>; STAGES + 1],
    equations: [Linearised; STAGES],
    matrix: Vec<f64>,
    pivots: Vec<usize>,
    rhs: Vec<f64>,
}

impl Tangent {
    /// For `n` states, `quadratures` and `columns` quantities. All derivatives are zero.
    #[must_use]
    pub fn new(n: usize, quadratures: usize, columns: usize) -> Self {
        let rows = n + quadratures;
        let values = || vec![0.0; rows * columns];
        let equations = || Linearised { jacobian: vec![0.0; rows * n], forcing: values() };
        Self {
            n,
            rows,
            columns,
            now: values(),
            knots: [values(), values(), values(), values()],
            equations: [equations(), equations(), equations()],
            matrix: vec![0.0; STAGES * n * STAGES * n],
            pivots: vec![0; STAGES * n],
            rhs: vec![0.0; STAGES * n * columns],
        }
    }

    /// Derivatives now, row-major: states, then quadratures; a column for each quantity.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.now
    }

    /// Derivatives now, to be set before the first step.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.now
    }

    /// The linearised equations at [`NODES`]`[i]` of the coming step, to be filled in.
    pub fn node(&mut self, i: usize) -> &mut Linearised {
        &mut self.equations[i]
    }

    /// The linearised equations at the nodes.
    #[must_use]
    pub fn nodes(&self) -> &[Linearised; NODES.len()] {
        &self.equations
    }

    /// Prepares a step of length `h`, whose Jacobians stand in [`Tangent::node`].
    ///
    /// # Errors
    /// The collocation equations have no solution, or a coefficient is not finite.
    pub fn prepare(&mut self, h: f64) -> Result<(), Singular> {
        let (n, width) = (self.n, STAGES * self.n);
        self.matrix.fill(0.0);
        for (i, e) in self.equations.iter().enumerate() {
            for r in 0..n {
                let row = &mut self.matrix[(i * n + r) * width..][..width];
                for (x, j) in row[i * n..(i + 1) * n].iter_mut().zip(&e.jacobian[r * n..]) {
                    *x = -j;
                }
                for (j, a) in INVERSE[i].iter().enumerate() {
                    row[j * n + r] += a / h;
                }
            }
        }
        lu_factor(&mut self.matrix, width, &mut self.pivots)
    }

    /// By how much the states `y` at the nodes of the step that was prepared, with the rates `f`, miss the solution of the collocation equations of `y` itself
    /// from `start`, one after the other into `out`: one step of Newton's method. States inside the steps of an integrator are less accurate than those at
    /// their ends, the stiff ones most of all.
    pub fn missing(
        &self,
        h: f64,
        start: &[f64],
        y: &[Vec<f64>; STAGES],
        f: &[Vec<f64>; STAGES],
        out: &mut [f64],
    ) {
        let n = self.n;
        for (i, inverse) in INVERSE.iter().enumerate() {
            for r in 0..n {
                let slope: f64 = inverse.iter().zip(y).map(|(a, y)| a * (y[r] - start[r])).sum();
                out[i * n + r] = f[i][r] - slope / h;
            }
        }
        lu_solve_rows(&self.matrix, STAGES * n, &self.pivots, out, 1);
    }

    /// Takes the step of length `h` that was prepared, whose forcing stands in [`Tangent::node`]:
    /// `Σ_j (A⁻¹)_ij (Z_j - S)/h = J_i Z_i + F_i` for the values `Z` at the nodes.
    pub fn step(&mut self, h: f64) {
        let (n, m) = (self.n, self.columns);
        for (i, (e, inverse)) in self.equations.iter().zip(&INVERSE).enumerate() {
            let per = inverse.iter().sum::<f64>() / h;
            let part = &mut self.rhs[i * n * m..(i + 1) * n * m];
            for ((x, s), f) in part.iter_mut().zip(&self.now).zip(&e.forcing) {
                *x = per * s + f;
            }
        }
        lu_solve_rows(&self.matrix, STAGES * n, &self.pivots, &mut self.rhs, m);
        let [start, nodes @ ..] = &mut self.knots;
        start.copy_from_slice(&self.now);
        for (node, found) in nodes.iter_mut().zip(self.rhs.chunks_exact(n * m)) {
            node[..n * m].copy_from_slice(found);
        }
        self.quadratures(h);
        self.now.copy_from_slice(&self.knots[STAGES]);
    }

    /// Quadratures at the nodes, from the states there.
    fn quadratures(&mut self, h: f64) {
        let (n, m) = (self.n, self.columns);
        for q in n..self.rows {
            for c in 0..m {
                let rate = |e: &Linearised, z: &[f64]| {
                    let row = &e.jacobian[q * n..(q + 1) * n];
                    row.iter().enumerate().map(|(k, j)| j * z[k * m + c]).sum::<f64>() + e.forcing[q * m + c]
                };
                let mut rates = [0.0; STAGES];
                for (i, r) in rates.iter_mut().enumerate() {
                    *r = rate(&self.equations[i], &self.knots[i + 1]);
                }
                let at = q * m + c;
                for (i, a) in A.iter().enumerate() {
                    let sum: f64 = a.iter().zip(&rates).map(|(a, r)| a * r).sum();
                    self.knots[i + 1][at] = self.now[at] + h * sum;
                }
            }
        }
    }

    /// Goes back to the start of the last step, whose [`Tangent::knot`]s stay.
    pub fn undo(&mut self) {
        self.now.copy_from_slice(&self.knots[0]);
    }

    /// Derivatives at the start of the last step (0) and at its nodes (1 to 3).
    #[must_use]
    pub fn knot(&self, k: usize) -> &[f64] {
        &self.knots[k]
    }

    /// The products `f_y S*` at node `i` with the columns of `s` from `first` on, into `out`: a row for each state and each quadrature, a column for each
    /// quantity.
    pub fn along(&self, i: usize, first: usize, s: &[f64], out: &mut [f64]) {
        let (n, m) = (self.n, self.columns);
        for (row, out) in self.equations[i].jacobian.chunks_exact(n).zip(out.chunks_exact_mut(m)) {
            let out = &mut out[first..];
            out.fill(0.0);
            for (j, s) in row.iter().zip(s.chunks_exact(m)) {
                for (o, s) in out.iter_mut().zip(&s[first..]) {
                    *o += j * s;
                }
            }
        }
    }

    /// Sets the forcing of quantity `c` at node `i` from the rates `f` there and `f_moved` at a distance `d` along it:
    /// `(f_moved - f)/d - f_y S*`, where `f_moved` belongs to the state `y + d S*`, and to the parameter `p + d` where `c` is one. `f_y S*` stands in
    /// column `c` of `told` ([`Tangent::along`]).
    pub fn directional(&mut self, i: usize, c: usize, f: &[f64], f_moved: &[f64], d: f64, told: &[f64]) {
        let m = self.columns;
        let forcing = self.equations[i].forcing.iter_mut().skip(c).step_by(m);
        let told = told.iter().skip(c).step_by(m);
        for ((out, told), (f, moved)) in forcing.zip(told).zip(f.iter().zip(f_moved)) {
            *out = (moved - f) / d - told;
        }
    }

    /// Derivatives at the place `x` of the last step, from 0 to 1: the collocation polynomial, of degree 3.
    pub fn interpolate(&self, x: f64, out: &mut [f64]) {
        let mut weights = [1.0; STAGES + 1];
        for (i, w) in weights.iter_mut().enumerate() {
            for (k, other) in KNOTS.iter().enumerate() {
                if k != i {
                    *w *= (x - other) / (KNOTS[i] - other);
                }
            }
        }
        let [w0, w1, w2, w3] = weights;
        let [k0, k1, k2, k3] = &self.knots;
        let knots = k0.iter().zip(k1).zip(k2.iter().zip(k3));
        for (o, ((s0, s1), (s2, s3))) in out.iter_mut().zip(knots) {
            *o = w0 * s0 + w1 * s1 + w2 * s2 + w3 * s3;
        }
    }

    /// Takes the derivatives across an event.
    pub fn jump(&mut self, jump: &Jump<'_>) {
        let (n, m) = (self.n, self.columns);
        let states = self.now[..n * m].to_vec();
        for r in 0..n {
            let reset = &jump.reset[r * n..(r + 1) * n];
            let arriving: f64 = reset.iter().zip(jump.before).map(|(a, f)| a * f).sum();
            for c in 0..m {
                let kept: f64 = reset.iter().enumerate().map(|(k, a)| a * states[k * m + c]).sum();
                let moved = jump.moved.get(r * m + c).copied().unwrap_or(0.0);
                let delay = jump.delay.get(c).copied().unwrap_or(0.0);
                self.now[r * m + c] = kept + moved + (arriving - jump.after[r]) * delay;
            }
        }
        for q in n..self.rows {
            for (c, delay) in jump.delay.iter().enumerate() {
                self.now[q * m + c] += (jump.before[q] - jump.after[q]) * delay;
            }
        }
    }
}
