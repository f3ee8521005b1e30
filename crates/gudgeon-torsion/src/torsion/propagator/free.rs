//! The decaying rest of a motion as a sum of damped modes.

use gudgeon_core::EvalError;
use gudgeon_numerics::elementary;
use gudgeon_numerics::linalg::Complex;

use crate::eigen;
use crate::tree::{Singular, Tree, Work};

/// Part of the start, in angles times the highest frequency and in speeds, that the sum may miss at time zero.
const MISSED: f64 = 1e-7;
/// Inverse iterations for a damped shape, from the undamped one at the damped eigenvalue.
const ITERATIONS: usize = 2;

/// Motion of a free linear line, `φ(t) = a + b t + Σ_j c_j v_j e^{z_j t}` by position.
#[derive(Debug, Clone)]
pub(super) struct FreeMotion {
    terms: Vec<Term>,
    /// Rigid motion `a + b t`.
    rigid: [f64; 2],
}

/// One damped mode.
#[derive(Debug, Clone)]
struct Term {
    /// Its eigenvalue.
    z: Complex,
    /// Amplitudes `c v` by position.
    amplitude: Vec<Complex>,
    /// Whether it stands for its conjugate as well: twice the real part.
    twice: bool,
}

fn real(v: f64) -> Complex {
    Complex::new(v, 0.0)
}

fn dot(a: &[Complex], b: &[Complex]) -> Complex {
    a.iter().zip(b).fold(Complex::default(), |s, (a, b)| s + *a * *b)
}

/// `C x`.
fn damping_times(tree: &Tree, x: &[Complex]) -> Vec<Complex> {
    let mut y: Vec<Complex> = x.iter().zip(&tree.damping).map(|(x, d)| *x * real(*d)).collect();
    for p in 0..tree.len() - 1 {
        let q = tree.parent[p];
        let t = (x[p] - x[q]) * real(tree.c[p]);
        y[p] = y[p] + t;
        y[q] = y[q] - t;
    }
    y
}

impl FreeMotion {
    /// From the state at time zero by position (φ and its rate).
    ///
    /// # Errors
    /// No convergence; a double eigenvalue, which has no sum of exponentials (Fatal).
    pub fn new(tree: &Tree, phi: &[f64], rate: &[f64]) -> Result<Self, EvalError> {
        let omega = eigen::natural_frequencies(tree, usize::MAX)?;
        let normal = eigen::shapes(tree, &omega);
        let spectrum = eigen::roots(tree, &omega, &normal)?;
        let drag: f64 = tree.damping.iter().sum();
        let mut start = Start::new(tree, phi, rate);
        let mut terms = Vec::new();
        for (k, pair) in spectrum.pairs.iter().enumerate() {
            let shape = &normal[k];
            if omega[k] == 0.0 {
                if drag != 0.0 {
                    terms.push(start.term(pair[1], shape, false));
                }
            } else if pair[0].im > 0.0 {
                terms.push(start.term(pair[0], shape, true));
            } else {
                terms.extend(pair.map(|z| start.term(z, shape, false)));
            }
        }
        let own = Self { terms, rigid: start.rigid(drag) };
        let fastest = omega.iter().copied().fold(0.0, f64::max);
        own.check(phi, rate, fastest)?;
        Ok(own)
    }

    /// Number of modes in the sum; conjugates count once.
    pub fn len(&self) -> usize {
        self.terms.len()
    }

    /// The sum must give what it was made from.
    fn check(&self, phi: &[f64], rate: &[f64], fastest: f64) -> Result<(), EvalError> {
        let n = phi.len();
        let (mut a, mut b) = (vec![0.0; n], vec![0.0; n]);
        self.at(0.0, &mut a, &mut b);
        let size = |x: &[f64]| x.iter().map(|v| v.abs()).fold(0.0, f64::max);
        let scale = size(phi) * fastest + size(rate);
        let error = |i: usize| ((a[i] - phi[i]).abs() * fastest).max((b[i] - rate[i]).abs());
        // What is no number does not agree either.
        let agrees = |i: usize| a[i].is_finite() && b[i].is_finite() && error(i) <= MISSED * scale;
        if !(0..n).all(agrees) {
            return Err(EvalError::fatal(
                "propagator",
                "two damped modes are (nearly) one: a critically damped pair has no sum of exponentials; use `implicit`",
            ));
        }
        Ok(())
    }

    /// Angles and speeds by position at time `t`.
    pub fn at(&self, t: f64, phi: &mut [f64], rate: &mut [f64]) {
        phi.fill(self.rigid[0] + self.rigid[1] * t);
        rate.fill(self.rigid[1]);
        for Term { z, amplitude, twice } in &self.terms {
            let (sin, cos) = elementary::sin_cos(z.im * t);
            let size = elementary::exp(z.re * t) * if *twice { 2.0 } else { 1.0 };
            let e = Complex::new(size * cos, size * sin);
            let d = *z * e;
            for ((p, r), v) in phi.iter_mut().zip(rate.iter_mut()).zip(amplitude) {
                *p += v.re * e.re - v.im * e.im;
                *r += v.re * d.re - v.im * d.im;
            }
        }
    }
}

/// The state at time zero, and what is needed to project it on modes.
struct Start<'a> {
    tree: &'a Tree,
    phi: &'a [f64],
    rate: &'a [f64],
    /// Angles, `C φ` and inertias as complex numbers.
    angle: Vec<Complex>,
    damped: Vec<Complex>,
    inertia: Vec<Complex>,
    work: Work,
}

impl<'a> Start<'a> {
    fn new(tree: &'a Tree, phi: &'a [f64], rate: &'a [f64]) -> Self {
        let angle: Vec<Complex> = phi.iter().map(|x| real(*x)).collect();
        Self {
            damped: damping_times(tree, &angle),
            angle,
            inertia: tree.inertia.iter().map(|j| real(*j)).collect(),
            work: Work::new(tree.len()),
            tree,
            phi,
            rate,
        }
    }

    /// The rigid motion `a + b t`.
    fn rigid(&self, drag: f64) -> [f64; 2] {
        let j = &self.tree.inertia;
        let momentum: f64 = self.rate.iter().zip(j).map(|(w, j)| w * j).sum();
        if drag == 0.0 {
            let total = self.tree.total_inertia();
            let first: f64 = self.phi.iter().zip(j).map(|(x, j)| x * j).sum();
            [first / total, momentum / total]
        } else {
            let c: f64 = self.damped.iter().map(|c| c.re).sum();
            [(momentum + c) / drag, 0.0]
        }
    }

    /// The term of an eigenvalue, with the amplitude that the start gives it.
    fn term(&mut self, z: Complex, undamped: &[f64], twice: bool) -> Term {
        let v = self.shape(z, undamped);
        let jv: Vec<Complex> = v.iter().zip(&self.inertia).map(|(v, j)| *v * *j).collect();
        let below = real(2.0) * z * dot(&v, &jv) + dot(&v, &damping_times(self.tree, &v));
        let above = (0..v.len()).fold(Complex::default(), |s, i| {
            let j = self.inertia[i];
            s + v[i] * (z * j * self.angle[i] + j * real(self.rate[i]) + self.damped[i])
        });
        let c = above / below;
        Term { z, amplitude: v.iter().map(|v| *v * c).collect(), twice }
    }

    /// The shape of a damped mode, by inverse iteration from the undamped one.
    fn shape(&mut self, z: Complex, undamped: &[f64]) -> Vec<Complex> {
        let n = undamped.len();
        let mut v: Vec<Complex> = undamped.iter().map(|v| real(*v)).collect();
        let (mut x, mut t) = (vec![Complex::default(); n], vec![Complex::default(); n]);
        for _ in 0..ITERATIONS {
            let rhs: Vec<Complex> = v.iter().zip(&self.inertia).map(|(v, j)| *v * *j).collect();
            if self.tree.solve(z, &rhs, &mut x, &mut t, Singular::Perturb, &mut self.work).is_ok() {
                let top = x.iter().fold(Complex::default(), |a, b| if b.abs() > a.abs() { *b } else { a });
                if top.abs() > 0.0 && top.abs().is_finite() {
                    let inverse = real(1.0) / top;
                    v = x.iter().map(|x| *x * inverse).collect();
                }
            }
        }
        v
    }
}
