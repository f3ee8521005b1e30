//! Small strictly convex quadratic programs by the dual active-set method (`goldfarb1983`).

/// Variables of a program.
pub const VARIABLES: usize = 3;

/// Maximum number of constraints of a program.
pub const MAX_CONSTRAINTS: usize = 16;

/// `a·x <= b`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HalfSpace {
    /// Normal, pointing out of the admitted side.
    pub a: [f64; VARIABLES],
    /// Bound.
    pub b: f64,
}

/// Minimiser and multipliers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Minimum {
    /// The point.
    pub x: [f64; VARIABLES],
    /// A multiplier of zero or more for each constraint; those of inactive constraints are zero.
    pub multipliers: [f64; MAX_CONSTRAINTS],
}

/// Why there is no minimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum QpError {
    /// The Hessian is not positive definite.
    #[error("the Hessian is not positive definite")]
    NotConvex,
    /// The constraints contradict each other.
    #[error("the constraints contradict each other")]
    Infeasible,
    /// Rounding keeps the method from ending, or there are too many constraints.
    #[error("the active set does not settle")]
    Stalled,
}

/// Inverse of a symmetric positive definite matrix by its factors `L D Lᵀ`; `None` when it is not.
#[must_use]
pub fn inverse(h: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    // The reciprocal of a pivot; one lost to rounding counts as zero.
    let reciprocal = |pivot: f64, i: usize| (pivot > 1e-14 * h[i][i].abs()).then(|| 1.0 / pivot);
    let r0 = reciprocal(h[0][0], 0)?;
    let (l10, l20) = (h[1][0] * r0, h[2][0] * r0);
    let r1 = reciprocal(h[1][1] - l10 * h[1][0], 1)?;
    let below = h[2][1] - l20 * h[1][0];
    let l21 = below * r1;
    let r2 = reciprocal(h[2][2] - l20 * h[2][0] - l21 * below, 2)?;
    // The inverse of L has ones on its diagonal and these below.
    let (u10, u20, u21) = (-l10, l10 * l21 - l20, -l21);
    let (s20, s21) = (u20 * r2, u21 * r2);
    let (i01, i11) = (u10 * r1 + u20 * s21, r1 + u21 * s21);
    Some([[r0 + u10 * u10 * r1 + u20 * s20, i01, s20], [i01, i11, s21], [s20, s21, r2]])
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn apply(m: &[[f64; 3]; 3], v: &[f64; 3]) -> [f64; 3] {
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v)]
}

/// Solves the leading `n` rows of `m x = r` by elimination with pivots; `None` when singular.
///
/// Not [`crate::linalg::lu_factor`]: with it a program takes 2 % longer, and one in seven differs by rounding.
#[must_use]
pub fn solve(m: [[f64; 3]; 3], r: [f64; 3], n: usize) -> Option<[f64; 3]> {
    match n {
        0 => Some([0.0; 3]),
        1 => solve_rows::<1>(m, r),
        2 => solve_rows::<2>(m, r),
        _ => solve_rows::<3>(m, r),
    }
}

/// As [`solve`], its loops written out by the compiler.
#[inline]
fn solve_rows<const N: usize>(mut m: [[f64; 3]; 3], mut r: [f64; 3]) -> Option<[f64; 3]> {
    for c in 0..N {
        let mut p = c;
        for i in c + 1..N {
            // The last of several of one size.
            p = if m[i][c].abs() >= m[p][c].abs() { i } else { p };
        }
        let pivot = m[p][c].abs();
        if pivot.is_nan() || pivot < f64::MIN_POSITIVE {
            return None;
        }
        m.swap(c, p);
        r.swap(c, p);
        for i in c + 1..N {
            let f = m[i][c] / m[c][c];
            for k in c + 1..N {
                m[i][k] -= f * m[c][k];
            }
            r[i] -= f * r[c];
        }
    }
    let mut x = [0.0; 3];
    for i in (0..N).rev() {
        let mut sum = 0.0;
        for k in i + 1..N {
            sum += m[i][k] * x[k];
        }
        x[i] = (r[i] - sum) / m[i][i];
    }
    Some(x)
}

/// Constraints that hold with equality, in the order they came, with their multipliers.
#[derive(Default)]
struct ActiveSet {
    index: [usize; VARIABLES],
    u: [f64; VARIABLES],
    len: usize,
}

impl ActiveSet {
    #[inline]
    fn indices(&self) -> &[usize] {
        &self.index[..self.len]
    }

    #[inline]
    fn push(&mut self, index: usize, u: f64) {
        (self.index[self.len], self.u[self.len]) = (index, u);
        self.len += 1;
    }

    /// A point with the multipliers of all constraints.
    fn minimum(&self, x: [f64; 3]) -> Minimum {
        let mut multipliers = [0.0; MAX_CONSTRAINTS];
        for (&k, u) in self.indices().iter().zip(self.u) {
            multipliers[k] = u;
        }
        Minimum { x, multipliers }
    }

    /// Takes out the constraint in place `j`; the others move up.
    #[inline]
    fn remove(&mut self, j: usize) {
        for j in j + 1..self.len {
            (self.index[j - 1], self.u[j - 1]) = (self.index[j], self.u[j]);
        }
        self.len -= 1;
    }

    /// The constraint violated most, by its own scale, among those that are not active.
    #[inline]
    fn violated(&self, constraints: &[HalfSpace], x: &[f64; 3]) -> Option<usize> {
        let mut worst = (0.0, None);
        let active = self.indices().iter().fold(0_u32, |active, k| active | 1 << k);
        for (k, c) in constraints.iter().enumerate() {
            if active >> k & 1 == 1 {
                continue;
            }
            let excess = dot(&c.a, x) - c.b;
            if excess <= 0.0 {
                continue;
            }
            let size = dot(&c.a, &c.a).sqrt().max(f64::MIN_POSITIVE);
            let by = excess / size;
            if by > worst.0 && by > 1e-15 * (1.0 + c.b.abs() / size) {
                worst = (by, Some(k));
            }
        }
        worst.1
    }

    /// For the normal `n` of a constraint, and `hn = h⁻¹ n`: the direction in which it is approached along the active ones, and the rates
    /// at which their multipliers fall.
    #[inline]
    fn direction(
        &self,
        inv: &[[f64; 3]; 3],
        constraints: &[HalfSpace],
        n: &[f64; 3],
        hn: [f64; 3],
    ) -> Option<([f64; 3], [f64; 3])> {
        let inward = |k: usize| constraints[k].a.map(|v| -v);
        let mut gram = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        let mut across = [[0.0; 3]; 3];
        for (i, &k) in self.indices().iter().enumerate() {
            let hi = apply(inv, &inward(k));
            across[i] = hi;
            for (j, &k) in self.indices().iter().enumerate() {
                gram[i][j] = dot(&hi, &inward(k));
            }
            right[i] = dot(&hi, n);
        }
        let r = solve(gram, right, self.len)?;
        let mut z = hn;
        for (rj, hj) in r.iter().zip(across).take(self.len) {
            for (zi, hji) in z.iter_mut().zip(hj) {
                *zi -= rj * hji;
            }
        }
        Some((z, r))
    }

    /// The longest step before a multiplier that falls at the rate `r` reaches zero, and its place.
    #[inline]
    fn longest(&self, r: &[f64; 3]) -> (f64, usize) {
        let mut longest = (f64::INFINITY, 0);
        for j in 0..self.len {
            if r[j] > 0.0 && self.u[j] / r[j] < longest.0 {
                longest = (self.u[j] / r[j], j);
            }
        }
        longest
    }
}

/// Minimises `½ xᵀ h x + gᵀ x` subject to `constraints`. Allocates nothing.
///
/// # Errors
/// [`QpError`].
pub fn minimise(h: &[[f64; 3]; 3], g: &[f64; 3], constraints: &[HalfSpace]) -> Result<Minimum, QpError> {
    minimise_with(&inverse(h).ok_or(QpError::NotConvex)?, g, constraints)
}

fn minimise_with(inv: &[[f64; 3]; 3], g: &[f64; 3], constraints: &[HalfSpace]) -> Result<Minimum, QpError> {
    if constraints.len() > MAX_CONSTRAINTS {
        return Err(QpError::Stalled);
    }
    let mut x = apply(inv, g).map(|v| -v);
    let mut active = ActiveSet::default();
    for _ in 0..20 * (constraints.len() + 1) {
        let Some(p) = active.violated(constraints, &x) else {
            return Ok(active.minimum(x));
        };
        satisfy(p, inv, constraints, &mut x, &mut active)?;
    }
    Err(QpError::Stalled)
}

/// As [`minimise`] of a matrix with its [`inverse`], where some constraints, at most [`VARIABLES`], are thought to hold with equality: the minimum over
/// those is taken at once where it is that of the program.
///
/// # Errors
/// [`QpError`].
pub fn minimise_near(
    (h, inv): (&[[f64; 3]; 3], &[[f64; 3]; 3]),
    g: &[f64; 3],
    constraints: &[HalfSpace],
    guess: &[usize],
) -> Result<Minimum, QpError> {
    if constraints.len() > MAX_CONSTRAINTS {
        return Err(QpError::Stalled);
    }
    match over_equalities((h, inv), g, constraints, guess) {
        Some(minimum) => Ok(minimum),
        None => minimise_with(inv, g, constraints),
    }
}

/// The minimum where the constraints `guess` hold with equality; none where it breaks another one or a multiplier is negative.
fn over_equalities(
    (h, inv): (&[[f64; 3]; 3], &[[f64; 3]; 3]),
    g: &[f64; 3],
    constraints: &[HalfSpace],
    guess: &[usize],
) -> Option<Minimum> {
    let mut active = ActiveSet::default();
    let mut bound = [0.0; 3];
    for (i, k) in guess.iter().enumerate() {
        bound.get_mut(i).map(|b| *b = constraints[*k].b)?;
        active.push(*k, 0.0);
    }
    let n = active.len;
    let normal = |i: usize| constraints[active.index[i]].a;
    let x = if n == VARIABLES {
        // A corner, whatever the function: its multipliers are those of its slope there.
        let x = solve([normal(0), normal(1), normal(2)], bound, n)?;
        let slope: [f64; 3] = std::array::from_fn(|i| -(dot(&h[i], &x) + g[i]));
        active.u = solve(std::array::from_fn(|i| std::array::from_fn(|j| normal(j)[i])), slope, n)?;
        x
    } else {
        let mut x = apply(inv, g).map(|v| -v);
        let mut across = [[0.0; 3]; 3];
        (0..n).for_each(|i| across[i] = apply(inv, &normal(i)));
        let (mut gram, mut beyond) = ([[0.0; 3]; 3], [0.0; 3]);
        for i in 0..n {
            (0..n).for_each(|j| gram[i][j] = dot(&across[i], &normal(j)));
            beyond[i] = dot(&normal(i), &x) - bound[i];
        }
        active.u = solve(gram, beyond, n)?;
        for i in 0..n {
            (0..3).for_each(|k| x[k] -= active.u[i] * across[i][k]);
        }
        x
    };
    let right = active.u[..n].iter().all(|u| *u > 0.0) && x.iter().all(|x| x.is_finite());
    (right && active.violated(constraints, &x).is_none()).then(|| active.minimum(x))
}

/// Goes to the minimum over the active constraints and constraint `p`, which joins them; others may leave on the way.
#[inline]
fn satisfy(
    p: usize,
    inv: &[[f64; 3]; 3],
    constraints: &[HalfSpace],
    x: &mut [f64; 3],
    active: &mut ActiveSet,
) -> Result<(), QpError> {
    let n = constraints[p].a.map(|v| -v);
    let hn = apply(inv, &n);
    let mut up = 0.0;
    loop {
        let (z, r) = active.direction(inv, constraints, &n, hn).ok_or(QpError::Stalled)?;
        let zn = dot(&z, &n);
        // Nothing is left of the direction when the normals depend on each other.
        let free = active.len < VARIABLES && zn > 1e-13 * dot(&hn, &n);
        let partial = active.longest(&r);
        let full = if free { (dot(&constraints[p].a, x) - constraints[p].b) / zn } else { f64::INFINITY };
        let t = partial.0.min(full);
        if !t.is_finite() {
            return Err(QpError::Infeasible);
        }
        if free {
            for (xi, zi) in x.iter_mut().zip(z) {
                *xi += t * zi;
            }
        }
        for j in 0..active.len {
            // The step ends where the first of them reaches zero: below lies rounding.
            active.u[j] = (active.u[j] - t * r[j]).max(0.0);
        }
        up += t;
        if full <= partial.0 {
            active.push(p, up);
            return Ok(());
        }
        active.remove(partial.1);
    }
}
