//! What a function says that could not be evaluated.

use std::borrow::Cow;

/// A model could not answer for these inputs.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EvalError {
    /// A smaller step may succeed (no convergence, a trial state outside the range). The integrator retries.
    #[error("{model}: {what}")]
    Recoverable {
        /// The model that could not answer.
        model: &'static str,
        /// What went wrong, with the offending values.
        what: Cow<'static, str>,
    },
    /// No step size can help. The run stops.
    #[error("{model}: {what}")]
    Fatal {
        /// The model that could not answer.
        model: &'static str,
        /// What went wrong, with the offending values.
        what: Cow<'static, str>,
    },
}

impl EvalError {
    /// A [`EvalError::Recoverable`].
    pub fn recoverable(model: &'static str, what: impl Into<Cow<'static, str>>) -> Self {
        Self::Recoverable { model, what: what.into() }
    }

    /// A [`EvalError::Fatal`].
    pub fn fatal(model: &'static str, what: impl Into<Cow<'static, str>>) -> Self {
        Self::Fatal { model, what: what.into() }
    }

    /// Whether a smaller step may help.
    #[must_use]
    pub const fn is_recoverable(&self) -> bool {
        matches!(self, Self::Recoverable { .. })
    }
}
