//! Stiff initial-value problems `y' = f(t, y)`, `q' = g(t, y)` with fallible right-hand sides, breakpoints, directed events
//! and dense output: what every integrator of this crate shares.
//!
//! # Error control
//! The norm is the largest component of `|error_i| / (atol_i + rtol max(|y_i| before, |y_i| after))`, not a root mean square: a
//! component that does not matter can then never loosen the control of one that does.
//!
//! # Kinks
//! A right-hand side may jump or have a kink at the breakpoints. Steps end exactly there, and no step of one side evaluates the
//! other: times within 8 machine epsilons (times `|t|`) of a breakpoint are moved that far inside the interval before they reach
//! the right-hand side.
//!
//! # Linear invariants
//! When `c·(f, g) = 0` for all arguments, the methods keep `c·(y, q)` constant to rounding, provided the Jacobian satisfies the
//! same relation. Finite differences do so only to (rounding of f) / increment; [`OdeSystem::invariants`] names the relations,
//! and one row of the Jacobian is then rewritten by each of them. The solution itself is never touched, so the closure of
//! the balance remains an honest check.
//!
//! # Events
//! Each event function has a *side*, the sign it was last known to have; a crossing is a change of side, and the direction
//! decides whether it counts. Functions are looked at on the dense output of every accepted step, at its ends and at
//! [`Options::event_samples`] points between, and roots are located to the resolution of `t`. After an event that changed the state
//! the function is zero but for rounding and its side unknown until it leaves a band of that width; the step that follows is
//! sampled geometrically from its start, so that a flight much shorter than the step is still seen. Nothing depends on
//! waiting times.

mod again;
mod check;
mod core;
mod dense;
mod difference;
mod driver;
mod events;
mod first_step;
mod integrator;
mod options;
mod samples;
mod step_matrix;
mod sums;
mod system;

pub use again::Again;
pub(crate) use check::{Shape, check};
pub(crate) use core::{Core, End, non_finite};
pub(crate) use dense::Interpolant;
pub(crate) use difference::{all_finite, difference};
pub(crate) use driver::{Scheme, Trial, drive};
pub use integrator::{Flow, Integrator, StepView};
pub use options::{IntegrateError, Options, Stats};
pub(crate) use step_matrix::StepMatrix;
pub(crate) use sums::{add_all, larger};
pub use system::{ColumnGroups, Direction, EventAction, LinearInvariant, OdeSystem, Stage};
