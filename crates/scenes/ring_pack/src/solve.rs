//! Every start of a case brought to its periodic state; the distinct ones told apart.

use gudgeon_core::result::{Branch, Event, Note, Series, SolverReport};
use gudgeon_scene::elsewhere::{Elsewhere, another};
use gudgeon_scene::{Progress, RunError, Stopped};
use indexmap::IndexMap;

use super::case::RingPackCase;
use super::evaporation;
use super::headlines::headlines;
use super::meter;
use super::pack::Pack;
use super::record::Record;
use super::results::Cycle;
use super::solver::{Recorded, Solution, Wanted};

/// A solved pack: the last cycle of the first start, and what else was found.
pub struct Solved {
    /// Film on the liner at the dead centres, when oil is followed.
    pub liner: Option<Series>,
    /// The series of the last cycle.
    pub record: Record,
    /// The last cycle.
    pub cycle: Cycle,
    /// Periodic solutions, when there are several or the start matters.
    pub branches: Vec<Branch>,
    /// Rings that left the liner.
    pub retreats: Vec<Event>,
    /// Work.
    pub report: SolverReport,
    /// Wall time of the solver \[s\], with the cycle that is measured; rows of the series are made after it.
    pub seconds: f64,
}

/// Starts when the case names none.
pub(super) fn starts(case: &RingPackCase, pack: &Pack) -> Vec<f64> {
    if !case.solver.starts.is_empty() {
        return case.solver.starts.iter().map(|p| p.si()).collect();
    }
    let mut s = vec![pack.p_crankcase];
    if pack.decision_interval().is_some() {
        s.push(ELSEWHERE);
    }
    s
}

/// Pressure of all lands \[Pa\] at a second start, that between the rings of an engine at load.
const ELSEWHERE: f64 = 6e5;
/// Starts whose pressures differ by less than this factor count as one; the second is then lower by the other factor.
const APART: f64 = 2.0;
const LOWER: f64 = 6.0;

/// The second start of a case that has one.
pub(super) fn elsewhere(case: &RingPackCase, pack: &Pack) -> Option<Elsewhere> {
    let &[own] = &starts(case, pack)[..] else { return None };
    let near = (own / ELSEWHERE).max(ELSEWHERE / own) < APART;
    let other = if near { own / LOWER } else { ELSEWHERE };
    Some(Elsewhere {
        starts: [own, other].map(named),
        set: vec![format!("solver.starts=[\"{other:.6e} Pa\"]")],
    })
}

/// A start in words.
fn named(pressure: f64) -> String {
    format!("all lands at {:.2} bar", pressure / 1e5)
}

/// What the solver of a case has to gather.
pub(super) fn wanted(case: &RingPackCase) -> Wanted<'_> {
    Wanted {
        seat: case.outputs.seat.si(),
        series_step: case.outputs.series_step.si(),
        limits: &case.solver.limits,
    }
}

/// Solves the case.
///
/// # Errors
/// What stopped the solver.
pub fn solve(
    case: &RingPackCase,
    pack: &mut Pack,
    progress: &mut dyn FnMut(Progress) -> Result<(), Stopped>,
) -> Result<Solved, RunError> {
    let starts = starts(case, pack);
    let total = starts.len() as f64;
    let wanted = wanted(case);
    let mut found: Vec<(f64, Solution)> = Vec::new();
    for (k, start) in starts.iter().enumerate() {
        let phase =
            if starts.len() > 1 { format!("start at {:.2} bar", start / 1e5) } else { "solving".to_owned() };
        let mut tell = |f: f64| progress(Progress { phase: phase.clone(), fraction: (k as f64 + f) / total });
        found.push((*start, case.solver.method.solve(pack, *start, &wanted, &mut tell)?));
    }
    let mut branches = branches(case, pack, &found);
    let report = report(case, pack, &found, &branches);
    if branches.len() < 2 {
        branches.clear();
    }
    let seconds = found.iter().map(|(_, f)| f.seconds).sum();
    let (_, first) = found.swap_remove(0);
    let record = match first.record {
        Recorded::Series(record) => record,
        Recorded::Rows(rows) => rows
            .record(pack)
            .map_err(|source| RunError::Eval { theta_deg: pack.at.theta.to_degrees(), source })?,
    };
    Ok(Solved {
        liner: first.liner,
        record,
        cycle: first.cycle,
        branches,
        retreats: first.retreats,
        report,
        seconds,
    })
}

/// The distinct periodic solutions.
fn branches(case: &RingPackCase, pack: &Pack, found: &[(f64, Solution)]) -> Vec<Branch> {
    let (m, leading) = (meter(case), headlines(&pack.names));
    let mut branches: Vec<Branch> = Vec::new();
    for (start, f) in found {
        let results = f.cycle.results(pack, m);
        let name = format!("{:.2} bar", start / 1e5);
        let alike = |b: &&mut Branch| another(&b.results, &results, &leading, &IndexMap::new()).is_none();
        match branches.iter_mut().find(alike) {
            Some(b) => {
                b.start.push_str(" and ");
                b.start.push_str(&name);
            }
            None => {
                branches.push(Branch { start: format!("all lands at {name}"), period: f.period, results })
            }
        }
    }
    branches
}

/// Work and notes of all starts.
fn report(case: &RingPackCase, pack: &Pack, found: &[(f64, Solution)], branches: &[Branch]) -> SolverReport {
    let mut report = SolverReport {
        method: case.solver.method.typetag_name().into(),
        notes: pack.cylinder.notes(),
        ..SolverReport::default()
    };
    report.notes.extend(pack.oil_pack.iter().flat_map(|oil| oil.notes()));
    if branches.len() > 1 {
        report.notes.push(Note::caution(
            "several_solutions",
            format!(
                "this case has {} periodic solutions; the results are those of the first start ({})",
                branches.len(),
                branches[0].start
            ),
        ));
    }
    // A solver that has seen by how much its cycle does not repeat has said so.
    let said = found.iter().any(|(_, f)| f.notes.iter().any(|n| n.topic == "not_periodic"));
    for b in branches {
        match b.period {
            1 => {}
            0 if said => {}
            0 => report.notes.push(Note::failure(
                "not_periodic",
                format!("started with {}, the cycle did not become periodic", b.start),
            )),
            p => report.notes.push(Note::caution(
                "subharmonic",
                format!(
                    "started with {}, the cycle repeats only every {p} cycles; the results are those of one of them",
                    b.start
                ),
            )
            .amount("period", f64::from(p), "1")),
        }
    }
    for (_, f) in found {
        for (name, n) in &f.counters {
            *report.counters.entry(name.clone()).or_insert(0) += n;
        }
        for n in &f.notes {
            // What acted is told once, for the reported cycle; how well a cycle repeats, for every start.
            let told = n.topic != "not_periodic" && report.notes.iter().any(|m| m.topic == n.topic);
            if !told && !report.notes.contains(n) {
                report.notes.push(n.clone());
            }
        }
    }
    if let Some((_, first)) = found.first() {
        report.notes.extend(evaporation::note(&first.cycle.totals));
        report.notes.extend(first.cycle.lost_charge(pack, meter(case)));
    }
    report.counters.insert("cycles".into(), found.iter().map(|(_, f)| f.cycles).sum::<f64>().ceil() as u64);
    report.counters.insert("states".into(), pack.layout.n as u64);
    report.counters.insert("film_evaluations".into(), pack.counters.film);
    report.counters.insert("gas_evaluations".into(), pack.counters.gas);
    report
}
