//! All damped eigenvalues together, by Aberth's method: each is pushed away from the others.

use gudgeon_core::EvalError;
use gudgeon_numerics::linalg::Complex;

use super::determinant::{Determinant, converged, is_finite, real};

/// Corrections of all eigenvalues.
const ROUNDS: usize = 500;

/// The eigenvalues of the elastic modes by pairs, ordered by the product of their magnitudes. `modes` holds undamped frequency and modal
/// damping of each, `rates` first values of the real roots of rigid modes, `known` their roots that are known.
pub(super) fn simultaneous(
    determinant: &mut Determinant<'_>,
    modes: &[[f64; 2]],
    rates: &[Complex],
    known: &[Complex],
) -> Result<Vec<[Complex; 2]>, EvalError> {
    let mut all = starts(modes);
    all.extend(rates);
    iterate(determinant, &mut all, known)?;
    // What is real to rounding is real.
    for z in &mut all {
        if z.im.abs() <= 1e-10 * z.re.abs() {
            z.im = 0.0;
        }
    }
    pairs(&all, modes.len())
}

/// Eigenvalues of each mode by itself, moved so that none are mirror images: pairs may become real.
fn starts(modes: &[[f64; 2]]) -> Vec<Complex> {
    let mut all = Vec::with_capacity(2 * modes.len());
    for &[w, c] in modes {
        if c.abs() < 2.0 * w {
            let im = (w * w - 0.25 * c * c).sqrt();
            all.push(Complex::new(-0.5 * c + 1e-3 * w, im));
            all.push(Complex::new(-0.5 * c - 1e-3 * w, -im));
        } else {
            let r = (0.25 * c * c - w * w).sqrt();
            all.push(Complex::new(-0.5 * c + r, 1e-3 * w));
            all.push(Complex::new(-0.5 * c - r, -1e-3 * w));
        }
    }
    all
}

/// Corrects all eigenvalues until none moves.
fn iterate(
    determinant: &mut Determinant<'_>,
    all: &mut [Complex],
    known: &[Complex],
) -> Result<(), EvalError> {
    let mut done = vec![false; all.len()];
    for _ in 0..ROUNDS {
        if done.iter().all(|d| *d) {
            return Ok(());
        }
        for i in 0..all.len() {
            if !done[i] {
                done[i] = correct(determinant, all, known, i);
            }
        }
    }
    let moving = done.iter().filter(|d| !**d).count();
    if moving == 0 {
        return Ok(());
    }
    Err(EvalError::fatal(
        "eigenvalues",
        format!(
            "{moving} damped eigenvalues are not found: critically damped modes have double ones, which no iteration separates"
        ),
    ))
}

/// One correction of eigenvalue `i`; whether it has come to rest.
fn correct(determinant: &mut Determinant<'_>, all: &mut [Complex], known: &[Complex], i: usize) -> bool {
    let n = determinant.log_derivative(all[i]);
    if !is_finite(n) {
        return true;
    }
    let mut repulsion = Complex::default();
    let others = all.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, z)| z);
    for z in others.chain(known) {
        let d = all[i] - *z;
        if d.norm1() > 0.0 {
            repulsion = repulsion + real(1.0) / d;
        }
    }
    let step = real(1.0) / (n - repulsion);
    if is_finite(step) {
        all[i] = all[i] - step;
        return converged(step, all[i]);
    }
    all[i] = all[i] + Complex::new(1e-6, 1e-6) * real(all[i].norm1().max(1e-300));
    false
}

/// Oscillating ones with their conjugates, then real ones by pairs, slow with fast, as many as there are modes: what is left between are rates of
/// rigid modes.
fn pairs(all: &[Complex], modes: usize) -> Result<Vec<[Complex; 2]>, EvalError> {
    let mut upper: Vec<Complex> = all.iter().copied().filter(|z| z.im > 0.0).collect();
    let mut flat: Vec<f64> = all.iter().filter(|z| z.im == 0.0).map(|z| z.re).collect();
    upper.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    flat.sort_by(|a, b| b.total_cmp(a));
    if upper.len() * 2 + flat.len() != all.len() || upper.len() > modes {
        return Err(EvalError::fatal(
            "eigenvalues",
            "damped eigenvalues do not come in conjugate pairs: not all were found",
        ));
    }
    let mut list: Vec<[Complex; 2]> = upper.iter().map(|z| [*z, Complex::new(z.re, -z.im)]).collect();
    for k in 0..modes - upper.len() {
        list.push([real(flat[k]), real(flat[flat.len() - 1 - k])]);
    }
    list.sort_by(|a, b| (a[0].abs() * a[1].abs()).total_cmp(&(b[0].abs() * b[1].abs())));
    Ok(list)
}
