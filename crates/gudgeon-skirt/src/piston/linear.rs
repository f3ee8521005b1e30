//! Answer of a piston to a small change of the forces on it.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::{lu_factor, lu_solve};

use super::newton::no_resistance;

/// Answer of rates and forces to a change of the forces: rates from coordinate `first` on are such that their forces stay in balance.
#[derive(Default)]
pub(super) struct Linear {
    n: usize,
    first: usize,
    /// Forces left over at the present place, and their derivatives with respect to the rates.
    pub(super) base: Vec<f64>,
    slope: Vec<f64>,
    lu: Vec<f64>,
    piv: Vec<usize>,
    /// Change of the forces at fixed rates.
    pub(super) dr: Vec<f64>,
    d: Vec<f64>,
}

impl Linear {
    pub(super) fn new(n: usize) -> Self {
        let v = |n: usize| vec![0.0; n];
        Self {
            n,
            base: v(n),
            slope: v(n * n),
            lu: v(n * n),
            piv: vec![0; n],
            dr: v(n),
            d: v(n),
            ..Self::default()
        }
    }

    /// Takes forces left over and their derivatives with respect to the rates, those before `first` being given.
    pub(super) fn prepare(&mut self, base: &[f64], slope: &[f64], first: usize) -> Result<(), EvalError> {
        let n = self.n;
        self.first = first;
        self.base.copy_from_slice(base);
        self.slope.copy_from_slice(slope);
        let m = n - first;
        for i in 0..m {
            for j in 0..m {
                self.lu[i * m + j] = self.slope[(first + i) * n + first + j];
            }
        }
        lu_factor(&mut self.lu[..m * m], m, &mut self.piv[..m]).map_err(|_| no_resistance())
    }

    /// Takes the derivatives with respect to rate `column` as the change of the forces.
    pub(super) fn move_rate(&mut self, column: usize) {
        for k in 0..self.n {
            self.dr[k] = self.slope[k * self.n + column];
        }
    }

    /// Takes a unit force on coordinate `k` as the change of the forces.
    pub(super) fn push(&mut self, k: usize) {
        self.dr.fill(0.0);
        self.dr[k] = 1.0;
    }

    /// Changes for the change of the forces in `dr`: of the rates of the shapes, into `shapes`, and of the rates of both edges, or of the forces on both
    /// edges when their rates are given.
    pub(super) fn respond(&mut self, shapes: &mut [f64]) -> [f64; 2] {
        let (n, first) = (self.n, self.first);
        let m = n - first;
        for i in 0..m {
            self.d[i] = -self.dr[first + i];
        }
        if m > 0 {
            lu_solve(&self.lu[..m * m], m, &self.piv[..m], &mut self.d[..m]);
        }
        shapes.copy_from_slice(&self.d[2 - first..m]);
        if first == 0 {
            return [self.d[0], self.d[1]];
        }
        let mut f = [self.dr[0], self.dr[1]];
        for (k, f) in f.iter_mut().enumerate() {
            for j in 0..m {
                *f += self.slope[k * n + first + j] * self.d[j];
            }
        }
        f
    }
}
