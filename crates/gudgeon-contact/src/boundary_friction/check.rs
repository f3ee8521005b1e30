//! What every friction model asks of its arguments.

use gudgeon_core::EvalError;

/// Whether speeds are finite and every buffer has their number.
pub(super) fn check(model: &'static str, speed: &[f64], lengths: &[usize]) -> Result<(), EvalError> {
    if lengths.iter().any(|&n| n != speed.len()) {
        let what = format!("{} speeds for buffers of {lengths:?}", speed.len());
        return Err(EvalError::fatal(model, what));
    }
    match speed.iter().find(|v| !v.is_finite()) {
        Some(v) => Err(EvalError::recoverable(model, format!("the sliding speed {v} m/s is not finite"))),
        None => Ok(()),
    }
}
