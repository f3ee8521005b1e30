//! What models that answer slices of points ask of them.

use gudgeon_core::EvalError;
use gudgeon_numerics::vectors::all_finite;

/// Whether all inputs are finite and every output buffer has their number.
pub(crate) fn check(
    model: &'static str,
    what: &'static str,
    inputs: &[f64],
    lengths: &[usize],
) -> Result<(), EvalError> {
    if lengths.iter().any(|&n| n != inputs.len()) {
        return Err(EvalError::fatal(
            model,
            format!("{} values of {what} for buffers of {lengths:?}", inputs.len()),
        ));
    }
    if all_finite(inputs) {
        return Ok(());
    }
    match inputs.iter().find(|v| !v.is_finite()) {
        Some(v) => Err(EvalError::recoverable(model, format!("{what} is {v}, which is not finite"))),
        None => Ok(()),
    }
}
