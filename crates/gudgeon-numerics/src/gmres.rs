//! Linear systems known by what they do to a vector: minimal residuals over a Krylov space.

/// Work arrays of [`Gmres::solve`], kept between solutions.
#[derive(Debug, Clone, Default)]
pub struct Gmres {
    basis: Vec<Vec<f64>>,
    /// Columns of the triangular factor.
    r: Vec<Vec<f64>>,
    rotations: Vec<[f64; 2]>,
    rhs: Vec<f64>,
    /// Vectors spent on the last solution.
    pub spent: usize,
}

impl Gmres {
    /// Solves `A x = b` to a residual of `tolerance` times that of b, or as far as `most` vectors go: A is what `apply` makes of its
    /// first argument in the second. Returns the part of the residual that is left. (Saad and Schultz 1986)
    pub fn solve(
        &mut self,
        b: &[f64],
        x: &mut [f64],
        tolerance: f64,
        most: usize,
        mut apply: impl FnMut(&[f64], &mut [f64]),
    ) -> f64 {
        x.fill(0.0);
        self.spent = 0;
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
        while k < most.min(b.len()) && left > tolerance {
            self.vector(k + 1, b.len());
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
                break;
            }
            for (i, [c, s]) in self.rotations.iter().enumerate() {
                let (p, q) = (column[i], column[i + 1]);
                column[i] = c * p + s * q;
                column[i + 1] = c * q - s * p;
            }
            let pivot = column[k].hypot(after);
            if pivot <= f64::EPSILON * before {
                // A takes this vector to nothing: the space ends before it.
                break;
            }
            let (c, s) = (column[k] / pivot, after / pivot);
            column[k] = pivot;
            self.rotations.push([c, s]);
            let top = self.rhs[k];
            self.rhs[k] = c * top;
            self.rhs.push(-s * top);
            left = (s * top).abs() / size;
            k += 1;
            if after <= f64::EPSILON * before {
                break;
            }
            w.iter_mut().for_each(|w| *w /= after);
        }
        self.spent = k;
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
        left
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
