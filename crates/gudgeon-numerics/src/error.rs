//! The error of a function that is integrated, iterated or searched.

use std::borrow::Cow;

/// A function could not be evaluated for the given arguments.
///
/// The functions that a method of this crate calls (right-hand sides, Jacobians, event functions, maps of a cycle) return this error. Its
/// variant decides what the method does next: a [`EvalError::Recoverable`] one makes an integrator reject the step and try a smaller
/// one, a [`EvalError::Fatal`] one ends the computation and is handed to the caller.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvalError {
    /// Arguments closer to the last accepted state may succeed: an inner iteration did not converge, or a trial state lies outside the
    /// range of the function.
    #[error("{model}: {what}")]
    Recoverable {
        /// Name of the function or of the model it belongs to.
        model: &'static str,
        /// What went wrong, with the offending values.
        what: Cow<'static, str>,
    },
    /// No step size can help: the function has no value here, or its parameters are wrong.
    #[error("{model}: {what}")]
    Fatal {
        /// Name of the function or of the model it belongs to.
        model: &'static str,
        /// What went wrong, with the offending values.
        what: Cow<'static, str>,
    },
    /// Nobody waits for the answer any more.
    #[error("{Stopped}")]
    Stopped,
}

/// The caller wants a computation to end: what a progress callback returns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("stopped")]
pub struct Stopped;

impl From<Stopped> for EvalError {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

/// A progress callback that never stops anything.
///
/// # Errors
/// None.
pub fn unwatched<T>(_: T) -> Result<(), Stopped> {
    Ok(())
}

impl EvalError {
    /// An [`EvalError::Recoverable`] of the function `model`.
    pub fn recoverable(model: &'static str, what: impl Into<Cow<'static, str>>) -> Self {
        Self::Recoverable { model, what: what.into() }
    }

    /// An [`EvalError::Fatal`] of the function `model`.
    pub fn fatal(model: &'static str, what: impl Into<Cow<'static, str>>) -> Self {
        Self::Fatal { model, what: what.into() }
    }

    /// Whether smaller steps may help.
    #[must_use]
    pub const fn is_recoverable(&self) -> bool {
        matches!(self, Self::Recoverable { .. })
    }
}
