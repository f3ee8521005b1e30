//! The matrix of an implicit step, `d I - J`, factored.

use super::core::Core;
use super::system::OdeSystem;
use crate::linalg::{lu_factor_weighted, lu_solve, lu_solve_by_products};

/// Factors of `d I - J`; empty for systems that solve for themselves.
#[derive(Debug, Clone)]
pub(crate) struct StepMatrix {
    lu: Vec<f64>,
    piv: Vec<usize>,
    weight: Vec<f64>,
    /// One over every pivot; empty: solutions divide.
    inverse: Vec<f64>,
}

impl StepMatrix {
    pub(crate) fn new(n: usize) -> Self {
        Self { lu: vec![0.0; n * n], piv: vec![0; n], weight: vec![1.0; n], inverse: Vec::new() }
    }

    /// One that solves by products with the inverses of its pivots.
    pub(crate) fn by_products(n: usize) -> Self {
        Self { inverse: vec![0.0; n], ..Self::new(n) }
    }

    /// Factors `diagonal I - J` with the Jacobian and the row weights of `core`; false when it is singular.
    pub(crate) fn factor<S: OdeSystem + ?Sized>(&mut self, core: &Core, sys: &mut S, diagonal: f64) -> bool {
        if core.structured {
            return sys.factor(diagonal);
        }
        let n = core.n;
        for (w, j) in self.lu.iter_mut().zip(&core.jac) {
            *w = -j;
        }
        for i in 0..n {
            self.lu[i * n + i] += diagonal;
        }
        self.weight.copy_from_slice(&core.weight);
        let factored = lu_factor_weighted(&mut self.lu, n, &mut self.piv, Some(&mut self.weight)).is_ok();
        for (i, inverse) in self.inverse.iter_mut().enumerate() {
            *inverse = 1.0 / self.lu[i * n + i];
        }
        factored
    }

    /// Solves `(diagonal I - J) x = b` in place.
    pub(crate) fn solve<S: OdeSystem + ?Sized>(&self, core: &Core, sys: &mut S, b: &mut [f64]) {
        if core.structured {
            sys.solve(b);
        } else if self.inverse.is_empty() {
            lu_solve(&self.lu, core.n, &self.piv, b);
        } else {
            lu_solve_by_products(&self.lu, core.n, &self.piv, &self.inverse, b);
        }
    }
}
