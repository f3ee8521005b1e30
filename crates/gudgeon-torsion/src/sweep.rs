//! Forced vibration at many speeds: the elimination of [`Tree`] for several frequencies side by side.
//!
//! Complex numbers are two rows of `LANES` reals, which the compiler turns into vector instructions. Where a pivot comes close to
//! zero, the lanes are solved again one by one with the careful elimination.

use gudgeon_numerics::linalg::Complex;

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
        if self.fast(tree, omega, torque) {
            return Ok(());
        }
        for l in 0..LANES {
            let c = &mut self.careful;
            for (t, f) in c.torque.iter_mut().zip(torque) {
                *t = Complex::new(f[0], f[1]);
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

    /// Plain elimination; false when a pivot is small.
    fn fast(&mut self, tree: &Tree, omega: &Lane, torque: &[[f64; 2]]) -> bool {
        let n = tree.len();
        let (inertia, damping, ground) = (&tree.inertia[..n], &tree.damping[..n], &tree.ground[..n]);
        let (k, c, eta, parent) = (&tree.k[..n], &tree.c[..n], &tree.eta[..n], &tree.parent[..n]);
        let (s, f, t) = (&mut self.s[..n], &mut self.f[..n], &mut self.t[..n]);
        let (angle, transmitted) = (&mut self.angle[..n], &mut self.transmitted[..n]);
        for i in 0..n {
            for l in 0..LANES {
                let w = omega[l];
                s[i][0][l] = ground[i] - w * w * inertia[i];
                s[i][1][l] = w * damping[i];
                f[i][0][l] = torque[i][0];
                f[i][1][l] = torque[i][1];
            }
        }
        // Smallest of all pivots against their limits, by lane: a minimum has no branch.
        let mut margin = [f64::INFINITY; LANES];
        // What the branches bring to the last pivot, beside which it may vanish.
        let mut brought = [0.0; LANES];
        for i in 0..n - 1 {
            let p = parent[i];
            let (own, force) = (s[i], f[i]);
            if k[i] == f64::INFINITY {
                add(&mut s[p], &own);
                add(&mut f[p], &force);
                if p == n - 1 {
                    for l in 0..LANES {
                        brought[l] += own[0][l].abs() + own[1][l].abs();
                    }
                }
                for l in 0..LANES {
                    t[i][0][l] = 1.0;
                    t[i][1][l] = 0.0;
                    angle[i][0][l] = 0.0;
                    angle[i][1][l] = 0.0;
                }
                continue;
            }
            let (ki, ki_loss) = (k[i], k[i] * eta[i]);
            let mut kappa = [[0.0; LANES]; 2];
            let mut inv = [[0.0; LANES]; 2];
            for l in 0..LANES {
                kappa[0][l] = ki;
                kappa[1][l] = ki_loss + omega[l] * c[i];
                let re = ki + own[0][l];
                let im = kappa[1][l] + own[1][l];
                let d2 = re * re + im * im;
                let size = ki * ki + own[0][l] * own[0][l];
                let m = d2 - SMALL2 * size;
                margin[l] = if m < margin[l] { m } else { margin[l] };
                let r = 1.0 / d2;
                inv[0][l] = re * r;
                inv[1][l] = -im * r;
            }
            let ti = mul(&kappa, &inv);
            t[i] = ti;
            let series = mul(&ti, &own);
            if p == n - 1 {
                for l in 0..LANES {
                    brought[l] += series[0][l].abs() + series[1][l].abs();
                }
            }
            add(&mut s[p], &series);
            add(&mut f[p], &mul(&ti, &force));
            angle[i] = mul(&force, &inv);
        }
        let r = n - 1;
        let mut inv = [[0.0; LANES]; 2];
        for l in 0..LANES {
            let (re, im) = (s[r][0][l], s[r][1][l]);
            let d2 = re * re + im * im;
            let size = omega[l] * omega[l] * inertia[r] + ground[r] + brought[l];
            let m = d2 - SMALL2 * size * size;
            margin[l] = if m < margin[l] { m } else { margin[l] };
            let q = 1.0 / d2;
            inv[0][l] = re * q;
            inv[1][l] = -im * q;
        }
        if margin.iter().any(|m| *m <= 0.0) {
            return false;
        }
        angle[r] = mul(&f[r], &inv);
        transmitted[r] = [[0.0; LANES]; 2];
        for i in (0..r).rev() {
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
        true
    }
}
