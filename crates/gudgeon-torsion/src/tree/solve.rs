//! Forced vibration at one complex frequency by elimination along the tree.

use gudgeon_numerics::linalg::Complex;

use super::data::{NONE, Tree};

/// The system has no unique answer at this frequency: an undamped resonance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resonance;

/// What happens at a pivot that vanishes to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Singular {
    /// The answer is refused.
    Refuse,
    /// The pivot is moved by rounding: inverse iteration wants the large answer.
    Perturb,
}

/// Work arrays of [`Tree::solve`], by position.
#[derive(Debug, Clone, Default)]
pub struct Work {
    /// Dynamic stiffness `S` of the branch that ends at a node.
    pub(super) s: Vec<Complex>,
    /// Torque of the branch, reduced to its node; in [`Tree::log_derivative`] the derivative of `s`.
    pub(super) f: Vec<Complex>,
    /// Angle of a node by that of its parent, `κ/(κ + S)`.
    t: Vec<Complex>,
    /// Inverse pivots.
    inverse: Vec<Complex>,
    /// Dynamic stiffness `κ` of the links.
    kappa: Vec<Complex>,
    /// Sum of the magnitudes of the terms in `s`.
    magnitude: Vec<f64>,
    /// Child whose pivot is (nearly) zero, to be eliminated together with this node.
    deferred: Vec<usize>,
}

impl Work {
    /// For `n` nodes.
    #[must_use]
    pub fn new(n: usize) -> Self {
        let z = vec![Complex::default(); n];
        Self {
            s: z.clone(),
            f: z.clone(),
            t: z.clone(),
            inverse: z.clone(),
            kappa: z,
            magnitude: vec![0.0; n],
            deferred: vec![NONE; n],
        }
    }
}

/// A pivot smaller than this part of its terms is eliminated together with the parent.
const SMALL: f64 = 1e-6;
/// A last pivot smaller than this part of its terms has no digit left that is worth having.
const VANISHED: f64 = 1e-12;

fn real(v: f64) -> Complex {
    Complex::new(v, 0.0)
}

impl Tree {
    /// Solves `(g + z c + z² J + links) φ = torque` at `z`; all arrays by position. `angle` receives φ, `transmitted` the torque
    /// from each node to its parent.
    ///
    /// # Errors
    /// [`Resonance`]: the system is singular to rounding there.
    pub fn solve(
        &self,
        z: Complex,
        torque: &[Complex],
        angle: &mut [Complex],
        transmitted: &mut [Complex],
        singular: Singular,
        work: &mut Work,
    ) -> Result<(), Resonance> {
        let n = self.len();
        self.coefficients(z, torque, work);
        for i in 0..n {
            self.eliminate(i, singular, work)?;
        }
        for i in (0..n).rev() {
            self.substitute(i, angle, work);
        }
        self.transmit(angle, transmitted, work);
        Ok(())
    }

    /// Dynamic stiffness of every node and link by itself.
    fn coefficients(&self, z: Complex, torque: &[Complex], work: &mut Work) {
        let z2 = z * z;
        for i in 0..self.len() {
            let own = real(self.damping[i]) * z + real(self.inertia[i]) * z2;
            work.s[i] = real(self.ground[i]) + own;
            work.magnitude[i] = self.ground[i] + own.norm1();
            work.f[i] = torque[i];
            work.deferred[i] = NONE;
            let loss = if z.im < 0.0 { -self.eta[i] } else { self.eta[i] };
            work.kappa[i] = Complex::new(self.k[i], self.k[i] * loss) + real(self.c[i]) * z;
        }
    }

    /// Dynamic stiffness of the link towards the parent; zero at the root.
    #[inline]
    fn kappa(&self, i: usize, work: &Work) -> Complex {
        if self.parent[i] == NONE { Complex::default() } else { work.kappa[i] }
    }

    /// Eliminates one node, whose branch its parent then contains.
    #[inline]
    fn eliminate(&self, i: usize, singular: Singular, work: &mut Work) -> Result<(), Resonance> {
        if self.is_rigid(i) {
            return self.join_parent(i, work);
        }
        if work.deferred[i] != NONE {
            return self.eliminate_pair(i, work.deferred[i], work);
        }
        let p = self.parent[i];
        let kappa = self.kappa(i, work);
        let Some(pivot) = self.pivot(i, kappa, singular, work)? else {
            work.deferred[p] = i;
            return Ok(());
        };
        let inverse = real(1.0) / pivot;
        work.inverse[i] = inverse;
        if p != NONE {
            let t = kappa * inverse;
            work.t[i] = t;
            let series = t * work.s[i];
            work.s[p] = work.s[p] + series;
            work.f[p] = work.f[p] + t * work.f[i];
            work.magnitude[p] += series.norm1();
        }
        Ok(())
    }

    /// A rigid link passes on what its branch has, a deferred child included.
    fn join_parent(&self, i: usize, work: &mut Work) -> Result<(), Resonance> {
        let p = self.parent[i];
        work.s[p] = work.s[p] + work.s[i];
        work.f[p] = work.f[p] + work.f[i];
        work.magnitude[p] += work.magnitude[i];
        let child = work.deferred[i];
        if child != NONE {
            if work.deferred[p] != NONE {
                return Err(Resonance);
            }
            work.deferred[p] = child;
        }
        Ok(())
    }

    /// The pivot `κ + S` of a node; `None` where the node has to be eliminated together with its parent.
    #[inline]
    fn pivot(
        &self,
        i: usize,
        kappa: Complex,
        singular: Singular,
        work: &Work,
    ) -> Result<Option<Complex>, Resonance> {
        let p = self.parent[i];
        let pivot = kappa + work.s[i];
        let floor = |size: f64| {
            let minimum = f64::EPSILON * size;
            if pivot.norm1() < minimum { real(minimum) } else { pivot }
        };
        if p == NONE {
            let size = work.magnitude[i];
            if pivot.norm1() > VANISHED * size {
                return Ok(Some(pivot));
            }
            return if singular == Singular::Refuse { Err(Resonance) } else { Ok(Some(floor(size))) };
        }
        let size = kappa.norm1() + work.magnitude[i];
        // Neither inertia nor stiffness: any angle would do.
        if size == 0.0 {
            return Err(Resonance);
        }
        if pivot.norm1() >= SMALL * size {
            return Ok(Some(pivot));
        }
        if singular == Singular::Perturb {
            return Ok(Some(floor(size)));
        }
        if work.deferred[p] == NONE {
            return Ok(None);
        }
        // Two such children vibrate against each other while the parent stands still.
        if pivot.norm1() <= VANISHED * size { Err(Resonance) } else { Ok(Some(pivot)) }
    }

    /// Eliminates a node together with a child `c` that is in resonance when the node is held:
    /// `[d_c, -κ_c; -κ_c, e] [φ_c, φ_i] = [f_c, f_i + κ φ_p]`, `e = S + κ_c + κ`.
    fn eliminate_pair(&self, i: usize, c: usize, work: &mut Work) -> Result<(), Resonance> {
        let p = self.parent[i];
        let kappa = self.kappa(i, work);
        let (s, f) = (work.s[i], work.f[i]);
        let (dc, kc, fc) = (work.kappa[c] + work.s[c], work.kappa[c], work.f[c]);
        let e = s + kc + kappa;
        let (left, right) = (dc * e, kc * kc);
        let det = left - right;
        let regular = det.norm1() > VANISHED * (left.norm1() + right.norm1());
        if !regular {
            return Err(Resonance);
        }
        let inverse = real(1.0) / det;
        work.inverse[i] = inverse;
        work.t[i] = kappa * dc * inverse;
        if p != NONE {
            work.s[p] = work.s[p] + kappa * (dc * (s + kc) - right) * inverse;
            work.f[p] = work.f[p] + kappa * (dc * f + kc * fc) * inverse;
            work.magnitude[p] += kappa.norm1();
        }
        Ok(())
    }

    /// Angle of a node, and of its deferred child, from that of its parent.
    #[inline]
    fn substitute(&self, i: usize, angle: &mut [Complex], work: &Work) {
        let p = self.parent[i];
        let above = if p == NONE { Complex::default() } else { angle[p] };
        if self.is_rigid(i) {
            angle[i] = above;
            return;
        }
        let c = work.deferred[i];
        if c != NONE {
            let (dc, kc, fc) = (work.kappa[c] + work.s[c], work.kappa[c], work.f[c]);
            let kappa = self.kappa(i, work);
            let f = work.f[i] + kappa * above;
            let e = work.s[i] + kc + kappa;
            angle[i] = (dc * f + kc * fc) * work.inverse[i];
            angle[c] = (e * fc + kc * f) * work.inverse[i];
            return;
        }
        if p != NONE && work.deferred[p] == i {
            // Found together with its parent.
            return;
        }
        let own = work.f[i] * work.inverse[i];
        angle[i] = if p == NONE { own } else { own + work.t[i] * above };
    }

    /// Torque from each node to its parent, `F - S φ`.
    fn transmit(&self, angle: &[Complex], transmitted: &mut [Complex], work: &Work) {
        for i in 0..self.len() {
            transmitted[i] = if self.parent[i] == NONE {
                Complex::default()
            } else {
                let c = work.deferred[i];
                let rest = work.f[i] - work.s[i] * angle[i];
                // A child that was not condensed into this node acts by its link.
                if c == NONE { rest } else { rest + work.kappa[c] * (angle[c] - angle[i]) }
            };
        }
    }
}
