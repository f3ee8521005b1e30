//! The search of the periodic state: how near, and what is told of it.

use gudgeon_core::Stopwatch;
use gudgeon_core::quantity::quantity;
use gudgeon_core::result::{Balance, Note};
use gudgeon_numerics::ode::{Again, IntegrateError, Stats};
use gudgeon_numerics::orbit::OrbitOptions;
use gudgeon_scene::{RunError, Stopped};
use indexmap::IndexMap;

use super::approach::{Start, approach};
use super::films_alone::FilmsAlone;
use super::sampler::liner_table;
use super::{Cycle, Implicit, Pack, RingIntegrator, Taken, Wanted};
use crate::error::RingPackError;
use crate::record::Totals;
use crate::results;
use crate::solver::{NOT_PERIODIC, Recorded, Solution};

/// How many times the search of a periodic state may tighten the tolerance tenfold: rings that float amplify the error of a cycle.
const REFINEMENTS: usize = 2;
/// How much less repeatable than its integration a cycle with oil on the liner is where films do not take the same steps again, and up to what error: with 4e-2 a search
/// ended where oil still crept by a hundredth a cycle.
const OIL_NOISE: f64 = 20.0;
const OIL_MOST: f64 = 1e-2;
/// Largest noise of a cycle with oil on the liner in the same steps that tighter tolerances do not lessen: at 1e-4 cycles differ by 1e-4 to 3e-4. Why is not known; an edge of a
/// film that is in one cell of the liner or in the next would do it.
const CELLS: f64 = 1e-4;
/// Periodicity with oil on the liner in the same steps over the noise of a cycle: the slowest mode multiplies that by ten and more.
const OIL_AGAIN: f64 = 10.0;
/// Most cycles in halves, without oil on the liner and with it, before the pack is integrated whole.
const HALVES_TRY: [usize; 2] = [10, 40];
/// Tolerance of that over the one that was asked for: with it both leave the same errors.
const WHOLE: f64 = 0.3;
/// What is said of a cycle that does not close as it should.
pub(super) fn not_periodic(error: f64, wanted: f64, cycles: usize) -> Note {
    let seen = if error <= wanted { " only since the last cycle" } else { "" };
    let text = format!(
        "not periodic within {wanted:.0e} after {cycles} cycles: the estimated error is {error:.1e}{seen}. Raise `solver.max_cycles`, tighten \
         `solver.tolerance`, or look for a mode that never settles (a ring that flutters)"
    );
    let failed = error.is_nan() || error > NOT_PERIODIC * wanted;
    let note = if failed { Note::failure("not_periodic", text) } else { Note::caution("not_periodic", text) };
    note.amount("estimated_error", error, "1").amount("wanted", wanted, "1")
}

/// What stopped an integration.
pub(super) fn stopped(e: IntegrateError) -> RunError {
    match e {
        IntegrateError::Eval { t, source } => RunError::Eval { theta_deg: t.to_degrees(), source },
        IntegrateError::TooManySteps { t, max } => {
            RunError::scene(RingPackError::Steps { theta_deg: t.to_degrees(), max })
        }
        other => RunError::Integrate(other),
    }
}

/// Work counters of a search.
pub(super) fn counters(work: &Stats) -> IndexMap<String, u64> {
    let all = [
        ("steps", work.steps),
        ("rejected", work.rejected),
        ("rhs", work.rhs),
        ("jacobians", work.jacobians),
        ("factorisations", work.lu),
        ("events", work.events),
        ("stages", work.stages),
    ];
    // Methods without stages of the scene's own do not speak of them.
    let all = all.into_iter().filter(|(name, n)| *name != "stages" || *n > 0);
    all.map(|(k, v)| (k.to_owned(), v)).collect()
}

/// States with which the first cycle starts, all lands at `start` \[Pa\].
pub(super) fn first_states(pack: &mut Pack, start: f64) -> Vec<f64> {
    let dim = pack.layout.n;
    let mut y = vec![0.0; dim + pack.layout.carried];
    pack.initial(start, &mut y[..dim]);
    if let Some(oil) = &pack.oil_pack {
        oil.field(&mut y[dim..]);
    }
    y
}

/// Noise of a cycle in halves with oil on the liner, in the steps of the one before.
pub(super) const fn oil_noise(tolerance: f64) -> f64 {
    (Again::NOISE * tolerance).max(tolerance.min(CELLS))
}

/// Least periodicity with oil on the liner where films do not take the same steps again.
pub(super) fn oil_least(tolerance: f64) -> f64 {
    (OIL_NOISE * tolerance).min(OIL_MOST).max(tolerance)
}

/// How the periodic state is searched.
pub(super) fn orbit_options(s: &Implicit, pack: &Pack) -> OrbitOptions {
    // A map is only as repeatable as its integration is accurate, and where a film ends on the liner depends on where steps end.
    let tolerance = s.tolerance.si();
    let halves = s.integrator == RingIntegrator::Waveform;
    let least = match (pack.oil_pack.is_some(), halves) {
        (true, true) => OIL_AGAIN * oil_noise(tolerance),
        (true, false) => oil_least(tolerance),
        _ => tolerance,
    };
    let most = if halves { HALVES_TRY[usize::from(pack.oil_pack.is_some())] } else { usize::MAX };
    OrbitOptions {
        tolerance: s.periodicity.si().max(least),
        accuracy: tolerance,
        max_cycles: most.min(s.max_cycles as usize),
        refinements: if halves { 0 } else { REFINEMENTS },
        accelerate: pack.decision_interval().is_none(),
    }
}

/// Solves one start.
pub(super) fn run(
    s: &Implicit,
    pack: &mut Pack,
    start: f64,
    wanted: &Wanted<'_>,
    progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
) -> Result<Solution, RunError> {
    pack.follow_passages(false);
    let begun = approach(s, pack, start, wanted, progress)?;
    let led = begun.led();
    search(s, (pack, begun), wanted, &mut |done| progress(led + (1.0 - led) * done), start)
}

/// Searches the periodic state from where it begins, and measures its cycle.
fn search(
    s: &Implicit,
    (pack, begun): (&mut Pack, Start),
    wanted: &Wanted<'_>,
    progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    start: f64,
) -> Result<Solution, RunError> {
    let clock = Stopwatch::start();
    let discrete = pack.decision_interval().is_some();
    let tolerance = s.tolerance.si();
    let mut options = orbit_options(s, pack);
    options.max_cycles -= begun.coarse;
    let led = begun.seconds;
    let mut cycle = Cycle::new(s, pack, wanted, progress);
    let mut y = cycle.begin_at(begun);
    let turns = cycle.come_near(&mut y, &options)?;
    options.max_cycles = options.max_cycles.saturating_sub(turns);
    let closed = cycle.close(&mut y, &options);
    let coarse = cycle.coarse + cycle.films_cycles;
    let apart = closed.as_ref().map_or_else(RunError::may_go_otherwise, |report| !report.converged);
    if s.integrator == RingIntegrator::Waveform && apart {
        let led = led + clock.seconds();
        let (why, work) = (cycle.why_whole(), (cycle.done, counters(&cycle.stats)));
        let mut solution = whole(s, (pack, start), wanted, progress, work)?;
        solution.notes.push(integrated_whole(&why, whole_tolerance(s)));
        solution.seconds += led;
        return Ok(solution);
    }
    let mut report = closed?;
    let mut cycles = report.cycle_equivalents + turns as f64;
    let Taken { sampler, balance } = match cycle.taken.take() {
        Some(taken) => taken,
        None => {
            let taken = cycle.record(&mut y, tolerance).map_err(stopped)?;
            cycle.judge(&mut report, options.tolerance);
            cycles += 1.0;
            taken
        }
    };
    let mut counters = counters(&cycle.stats);
    let q = cycle.q;
    let (energy, momentum) = sampler.balance(pack);
    let gas_energy = pack.layout.gas_quad().and_then(|k| sampler.gas_ledger.closure(q[k]));
    let totals = Totals {
        balance: Balance { energy, momentum, gas_energy, ..balance },
        periodicity_error: report.error_estimate,
        ..Totals::of_cycle(pack, &q)
    };
    sampler.watch.carried(pack)?;
    let mut notes = sampler.watch.notes(pack);
    if report.period == 1 && !report.converged {
        notes.push(not_periodic(report.error_estimate, options.tolerance, report.cycles + turns));
    }
    if coarse > 0 {
        counters.insert("coarse_cycles".into(), coarse as u64);
    }
    Ok(Solution {
        liner: liner_table(pack, sampler.liner),
        record: Recorded::Rows(sampler.rows),
        retreats: sampler.watch.events(),
        cycle: results::Cycle { totals, measures: sampler.measures },
        // Decisions that do not repeat are told by the caller, for every start.
        period: if report.converged || !discrete { report.period } else { 0 },
        cycles,
        counters,
        notes,
        // With the cycle that is recorded, whether the search had foreseen that or not.
        seconds: led + clock.seconds(),
    })
}

/// Tolerance at which a pack is integrated whole in place of halves.
fn whole_tolerance(s: &Implicit) -> f64 {
    WHOLE * s.tolerance.si()
}

/// What is said of a pack whose halves are no way to its periodic state.
fn integrated_whole(why: &str, tolerance: f64) -> Note {
    let text = format!(
        "{why} (`solver.integrator` `waveform`): the pack was integrated whole, by `rodas3` at a tolerance of {tolerance:.1e}. Where \
         rings leave the liner or flutter, take that from the start"
    );
    Note::caution("halves_apart", text).of_numerics()
}

/// Solves one start by the whole pack, whose halves were no way.
fn whole(
    s: &Implicit,
    (pack, start): (&mut Pack, f64),
    wanted: &Wanted<'_>,
    progress: &mut dyn FnMut(f64) -> Result<(), Stopped>,
    (cycles, work): (f64, IndexMap<String, u64>),
) -> Result<Solution, RunError> {
    let tolerance = quantity(whole_tolerance(s));
    let whole = Implicit { tolerance, integrator: RingIntegrator::Rodas3, ..s.clone() };
    pack.follow_passages(false);
    let mut begun = Start::cold(pack, start);
    if pack.oil_pack.is_some() {
        begun.films = Some(FilmsAlone::new(s.clone(), orbit_options(s, pack), pack));
    }
    let mut solution = search(&whole, (pack, begun), wanted, progress, start)?;
    for (name, count) in work {
        *solution.counters.entry(name).or_default() += count;
    }
    solution.cycles += cycles;
    Ok(solution)
}
