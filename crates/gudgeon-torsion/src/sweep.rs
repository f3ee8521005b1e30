//! Forced vibration at many speeds: the elimination of [`Tree`] for several frequencies side by side.
//!
//! Complex numbers are two rows of `LANES` reals, which the compiler turns into vector instructions. Where a pivot comes close to
//! zero, the lanes are solved again one by one with the careful elimination.

use gudgeon_numerics::linalg::Complex;
use gudgeon_numerics::vectors::{Vectorised, widest};

use crate::tree::{Resonance, Singular, Tree, Work};

/// Frequencies side by side.
pub const LANES: usize = 8;
/// One real number per lane.
pub type Lane = [f64; LANES];

/// Work arrays and the answer of a sweep; positions of the tree by rows.
#[derive(Debug, Clone, Default)]
pub struct Sweep {
    /// Angles φ, real and imaginary part.
    pub angle: Vec<[Lane; 2]>,
    /// Torque from each node to its parent.
    pub transmitted: Vec<[Lane; 2]>,
    s: Vec<[Lane; 2]>,
    f: Vec<[Lane; 2]>,
    t: Vec<[Lane; 2]>,
    careful: Careful,
}

#[derive(Debug, Clone, Default)]
struct Careful {
    work: Work,
    torque: Vec<Complex>,
    angle: Vec<Complex>,
    transmitted: Vec<Complex>,
}

/// A pivot smaller than this part of its terms sends the lanes to the careful elimination; squared.
const SMALL2: f64 = 1e-12;

#[inline(always)]
fn mul(a: &[Lane; 2], b: &[Lane; 2]) -> [Lane; 2] {
    let mut o = [[0.0; LANES]; 2];
    for l in 0..LANES {
        o[0][l] = a[0][l] * b[0][l] - a[1][l] * b[1][l];
        o[1][l] = a[0][l] * b[1][l] + a[1][l] * b[0][l];
    }
    o
}

#[inline(always)]
fn add(a: &mut [Lane; 2], b: &[Lane; 2]) {
    for l in 0..LANES {
        a[0][l] += b[0][l];
        a[1][l] += b[1][l];
    }
}

/// Plain elimination; false when a pivot is small.
struct Fast<'w, T> {
    sweep: &'w mut Sweep,
    tree: &'w Tree,
    omega: &'w Lane,
    torque: &'w T,
}

impl<T: Fn(usize) -> [Lane; 2]> Vectorised for Fast<'_, T> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let Self { sweep, tree, omega, torque } = self;
        sweep.coefficients(tree, omega, torque);
        let mut margin = [f64::INFINITY; LANES];
        let brought = sweep.eliminate(tree, omega, &mut margin);
        sweep.root(tree, omega, &brought, &mut margin);
        if margin.iter().any(|m| *m <= 0.0) {
            return false;
        }
        sweep.substitute(tree);
        true
    }
}

impl Sweep {
    /// For `n` nodes.
    #[must_use]
    pub fn new(n: usize) -> Self {
        let rows = vec![[[0.0; LANES]; 2]; n];
        let z = vec![Complex::default(); n];
        Self {
            angle: rows.clone(),
            transmitted: rows.clone(),
            s: rows.clone(),
            f: rows.clone(),
            t: rows,
            careful: Careful { work: Work::new(n), torque: z.clone(), angle: z.clone(), transmitted: z },
        }
    }

    /// Solves at the angular frequencies `omega`; `torque` by position, the same in all lanes.
    ///
    /// # Errors
    /// The lane whose frequency is an undamped resonance.
    pub fn solve(
        &mut self,
        tree: &Tree,
        omega: &Lane,
        torque: &[[f64; 2]],
    ) -> Result<(), (usize, Resonance)> {
        self.solve_lanes(tree, omega, |i| torque[i].map(|t| [t; LANES]))
    }

    /// The same for torques by position and lane: other torques at every frequency.
    ///
    /// # Errors
    /// As [`Sweep::solve`].
    #[inline]
    pub fn solve_lanes(
        &mut self,
        tree: &Tree,
        omega: &Lane,
        torque: impl Fn(usize) -> [Lane; 2],
    ) -> Result<(), (usize, Resonance)> {
        if widest(Fast { sweep: self, tree, omega, torque: &torque }) {
            return Ok(());
        }
        for l in 0..LANES {
            let c = &mut self.careful;
            for (i, t) in c.torque.iter_mut().enumerate() {
                let [re, im] = torque(i);
                *t = Complex::new(re[l], im[l]);
            }
            let z = Complex::new(0.0, omega[l]);
            tree.solve(z, &c.torque, &mut c.angle, &mut c.transmitted, Singular::Refuse, &mut c.work)
                .map_err(|r| (l, r))?;
            for i in 0..tree.len() {
                self.angle[i][0][l] = c.angle[i].re;
                self.angle[i][1][l] = c.angle[i].im;
                self.transmitted[i][0][l] = c.transmitted[i].re;
                self.transmitted[i][1][l] = c.transmitted[i].im;
            }
        }
        Ok(())
    }

    /// Dynamic stiffness of every node by itself, and its torque.
    #[inline(always)]
    fn coefficients(&mut self, tree: &Tree, omega: &Lane, torque: &impl Fn(usize) -> [Lane; 2]) {
        let n = tree.len();
        let (inertia, damping, ground) = (&tree.inertia[..n], &tree.damping[..n], &tree.ground[..n]);
        let (s, f) = (&mut self.s[..n], &mut self.f[..n]);
        let mut square = [0.0; LANES];
        for l in 0..LANES {
            square[l] = omega[l] * omega[l];
        }
        for i in 0..n {
            let (own, ground, inertia, damping) = (&mut s[i], ground[i], inertia[i], damping[i]);
            for l in 0..LANES {
                own[0][l] = ground - square[l] * inertia;
            }
            for l in 0..LANES {
                own[1][l] = omega[l] * damping;
            }
            f[i] = torque(i);
        }
    }

    /// Eliminates all nodes but the root. `margin` receives the smallest of all pivots against their limits, by lane: a minimum has no
    /// branch. Returned is what the branches bring to the last pivot, beside which it may vanish.
    #[inline(always)]
    fn eliminate(&mut self, tree: &Tree, omega: &Lane, margin: &mut Lane) -> Lane {
        let n = tree.len();
        let (k, parent) = (&tree.k[..n], &tree.parent[..n]);
        let (s, f, t) = (&mut self.s[..n], &mut self.f[..n], &mut self.t[..n]);
        let angle = &mut self.angle[..n];
        let mut brought = [0.0; LANES];
        for i in 0..n - 1 {
            let p = parent[i];
            let (own, force) = (s[i], f[i]);
            // Of a rigid link the branch as it is, of another one springs in series.
            let series;
            if k[i] == f64::INFINITY {
                series = own;
                add(&mut f[p], &force);
                t[i] = [[1.0; LANES], [0.0; LANES]];
                angle[i] = [[0.0; LANES]; 2];
            } else {
                let (kappa, inverse) = link(tree, i, omega, &own, margin);
                let ti = mul(&kappa, &inverse);
                t[i] = ti;
                series = mul(&ti, &own);
                add(&mut f[p], &mul(&ti, &force));
                angle[i] = mul(&force, &inverse);
            }
            add(&mut s[p], &series);
            if p == n - 1 {
                for l in 0..LANES {
                    brought[l] += series[0][l].abs() + series[1][l].abs();
                }
            }
        }
        brought
    }

    /// The last pivot, and the angle of the root.
    #[inline(always)]
    fn root(&mut self, tree: &Tree, omega: &Lane, brought: &Lane, margin: &mut Lane) {
        let r = tree.len() - 1;
        let mut inverse = [[0.0; LANES]; 2];
        for l in 0..LANES {
            let (re, im) = (self.s[r][0][l], self.s[r][1][l]);
            let d2 = re * re + im * im;
            let size = omega[l] * omega[l] * tree.inertia[r] + tree.ground[r] + brought[l];
            let m = d2 - SMALL2 * size * size;
            margin[l] = if m < margin[l] { m } else { margin[l] };
            let q = 1.0 / d2;
            inverse[0][l] = re * q;
            inverse[1][l] = -im * q;
        }
        self.angle[r] = mul(&self.f[r], &inverse);
        self.transmitted[r] = [[0.0; LANES]; 2];
    }

    /// Angles from the root to the leaves, and the torques in the links.
    #[inline(always)]
    fn substitute(&mut self, tree: &Tree) {
        let n = tree.len();
        let parent = &tree.parent[..n];
        let (s, f, t) = (&self.s[..n], &self.f[..n], &self.t[..n]);
        let (angle, transmitted) = (&mut self.angle[..n], &mut self.transmitted[..n]);
        for i in (0..n - 1).rev() {
            let above = angle[parent[i]];
            let turn = mul(&t[i], &above);
            add(&mut angle[i], &turn);
            // What the branch does not need for itself goes on: F - S φ.
            let mut own = mul(&s[i], &angle[i]);
            for l in 0..LANES {
                own[0][l] = f[i][0][l] - own[0][l];
                own[1][l] = f[i][1][l] - own[1][l];
            }
            transmitted[i] = own;
        }
    }
}

/// Dynamic stiffness of the link of node `i` and the inverse of its pivot.
#[inline(always)]
fn link(tree: &Tree, i: usize, omega: &Lane, own: &[Lane; 2], margin: &mut Lane) -> ([Lane; 2], [Lane; 2]) {
    let (ki, ki_loss, ci) = (tree.k[i], tree.k[i] * tree.eta[i], tree.c[i]);
    let mut kappa = [[0.0; LANES]; 2];
    let mut inverse = [[0.0; LANES]; 2];
    for l in 0..LANES {
        kappa[0][l] = ki;
        kappa[1][l] = ki_loss + omega[l] * ci;
        let re = ki + own[0][l];
        let im = kappa[1][l] + own[1][l];
        let d2 = re * re + im * im;
        let size = ki * ki + own[0][l] * own[0][l];
        let m = d2 - SMALL2 * size;
        margin[l] = if m < margin[l] { m } else { margin[l] };
        let r = 1.0 / d2;
        inverse[0][l] = re * r;
        inverse[1][l] = -im * r;
    }
    (kappa, inverse)
}
