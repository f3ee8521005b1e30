//! Why a run gives no result, and how far it is.

use gudgeon_core::result::{Failure, REFUSED};
use gudgeon_core::{BuildError, EvalError};
use gudgeon_numerics::Stopped;
use gudgeon_numerics::ode::IntegrateError;

/// How far a run is.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// What is going on.
    pub phase: String,
    /// Fraction done, 0 to 1.
    pub fraction: f64,
}

/// A case that is well-formed but whose run failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// A sub-model refused.
    #[error("at {theta_deg:.3} deg crank angle: {source}")]
    Eval {
        /// Where \[deg\].
        theta_deg: f64,
        /// What it said.
        source: EvalError,
    },
    /// A sub-model refused, wherever it was asked.
    #[error("{source}")]
    Model {
        /// What it said.
        source: EvalError,
    },
    /// The integrator gave up.
    #[error("the integration stopped: {}", in_degrees(.0))]
    Integrate(#[from] IntegrateError),
    /// A result is not a number: a defect of a model, caught before anything is written.
    #[error("the result `{0}` is not a number; nothing was written")]
    NotANumber(String),
    /// The sub-models could not be built a second time.
    #[error("{0}")]
    Refused(String),
    /// The caller wanted it to end.
    #[error("stopped before its end")]
    Stopped,
    /// What only the scene knows.
    #[error("{0}")]
    Scene(Box<dyn std::error::Error + Send + Sync>),
}

impl From<Stopped> for RunError {
    fn from(_: Stopped) -> Self {
        Self::Stopped
    }
}

impl RunError {
    /// The same, with a stop that came through a method told as what it is.
    #[must_use]
    pub(crate) fn plain(self) -> Self {
        match self {
            Self::Eval { source: EvalError::Stopped, .. }
            | Self::Model { source: EvalError::Stopped }
            | Self::Integrate(IntegrateError::Eval { source: EvalError::Stopped, .. }) => Self::Stopped,
            e => e,
        }
    }

    /// Whether another method may still succeed: it was neither stopped nor did a model refuse for good.
    #[must_use]
    pub const fn may_go_otherwise(&self) -> bool {
        match self {
            Self::Eval { source, .. }
            | Self::Model { source }
            | Self::Integrate(IntegrateError::Eval { source, .. }) => source.is_recoverable(),
            Self::Integrate(_) | Self::Scene(_) => true,
            Self::NotANumber(_) | Self::Refused(_) | Self::Stopped => false,
        }
    }

    /// The same as a row of a study tells it.
    #[must_use]
    pub fn failure(&self) -> Failure {
        let code = match self {
            Self::Eval { .. } | Self::Model { .. } => "model",
            Self::Integrate(_) => "integration",
            Self::NotANumber(_) => "not_a_number",
            Self::Refused(_) => REFUSED,
            Self::Stopped => "stopped",
            Self::Scene(_) => "scene",
        };
        Failure { code: code.into(), message: self.to_string(), path: String::new() }
    }

    /// An error of a scene's own.
    pub fn scene(e: impl std::error::Error + Send + Sync + 'static) -> Self {
        Self::Scene(Box::new(e))
    }

    /// A case that cannot be built, in one line.
    #[must_use]
    pub fn refused(errors: &[BuildError]) -> Self {
        Self::Refused(errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
    }
}

/// What an integrator over the crank angle says, with the angle in degrees.
fn in_degrees(e: &IntegrateError) -> String {
    let deg = |t: &f64| format!("{:.3} deg crank angle", t.to_degrees());
    match e {
        IntegrateError::Eval { t, source } => format!("at {}: {source}", deg(t)),
        IntegrateError::StepTooSmall { t, h, last } => {
            let why = last.as_ref().map_or_else(String::new, |e| format!(" ({e})"));
            format!("at {} the step would have to be smaller than {:e} deg{why}", deg(t), h.to_degrees())
        }
        IntegrateError::TooManySteps { t, max } => format!("more than {max} steps, stopped at {}", deg(t)),
        IntegrateError::NonFinite { t } => format!("at {} the rates are not finite", deg(t)),
        IntegrateError::Chatter { t, event } => {
            format!("at {} event {event} repeats without progress", deg(t))
        }
        other => other.to_string(),
    }
}
