//! What a solver of a piston in its bore is.

use std::fmt::Debug;

use dyn_clone::DynClone;
use gudgeon_core::{BuildError, register_kind};
use gudgeon_numerics::ode::Stats;
use gudgeon_scene::{MethodSetting, RunError};

use super::assembly::Assembly;
use super::equations::Work;
use super::trajectory::Trajectory;

/// Configuration of a solver: the keys of the table `solver` that are its own.
///
/// It integrates one cycle at a time; the search of the periodic motion calls it again and again.
#[register_kind(
    name = "piston_solver",
    summary = "integrates the motion of a piston in its bore over a cycle"
)]
pub trait PistonSolverSpec: Debug + DynClone + Send + Sync {
    /// What is wrong with its own numbers, or with rows of the series every `series_step` \[rad\], with places in the case.
    fn wrong(&self, series_step: f64) -> Vec<BuildError>;

    /// Why it cannot integrate this motion, with its place in the case.
    fn refuses(&self, _a: &Assembly) -> Option<BuildError> {
        None
    }

    /// How repeatable a cycle is, in clearances: a search of the periodic motion looks no closer.
    fn repeatable_to(&self) -> f64;

    /// The solver, ready for cycles of `a`.
    fn build(&self, a: &Assembly) -> Box<dyn PistonSolver>;

    /// Its settings from coarse to fine, for diagrams of run time against error; where a case has this
    /// solver, `own` are the intervals of its film along and across.
    fn settings(&self, own: Option<[u32; 2]>) -> Vec<MethodSetting>;
}

/// How accurate a search wants a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Error of a step that it admits, in clearances; where the solver's own is larger, that stands.
    pub error: f64,
    /// The part of the solver's own error that is asked for, below 1 where the noise of its steps is too much.
    pub part: f64,
}

impl Accuracy {
    /// That of the solver.
    pub const OWN: Self = Self { error: 0.0, part: 1.0 };

    /// The tolerance of a solver whose own it is.
    #[must_use]
    pub const fn tolerance(self, own: f64) -> f64 {
        if self.part < 1.0 { own * self.part } else { own.max(self.error) }
    }
}

/// A solver of one piston, its work arrays allocated.
pub trait PistonSolver {
    /// One cycle from the states `y`, into `trajectory` where one is wanted; `y` are the states at its end.
    ///
    /// # Errors
    /// A step that cannot be taken.
    fn cycle(
        &mut self,
        of: &mut Cycled<'_>,
        y: &mut [f64],
        accuracy: Accuracy,
        trajectory: Option<&mut Trajectory>,
    ) -> Result<(), RunError>;

    /// Part of its accuracy by which the last cycle differs from another from the same start.
    fn noise(&self) -> f64 {
        1.0
    }

    /// An empty cycle, as the solver fills it.
    fn trajectory(&self, a: &Assembly, work: &Work) -> Trajectory;
}

/// The piston that is integrated, with what it is integrated in.
pub struct Cycled<'a> {
    /// The piston.
    pub a: &'a mut Assembly,
    /// Coordinates and their rates; rates of zero at the start of a cycle.
    pub work: &'a mut Work,
    /// Steps, rejected steps, right-hand sides, Jacobians.
    pub stats: &'a mut Stats,
}

/// Intervals of the film along and across, as changes of a case.
pub(crate) fn mesh(along: u32, across: u32) -> [String; 2] {
    [format!("solver.intervals_along={along}"), format!("solver.intervals_across={across}")]
}

/// The complaint about a tolerance that is none.
pub(crate) fn check_tolerance(key: &str, value: f64) -> Option<BuildError> {
    let admitted = (1e-12..=0.1).contains(&value);
    let what = || format!("must be between 1e-12 and 0.1, not {value}");
    (!admitted).then(|| BuildError::at(format!("solver.{key}"), what()))
}
