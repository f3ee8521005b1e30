//! Jacobians by difference quotients.

use super::options::{Options, Stats};
use super::system::{ColumnGroups, OdeSystem};
use crate::EvalError;

/// Increment for a difference quotient in state `y` of absolute tolerance `atol` at relative tolerance `rtol`.
pub(crate) fn increment(y: f64, atol: f64, rtol: f64) -> f64 {
    // What is noise in y (atol / rtol) bounds its magnitude from below; a thousandth of it leaves room for a cautious atol.
    let scale = y.abs().max(atol / rtol.max(1e-12) * 1e-3).max(1e-30);
    let d = 1.5e-8 * scale;
    // The difference that is actually applied, free of rounding.
    (y + d) - y
}

/// Jacobian by differences, in groups where these are given, made to satisfy the system's invariants. `moved` has room for
/// one `y`, `work` for one `f`. A perturbed state that is refused is tried on its other side.
#[allow(clippy::too_many_arguments, reason = "scratch is passed in so that nothing is allocated")]
pub(crate) fn difference<S: OdeSystem + ?Sized>(
    sys: &mut S,
    groups: Option<&ColumnGroups>,
    t: f64,
    y: &[f64],
    f: &[f64],
    options: &Options,
    jac: &mut [f64],
    work: &mut [f64],
    moved: &mut [f64],
    stats: &mut Stats,
) -> Result<(), EvalError> {
    let n = y.len();
    // Towards where the solution goes: that side is more likely to be admissible.
    let step = |j: usize| {
        let d = increment(y[j], options.atol[j], options.rtol);
        if f[j] < 0.0 { (y[j] - d) - y[j] } else { d }
    };
    moved.copy_from_slice(y);
    jac.fill(0.0);
    let count = groups.map_or(n, |c| c.groups.len());
    for g in 0..count {
        let single = [g];
        let columns: &[usize] = groups.map_or(&single, |c| &c.groups[g]);
        let mut side = 1.0;
        loop {
            for &j in columns {
                moved[j] = y[j] + side * step(j);
            }
            stats.rhs += 1;
            let refusal = match sys.rhs(t, moved, work) {
                Ok(()) if all_finite(work) => None,
                Ok(()) => Some(EvalError::recoverable("difference", "a perturbed rate is not finite")),
                Err(e) if e.is_recoverable() => Some(e),
                Err(e) => return Err(e),
            };
            match refusal {
                None => break,
                Some(e) if side < 0.0 => return Err(e),
                Some(_) => side = -1.0,
            }
        }
        for &j in columns {
            // The increment that was made, after its own rounding.
            let d = moved[j] - y[j];
            moved[j] = y[j];
            match groups {
                None => {
                    for (i, (w, f)) in work.iter().zip(f).enumerate() {
                        jac[i * n + j] = (w - f) / d;
                    }
                }
                Some(c) => {
                    for &i in &c.rows[j] {
                        jac[i * n + j] = (work[i] - f[i]) / d;
                    }
                }
            }
        }
    }
    for inv in sys.invariants() {
        for j in 0..n {
            jac[inv.pivot * n + j] = inv.pivot_value(|row| jac[row * n + j]);
        }
    }
    Ok(())
}

/// Whether no entry is NaN or infinite. A sum of zeros times the entries: one pass without branches.
#[inline]
pub(crate) fn all_finite(v: &[f64]) -> bool {
    v.iter().map(|v| v * 0.0).sum::<f64>() == 0.0
}
