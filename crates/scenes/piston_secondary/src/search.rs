//! The motions that a run searches: on the way to that of the case, those of a rigid skirt and of coarse films.

use gudgeon_core::BuildError;
use gudgeon_core::result::Skipped;
use gudgeon_numerics::orbit::Change;
use gudgeon_scene::{Progress, RunError, Stopped};

use gudgeon_case::Loaded;

use super::assemble::assemble;
use super::assembly::Assembly;
use super::case::PistonSecondaryCase;
use super::march::{self, Begin, Purpose};
use super::record;

/// Intervals of a film that is coarse enough to look for a start with, when that of the case is much finer.
fn coarse(case: &PistonSecondaryCase) -> Option<[u32; 2]> {
    let s = &case.solver;
    let own = [s.intervals_along, s.intervals_across];
    // Oil that is kept stays on its own grid: of the start alone little comes, so only a film of a small part of the work is worth it.
    let coarse = if case.models.skirt_oil.keeps_oil() {
        [0, 1].map(|k| COARSE[k].min(own[k]))
    } else {
        [0, 1].map(|k| (own[k] / 2).clamp(COARSEST[k], COARSE[k]).min(own[k]))
    };
    let much_finer = own[0] * own[1] >= 4 * coarse[0] * coarse[1];
    (s.cycles == 0 && much_finer).then_some(coarse)
}

/// Half the intervals of the case, up to these: forces within some percent, at a hundredth of the work of 64 x 48.
const COARSE: [u32; 2] = [16, 12];
/// Fewer than these say little of the motion.
const COARSEST: [u32; 2] = [8, 6];

/// What the films of a piston took so far.
pub fn work(piston: &gudgeon_skirt::Piston) -> [(&'static str, u64); 3] {
    [
        ("film_evaluations", piston.film_evaluations()),
        ("contact_sums", piston.sides.iter().map(|s| s.contact_sums()).sum()),
        ("newton_steps", piston.newton_steps),
    ]
}

/// What the assemblies of a run could not be built for: the same as before it.
pub fn refused(e: Vec<BuildError>) -> RunError {
    RunError::Refused(e.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))
}

/// All motions of a run, and what they took together.
pub struct Search<'a> {
    loaded: &'a Loaded<PistonSecondaryCase>,
    progress: &'a mut dyn FnMut(Progress) -> Result<(), Stopped>,
    /// Work of all motions.
    pub counters: indexmap::IndexMap<String, u64>,
    /// Wall time of the searches \[s\].
    pub seconds: f64,
}

/// Where the motion of the case is searched from.
#[derive(Default)]
pub struct Start {
    /// Whether the skirt yields enough for it to count.
    pub elastic: bool,
    /// States at the start of a cycle.
    pub states: Option<Vec<f64>>,
    /// What is known of the slope of a cycle.
    pub known: Vec<Change>,
    /// What was found not to be needed.
    pub skipped: Vec<Skipped>,
}

impl Start {
    /// The same, for a search.
    #[must_use]
    pub fn begin(&self) -> Begin<'_> {
        Begin { states: self.states.as_deref(), known: &self.known }
    }
}

impl<'a> Search<'a> {
    /// Nothing searched yet.
    pub fn new(
        loaded: &'a Loaded<PistonSecondaryCase>,
        progress: &'a mut dyn FnMut(Progress) -> Result<(), Stopped>,
    ) -> Self {
        Self { loaded, progress, counters: indexmap::IndexMap::new(), seconds: 0.0 }
    }

    /// An assembly whose films nobody has asked yet. A film starts from where its last search ended, so the one that was looked at before the run
    /// cannot take its place: its digits would be others.
    ///
    /// # Errors
    /// None that the case did not have before the run.
    pub fn built(&self, elastic: bool, intervals: Option<[u32; 2]>) -> Result<Assembly, RunError> {
        assemble(&self.loaded.value, &self.loaded.source.files, elastic, intervals).map_err(refused)
    }

    /// Looks whether the skirt yields, and for a start close to the periodic motion. `checked` is the assembly of the case.
    ///
    /// # Errors
    /// What stopped a motion.
    pub fn start(&mut self, checked: Assembly) -> Result<Start, RunError> {
        let case = &self.loaded.value;
        let periodic = case.solver.cycles == 0 && checked.layout.n > 0;
        let coarse = coarse(case);
        let mut start = Start::default();
        if !case.models.skirt_compliance.is_rigid() {
            self.rigid_first(checked, coarse, periodic, &mut start)?;
        }
        let looked_at = start.elastic || start.states.is_none();
        if let (true, true, Some(_)) = (periodic, looked_at, coarse) {
            // A start that is wrong costs cycles; one that is not found costs nothing more.
            let mut a = self.built(start.elastic, coarse)?;
            match self.run("coarse film", &mut a, start.begin(), Purpose::Start, true) {
                Ok(found) => (start.states, start.known) = (Some(found.start), found.changes),
                Err(RunError::Stopped) => return Err(RunError::Stopped),
                Err(_) => {}
            }
        }
        Ok(start)
    }

    /// The motion of a rigid skirt: whether its pressures would move the surface, and where it starts.
    fn rigid_first(
        &mut self,
        checked: Assembly,
        coarse: Option<[u32; 2]>,
        periodic: bool,
        start: &mut Start,
    ) -> Result<(), RunError> {
        let below = self.loaded.value.solver.rigid_below.si();
        let mut hard = self.built(false, coarse)?;
        // Of the skirt that yields the shapes alone count here, and no film is asked: on the grid of the case those of the checked assembly do.
        let soft = if coarse.is_some() { self.built(true, coarse)? } else { checked };
        let found = self.run("rigid skirt", &mut hard, Begin::default(), Purpose::Look, coarse.is_some())?;
        let (yielding, amplitudes) = record::yielding(&mut hard, &found.trajectory, &soft.piston)?;
        start.elastic = yielding >= below;
        if periodic {
            let mut states = found.start;
            if start.elastic {
                states.extend(amplitudes.iter().map(|q| q / soft.clearance));
                debug_assert_eq!(states.len(), soft.layout.n, "one amplitude a shape");
            }
            start.states = Some(states);
        }
        if !start.elastic {
            start.skipped.push(Skipped {
                what: "yielding of the skirt".into(),
                why: format!(
                    "the pressures on the rigid skirt would move its surface by {:.2} % of the gap at most, below {:.3} %: `solver.rigid_below`",
                    100.0 * yielding,
                    100.0 * below
                ),
            });
        }
        Ok(())
    }

    /// A motion for `purpose`; `coarse`: on a film that is not that of the case.
    ///
    /// # Errors
    /// What stopped it.
    pub fn run(
        &mut self,
        phase: &str,
        a: &mut Assembly,
        from: Begin<'_>,
        purpose: Purpose,
        coarse: bool,
    ) -> Result<march::Found, RunError> {
        let mut tell = |fraction: f64| (self.progress)(Progress { phase: phase.to_owned(), fraction });
        let found = march::run(&self.loaded.value, a, from, purpose, &mut tell)?;
        self.seconds += found.seconds;
        let s = &found.stats;
        let cycles = if coarse { "coarse_cycles" } else { "cycles" };
        for (name, n) in [
            ("steps", s.steps),
            ("rejected", s.rejected),
            ("rhs", s.rhs),
            ("jacobians", s.jacobians),
            (cycles, found.cycles.ceil() as u64),
        ]
        .into_iter()
        .chain(work(&a.piston))
        {
            self.count(name, n);
        }
        let nodes = a.piston.sides.iter().map(|s| s.nodes() as u64).sum();
        self.counters.insert("nodes".into(), nodes);
        Ok(found)
    }

    /// Adds `n` to a counter.
    pub fn count(&mut self, name: &str, n: u64) {
        *self.counters.entry(name.to_owned()).or_default() += n;
    }
}
