//! What a solver of a ring pack is.

use std::fmt::Debug;

use dyn_clone::DynClone;
use gudgeon_core::result::{Event, Gradients, Note, Series};
use gudgeon_core::{BuildError, register_kind};
use gudgeon_scene::{GradientError, MethodSetting, RunError, Stopped};
use indexmap::IndexMap;
use serde_json::Value;

use super::around::Around;
use super::limits::Limits;
use super::pack::Pack;
use super::record::Record;
use super::results::Cycle;
use super::rows::Rows;

/// Configuration of a solver: the keys of the table `solver` that are its own.
///
/// A solver drives the sub-models through [`Pack`] and gathers what the results need as it goes ([`Measures`](super::measure::Measures),
/// [`Watch`](super::watch::Watch), [`Rows`] or [`Record`]).
#[register_kind(name = "ring_pack_solver", summary = "brings a ring pack to its periodic state")]
pub trait RingPackSolverSpec: Debug + DynClone + Send + Sync {
    /// Why it cannot solve this pack, with places in the case.
    fn refuses(&self, pack: &Pack) -> Vec<BuildError>;

    /// Whether it can do two things at once, for the second of which it needs the pack a second time.
    fn works_at_once(&self, _pack: &Pack) -> bool {
        false
    }

    /// Brings the pack to its periodic state, from all lands at `start` \[Pa\].
    ///
    /// # Errors
    /// What stopped it.
    fn solve(
        &self,
        pack: &mut Pack,
        start: f64,
        wanted: &Wanted<'_>,
        progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Result<Solution, RunError>;

    /// Derivatives of the results by inputs through the periodic state that is reached from all lands at `start` \[Pa\]; the packs of `around` are
    /// the same with one input a little lower and a little higher.
    ///
    /// # Errors
    /// The solver or the pack has no such derivatives ([`GradientError::NoMethod`]), or what stopped it.
    fn gradients(
        &self,
        _pack: &mut Pack,
        _start: f64,
        _wanted: &Wanted<'_>,
        _around: Around<'_>,
        _progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    ) -> Result<Gradients, GradientError> {
        Err(GradientError::NoMethod("this solver follows no derivatives along a cycle".into()))
    }

    /// Fills in the numbers of the resolved table `solver` that the case leaves to the solver, for a pack of `rings` rings.
    fn resolve(&self, _rings: usize, _table: &mut Value) {}

    /// Its settings from coarse to fine, for diagrams of run time against error; the settings of a case are `own` where it has this solver.
    fn settings(&self, pack: &Pack, own: Option<&Value>) -> Vec<MethodSetting>;
}

/// What a solver has to gather.
#[derive(Debug, Clone, Copy)]
pub struct Wanted<'a> {
    /// Share of the axial clearance within which a ring is on a flank.
    pub seat: f64,
    /// Distance of the rows of the series \[rad\].
    pub series_step: f64,
    /// Floors, caps and limits.
    pub limits: &'a Limits,
}

/// One start brought to its periodic state.
pub struct Solution {
    /// Film on the liner at the dead centres, when oil is followed.
    pub liner: Option<Series>,
    /// The series of the last cycle.
    pub record: Recorded,
    /// The last cycle.
    pub cycle: Cycle,
    /// Cycles after which the state repeats: 1 normally, more for a periodic state of higher order, 0 when none was seen.
    pub period: u32,
    /// Work in cycles.
    pub cycles: f64,
    /// Work counters.
    pub counters: IndexMap<String, u64>,
    /// What a person has to know.
    pub notes: Vec<Note>,
    /// Rings that left the liner.
    pub retreats: Vec<Event>,
    /// Wall time \[s\], with the cycle that is measured.
    pub seconds: f64,
}

/// The series of a cycle, or what it is evaluated from.
pub enum Recorded {
    /// The series.
    Series(Record),
    /// Its instants.
    Rows(Rows),
}

/// A result whose cycle is farther from repeating than this many times the tolerance is not the periodic one.
pub const NOT_PERIODIC: f64 = 10.0;
