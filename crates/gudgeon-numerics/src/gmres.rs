//! Linear systems known by what they do to a vector: minimal residuals over a Krylov space.

use crate::elementary;

/// Work arrays of [`Gmres::solve`], kept between solutions.
#[derive(Debug, Clone, Default)]
pub struct Gmres {
    basis: Vec<Vec<f64>>,
    /// Columns of the triangular factor.
    r: Vec<Vec<f64>>,
    rotations: Vec<[f64; 2]>,
    rhs: Vec<f64>,
    /// Vectors of the Krylov space that the last solution took: the products with A.
    pub iterations: usize,
}

/// What a new vector brought.
enum Grown {
    /// Nothing: it is not finite, or A takes the vector before it to zero.
    Nothing,
    /// One dimension more; the space ends here when `last`.
    Vector { last: bool },
}

impl Gmres {
    /// Solves `A x = b` to a residual of `tolerance` times that of b, or as far as `max_vectors` vectors go: A is what `apply` makes of its
    /// first argument in the second. Returns the part of the residual that is left. (Saad and Schultz 1986)
    pub fn solve(
        &mut self,
        b: &[f64],
        x: &mut [f64],
        tolerance: f64,
        max_vectors: usize,
        mut apply: impl FnMut(&[f64], &mut [f64]),
    ) -> f64 {
        x.fill(0.0);
        self.iterations = 0;
        let size = norm(b);
        if size == 0.0 || !size.is_finite() {
            return if size == 0.0 { 0.0 } else { 1.0 };
        }
        self.rotations.clear();
        self.rhs.clear();
        self.rhs.push(size);
        self.vector(0, b.len());
        self.basis[0].iter_mut().zip(b).for_each(|(v, b)| *v = b / size);
        let mut left = 1.0;
        let mut k = 0;
        while k < max_vectors.min(b.len()) && left > tolerance {
            let Grown::Vector { last } = self.grow(k, b.len(), &mut apply) else { break };
            left = self.rhs[k + 1].abs() / size;
            k += 1;
            if last {
                break;
            }
        }
        self.iterations = k;
        self.combine(k, x);
        left
    }

    /// Adds the image of vector `k` to the space, orthogonal to what is there, and eliminates it from the least-squares problem.
    fn grow(&mut self, k: usize, n: usize, apply: &mut impl FnMut(&[f64], &mut [f64])) -> Grown {
        self.vector(k + 1, n);
        let (old, new) = self.basis.split_at_mut(k + 1);
        let w = &mut new[0];
        apply(&old[k], w);
        let before = norm(w);
        if self.r.len() <= k {
            self.r.push(Vec::new());
        }
        let column = &mut self.r[k];
        column.clear();
        for v in old.iter() {
            let h = dot(v, w);
            w.iter_mut().zip(v).for_each(|(w, v)| *w -= h * v);
            column.push(h);
        }
        let after = norm(w);
        if !after.is_finite() {
            return Grown::Nothing;
        }
        for (i, [c, s]) in self.rotations.iter().enumerate() {
            let (p, q) = (column[i], column[i + 1]);
            column[i] = c * p + s * q;
            column[i + 1] = c * q - s * p;
        }
        let pivot = elementary::hypot(column[k], after);
        if pivot <= f64::EPSILON * before {
            // A takes this vector to nothing: the space ends before it.
            return Grown::Nothing;
        }
        let (c, s) = (column[k] / pivot, after / pivot);
        column[k] = pivot;
        self.rotations.push([c, s]);
        let top = self.rhs[k];
        self.rhs[k] = c * top;
        self.rhs.push(-s * top);
        let last = after <= f64::EPSILON * before;
        if !last {
            w.iter_mut().for_each(|w| *w /= after);
        }
        Grown::Vector { last }
    }

    /// Adds the combination of the first `k` vectors with the smallest residual to `x`.
    fn combine(&mut self, k: usize, x: &mut [f64]) {
        for i in (0..k).rev() {
            self.rhs[i] /= self.r[i][i];
            let y = self.rhs[i];
            for j in 0..i {
                self.rhs[j] -= y * self.r[i][j];
            }
        }
        for (y, v) in self.rhs.iter().zip(&self.basis).take(k) {
            x.iter_mut().zip(v).for_each(|(x, v)| *x += y * v);
        }
    }

    /// Makes room for a vector of the basis.
    fn vector(&mut self, i: usize, n: usize) {
        if self.basis.len() <= i {
            self.basis.push(Vec::new());
        }
        self.basis[i].resize(n, 0.0);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Four sums that do not wait for each other.
    let mut sums = [0.0; 4];
    let (x, y) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = x.remainder().iter().zip(y.remainder()).map(|(a, b)| a * b).sum();
    for (x, y) in x.zip(y) {
        for i in 0..4 {
            sums[i] += x[i] * y[i];
        }
    }
    rest + sums.iter().sum::<f64>()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
