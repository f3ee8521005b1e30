//! The characteristic polynomial of a line: counts of its roots, and its logarithmic derivative.

use gudgeon_numerics::linalg::Complex;

use super::data::{NONE, Tree};
use super::solve::Work;

impl Tree {
    /// Number of undamped eigenvalues ω² below `lambda` \[1/s²\].
    #[must_use]
    pub fn count_below(&self, lambda: f64, s: &mut [f64]) -> usize {
        self.count_and_pivot(lambda, s).0
    }

    /// The same with the pivot of the root, which passes zero, falling with `lambda`, at every eigenvalue that moves the root.
    #[must_use]
    pub fn count_and_pivot(&self, lambda: f64, s: &mut [f64]) -> (usize, f64) {
        for ((s, j), g) in s.iter_mut().zip(&self.inertia).zip(&self.ground) {
            *s = g - lambda * j;
        }
        let n = self.len();
        let (mut count, mut last) = (0, 0.0);
        for i in 0..n {
            let (k, own) = (self.k[i], s[i]);
            let p = self.parent[i];
            if p == NONE {
                count += usize::from(own < 0.0);
                last = own;
            } else if k == f64::INFINITY {
                s[p] += own;
            } else {
                let d = k + own;
                // A pivot of zero is an eigenvalue of the branch held at its parent: it counts as above.
                let d = if d == 0.0 { f64::MIN_POSITIVE * 4.0 } else { d };
                count += usize::from(d < 0.0);
                let series = own / d * k;
                s[p] += if series.is_finite() { series } else { -f64::MAX.sqrt() };
            }
        }
        (count, last)
    }

    /// Derivative of the logarithm of the determinant of `g + z c + z² J + …` at `z`: zero or not finite on a zero of the
    /// determinant's derivative or of the determinant.
    #[must_use]
    pub fn log_derivative(&self, z: Complex, work: &mut Work) -> Complex {
        let n = self.len();
        let two = Complex::new(2.0, 0.0);
        let z2 = z * z;
        let real = |v: f64| Complex::new(v, 0.0);
        // s: dynamic stiffness, f: its derivative.
        for i in 0..n {
            work.s[i] = real(self.ground[i]) + real(self.damping[i]) * z + real(self.inertia[i]) * z2;
            work.f[i] = real(self.damping[i]) + two * real(self.inertia[i]) * z;
        }
        let mut sum = Complex::default();
        for i in 0..n {
            let (s, ds) = (work.s[i], work.f[i]);
            let p = self.parent[i];
            if p == NONE {
                sum = sum + ds / s;
                continue;
            }
            if self.k[i] == f64::INFINITY {
                work.s[p] = work.s[p] + s;
                work.f[p] = work.f[p] + ds;
                continue;
            }
            // A loss factor belongs to oscillation: on the real axis there is none.
            let loss = if z.im == 0.0 { 0.0 } else { self.eta[i].copysign(z.im) };
            let kappa = Complex::new(self.k[i], self.k[i] * loss) + real(self.c[i]) * z;
            let dk = real(self.c[i]);
            let inv = real(1.0) / (kappa + s);
            sum = sum + (dk + ds) * inv;
            let (a, b) = (s * inv, kappa * inv);
            work.s[p] = work.s[p] + a * kappa;
            work.f[p] = work.f[p] + a * a * dk + b * b * ds;
        }
        sum
    }

    /// Newton's step `-p/p'` of the undamped characteristic polynomial `p(λ) = det(K - λ J)`, of a chain.
    pub(crate) fn newton_step(&self, lambda: f64) -> f64 {
        let (mut s, mut ds, mut sum) = (0.0, 0.0, 0.0);
        let last = self.len() - 1;
        for i in 0..last {
            s += self.ground[i] - lambda * self.inertia[i];
            ds -= self.inertia[i];
            let k = self.k[i];
            if k == f64::INFINITY {
                continue;
            }
            let inv = 1.0 / (k + s);
            sum += ds * inv;
            let b = k * inv;
            s *= b;
            ds *= b * b;
        }
        s += self.ground[last] - lambda * self.inertia[last];
        ds -= self.inertia[last];
        -1.0 / (sum + ds / s)
    }
}
