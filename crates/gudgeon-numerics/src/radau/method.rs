//! One step of the method: work arrays, linear algebra and the stages.

use super::coefficients::{C, IM, RE, REAL, T, T_INV, newton_form};
use super::tolerance::{larger, scaled_norm};
use crate::EvalError;
use crate::linalg::{ComplexLu, lu_factor, lu_solve};
use crate::ode::{ColumnGroups, OdeSystem, Options, Stats, difference};

/// Work arrays of a system of one size.
#[derive(Debug)]
pub struct Method {
    pub n: usize,
    pub rows: usize,
    pub groups: Option<ColumnGroups>,
    pub jac: Vec<f64>,
    pub lu: Vec<f64>,
    pub pivot: Vec<usize>,
    pub complex: ComplexLu,
    pub f0: Vec<f64>,
    /// Stages in the original and in transformed coordinates, rates and increments: three blocks of `rows` each.
    pub z: Vec<f64>,
    pub w: Vec<f64>,
    pub f: Vec<f64>,
    /// Divided differences of the collocation polynomial of the last accepted step, three blocks of `rows`.
    pub dense: Vec<f64>,
    pub error: Vec<f64>,
    pub scale: Vec<f64>,
    pub stage: Vec<f64>,
    pub moved: Vec<f64>,
    pub y0: Vec<f64>,
    pub y1: Vec<f64>,
    /// Factor on the tolerance of the Newton iteration.
    pub newton: f64,
}

/// Where a step lies, and what its evaluations may look at.
pub struct Span {
    pub t: f64,
    pub h: f64,
    /// Arguments of the right-hand side stay between these, so that a jump at an end is seen from inside.
    pub low: f64,
    pub high: f64,
}

impl Span {
    /// Time at the part `c` of the step.
    pub fn at(&self, c: f64) -> f64 {
        (self.t + c * self.h).clamp(self.low, self.high)
    }
}

impl Method {
    pub fn new(dim: usize, quad_dim: usize, groups: Option<ColumnGroups>) -> Self {
        let rows = dim + quad_dim;
        Self {
            n: dim,
            rows,
            groups,
            jac: vec![0.0; rows * dim],
            lu: vec![0.0; dim * dim],
            pivot: vec![0; dim],
            complex: ComplexLu::new(dim),
            f0: vec![0.0; rows],
            z: vec![0.0; 3 * rows],
            w: vec![0.0; 3 * rows],
            f: vec![0.0; 3 * rows],
            dense: vec![0.0; 3 * rows],
            error: vec![0.0; dim],
            scale: vec![0.0; dim],
            stage: vec![0.0; dim],
            moved: vec![0.0; dim],
            y0: vec![0.0; dim],
            y1: vec![0.0; dim],
            newton: 1.0,
        }
    }

    /// The Jacobian at the start of a step, whose rates are in `f0`.
    pub fn jacobian<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        t: f64,
        y: &[f64],
        options: &Options,
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        stats.jacobians += 1;
        if sys.jacobian(t, y, &self.f0, &mut self.jac)? {
            return Ok(());
        }
        let (work, groups) = (&mut self.f[..self.rows], self.groups.as_ref());
        difference(sys, groups, t, y, &self.f0, options, &mut self.jac, work, &mut self.moved, stats)
    }

    /// Factors `λ/h - J` for the real and the complex eigenvalue.
    pub fn factor(&mut self, h: f64, stats: &mut Stats) -> Result<(), EvalError> {
        let n = self.n;
        for (l, j) in self.lu.iter_mut().zip(&self.jac) {
            *l = -j;
        }
        for i in 0..n {
            self.lu[i * n + i] += REAL / h;
        }
        stats.lu += 1;
        let real = lu_factor(&mut self.lu, n, &mut self.pivot).is_ok();
        if real && self.factor_complex(h) {
            Ok(())
        } else {
            Err(EvalError::recoverable("radau5", "singular iteration matrix"))
        }
    }

    /// Factors `λ/h - J` for the complex eigenvalue; false when it is singular.
    fn factor_complex(&mut self, h: f64) -> bool {
        let n = self.n;
        let (re, im) = self.complex.parts();
        for (l, j) in re.iter_mut().zip(&self.jac) {
            *l = -j;
        }
        im.fill(0.0);
        for i in 0..n {
            re[i * n + i] += RE / h;
            im[i * n + i] += IM / h;
        }
        self.complex.factor().is_ok()
    }

    /// First guess of the stages: the last step's polynomial continued, or no change at all.
    pub fn guess(&mut self, ratio: Option<f64>) {
        let rows = self.rows;
        let Some(ratio) = ratio else {
            self.z.fill(0.0);
            self.w.fill(0.0);
            return;
        };
        for i in 0..3 {
            let s = C[i] * ratio;
            for k in 0..rows {
                self.z[i * rows + k] =
                    newton_form(s, [self.dense[k], self.dense[rows + k], self.dense[2 * rows + k]]);
            }
        }
        for k in 0..rows {
            let z = [self.z[k], self.z[rows + k], self.z[2 * rows + k]];
            for i in 0..3 {
                self.w[i * rows + k] = T_INV[i][0] * z[0] + T_INV[i][1] * z[1] + T_INV[i][2] * z[2];
            }
        }
    }

    /// Rates at the three stages.
    pub fn rates<S: OdeSystem + ?Sized>(
        &mut self,
        sys: &mut S,
        span: &Span,
        y: &[f64],
        stats: &mut Stats,
    ) -> Result<(), EvalError> {
        let (n, rows) = (self.n, self.rows);
        for i in 0..3 {
            for ((s, y), z) in self.stage.iter_mut().zip(y).zip(&self.z[i * rows..i * rows + n]) {
                *s = y + z;
            }
            stats.rhs += 1;
            sys.rhs(span.at(C[i]), &self.stage, &mut self.f[i * rows..(i + 1) * rows])?;
        }
        Ok(())
    }

    /// One simplified Newton iteration from the rates in `f`; returns the largest scaled increment of a state.
    pub fn iterate(&mut self, h: f64, stats: &mut Stats) -> f64 {
        let (n, rows) = (self.n, self.rows);
        let (real, re, im) = (REAL / h, RE / h, IM / h);
        let (f1, rest) = self.f.split_at_mut(rows);
        let (f2, f3) = rest.split_at_mut(rows);
        let (w1, rest) = self.w.split_at_mut(rows);
        let (w2, w3) = rest.split_at_mut(rows);
        for k in 0..rows {
            let f = [f1[k], f2[k], f3[k]];
            let g = |i: usize| T_INV[i][0] * f[0] + T_INV[i][1] * f[1] + T_INV[i][2] * f[2];
            f1[k] = g(0) - real * w1[k];
            f2[k] = g(1) - (re * w2[k] - im * w3[k]);
            f3[k] = g(2) - (re * w3[k] + im * w2[k]);
        }
        lu_solve(&self.lu, n, &self.pivot, &mut f1[..n]);
        self.complex.solve(&mut f2[..n], &mut f3[..n]);
        stats.solves += 1;
        // Rows of quadratures have no column of their own: the same equations by substitution.
        let square = re * re + im * im;
        for k in n..rows {
            let row = &self.jac[k * n..(k + 1) * n];
            let through = |x: &[f64]| row.iter().zip(x).map(|(j, x)| j * x).sum::<f64>();
            f1[k] = (f1[k] + through(f1)) / real;
            let (a, b) = (f2[k] + through(f2), f3[k] + through(f3));
            f2[k] = (a * re + b * im) / square;
            f3[k] = (b * re - a * im) / square;
        }
        let mut largest: f64 = 0.0;
        for d in [&*f1, &*f2, &*f3] {
            largest = larger(largest, scaled_norm(&d[..n], &self.scale));
        }
        let (z1, rest) = self.z.split_at_mut(rows);
        let (z2, z3) = rest.split_at_mut(rows);
        for k in 0..rows {
            w1[k] += f1[k];
            w2[k] += f2[k];
            w3[k] += f3[k];
            let w = [w1[k], w2[k], w3[k]];
            let z = |i: usize| T[i][0] * w[0] + T[i][1] * w[1] + T[i][2] * w[2];
            (z1[k], z2[k], z3[k]) = (z(0), z(1), z(2));
        }
        largest
    }

    /// Divided differences of the collocation polynomial over the nodes 0, c_2 - 1, c_1 - 1, -1 counted from the end of the step.
    pub fn prepare_dense(&mut self) {
        let rows = self.rows;
        for k in 0..rows {
            let (z1, z2, z3) = (self.z[k], self.z[rows + k], self.z[2 * rows + k]);
            let first = (z2 - z3) / (C[1] - 1.0);
            let inner = (z1 - z2) / (C[0] - C[1]);
            let second = (inner - first) / (C[0] - 1.0);
            let third = second - (inner - z1 / C[0]) / C[1];
            self.dense[k] = first;
            self.dense[rows + k] = second;
            self.dense[2 * rows + k] = third;
        }
    }
}
