//! What every friction model asks of its arguments.

use gudgeon_core::EvalError;
use gudgeon_core::kinds::Rubbing;

/// Whether what is given is finite and every buffer has the number of the speeds.
pub(super) fn check(model: &'static str, at: &Rubbing<'_>, lengths: [usize; 2]) -> Result<(), EvalError> {
    let n = at.speed.len();
    let lengths = [at.pressure.len(), at.real_area.len(), lengths[0], lengths[1]];
    if lengths.iter().any(|&k| k != n) {
        let what = format!("{n} speeds for pressures, areas and buffers of {lengths:?}");
        return Err(EvalError::fatal(model, what));
    }
    let given = [("sliding speed", at.speed), ("contact pressure", at.pressure), ("real area", at.real_area)];
    for (what, values) in given {
        if let Some(v) = values.iter().find(|v| !v.is_finite()) {
            return Err(EvalError::recoverable(model, format!("the {what} {v} is not finite")));
        }
    }
    Ok(())
}
