//! What models that answer slices of points ask of them.

use gudgeon_core::EvalError;
use gudgeon_numerics::vectors::finite_least;

/// Whether all inputs are finite and every output buffer has their number. The least input.
pub(crate) fn check(
    model: &'static str,
    what: &'static str,
    inputs: &[f64],
    lengths: &[usize],
) -> Result<f64, EvalError> {
    if lengths.iter().any(|&n| n != inputs.len()) {
        return Err(EvalError::fatal(
            model,
            format!("{} values of {what} for buffers of {lengths:?}", inputs.len()),
        ));
    }
    finite_least(inputs).ok_or_else(|| {
        let wrong = inputs.iter().copied().find(|v| !v.is_finite()).unwrap_or(f64::NAN);
        EvalError::recoverable(model, format!("{what} is {wrong}, which is not finite"))
    })
}
