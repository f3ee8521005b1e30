//! What the models check of their settings and inputs.

use gudgeon_core::kinds::FilmMode;
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::vectors::all_finite;

/// Relative tolerance of a solution that is asked for when a case does not say.
pub(super) fn tolerance() -> f64 {
    1e-9
}

pub(super) fn check_tolerance(tolerance: f64) -> Result<(), BuildError> {
    if (1e-14..=0.1).contains(&tolerance) {
        Ok(())
    } else {
        let what = format!("must be between 1e-14 and 0.1, not {tolerance}");
        Err(BuildError::at("tolerance", what))
    }
}

pub(super) fn check_modes(
    model: &'static str,
    n: usize,
    modes: &[FilmMode<'_>],
    values: usize,
) -> Result<(), EvalError> {
    if values != n * modes.len() {
        return Err(EvalError::fatal(
            model,
            format!("{} modes of {n} nodes do not fit {values} values", modes.len()),
        ));
    }
    for m in modes {
        let sum = m.u + m.edge_pressure.iter().sum::<f64>();
        if !(sum.is_finite() && all_finite(m.dhdt) && (m.dhdt.is_empty() || m.dhdt.len() == n)) {
            return Err(EvalError::fatal(model, "a mode is not finite or not of the size of the grid"));
        }
    }
    Ok(())
}
