//! Accuracy and limits, counts of work, and why an integration ends early.

use crate::EvalError;

/// Accuracy and limits of an integration.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Relative error per step.
    pub rtol: f64,
    /// Absolute error per step, one per state.
    pub atol: Vec<f64>,
    /// States whose value says nothing about the accuracy they need (a position, whose origin is arbitrary): for them
    /// `atol` alone counts. One per state; empty: none.
    pub absolute: Vec<bool>,
    /// Absolute error per step, one per quadrature; empty: quadratures take no part in the error control.
    pub atol_quad: Vec<f64>,
    /// First step; 0 lets the integrator choose.
    pub h_init: f64,
    /// Largest step.
    pub h_max: f64,
    /// Smallest step.
    pub h_min: f64,
    /// Maximum number of steps, rejected ones included.
    pub max_steps: u64,
    /// Ends of the steps of an integration that was much like this one: they are taken again, and only a step whose error is more than [`Options::slack`] times what is
    /// admitted is tried in parts. Empty: steps are as long as their errors allow. Results then go smoothly with the start, which the number of steps spoils.
    pub ends: Vec<f64>,
    /// Error of a step over the one admitted with which it is accepted.
    pub slack: f64,
    /// Points inside each step at which event functions are looked at, beside its ends.
    pub event_samples: u32,
}

impl Options {
    /// Whether `atol` alone counts for state or quadrature `i`.
    #[inline]
    pub(crate) fn is_absolute(&self, i: usize) -> bool {
        self.absolute.get(i).copied().unwrap_or(false)
    }

    /// Relative error of state or quadrature `i`.
    #[inline]
    pub(crate) fn relative(&self, i: usize) -> f64 {
        if self.is_absolute(i) { 0.0 } else { self.rtol }
    }

    /// Relative tolerance `rtol`, absolute `rtol * scale`; quadratures outside the error control.
    #[must_use]
    pub fn new(rtol: f64, scale: &[f64]) -> Self {
        Self {
            rtol,
            atol: scale.iter().map(|s| s * rtol).collect(),
            absolute: Vec::new(),
            atol_quad: Vec::new(),
            h_init: 0.0,
            h_max: f64::INFINITY,
            h_min: 0.0,
            max_steps: 2_000_000,
            ends: Vec::new(),
            slack: 1.0,
            event_samples: 3,
        }
    }
}

/// Work of an integration.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Stats {
    /// Accepted steps.
    pub steps: u64,
    /// Rejected steps.
    pub rejected: u64,
    /// Right-hand sides, those for Jacobians included.
    pub rhs: u64,
    /// Jacobians.
    pub jacobians: u64,
    /// Factorisations.
    pub lu: u64,
    /// Triangular solves.
    pub solves: u64,
    /// Stages that the system solved itself.
    pub stages: u64,
    /// Events that happened.
    pub events: u64,
}

impl Stats {
    /// Adds the work of another integration.
    pub fn add(&mut self, o: &Self) {
        self.steps += o.steps;
        self.rejected += o.rejected;
        self.rhs += o.rhs;
        self.jacobians += o.jacobians;
        self.lu += o.lu;
        self.solves += o.solves;
        self.stages += o.stages;
        self.events += o.events;
    }
}

/// Why an integration ended early.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntegrateError {
    /// The right-hand side refused.
    #[error("at {t}: {source}")]
    Eval {
        /// Where.
        t: f64,
        /// Its error.
        source: EvalError,
    },
    /// The step would have to be smaller than allowed.
    #[error("at {t} the step would have to be smaller than {h:e}{}", .last.as_ref().map(|e| format!(" ({e})")).unwrap_or_default())]
    StepTooSmall {
        /// Where.
        t: f64,
        /// The step.
        h: f64,
        /// The last refusal of the right-hand side, when that was the cause.
        last: Option<EvalError>,
    },
    /// More steps than allowed.
    #[error("more than {max} steps, stopped at {t}")]
    TooManySteps {
        /// Where.
        t: f64,
        /// The limit.
        max: u64,
    },
    /// The rates are not finite at an accepted state, or for any step from it.
    #[error("at {t} the rates are not finite")]
    NonFinite {
        /// Where.
        t: f64,
    },
    /// An event restarts the integration again and again without progress in time.
    #[error("at {t} event {event} repeats without progress")]
    Chatter {
        /// Where.
        t: f64,
        /// Which event function.
        event: usize,
    },
    /// Options or array lengths that contradict the system.
    #[error("{what}")]
    Input {
        /// What is wrong.
        what: &'static str,
    },
}
