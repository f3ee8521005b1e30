//! Errors of this model.

use gudgeon_core::EvalError;

pub(super) const MODEL: &str = "closed_form_face";

pub(super) fn no_convergence(what: &'static str) -> EvalError {
    EvalError::recoverable(MODEL, format!("no convergence of the {what}"))
}

pub(super) fn finite(x: f64, what: &'static str) -> Result<f64, EvalError> {
    if x.is_finite() { Ok(x) } else { Err(EvalError::recoverable(MODEL, format!("{what} out of range"))) }
}
