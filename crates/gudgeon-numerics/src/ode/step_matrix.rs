//! The matrix of an implicit step, `d I - J`, factored.

use super::core::Core;
use super::system::OdeSystem;
use crate::linalg::{columns, lu_factor_weighted, lu_solve, lu_solve_by_products};

/// Factors of `d I - J`; empty for systems that solve for themselves.
#[derive(Debug, Clone)]
pub(crate) struct StepMatrix {
    /// The matrix, then its factors: by columns from [`columns::WORTH`] unknowns on, by rows below.
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
        self.weight.copy_from_slice(&core.weight);
        let (weight, piv) = (&mut self.weight, &mut self.piv);
        let factored = if n < columns::WORTH {
            self.lu.iter_mut().zip(&core.jac).for_each(|(w, j)| *w = -j);
            self.lu.iter_mut().step_by(n + 1).for_each(|w| *w += diagonal);
            lu_factor_weighted(&mut self.lu, n, piv, Some(weight))
        } else {
            for (i, row) in core.jac[..n * n].chunks_exact(n).enumerate() {
                self.lu.chunks_exact_mut(n).zip(row).for_each(|(column, j)| column[i] = -j);
                self.lu[i * n + i] += diagonal;
            }
            columns::factor(&mut self.lu, n, piv, weight)
        };
        for (i, inverse) in self.inverse.iter_mut().enumerate() {
            *inverse = 1.0 / self.lu[i * n + i];
        }
        factored.is_ok()
    }

    /// Solves `(diagonal I - J) x = b` in place.
    pub(crate) fn solve<S: OdeSystem + ?Sized>(&self, core: &Core, sys: &mut S, b: &mut [f64]) {
        if core.structured {
            sys.solve(b);
            return;
        }
        let Self { lu, piv, inverse, .. } = self;
        let n = core.n;
        match (n < columns::WORTH, inverse.is_empty()) {
            (true, true) => lu_solve(lu, n, piv, b),
            (true, false) => lu_solve_by_products(lu, n, piv, inverse, b),
            (false, true) => columns::solve(lu, n, piv, b, |k, x| x / lu[k * n + k]),
            (false, false) => columns::solve(lu, n, piv, b, |k, x| x * inverse[k]),
        }
    }
}
