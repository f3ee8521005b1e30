//! Small strictly convex quadratic programs by the dual active-set method (`goldfarb1983`).

/// Variables of a program.
pub const VARIABLES: usize = 3;

/// Most constraints of a program.
pub const MOST_CONSTRAINTS: usize = 32;

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
    pub multipliers: [f64; MOST_CONSTRAINTS],
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

/// Inverse of a symmetric positive definite matrix by its Cholesky factor; `None` when it is not.
#[must_use]
pub fn inverse(h: &[[f64; 3]; 3]) -> Option<[[f64; 3]; 3]> {
    let mut l = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..=i {
            let s = h[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            if i == j {
                // A pivot lost to rounding counts as zero.
                if s.is_nan() || s <= 1e-14 * h[i][i].abs() {
                    return None;
                }
                l[i][i] = s.sqrt();
            } else {
                l[i][j] = s / l[j][j];
            }
        }
    }
    let mut out = [[0.0; 3]; 3];
    for c in 0..3 {
        let mut y = [0.0; 3];
        for i in 0..3 {
            let e = if i == c { 1.0 } else { 0.0 };
            y[i] = (e - (0..i).map(|k| l[i][k] * y[k]).sum::<f64>()) / l[i][i];
        }
        for i in (0..3).rev() {
            y[i] = (y[i] - (i + 1..3).map(|k| l[k][i] * y[k]).sum::<f64>()) / l[i][i];
        }
        for i in 0..3 {
            out[i][c] = y[i];
        }
    }
    Some(out)
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn apply(m: &[[f64; 3]; 3], v: &[f64; 3]) -> [f64; 3] {
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v)]
}

/// Solves the leading `n` rows of `m x = r` by elimination with pivots; `None` when singular.
#[must_use]
pub fn solve(mut m: [[f64; 3]; 3], mut r: [f64; 3], n: usize) -> Option<[f64; 3]> {
    for c in 0..n {
        let p = (c..n).max_by(|&i, &j| m[i][c].abs().total_cmp(&m[j][c].abs()))?;
        if m[p][c].abs() < f64::MIN_POSITIVE {
            return None;
        }
        m.swap(c, p);
        r.swap(c, p);
        for i in c + 1..n {
            let f = m[i][c] / m[c][c];
            for k in c..n {
                m[i][k] -= f * m[c][k];
            }
            r[i] -= f * r[c];
        }
    }
    let mut x = [0.0; 3];
    for i in (0..n).rev() {
        x[i] = (r[i] - (i + 1..n).map(|k| m[i][k] * x[k]).sum::<f64>()) / m[i][i];
    }
    Some(x)
}

/// Minimises `½ xᵀ h x + gᵀ x` subject to `constraints`. Allocates nothing.
///
/// # Errors
/// [`QpError`].
pub fn minimise(h: &[[f64; 3]; 3], g: &[f64; 3], constraints: &[HalfSpace]) -> Result<Minimum, QpError> {
    if constraints.len() > MOST_CONSTRAINTS {
        return Err(QpError::Stalled);
    }
    let inv = inverse(h).ok_or(QpError::NotConvex)?;
    let mut x = apply(&inv, g).map(|v| -v);
    // Active constraints in the order they came, with their multipliers.
    let (mut active, mut u, mut q) = ([0usize; 3], [0.0; 3], 0usize);
    for _ in 0..20 * (constraints.len() + 1) {
        // The constraint violated most, by its own scale.
        let mut worst = (0.0, usize::MAX);
        for (k, c) in constraints.iter().enumerate() {
            if active[..q].contains(&k) {
                continue;
            }
            let size = dot(&c.a, &c.a).sqrt().max(f64::MIN_POSITIVE);
            let by = (dot(&c.a, &x) - c.b) / size;
            if by > worst.0 && by > 1e-15 * (1.0 + c.b.abs() / size) {
                worst = (by, k);
            }
        }
        let p = worst.1;
        if p == usize::MAX {
            let mut multipliers = [0.0; MOST_CONSTRAINTS];
            for j in 0..q {
                multipliers[active[j]] = u[j];
            }
            return Ok(Minimum { x, multipliers });
        }
        let n = constraints[p].a.map(|v| -v);
        let mut up = 0.0;
        loop {
            // Direction in primal space and its effect on the multipliers.
            let hn = apply(&inv, &n);
            let mut gram = [[0.0; 3]; 3];
            let mut right = [0.0; 3];
            for i in 0..q {
                let hi = apply(&inv, &constraints[active[i]].a.map(|v| -v));
                for j in 0..q {
                    gram[i][j] = dot(&hi, &constraints[active[j]].a.map(|v| -v));
                }
                right[i] = dot(&hi, &n);
            }
            let r = solve(gram, right, q).ok_or(QpError::Stalled)?;
            let mut z = hn;
            for j in 0..q {
                let hj = apply(&inv, &constraints[active[j]].a.map(|v| -v));
                for (zi, hji) in z.iter_mut().zip(hj) {
                    *zi -= r[j] * hji;
                }
            }
            let zn = dot(&z, &n);
            // Nothing is left of the direction when the normals depend on each other.
            let free = q < VARIABLES && zn > 1e-13 * dot(&hn, &n);
            let mut partial = (f64::INFINITY, 0usize);
            for j in 0..q {
                if r[j] > 0.0 && u[j] / r[j] < partial.0 {
                    partial = (u[j] / r[j], j);
                }
            }
            let full =
                if free { (dot(&constraints[p].a, &x) - constraints[p].b) / zn } else { f64::INFINITY };
            let t = partial.0.min(full);
            if !t.is_finite() {
                return Err(QpError::Infeasible);
            }
            if free {
                for (xi, zi) in x.iter_mut().zip(z) {
                    *xi += t * zi;
                }
            }
            for j in 0..q {
                // The step ends where the first of them reaches zero: below lies rounding.
                u[j] = (u[j] - t * r[j]).max(0.0);
            }
            up += t;
            if full <= partial.0 {
                (active[q], u[q]) = (p, up);
                q += 1;
                break;
            }
            // The multiplier that reached zero leaves; the others move up.
            for j in partial.1 + 1..q {
                (active[j - 1], u[j - 1]) = (active[j], u[j]);
            }
            q -= 1;
        }
    }
    Err(QpError::Stalled)
}
