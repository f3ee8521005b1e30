//! Cycles that came to rest after a step, and what they say together of where the orbit is.
//!
//! Near the orbit the change of one cycle drowns in the noise of the map, and a slow mode multiplies that: at a multiplier of 0.95 by twenty. All cycles together
//! know more. The state that is looked for is the mean of their ends with the weights for which the mean of their residuals, doubts included, is least: reduced rank
//! extrapolation (sidi2017) with noise. Where all residuals are noise that is the plain mean. Secants of a map that is like it may be added to that, for what their
//! ends and residuals have in common is not asked.

use nalgebra::{DMatrix, DVector};

use super::{DEPTH, Secant};

/// Largest residual of a cycle that is taken together with others: beyond it a map is too strongly bent.
const NEAR: f64 = 0.02;
/// How much a residual is in doubt because the map is bent, over itself: from 0.03 to 0.1 it hardly matters.
const BLUR: f64 = 0.1;
/// Growth of the residual over its noise by which a cycle leaves an orbit that is not stable.
const LEAVES: f64 = 10.0;

/// A cycle.
struct Point {
    at: DVector<f64>,
    r: DVector<f64>,
    noise: f64,
}

/// Cycles taken together.
pub struct Blend {
    /// Norm of their weights: what is left of the noise of one.
    pub weight: f64,
    /// Residual.
    pub rest: DVector<f64>,
    /// The way there from the end of the last cycle.
    pub step: DVector<f64>,
}

/// Cycles, oldest first: those near the orbit before the last step, and those since.
#[derive(Default)]
pub struct Points {
    all: Vec<Point>,
    own: usize,
    /// Secants of a map that is like this one, in its scales.
    known: Vec<Secant>,
}

impl Points {
    /// None yet, of a map of which the secants `known` are known.
    pub const fn with(known: Vec<Secant>) -> Self {
        Self { all: Vec::new(), own: 0, known }
    }

    /// Cycles since the last step.
    pub const fn own(&self) -> usize {
        self.own
    }

    /// Whether more is known than these say.
    pub const fn has_earlier(&self) -> bool {
        self.own < self.all.len() || !self.known.is_empty()
    }

    /// A cycle from `at` with the residual `r` and its noise.
    pub fn push(&mut self, at: &DVector<f64>, r: &DVector<f64>, noise: f64) {
        self.all.push(Point { at: at.clone(), r: r.clone(), noise });
        self.own += 1;
        if self.all.len() > DEPTH {
            self.all.remove(0);
            self.own = self.own.min(DEPTH);
        }
    }

    /// After a step. Far from the orbit what was before it is forgotten.
    pub fn stepped(&mut self) {
        if !self.is_near() {
            self.all.clear();
            self.known.clear();
        }
        self.own = 0;
    }

    /// Brings all to other scales.
    pub fn rescale(&mut self, by: &DVector<f64>) {
        for point in &mut self.all {
            point.at.component_mul_assign(by);
            point.r.component_mul_assign(by);
        }
        for secant in &mut self.known {
            secant.rescale(by);
        }
    }

    /// Secants: those that were known, then from cycle to cycle.
    pub fn secants(&self) -> Vec<Secant> {
        self.known.iter().cloned().chain(self.between(0)).collect()
    }

    /// Forgets all cycles, and nothing of what was known before.
    pub fn forget(&mut self) {
        self.all.clear();
        self.own = 0;
    }

    /// Those that were known.
    pub fn known(&self) -> &[Secant] {
        &self.known
    }

    /// Those since the last step.
    pub fn own_secants(&self) -> Vec<Secant> {
        self.between(self.all.len() - self.own).collect()
    }

    /// Those from cycle to cycle, from the cycle `first` on.
    fn between(&self, first: usize) -> impl Iterator<Item = Secant> {
        let between = |w: &[Point]| Secant {
            dy: &w[1].at - &w[0].at,
            dr: &w[1].r - &w[0].r,
            noise: w[0].noise.max(w[1].noise),
        };
        self.all[first..].windows(2).map(between)
    }

    /// Whether the last cycle came to rest near the orbit, and did not begin to leave it.
    fn is_near(&self) -> bool {
        let leaves = |p: &Point, before: &Point| p.r.norm() > before.r.norm() + LEAVES * p.noise;
        match &self.all[..] {
            [.., before, p] if self.own > 1 => p.r.amax() <= NEAR && !leaves(p, before),
            [.., p] => self.own > 0 && p.r.amax() <= NEAR,
            [] => false,
        }
    }

    /// Near the orbit all cycles together, with the weights `w` of the least `|Σ w r|² + Σ (w s)²` for `Σ w = 1`, where `s` is the doubt in a residual `r`:
    /// `(RᵀR + diag s²) w ∝ e`, with `e` of ones. The differences `dr` of known secants are further columns of `R`, whose weights are free: `e` is zero there.
    pub fn blend(&self) -> Option<Blend> {
        let last = self.all.last().filter(|_| self.is_near())?;
        let cycles = self.all.iter().map(|p| (&p.r, &p.at, p.noise));
        let columns: Vec<_> = cycles.chain(self.known.iter().map(|c| (&c.dr, &c.dy, c.noise))).collect();
        let (n, all) = (columns.len(), self.all.len());
        let mut matrix = DMatrix::from_fn(n, n, |i, j| columns[i].0.dot(columns[j].0));
        for (i, (r, _, noise)) in columns.iter().enumerate() {
            matrix[(i, i)] += (noise + BLUR * r.norm()).powi(2);
        }
        let ones = DVector::from_fn(n, |i, _| f64::from(u8::from(i < all)));
        let w = matrix.cholesky()?.solve(&ones);
        let w = &w / w.rows(0, all).sum();
        let (mut rest, mut step) = (DVector::zeros(last.r.len()), -(&last.at + &last.r));
        let mut noise = 0.0;
        for (w, (r, at, of)) in w.iter().zip(&columns) {
            rest += *r * *w;
            step += (*at + *r) * *w;
            noise += (w * of).powi(2);
        }
        Some(Blend { weight: noise.sqrt() / last.noise.max(f64::MIN_POSITIVE), rest, step })
    }
}
