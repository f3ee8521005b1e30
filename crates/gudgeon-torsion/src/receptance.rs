//! Angles of a line per torque at many orders of one speed: eliminated once, solved for as many torques as are wanted.

use gudgeon_numerics::linalg::Complex;

use crate::steady::Steady;
use crate::tree::{Resonance, Singular, Work};

/// A pivot smaller than this part of its terms leaves its order to the careful elimination; squared.
const SMALL2: f64 = 1e-12;

/// Eliminations of a line at the orders `base`, `2 base`, … Rows are positions of the tree, columns orders; real and imaginary parts apart.
#[derive(Debug, Clone, Default)]
pub struct Receptance {
    orders: usize,
    base: f64,
    /// Inverse pivots and what a node passes on to its parent.
    inverse: [Vec<f64>; 2],
    share: [Vec<f64>; 2],
    /// Orders with a small pivot.
    careful: Vec<usize>,
    work: Work,
    column: [Vec<Complex>; 3],
    /// Torques by position and order, and the angles they become.
    pub field: [Vec<f64>; 2],
}

impl Receptance {
    /// Eliminates at the speed that the line stands at, for `orders` orders that are multiples of `base`. Storage of before is used again.
    ///
    /// Torques are then put into [`Receptance::field`] at `position * orders + (multiple - 1)`, times the speed ratio of their inertia, and
    /// [`Receptance::solve`] turns them into angles divided by the speed ratio.
    pub fn factor(&mut self, steady: &mut Steady, base: f64, orders: usize) {
        let n = steady.tree.len();
        let room = |v: &mut [Vec<f64>; 2]| v.iter_mut().for_each(|v| v.resize(n * orders, 0.0));
        room(&mut self.inverse);
        room(&mut self.share);
        room(&mut self.field);
        self.column.iter_mut().for_each(|c| c.resize(n, Complex::default()));
        (self.orders, self.base, self.work) = (orders, base, Work::new(n));
        self.careful.clear();
        let mut s = vec![Complex::default(); n];
        for k in 0..orders {
            let omega = (k + 1) as f64 * base * steady.speed;
            steady.at_frequency(omega);
            if !self.eliminate(steady, k, omega, &mut s) {
                self.careful.push(k);
            }
        }
        steady.at_frequency(0.0);
    }

    /// One order; false when a pivot is small.
    fn eliminate(&mut self, steady: &Steady, k: usize, omega: f64, s: &mut [Complex]) -> bool {
        let t = &steady.tree;
        let n = t.len();
        let mut sound = true;
        let square = |z: Complex| z.re * z.re + z.im * z.im;
        for p in 0..n {
            s[p] = Complex::new(t.ground[p] - omega * omega * t.inertia[p], omega * t.damping[p]);
        }
        let mut brought = 0.0;
        for p in 0..n {
            let (at, parent) = (p * self.orders + k, t.parent[p]);
            let root = parent >= n;
            let (mut inverse, mut share) = (Complex::default(), Complex::new(1.0, 0.0));
            let mut series = s[p];
            if root || t.k[p].is_finite() {
                let kappa = if root {
                    Complex::default()
                } else {
                    Complex::new(t.k[p], t.k[p] * t.eta[p] + omega * t.c[p])
                };
                let pivot = kappa + s[p];
                let size = if root {
                    omega * omega * t.inertia[p] + t.ground[p] + brought
                } else {
                    kappa.norm1() + s[p].norm1()
                };
                let d2 = square(pivot);
                sound &= d2 > SMALL2 * size * size && d2.is_finite();
                let r = 1.0 / d2;
                inverse = Complex::new(pivot.re * r, -pivot.im * r);
                share = kappa * inverse;
                series = share * s[p];
            }
            if !root {
                s[parent] = s[parent] + series;
                if parent == n - 1 {
                    brought += series.norm1();
                }
            }
            (self.inverse[0][at], self.inverse[1][at]) = (inverse.re, inverse.im);
            (self.share[0][at], self.share[1][at]) = (share.re, share.im);
        }
        sound
    }

    /// Turns the torques in `field` (by position, times the speed ratio) into angles by position.
    ///
    /// # Errors
    /// The order (from 0) whose frequency is an undamped resonance.
    pub fn solve(&mut self, steady: &mut Steady) -> Result<(), (usize, Resonance)> {
        for i in 0..self.careful.len() {
            let k = self.careful[i];
            self.carefully(steady, k).map_err(|r| (k, r))?;
        }
        let kept: Vec<Vec<[f64; 2]>> = self.careful.iter().map(|k| self.column_of(*k)).collect();
        self.fast(&steady.tree.parent);
        for (k, column) in self.careful.iter().zip(kept) {
            for (p, z) in column.into_iter().enumerate() {
                let at = p * self.orders + k;
                (self.field[0][at], self.field[1][at]) = (z[0], z[1]);
            }
        }
        Ok(())
    }

    fn column_of(&self, k: usize) -> Vec<[f64; 2]> {
        let n = self.field[0].len() / self.orders.max(1);
        (0..n).map(|p| p * self.orders + k).map(|at| [self.field[0][at], self.field[1][at]]).collect()
    }

    fn fast(&mut self, parent: &[usize]) {
        let (n, m) = (parent.len(), self.orders);
        let [re, im] = &mut self.field;
        for p in 0..n {
            let own = p * m..(p + 1) * m;
            let (tr, ti) = (&self.share[0][own.clone()], &self.share[1][own.clone()]);
            let above = parent[p];
            if above < n {
                let (low, high) = (p * m, above * m);
                let (r, above_r) = re.split_at_mut(high);
                let (i, above_i) = im.split_at_mut(high);
                let (r, i) = (&r[low..low + m], &i[low..low + m]);
                let (above_r, above_i) = (&mut above_r[..m], &mut above_i[..m]);
                for k in 0..m {
                    above_r[k] += tr[k] * r[k] - ti[k] * i[k];
                    above_i[k] += tr[k] * i[k] + ti[k] * r[k];
                }
            }
            let (vr, vi) = (&self.inverse[0][own.clone()], &self.inverse[1][own.clone()]);
            let (r, i) = (&mut re[own.clone()], &mut im[own]);
            for k in 0..m {
                (r[k], i[k]) = (vr[k] * r[k] - vi[k] * i[k], vr[k] * i[k] + vi[k] * r[k]);
            }
        }
        for p in (0..n).rev() {
            let above = parent[p];
            if above >= n {
                continue;
            }
            let (tr, ti) = (&self.share[0][p * m..(p + 1) * m], &self.share[1][p * m..(p + 1) * m]);
            let (r, above_r) = re.split_at_mut(above * m);
            let (i, above_i) = im.split_at_mut(above * m);
            let (r, i) = (&mut r[p * m..(p + 1) * m], &mut i[p * m..(p + 1) * m]);
            let (above_r, above_i) = (&above_r[..m], &above_i[..m]);
            for k in 0..m {
                r[k] += tr[k] * above_r[k] - ti[k] * above_i[k];
                i[k] += tr[k] * above_i[k] + ti[k] * above_r[k];
            }
        }
    }

    /// One order by the elimination of the tree, in place.
    fn carefully(&mut self, steady: &mut Steady, k: usize) -> Result<(), Resonance> {
        let omega = (k + 1) as f64 * self.base * steady.speed;
        steady.at_frequency(omega);
        let [f, x, q] = &mut self.column;
        for (p, f) in f.iter_mut().enumerate() {
            let at = p * self.orders + k;
            *f = Complex::new(self.field[0][at], self.field[1][at]);
        }
        let z = Complex::new(0.0, omega);
        let solved = steady.tree.solve(z, f, x, q, Singular::Refuse, &mut self.work);
        steady.at_frequency(0.0);
        solved?;
        for (p, x) in x.iter().enumerate() {
            let at = p * self.orders + k;
            (self.field[0][at], self.field[1][at]) = (x.re, x.im);
        }
        Ok(())
    }
}
