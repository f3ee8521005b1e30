//! Undamped and damped eigenvalues of a [`Tree`], with shapes.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::Mode;
use gudgeon_numerics::linalg::Complex;

use crate::tree::{Singular, Tree, Work};

/// Parts of the line that no stiffness joins to each other: for each position that of its part nearest to the root.
#[must_use]
pub fn parts(tree: &Tree) -> Vec<usize> {
    let n = tree.len();
    let mut part: Vec<usize> = (0..n).collect();
    for i in (0..n).rev() {
        if tree.parent[i] < n && tree.k[i] > 0.0 {
            part[i] = part[tree.parent[i]];
        }
    }
    part
}

/// Number of rigid modes: parts of the line that no stiffness joins to each other or to the ground.
#[must_use]
pub fn rigid_modes(tree: &Tree) -> usize {
    let n = tree.len();
    // A part is free when none of its nodes is held.
    let part = parts(tree);
    let (mut held, mut heavy) = (vec![false; n], vec![false; n]);
    for i in 0..n {
        held[part[i]] |= tree.ground[i] != 0.0;
        heavy[part[i]] |= tree.inertia[i] != 0.0;
    }
    (0..n).filter(|&p| part[p] == p && !held[p] && heavy[p]).count()
}

/// Squared frequencies of a chain by the differences of its shafts: the matrix `k_i (1/J_i + 1/J_{i+1})` with `√(k_i k_{i+1})/J_{i+1}`
/// beside the diagonal has the eigenvalues of the line without the rigid mode. By the root-free QL method (reinsch1973); errors are of
/// the order of rounding times the largest value. `a`, `b` are the work arrays, `a` receives the values in no order.
fn chain_values(inertia: &[f64], k: &[f64], a: &mut [f64], b: &mut [f64]) -> Result<(), EvalError> {
    let m = k.len();
    for i in 0..m {
        a[i] = k[i] * (1.0 / inertia[i] + 1.0 / inertia[i + 1]);
        // Squares of the off-diagonal, b[i] between i and i + 1.
        b[i] = if i + 1 < m { k[i] * k[i + 1] / (inertia[i + 1] * inertia[i + 1]) } else { 0.0 };
    }
    for l in 0..m {
        let mut iterations = 0;
        loop {
            let mut end = l;
            while end + 1 < m {
                let size = a[end].abs() + a[end + 1].abs();
                if b[end] <= (f64::EPSILON * size) * (f64::EPSILON * size) {
                    break;
                }
                end += 1;
            }
            if end == l {
                break;
            }
            iterations += 1;
            if iterations > 60 {
                return Err(EvalError::fatal("eigenvalues", "the QL iteration does not converge"));
            }
            // Shift from the leading 2 x 2 block, then one implicit sweep on squares (Pal, Walker and Kahan).
            let g = b[l].sqrt();
            let x = (a[l + 1] - a[l]) / (2.0 * g);
            let r = x.hypot(1.0);
            let sigma = a[l] - g / (x + r.copysign(x));
            let (mut c, mut s) = (1.0, 0.0);
            let mut gamma = a[end] - sigma;
            let mut p = gamma * gamma;
            for i in (l..end).rev() {
                let bb = b[i];
                let r = p + bb;
                if i + 1 < end {
                    b[i + 1] = s * r;
                }
                let old = c;
                c = p / r;
                s = bb / r;
                let old_gamma = gamma;
                let alpha = a[i];
                gamma = c * (alpha - sigma) - s * old_gamma;
                a[i + 1] = old_gamma + (alpha - gamma);
                p = if c == 0.0 { old * bb } else { gamma * gamma / c };
            }
            b[l] = s * p;
            a[l] = sigma + gamma;
        }
    }
    Ok(())
}

/// Undamped natural frequencies ω \[rad/s\], ascending, at most `most` of them, those of the rigid modes exactly zero.
///
/// Chains: root-free QL on the shafts' differences. Values far below the largest, and all values of branched or held lines, come
/// from bisection by counts of negative pivots, to the last digit (see [`crate::tree`]).
///
/// # Errors
/// No convergence (Fatal).
pub fn natural_frequencies(tree: &Tree, most: usize) -> Result<Vec<f64>, EvalError> {
    let n = tree.len();
    // A chain that turns freely, without inertias of zero, rigid links and links of fluid alone: one rigid mode.
    let plain = tree.chain
        && n > 1
        && !tree.is_grounded()
        && tree.inertia.iter().all(|j| *j > 0.0)
        && tree.k[..n - 1].iter().all(|k| k.is_finite() && *k > 0.0);
    let mut squares;
    if plain {
        // The zero, the values, and room for the off-diagonal.
        squares = vec![0.0; 2 * n - 1];
        let (a, b) = squares[1..].split_at_mut(n - 1);
        chain_values(&tree.inertia, &tree.k[..n - 1], a, b)?;
        a.sort_unstable_by(f64::total_cmp);
        let top = a[n - 2];
        squares.truncate(most.min(n));
        refine(tree, &mut squares, 10.0 * f64::EPSILON * top);
    } else {
        let mut s = vec![0.0; n];
        // Every inertia that moves by itself has a mode.
        let rigid = rigid_modes(tree);
        let all = tree.count_below(f64::MAX.sqrt(), &mut s).max(rigid);
        squares = vec![0.0; all.min(most)];
        let upto = squares.len();
        bisect(tree, rigid, upto, &mut squares);
    }
    Ok(squares.iter().map(|v| v.sqrt()).collect())
}

/// Takes the error `bound` of the values of a chain out of those it matters for.
fn refine(tree: &Tree, squares: &mut [f64], bound: f64) {
    for k in 1..squares.len() {
        let v = squares[k];
        // Half of this is the relative error of the frequency.
        if v > bound * 1e12 {
            break;
        }
        let above = squares.get(k + 1).map_or(f64::INFINITY, |a| a - v);
        let gap = above.min(v - squares[k - 1]);
        let mut found = v;
        let mut good = gap > 1e4 * bound;
        for _ in 0..3 {
            if !good {
                break;
            }
            let step = tree.newton_step(found);
            if step.is_nan() || step.abs() > 10.0 * bound {
                good = false;
            } else {
                found += step;
                if step.abs() <= 1e-8 * found {
                    break;
                }
            }
        }
        if good {
            squares[k] = found;
        } else {
            bisect(tree, k, k + 1, squares);
        }
    }
}

/// Eigenvalues `from..to` by bisection.
fn bisect(tree: &Tree, from: usize, to: usize, squares: &mut [f64]) {
    let mut s = vec![0.0; tree.len()];
    if from >= to {
        return;
    }
    // Powers of two that enclose all that are wanted.
    let mut high = 1.0_f64;
    while tree.count_below(high, &mut s) < to && high < f64::MAX.sqrt() {
        high *= 1024.0;
    }
    let mut low = high;
    while tree.count_below(low, &mut s) > from && low > f64::MIN_POSITIVE.sqrt() {
        low /= 1024.0;
    }
    // Brackets are shared: a count narrows those of all eigenvalues still to come.
    let mut lows = vec![low; to];
    let mut highs = vec![high; to];
    for k in from..to {
        loop {
            let (a, b) = (lows[k], highs[k]);
            let middle = if b > 4.0 * a { (a * b).sqrt() } else { a + 0.5 * (b - a) };
            if middle <= a || middle >= b {
                break;
            }
            let count = tree.count_below(middle, &mut s);
            for j in k..to {
                if j < count {
                    highs[j] = highs[j].min(middle);
                } else {
                    lows[j] = lows[j].max(middle);
                }
                if j > count && lows[j] > middle {
                    break;
                }
            }
        }
        squares[k] = highs[k];
    }
}

/// Frequencies closer than this are one cluster, whose shapes are made orthogonal to each other.
const CLUSTER: f64 = 1e-7;

/// Shapes of undamped modes by position, scaled to `Σ J φ² = 1`, first the rigid ones.
///
/// Inverse iteration with the elimination of the tree, from vectors that are the same every time; within a cluster of equal frequencies
/// the shapes are orthogonalised.
#[must_use]
pub fn shapes(tree: &Tree, omega: &[f64]) -> Vec<Vec<f64>> {
    let n = tree.len();
    let mut work = Work::new(n);
    let mut found: Vec<Vec<f64>> = Vec::with_capacity(omega.len());
    let (mut rhs, mut x, mut t) =
        (vec![Complex::default(); n], vec![Complex::default(); n], vec![Complex::default(); n]);
    let rigid_is_whole = rigid_modes(tree) == 1;
    let bare = tree.undamped();
    for (k, &w) in omega.iter().enumerate() {
        let cluster = (0..k).rev().take_while(|&j| w - omega[j] <= CLUSTER * w).last().unwrap_or(k);
        let mut v: Vec<f64> = vec![1.0; n];
        if w > 0.0 || !rigid_is_whole {
            // A start without symmetry, different for each mode.
            let mut state = 0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(k as u64 + 1);
            for v in &mut v {
                state ^= state << 13;
                state ^= state >> 7;
                state ^= state << 17;
                *v = 0.5 + (state >> 11) as f64 / (1_u64 << 53) as f64;
            }
            // Frequencies of rigid modes are exact; a shift keeps the elimination alive.
            let scale = tree.k.iter().copied().filter(|k| k.is_finite()).fold(0.0_f64, f64::max)
                / tree.total_inertia();
            let lambda = if w > 0.0 { w * w } else { 1e-14 * scale.max(f64::MIN_POSITIVE) };
            let z = Complex::new(0.0, lambda.sqrt());
            for _ in 0..3 {
                for i in 0..n {
                    rhs[i] = Complex::new(v[i] * tree.inertia[i], 0.0);
                }
                if bare.solve(z, &rhs, &mut x, &mut t, Singular::Perturb, &mut work).is_ok() {
                    let top = x.iter().map(|x| x.re.abs()).fold(0.0, f64::max);
                    if top > 0.0 && top.is_finite() {
                        for i in 0..n {
                            v[i] = x[i].re / top;
                        }
                    }
                }
                for j in cluster..k {
                    let dot: f64 = (0..n).map(|i| tree.inertia[i] * v[i] * found[j][i]).sum();
                    for i in 0..n {
                        v[i] -= dot * found[j][i];
                    }
                }
            }
        }
        let norm = (0..n).map(|i| tree.inertia[i] * v[i] * v[i]).sum::<f64>().sqrt();
        if norm > 0.0 {
            v.iter_mut().for_each(|v| *v /= norm);
        }
        found.push(v);
    }
    found
}

/// Holzer's residual of a shape: torque left over at the end, by the largest torque on the way.
#[must_use]
pub fn holzer_residual(tree: &Tree, omega: f64, shape: &[f64]) -> f64 {
    let n = tree.len();
    let mut carried = vec![0.0; n];
    let (mut largest, mut left) = (0.0_f64, 0.0);
    for i in 0..n {
        carried[i] += (omega * omega * tree.inertia[i] - tree.ground[i]) * shape[i];
        largest = largest.max(carried[i].abs());
        match tree.parent.get(i) {
            Some(&p) if p < n => carried[p] += carried[i],
            _ => left = carried[i],
        }
    }
    if largest > 0.0 { left.abs() / largest } else { 0.0 }
}

/// Modes with shapes over the nodes of the line (the largest angle 1) and damped eigenvalues.
///
/// # Errors
/// No convergence (Fatal).
pub fn modes(tree: &Tree, most: usize, with_damping: bool) -> Result<Vec<Mode>, EvalError> {
    let omega = natural_frequencies(tree, most)?;
    let normal = shapes(tree, &omega);
    let damped = if with_damping { damped_eigenvalues(tree, &omega, &normal)? } else { Vec::new() };
    let n = tree.len();
    Ok(omega
        .iter()
        .zip(&normal)
        .enumerate()
        .map(|(k, (&w, v))| {
            let mut shape = vec![0.0; n];
            for i in 0..n {
                shape[tree.node[i]] = v[i] * tree.ratio[i];
            }
            let top = shape.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
            if top != 0.0 {
                shape.iter_mut().for_each(|x| *x /= top);
            }
            Mode {
                omega: w,
                damped: damped
                    .get(k)
                    .copied()
                    .flatten()
                    .filter(|_| w > 0.0)
                    .filter(|z| z.im > 0.0)
                    .map(|z| (-z.re, z.im)),
                shape,
                residual: holzer_residual(tree, w, v),
            }
        })
        .collect())
}

/// All eigenvalues `z` of `z² J + z C + K`, those with positive imaginary part first in each pair of a mode: see [`roots`].
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// For each mode its two eigenvalues.
    pub pairs: Vec<[Complex; 2]>,
    /// Evaluations of the determinant.
    pub evaluations: u64,
}

fn converged(step: Complex, z: Complex) -> bool {
    step.norm1() <= 8.0 * f64::EPSILON * z.norm1()
}

/// The eigenvalue of each mode with positive imaginary part, or its slower real one when the mode no longer oscillates; `None` for
/// rigid modes.
///
/// # Errors
/// No convergence (Fatal).
pub fn damped_eigenvalues(
    tree: &Tree,
    omega: &[f64],
    normal: &[Vec<f64>],
) -> Result<Vec<Option<Complex>>, EvalError> {
    let s = roots(tree, omega, normal)?;
    Ok(s.pairs.iter().zip(omega).map(|(p, w)| (*w > 0.0).then_some(p[0])).collect())
}

/// Modal damping `φᵀ C φ` of a shape with unit modal inertia, the loss factors as equivalent viscous damping.
#[must_use]
pub fn modal_damping(tree: &Tree, omega: f64, v: &[f64]) -> f64 {
    let n = tree.len();
    let mut sum = 0.0;
    for i in 0..n {
        sum += tree.damping[i] * v[i] * v[i];
        if tree.parent[i] < n && tree.k[i].is_finite() {
            let d = v[i] - v[tree.parent[i]];
            let loss = if omega > 0.0 { tree.k[i] * tree.eta[i] / omega } else { 0.0 };
            sum += (tree.c[i] + loss) * d * d;
        }
    }
    sum
}

/// Eigenvalues of the damped line: Newton's method on the determinant, which the tree gives with its derivative in linear time, from
/// the undamped modes; where that does not find every eigenvalue once, all are corrected together (aberth1973).
///
/// # Errors
/// No convergence (Fatal).
pub fn roots(tree: &Tree, omega: &[f64], normal: &[Vec<f64>]) -> Result<Spectrum, EvalError> {
    let mut work = Work::new(tree.len());
    let mut evaluations = 0;
    let m = omega.len();
    let damping: Vec<f64> = omega.iter().zip(normal).map(|(w, v)| modal_damping(tree, *w, v)).collect();
    let mut pairs = vec![[Complex::default(); 2]; m];
    let multiplicity: Vec<f64> = omega
        .iter()
        .map(|w| omega.iter().filter(|o| (**o - w).abs() <= CLUSTER * w).count() as f64)
        .collect();
    // Rigid modes: zero, and the rate at which the whole slows down.
    let drag: f64 = tree.damping.iter().sum();
    let mut simple = true;
    for k in 0..m {
        let (w, c) = (omega[k], damping[k]);
        if w == 0.0 {
            pairs[k] = [Complex::default(), Complex::new(-c, 0.0)];
            if drag != 0.0 {
                let mut z = Complex::new(-c, 0.0);
                for _ in 0..60 {
                    // The zero root is known: deflate it.
                    let n = tree.log_derivative(z, &mut work) - Complex::new(1.0, 0.0) / z;
                    evaluations += 1;
                    let step = Complex::new(1.0, 0.0) / n;
                    if !(step.re.is_finite() && step.im.is_finite()) {
                        break;
                    }
                    z = z - step;
                    if converged(step, z) {
                        break;
                    }
                }
                z.im = 0.0;
                pairs[k][1] = z;
            }
            continue;
        }
        if c.abs() >= 2.0 * w {
            simple = false;
            continue;
        }
        let mut z = Complex::new(-0.5 * c, (w * w - 0.25 * c * c).sqrt());
        let mut done = c == 0.0;
        if !done {
            for _ in 0..40 {
                let n = tree.log_derivative(z, &mut work);
                evaluations += 1;
                let step = Complex::new(multiplicity[k], 0.0) / n;
                if !(step.re.is_finite() && step.im.is_finite()) {
                    // The determinant is zero to the last digit, or the point is a saddle of it.
                    done = n.norm1().is_nan() || n.norm1() > 0.0;
                    break;
                }
                z = z - step;
                if converged(step, z) {
                    done = true;
                    break;
                }
            }
        }
        simple &= done && z.im > 0.0;
        pairs[k] = [z, Complex::new(z.re, -z.im)];
    }
    // Every eigenvalue once?
    for i in 0..m {
        for j in 0..i {
            let same = (pairs[i][0] - pairs[j][0]).norm1() <= 1e-9 * pairs[i][0].norm1();
            simple &= !(same && omega[i] > 0.0 && (omega[i] - omega[j]).abs() > CLUSTER * omega[i]);
        }
    }
    if simple {
        return Ok(Spectrum { pairs, evaluations });
    }
    let mut all: Vec<Complex> = Vec::new();
    let mut fixed: Vec<Complex> = Vec::new();
    for k in 0..m {
        let (w, c) = (omega[k], damping[k]);
        if w == 0.0 {
            fixed.extend_from_slice(&pairs[k]);
        } else if c.abs() < 2.0 * w {
            let im = (w * w - 0.25 * c * c).sqrt();
            // Starts are not mirror images, so that pairs may become real.
            all.push(Complex::new(-0.5 * c + 1e-3 * w, im));
            all.push(Complex::new(-0.5 * c - 1e-3 * w, -im));
        } else {
            let r = (0.25 * c * c - w * w).sqrt();
            all.push(Complex::new(-0.5 * c + r, 1e-3 * w));
            all.push(Complex::new(-0.5 * c - r, -1e-3 * w));
        }
    }
    let mut moving = all.len();
    let mut done = vec![false; all.len()];
    for _ in 0..500 {
        if moving == 0 {
            break;
        }
        for i in 0..all.len() {
            if done[i] {
                continue;
            }
            let n = tree.log_derivative(all[i], &mut work);
            evaluations += 1;
            if !(n.re.is_finite() && n.im.is_finite()) {
                done[i] = true;
                moving -= 1;
                continue;
            }
            let mut repel = Complex::default();
            for (j, z) in all.iter().enumerate() {
                let d = all[i] - *z;
                if j != i && d.norm1() > 0.0 {
                    repel = repel + Complex::new(1.0, 0.0) / d;
                }
            }
            for z in &fixed {
                let d = all[i] - *z;
                if d.norm1() > 0.0 {
                    repel = repel + Complex::new(1.0, 0.0) / d;
                }
            }
            let step = Complex::new(1.0, 0.0) / (n - repel);
            if step.re.is_finite() && step.im.is_finite() {
                all[i] = all[i] - step;
                if converged(step, all[i]) {
                    done[i] = true;
                    moving -= 1;
                }
            } else {
                all[i] = all[i] + Complex::new(1e-6, 1e-6) * Complex::new(all[i].norm1().max(1e-300), 0.0);
            }
        }
    }
    if moving > 0 {
        return Err(EvalError::fatal(
            "eigenvalues",
            format!(
                "{moving} damped eigenvalues are not found: critically damped modes have double ones, which no iteration separates"
            ),
        ));
    }
    // What is real to rounding is real.
    for z in &mut all {
        if z.im.abs() <= 1e-10 * z.re.abs() {
            z.im = 0.0;
        }
    }
    // Oscillating ones by frequency, then real ones by pairs, slow with fast.
    let mut upper: Vec<Complex> = all.iter().copied().filter(|z| z.im > 0.0).collect();
    let mut flat: Vec<f64> = all.iter().filter(|z| z.im == 0.0).map(|z| z.re).collect();
    upper.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    flat.sort_by(|a, b| b.total_cmp(a));
    if upper.len() * 2 + flat.len() != all.len() || !flat.len().is_multiple_of(2) {
        return Err(EvalError::fatal(
            "eigenvalues",
            "damped eigenvalues do not come in conjugate pairs: not all were found",
        ));
    }
    let half = flat.len() / 2;
    let mut list: Vec<[Complex; 2]> = upper.iter().map(|z| [*z, Complex::new(z.re, -z.im)]).collect();
    for k in 0..half {
        let z = |v: f64| Complex::new(v, 0.0);
        list.push([z(flat[k]), z(flat[flat.len() - 1 - k])]);
    }
    list.sort_by(|a, b| (a[0].abs() * a[1].abs()).total_cmp(&(b[0].abs() * b[1].abs())));
    let mut list = list.into_iter();
    for k in 0..m {
        if omega[k] > 0.0
            && let Some(p) = list.next()
        {
            pairs[k] = p;
        }
    }
    Ok(Spectrum { pairs, evaluations })
}
