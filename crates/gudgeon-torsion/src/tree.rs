//! The one data structure behind everything here: a shaft line as a tree in the order of its elimination.
//!
//! Angles are divided by the speed ratio of their inertia, `φ = θ/ratio`, so that the rigid motion is `φ = const` and gears leave no
//! trace but in the coefficients. Every node but the last (the root) has one link to its parent, which stands behind it. A
//! branch is then known to the rest by its dynamic stiffness alone,
//!
//! ```text
//! S_i = g_i + z c_i + z² J_i + Σ_children κ_c S_c/(κ_c + S_c),      κ = k (1 + iη) + z d
//! ```
//!
//! with `z = iω` for forced vibration, any `z` for damped eigenvalues and `z² = -λ` for undamped ones. One pass from the leaves to the
//! root is an elimination (`D_i = κ_i + S_i` are its pivots), one pass back the solution: both grow linearly with the number of
//! inertias, for chains and trees alike.
//!
//! Spring and branch come in as springs in series, never as the difference of large numbers. A link of any stiffness is therefore
//! as good as any other: a rigid one passes `S` on as it is (`κ S/(κ+S) → S`), an inertia of zero adds nothing, and neither has to be
//! removed first. Rounding in this recursion equals relative changes of a few ulps of single inertias and stiffnesses, so the number of
//! negative pivots at `z² = -λ`, which is the number of eigenvalues below λ (Sylvester), places even the smallest eigenvalue to a
//! relative accuracy that does not know the ratio of the stiffnesses.

use gudgeon_core::BuildError;
use gudgeon_core::kinds::Line;
use gudgeon_numerics::linalg::Complex;

/// Position of a node that is not there: the parent of the root.
const NONE: usize = usize::MAX;

/// A shaft line in the order of elimination, with the coefficients of small vibration.
#[derive(Debug, Clone)]
pub struct Tree {
    /// Node of the line at each position.
    pub node: Vec<usize>,
    /// Position of each node of the line.
    pub position: Vec<usize>,
    /// Position of the parent, behind the own one; the last has none.
    pub parent: Vec<usize>,
    /// Link of the line towards the parent.
    pub link: Vec<usize>,
    /// Whether the link's first node is the child.
    pub forward: Vec<bool>,
    /// Speed ratio of the nodes.
    pub ratio: Vec<f64>,
    /// Speed ratio of the first node of the link towards the parent.
    pub link_ratio: Vec<f64>,
    /// Inertias times ratio² \[kg m²\].
    pub inertia: Vec<f64>,
    /// Damping against the ground times ratio² \[N m s/rad\].
    pub damping: Vec<f64>,
    /// Stiffness against the ground times ratio² \[N m/rad\].
    pub ground: Vec<f64>,
    /// Stiffness of the link towards the parent \[N m/rad\]; infinite when rigid; of the root: zero.
    pub k: Vec<f64>,
    /// Damping of the link towards the parent \[N m s/rad\].
    pub c: Vec<f64>,
    /// Loss factor of the link towards the parent.
    pub eta: Vec<f64>,
    /// Whether it is a chain: every parent stands right behind.
    pub chain: bool,
}

/// The system has no unique answer at this frequency: an undamped resonance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resonance;

/// Work arrays of [`Tree::solve`].
#[derive(Debug, Clone, Default)]
pub struct Work {
    s: Vec<Complex>,
    f: Vec<Complex>,
    t: Vec<Complex>,
    inv: Vec<Complex>,
    kappa: Vec<Complex>,
    magnitude: Vec<f64>,
    /// Child whose pivot is (nearly) zero, to be eliminated together with this node.
    late: Vec<usize>,
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
            inv: z.clone(),
            kappa: z,
            magnitude: vec![0.0; n],
            late: vec![NONE; n],
        }
    }
}

/// What happens at a pivot that vanishes to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Singular {
    /// The answer is refused.
    Refuse,
    /// The pivot is moved by rounding: inverse iteration wants the large answer.
    Perturb,
}

/// A pivot smaller than this part of its terms is eliminated together with the parent.
const SMALL: f64 = 1e-6;
/// A last pivot smaller than this part of its terms has no digit left that is worth having.
const VANISHED: f64 = 1e-12;

impl Tree {
    /// Orders a line for elimination. Links are linearised about zero mean torque at zero frequency (see [`Tree::linearise`]).
    ///
    /// # Errors
    /// No inertia, links that join a node with itself, close a loop or leave the line in pieces, ratios that are not numbers.
    pub fn new(line: &Line) -> Result<Self, BuildError> {
        let n = line.nodes.len();
        if n == 0 {
            return Err(BuildError::at("inertias", "a shaft line needs at least one inertia"));
        }
        let mut at = vec![Vec::new(); n];
        for (l, link) in line.links.iter().enumerate() {
            let [a, b] = link.nodes;
            if a == b || a >= n || b >= n {
                let what = format!("`{}` joins an inertia with itself or with none", link.name);
                return Err(BuildError::at(format!("links.{l}"), what));
            }
            at[a].push((b, l));
            at[b].push((a, l));
        }
        // The root is the last node that ends the line, so that a chain keeps its order.
        let root = (0..n).rev().find(|&i| at[i].len() <= 1).unwrap_or(n - 1);
        let (mut parent_of, mut link_of) = (vec![NONE; n], vec![NONE; n]);
        let mut seen = vec![false; n];
        let mut order = Vec::with_capacity(n);
        let mut stack = vec![root];
        seen[root] = true;
        while let Some(i) = stack.pop() {
            order.push(i);
            for &(j, l) in &at[i] {
                if l == link_of[i] {
                    continue;
                }
                if seen[j] {
                    let what = format!(
                        "`{}` closes a loop of links: only lines with branches are treated, a link joins two parts that nothing else joins",
                        line.links[l].name
                    );
                    return Err(BuildError::at(format!("links.{l}"), what));
                }
                seen[j] = true;
                parent_of[j] = i;
                link_of[j] = l;
                stack.push(j);
            }
        }
        if let Some(lost) = seen.iter().position(|s| !s) {
            let what = format!("`{}` is not connected with the rest", line.nodes[lost].name);
            return Err(BuildError::at(format!("inertias.{lost}"), what)
                .help("a link joins two inertias; every inertia needs one"));
        }
        order.reverse();
        let mut position = vec![0; n];
        for (p, &i) in order.iter().enumerate() {
            position[i] = p;
        }
        let mut tree =
            Self {
                parent: order
                    .iter()
                    .map(|&i| if parent_of[i] == NONE { NONE } else { position[parent_of[i]] })
                    .collect(),
                link: order.iter().map(|&i| link_of[i]).collect(),
                forward: order
                    .iter()
                    .map(|&i| link_of[i] != NONE && line.links[link_of[i]].nodes[0] == i)
                    .collect(),
                ratio: order.iter().map(|&i| line.nodes[i].ratio).collect(),
                link_ratio: order
                    .iter()
                    .map(|&i| {
                        if link_of[i] == NONE {
                            1.0
                        } else {
                            line.nodes[line.links[link_of[i]].nodes[0]].ratio
                        }
                    })
                    .collect(),
                inertia: Vec::new(),
                damping: Vec::new(),
                ground: Vec::new(),
                k: vec![0.0; n],
                c: vec![0.0; n],
                eta: vec![0.0; n],
                chain: false,
                position,
                node: order,
            };
        tree.chain = tree.parent.iter().enumerate().all(|(p, &q)| q == p + 1 || q == NONE);
        for (p, &i) in tree.node.iter().enumerate() {
            let node = &line.nodes[i];
            let r2 = tree.ratio[p] * tree.ratio[p];
            for (name, v) in [
                ("inertia", line.mean_inertia(i)),
                ("damping", node.damping),
                ("ground", node.ground),
                ("ratio", node.ratio),
            ] {
                let bad = !v.is_finite()
                    || (name == "inertia" || name == "ground") && v < 0.0
                    || name == "ratio" && v == 0.0;
                if bad {
                    let what = format!("{name} of `{}` is {v}", node.name);
                    return Err(BuildError::at(format!("inertias.{i}.{name}"), what));
                }
            }
            tree.inertia.push(line.mean_inertia(i) * r2);
            tree.damping.push(node.damping * r2);
            tree.ground.push(node.ground * r2);
        }
        if tree.inertia.iter().all(|j| *j == 0.0) {
            return Err(BuildError::at("inertias", "all inertias are zero: nothing can vibrate"));
        }
        tree.linearise(line, 0.0, &[]);
        for p in 0..n {
            let (k, c, eta) = (tree.k[p], tree.c[p], tree.eta[p]);
            if k.is_nan() || k < 0.0 || !c.is_finite() || !eta.is_finite() {
                let what = format!("stiffness {k}, damping {c}, loss factor {eta} cannot be");
                return Err(BuildError::at(format!("links.{}", tree.link[p]), what));
            }
        }
        Ok(tree)
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.node.len()
    }

    /// Whether there is no node; never so for one that was built.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.node.is_empty()
    }

    /// Takes the coefficients of the links at angular frequency `omega` about mean torques by link (empty: none).
    pub fn linearise(&mut self, line: &Line, omega: f64, mean_torque: &[f64]) {
        for p in 0..self.len() {
            let l = self.link[p];
            if l == NONE {
                continue;
            }
            let mean = mean_torque.get(l).copied().unwrap_or(0.0);
            let v = line.links[l].coupling.linear(omega, mean);
            let r2 = self.link_ratio[p] * self.link_ratio[p];
            self.k[p] = v.stiffness * r2;
            self.c[p] = v.damping * r2;
            self.eta[p] = v.loss_factor;
        }
    }

    /// Whether any node is held against the ground.
    #[must_use]
    pub fn is_grounded(&self) -> bool {
        self.ground.iter().any(|g| *g != 0.0)
    }

    /// The sum of all inertias, as the reference shaft feels it \[kg m²\].
    #[must_use]
    pub fn total_inertia(&self) -> f64 {
        self.inertia.iter().sum()
    }

    /// Number of undamped eigenvalues ω² below `lambda` \[1/s²\].
    #[must_use]
    pub fn count_below(&self, lambda: f64, s: &mut [f64]) -> usize {
        for ((s, j), g) in s.iter_mut().zip(&self.inertia).zip(&self.ground) {
            *s = g - lambda * j;
        }
        let n = self.len();
        let mut count = 0;
        for i in 0..n {
            let (k, own) = (self.k[i], s[i]);
            let p = self.parent[i];
            if p == NONE {
                count += usize::from(own < 0.0);
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
        count
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
            let loss = if z.im < 0.0 { -self.eta[i] } else { self.eta[i] };
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
        let z2 = z * z;
        let real = |v: f64| Complex::new(v, 0.0);
        let one = real(1.0);
        for i in 0..n {
            let own = real(self.damping[i]) * z + real(self.inertia[i]) * z2;
            work.s[i] = real(self.ground[i]) + own;
            work.magnitude[i] = self.ground[i] + own.norm1();
            work.f[i] = torque[i];
            work.late[i] = NONE;
            let loss = if z.im < 0.0 { -self.eta[i] } else { self.eta[i] };
            work.kappa[i] = Complex::new(self.k[i], self.k[i] * loss) + real(self.c[i]) * z;
        }
        for i in 0..n {
            let p = self.parent[i];
            let (s, f, c) = (work.s[i], work.f[i], work.late[i]);
            if p != NONE && self.k[i] == f64::INFINITY {
                work.s[p] = work.s[p] + s;
                work.f[p] = work.f[p] + f;
                work.magnitude[p] += work.magnitude[i];
                if c != NONE {
                    if work.late[p] != NONE {
                        return Err(Resonance);
                    }
                    work.late[p] = c;
                }
                continue;
            }
            let kappa = if p == NONE { Complex::default() } else { work.kappa[i] };
            if c != NONE {
                // A child that is in resonance when this node is held: both are eliminated at once.
                let (dc, kc, fc) = (work.kappa[c] + work.s[c], work.kappa[c], work.f[c]);
                let e = s + kc + kappa;
                let (left, right) = (dc * e, kc * kc);
                let det = left - right;
                if det.norm1() <= VANISHED * (left.norm1() + right.norm1()) {
                    return Err(Resonance);
                }
                let inv = one / det;
                work.inv[i] = inv;
                work.t[i] = kappa * dc * inv;
                if p != NONE {
                    work.s[p] = work.s[p] + kappa * (dc * (s + kc) - right) * inv;
                    work.f[p] = work.f[p] + kappa * (dc * f + kc * fc) * inv;
                    work.magnitude[p] += kappa.norm1();
                }
                continue;
            }
            let mut d = kappa + s;
            let size = if p == NONE { work.magnitude[i] } else { kappa.norm1() + work.magnitude[i] };
            if p == NONE {
                if d.norm1() <= VANISHED * size {
                    if singular == Singular::Refuse {
                        return Err(Resonance);
                    }
                    if d.norm1() < f64::EPSILON * size {
                        d = real(f64::EPSILON * size);
                    }
                }
            } else if d.norm1() < SMALL * size {
                if size == 0.0 {
                    return Err(Resonance);
                }
                if singular == Singular::Perturb {
                    if d.norm1() < f64::EPSILON * size {
                        d = real(f64::EPSILON * size);
                    }
                } else if work.late[p] == NONE {
                    work.late[p] = i;
                    continue;
                } else if d.norm1() <= VANISHED * size {
                    // Two such children vibrate against each other while the parent stands still.
                    return Err(Resonance);
                }
            }
            let inv = one / d;
            work.inv[i] = inv;
            if p != NONE {
                let t = kappa * inv;
                work.t[i] = t;
                let series = t * s;
                work.s[p] = work.s[p] + series;
                work.f[p] = work.f[p] + t * f;
                work.magnitude[p] += series.norm1();
            }
        }
        for i in (0..n).rev() {
            let p = self.parent[i];
            let above = if p == NONE { Complex::default() } else { angle[p] };
            if p != NONE && self.k[i] == f64::INFINITY {
                angle[i] = above;
                continue;
            }
            let c = work.late[i];
            if c != NONE {
                let (dc, kc, fc) = (work.kappa[c] + work.s[c], work.kappa[c], work.f[c]);
                let kappa = if p == NONE { Complex::default() } else { work.kappa[i] };
                let f = work.f[i] + kappa * above;
                let e = work.s[i] + kc + kappa;
                angle[i] = (dc * f + kc * fc) * work.inv[i];
                angle[c] = (e * fc + kc * f) * work.inv[i];
                continue;
            }
            if p != NONE && work.late[p] == i {
                // Found together with its parent.
                continue;
            }
            angle[i] =
                if p == NONE { work.f[i] * work.inv[i] } else { work.f[i] * work.inv[i] + work.t[i] * above };
        }
        for i in 0..n {
            transmitted[i] = if self.parent[i] == NONE {
                Complex::default()
            } else {
                let c = work.late[i];
                let rest = work.f[i] - work.s[i] * angle[i];
                // A child that was not condensed into this node acts by its link.
                if c == NONE { rest } else { rest + work.kappa[c] * (angle[c] - angle[i]) }
            };
        }
        Ok(())
    }

    /// The line as it is without damping.
    #[must_use]
    pub fn undamped(&self) -> Self {
        let n = self.len();
        Self { damping: vec![0.0; n], c: vec![0.0; n], eta: vec![0.0; n], ..self.clone() }
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
